//! The clocks that can pace the solver.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// A clock in nanoseconds with absolute deadlines.
pub trait Clock: Send {
    /// Nanoseconds; the zero is the clock's own.
    fn now(&self) -> u64;
    /// Waits for a deadline, at most for some milliseconds when it is not known when that will be. Returns early or late;
    /// the caller looks at [`Clock::now`].
    fn wait_until(&self, deadline: u64);
    /// The present instant on the rig's clock (ns since 1970), for stamps.
    fn rig_time(&self) -> u64;
}

/// The machine's clock: deadlines on the monotonic one, stamps from the real-time one.
pub struct WallClock {
    zero: Instant,
}

impl WallClock {
    /// A clock that starts now.
    pub fn new() -> Self {
        Self { zero: Instant::now() }
    }
}

impl Default for WallClock {
    fn default() -> Self {
        Self::new()
    }
}

impl Clock for WallClock {
    fn now(&self) -> u64 {
        self.zero.elapsed().as_nanos() as u64
    }

    fn wait_until(&self, deadline: u64) {
        let now = self.now();
        if deadline > now {
            std::thread::sleep(Duration::from_nanos(deadline - now));
        }
    }

    fn rig_time(&self) -> u64 {
        SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .map_or(0, |since| since.as_nanos() as u64)
    }
}

/// The clock of `/clock`: stands still between messages. 0 until the first one.
pub struct SimulatedClock {
    newest: Arc<AtomicU64>,
}

impl SimulatedClock {
    /// Follows the cell into which the subscription writes (ns).
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
}
