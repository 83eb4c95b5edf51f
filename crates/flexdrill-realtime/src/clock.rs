//! The clocks that can pace the solver.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use crate::monotonic;

/// Longest step of a simulated clock that counts as elapsed time (ns), for a clock that is published once a second at
/// many times real time. A longer step, in either direction, means that the clock was set.
pub const LEAP: u64 = 60_000_000_000;

/// A clock in nanoseconds with absolute deadlines.
pub trait Clock: Send {
    /// The present time (ns) from the clock's own zero.
    fn now(&self) -> u64;
    /// Waits for a deadline, for some milliseconds at most if its instant is unknown. The wait may end early or late;
    /// the caller reads [`Clock::now`].
    fn wait_until(&self, deadline: u64);
    /// The present instant on the rig's clock (ns since 1970), for stamps.
    fn rig_time(&self) -> u64;
    /// Lateness up to which steps are caught up, not skipped (s).
    fn tolerance(&self) -> f64;
    /// The machine's monotonic time (ns), the measure of computing time for every clock.
    fn machine_time(&self) -> u64 {
        monotonic::now()
    }
    /// Lateness above which the clock was set, and the solver is not late (ns).
    fn leap(&self) -> u64 {
        u64::MAX
    }
    /// Largest regular jump of the clock (ns): lateness up to it does not indicate a slow machine.
    fn jump(&self) -> u64 {
        0
    }
}

/// The present instant for stamps (ns since 1970): the system's clock at the first call plus the monotonic time since
/// then. All stamps of a process are on this one clock, also when the system's clock is set meanwhile.
pub fn rig_clock() -> u64 {
    static OFFSET: OnceLock<u64> = OnceLock::new();
    let offset = OFFSET.get_or_init(|| {
        let system = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0, |since| since.as_nanos() as u64);
        system.saturating_sub(monotonic::now())
    });
    offset + monotonic::now()
}

/// The machine's clock: deadlines on the monotonic one, stamps from [`rig_clock`].
#[derive(Debug, Clone, Copy, Default)]
pub struct WallClock;

impl Clock for WallClock {
    fn now(&self) -> u64 {
        monotonic::now()
    }

    fn wait_until(&self, deadline: u64) {
        monotonic::sleep_until(deadline);
    }

    fn rig_time(&self) -> u64 {
        rig_clock()
    }

    fn tolerance(&self) -> f64 {
        // Longer than the scheduling delays of a general-purpose system, shorter than a person notices.
        0.1
    }
}

/// The clock of `/clock`, constant between messages. 0 until the first one.
pub struct SimulatedClock {
    newest: Arc<AtomicU64>,
}

impl SimulatedClock {
    /// A clock that reads the cell which the subscription writes (ns).
    pub fn new(newest: Arc<AtomicU64>) -> Self {
        Self { newest }
    }
}

impl Clock for SimulatedClock {
    fn now(&self) -> u64 {
        self.newest.load(Ordering::Acquire)
    }

    fn wait_until(&self, deadline: u64) {
        if self.now() < deadline {
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    fn rig_time(&self) -> u64 {
        self.now()
    }

    fn tolerance(&self) -> f64 {
        // /clock may come once a second.
        2.5
    }

    fn jump(&self) -> u64 {
        (self.tolerance() * 1e9) as u64
    }

    fn leap(&self) -> u64 {
        LEAP
    }
}
