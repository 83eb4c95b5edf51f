//! The state of DDS, for status, diagnostics and alarms.

use crate::dds::plan::GuidPrefix;
use flexdrill_clock::monotonic;

/// Time for which a stalled reader and a restart count as recent (ns).
const RECENT: u64 = 60_000_000_000;

/// The state of DDS.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Health {
    /// Whether DDS is up.
    pub is_up: bool,
    /// The prefix of the present participant's GUIDs; none before the first start.
    pub participant: Option<GuidPrefix>,
    /// Number of restarts.
    pub restarts: u64,
    /// The latest restarts, the newest one last.
    pub newest: Vec<Restart>,
    /// Resident memory of its process (bytes).
    pub memory: u64,
    /// Lead of the system's clock over the clock of the stamps (s): the system's clock was set by this.
    pub clock_set_by: f64,
    /// The newest stall of readers: its instant (ns of the monotonic clock), and a sentence that names topic and readers.
    pub stalled: Option<(u64, String)>,
}

/// A restart of DDS.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Restart {
    /// Its instant (ns of the monotonic clock).
    pub at: u64,
    /// Its cause.
    pub cause: String,
}

impl Health {
    /// Number of restarts that are kept.
    pub(super) const KEPT: usize = 16;

    /// The cause of the latest restart.
    pub fn cause(&self) -> Option<&str> {
        self.newest.last().map(|restart| restart.cause.as_str())
    }

    /// Number of restarts within the last minute.
    pub fn recent_restarts(&self) -> usize {
        let now = monotonic::now();
        self.newest
            .iter()
            .filter(|restart| now.saturating_sub(restart.at) < RECENT)
            .count()
    }

    /// The readers that stalled within the last minute.
    pub fn stalled_reader(&self) -> Option<&str> {
        let (at, text) = self.stalled.as_ref()?;
        (monotonic::now().saturating_sub(*at) < RECENT).then_some(text)
    }
}
