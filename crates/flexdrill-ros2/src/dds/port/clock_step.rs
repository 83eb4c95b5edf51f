//! Detects that the system's clock was set.

use std::time::{SystemTime, UNIX_EPOCH};

use flexdrill_clock::monotonic;

/// Smallest step that counts (ns). NTP slews a clock by half a millisecond per second at most.
const SMALLEST_STEP: i128 = 200_000_000;

/// Compares the system's clock with the monotonic clock.
pub(super) struct ClockWatch {
    /// System time less monotonic time (ns).
    offset: i128,
    total: i128,
}

impl ClockWatch {
    pub(super) fn new() -> Self {
        Self {
            offset: offset(),
            total: 0,
        }
    }

    /// The step since the last call (s), if there was one.
    pub(super) fn step(&mut self) -> Option<f64> {
        self.step_to(offset())
    }

    /// The sum of all steps (s).
    pub(super) fn total(&self) -> f64 {
        self.total as f64 * 1e-9
    }

    fn step_to(&mut self, offset: i128) -> Option<f64> {
        let step = offset - self.offset;
        self.offset = offset;
        (step.abs() >= SMALLEST_STEP).then(|| {
            self.total += step;
            step as f64 * 1e-9
        })
    }
}

fn offset() -> i128 {
    let system = SystemTime::now().duration_since(UNIX_EPOCH).map_or_else(
        |before| -(before.duration().as_nanos() as i128),
        |since| since.as_nanos() as i128,
    );
    system - i128::from(monotonic::now())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_count_and_slewing_does_not() {
        let mut watch = ClockWatch { offset: 0, total: 0 };
        for ms in 1..1000 {
            assert_eq!(watch.step_to(ms * 1_000_000), None);
        }
        assert_eq!(watch.step_to(-3_599_001_000_000), Some(-3600.0));
        assert_eq!(watch.step_to(-3_599_001_000_000), None);
        assert_eq!(watch.total(), -3600.0);
    }
}
