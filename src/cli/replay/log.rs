//! The way back from the model time of a replay to the field log that drove it.

use crate::field_log::LogRows;
use flexdrill_text::date_time;

/// The rows of the log, and the begin of the replay (ns since 1970).
#[derive(Debug, Default)]
pub(super) struct LogPlace {
    pub rows: LogRows,
    pub start: i64,
}

impl LogPlace {
    /// The row at a model time (s) in words; empty where no field log drove the run.
    pub(super) fn row(&self, seconds: f64) -> String {
        self.rows.row(self.start.saturating_add((1e9 * seconds).round() as i64))
    }

    /// The rows and the date of their begin; none where no field log drove the run.
    pub(super) fn text(&self) -> Option<String> {
        (!self.rows.is_empty()).then(|| format!("{}; begin: {}", self.rows.all(), date_time(self.start)))
    }
}
