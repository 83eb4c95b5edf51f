//! The rows of the field log that drove a recorded run: from an instant of the recording to the row.

use flexdrill_text::printable;

/// Most rows that are kept: eleven days at 1 Hz, in 50 MB. Later instants have no row.
const MOST: usize = 1_000_000;

/// The source of a message on `rig/inputs` that a row of a field log gave: the row as an editor numbers it, and what its
/// time column says where that is no date.
pub fn row_source(row: u64, own_time: &str, file: &str) -> String {
    match own_time {
        "" => format!("row {row} of {file}"),
        own_time => format!("row {row} ({own_time}) of {file}"),
    }
}

/// The row, what its time column says, and the file, of a source that [`row_source`] made.
fn row_of(source: &str) -> Option<(u64, &str, &str)> {
    let rest = source.strip_prefix("row ")?;
    let (row, rest) = rest.split_once(' ')?;
    let row = row.parse().ok()?;
    if let Some(file) = rest.strip_prefix("of ") {
        return Some((row, "", file));
    }
    let (own_time, file) = rest.strip_prefix('(')?.split_once(") of ")?;
    Some((row, own_time, file))
}

#[derive(Debug, Clone)]
struct LogRow {
    /// ns since 1970, as recorded.
    time: i64,
    row: u64,
    /// What the time column says; empty where the recorded time is the log's own.
    own_time: Box<str>,
}

/// The rows of the log by their recorded times.
#[derive(Debug, Clone, Default)]
pub struct LogRows {
    rows: Vec<LogRow>,
    file: String,
}

impl LogRows {
    /// Adds the source of a message on `rig/inputs`, recorded at a time (ns since 1970); another source than a row of a log
    /// adds nothing.
    pub fn push(&mut self, time: i64, source: &str) {
        let Some((row, own_time, file)) = row_of(source) else {
            return;
        };
        if self.rows.len() == MOST {
            return;
        }
        if self.file != file {
            file.clone_into(&mut self.file);
        }
        self.rows.push(LogRow {
            time,
            row,
            own_time: own_time.into(),
        });
    }

    /// Whether no field log drove the run.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The newest row at an instant (ns since 1970), which drove the model then.
    fn at(&self, time: i64) -> Option<&LogRow> {
        let after = self.rows.partition_point(|row| row.time <= time);
        self.rows.get(after.checked_sub(1)?)
    }

    /// The row of an instant in words, such as `row 63 (time_s 62.35)`; empty without one.
    pub fn row(&self, time: i64) -> String {
        self.at(time).map_or_else(String::new, |row| match &*row.own_time {
            "" => format!("row {}", row.row),
            own_time => format!("row {} ({})", row.row, printable(own_time)),
        })
    }

    /// The rows from one instant to another in words; empty without any.
    pub fn span(&self, from: i64, to: i64) -> String {
        let (first, last) = (self.row(from), self.row(to));
        match (first.is_empty(), first == last) {
            // The first row begins the replay, so that an earlier instant belongs to it.
            (true, _) => last,
            (false, true) => first,
            (false, false) => format!("{first} to {last}"),
        }
    }

    /// First and last row and the file, in words.
    pub fn all(&self) -> String {
        let (Some(first), Some(last)) = (self.rows.first(), self.rows.last()) else {
            return String::new();
        };
        format!("{} of {}", self.span(first.time, last.time), printable(&self.file))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_found_again_by_its_time() {
        let mut rows = LogRows::default();
        rows.push(5, "WITS of rig 7");
        rows.push(5, "row x of a.csv");
        assert!(rows.is_empty() && rows.all().is_empty() && rows.row(7).is_empty());
        rows.push(10, &row_source(63, "time_s 62.35", "a (b) of c.csv"));
        rows.push(20, &row_source(64, "time_s 63.4", "a (b) of c.csv"));
        rows.push(30, &row_source(65, "", "a (b) of c.csv"));
        assert_eq!(rows.row(9), "");
        assert_eq!(rows.row(19), "row 63 (time_s 62.35)");
        assert_eq!(rows.row(99), "row 65");
        assert_eq!(rows.span(10, 25), "row 63 (time_s 62.35) to row 64 (time_s 63.4)");
        assert_eq!(rows.span(20, 21), "row 64 (time_s 63.4)");
        assert_eq!(rows.span(0, 12), "row 63 (time_s 62.35)");
        assert_eq!(rows.all(), "row 63 (time_s 62.35) to row 65 of a (b) of c.csv");
    }
}
