//! The clocks of a node.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use flexdrill_realtime::clock::rig_clock;
use flexdrill_realtime::monotonic;

/// Tells the time for ages, stamps and messages. All of them follow `/clock` where it paces the model.
#[derive(Debug, Clone)]
pub struct Clocks {
    /// The newest time on `/clock` (ns), 0 before the first message; none where the machine's clock paces the model.
    simulated: Option<Arc<AtomicU64>>,
}

/// Time of the steady clock (s).
pub fn steady() -> f64 {
    monotonic::now() as f64 * 1e-9
}

impl Clocks {
    /// The clocks of a node; `use_sim_time` makes them follow `/clock`.
    pub fn new(use_sim_time: bool) -> Self {
        Self {
            simulated: use_sim_time.then(Arc::default),
        }
    }

    /// The cell of the newest time on `/clock` (ns); none where the machine's clock paces the model.
    pub fn simulated(&self) -> Option<&Arc<AtomicU64>> {
        self.simulated.as_ref()
    }

    /// Whether `/clock` paces the model.
    pub fn are_simulated(&self) -> bool {
        self.simulated.is_some()
    }

    /// The time in which the inputs age (s). Without `/clock` no setting of the system's clock changes it.
    pub fn age_time(&self) -> f64 {
        self.simulated_time().unwrap_or_else(monotonic::now) as f64 * 1e-9
    }

    /// The instant with which foreign stamps are compared (ns since 1970). Without `/clock` it follows the system's clock,
    /// as the publisher's stamps do, also when that is set.
    pub fn stamp_time(&self) -> i64 {
        self.simulated_time().unwrap_or_else(|| {
            SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .map_or(0, |since| since.as_nanos() as u64)
        }) as i64
    }

    /// The instant for our own stamps (ns since 1970). Without `/clock` it keeps the system's clock of the start, so that
    /// all stamps of a run are on one clock.
    pub fn rig_time(&self) -> i64 {
        self.simulated_time().unwrap_or_else(rig_clock) as i64
    }

    fn simulated_time(&self) -> Option<u64> {
        self.simulated.as_ref().map(|newest| newest.load(Ordering::Acquire))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_clocks_follow_the_simulated_one() {
        let clocks = Clocks::new(true);
        assert_eq!((clocks.age_time(), clocks.stamp_time(), clocks.rig_time()), (0.0, 0, 0));
        let newest = clocks.clone().simulated().cloned().unwrap();
        newest.store(12_500_000_000, Ordering::Release);
        assert_eq!(clocks.age_time(), 12.5);
        assert_eq!(
            (clocks.stamp_time(), clocks.rig_time()),
            (12_500_000_000, 12_500_000_000)
        );
    }

    #[test]
    fn without_a_simulated_clock_stamps_are_instants_and_ages_are_not() {
        let clocks = Clocks::new(false);
        assert!(clocks.simulated().is_none() && !clocks.are_simulated());
        // 2020-01-01 (ns since 1970). The monotonic clock begins with the machine.
        const RECENT: i64 = 1_577_836_800_000_000_000;
        assert!(clocks.stamp_time() > RECENT && clocks.rig_time() > RECENT);
        assert!(clocks.age_time() < RECENT as f64 * 1e-9);
    }
}
