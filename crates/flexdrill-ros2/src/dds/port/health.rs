//! How DDS is, for status, diagnostics and alarms.

use crate::dds::plan::GuidPrefix;
use flexdrill_realtime::monotonic;

/// How long a reader that does not take, and a restart, are news (ns).
const NEWS: u64 = 60_000_000_000;

/// How DDS is.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Health {
    /// Whether it is up.
    pub is_up: bool,
    /// What the ids of all endpoints of its present life begin with; none before the first.
    pub participant: Option<GuidPrefix>,
    /// How often it was started again.
    pub restarts: u64,
    /// The newest times that it had to be, the last one last.
    pub newest: Vec<Restart>,
    /// Resident memory of its process (bytes).
    pub memory: u64,
    /// What the system's clock is ahead of the one that stamps (s): it was set by that much.
    pub clock_set_by: f64,
    /// The newest topic whose readers did not take, and who they are, with the instant (ns of the monotonic clock).
    pub stalled: Option<(u64, String)>,
}

/// Why DDS had to be started again.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Restart {
    /// When (ns of the monotonic clock).
    pub at: u64,
    /// Why.
    pub cause: String,
}

impl Health {
    /// How many restarts are kept.
    pub(super) const KEPT: usize = 16;

    /// Why it was started again the last time.
    pub fn cause(&self) -> Option<&str> {
        self.newest.last().map(|restart| restart.cause.as_str())
    }

    /// How often it was started again within the last minute.
    pub fn recent_restarts(&self) -> usize {
        let now = monotonic::now();
        self.newest
            .iter()
            .filter(|restart| now.saturating_sub(restart.at) < NEWS)
            .count()
    }

    /// The readers that did not take within the last minute.
    pub fn stalled_reader(&self) -> Option<&str> {
        let (at, who) = self.stalled.as_ref()?;
        (monotonic::now().saturating_sub(*at) < NEWS).then_some(who)
    }
}
