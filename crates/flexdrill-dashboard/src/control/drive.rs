//! The values that a page sends, on their way to its targets.

use std::time::Instant;

use super::PERIOD;
use crate::session::Limit;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use flexdrill_messages::TwinStatus;

/// A stamp of the twin that differs more from this machine's clock than this is of a recording's or simulator's clock
/// (ns).
const OTHER_CLOCK: i64 = 10_000_000_000;

/// The state while a page steers. Values are speed (r/min) and weight (kN).
#[derive(Debug, Clone)]
pub(super) struct Drive {
    pub operator: String,
    pub target: [f64; 2],
    pub sent: [f64; 2],
    pub limits: [Limit; 2],
    pub renewed: Instant,
}

impl Drive {
    /// Moves the values by one period towards the targets, no faster than the model follows.
    pub fn advance(&mut self) {
        for ((sent, target), limit) in self.sent.iter_mut().zip(self.target).zip(self.limits) {
            let most = limit.slew * PERIOD.as_secs_f64();
            *sent += (target - *sent).clamp(-most, most);
        }
    }
}

/// The inputs that the model applies (r/min, kN).
pub(super) fn applied(status: &TwinStatus) -> [Option<f64>; 2] {
    let value = |input: usize| {
        status
            .input_applied
            .get(input)
            .copied()
            .filter(|value| value.is_finite())
    };
    [value(0).map(rad_per_s_to_rpm), value(1).map(n_to_kn)]
}

/// The present time on the twin's clock (ns since 1970): the system's clock, unless the twin follows another one.
pub(super) fn measured(status: Option<(&TwinStatus, Instant)>) -> i64 {
    let clock = crate::now();
    match status {
        Some((status, arrived)) => {
            let stamp = status.header.stamp.to_nanoseconds();
            let twins = stamp.saturating_add(arrived.elapsed().as_nanos() as i64);
            if (twins - clock).abs() > OTHER_CLOCK {
                twins
            } else {
                clock
            }
        }
        None => clock,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_values_sent_approach_the_target_no_faster_than_the_slew_limit() {
        let limit = |slew| Limit {
            min: 0.0,
            max: 100.0,
            slew,
        };
        let mut drive = Drive {
            operator: "Kim".into(),
            target: [40.0, 0.0],
            sent: [35.0, 0.5],
            limits: [limit(20.0), limit(10.0)],
            renewed: Instant::now(),
        };
        drive.advance();
        assert_eq!(drive.sent, [37.0, 0.0]);
        drive.advance();
        drive.advance();
        assert_eq!(drive.sent, [40.0, 0.0]);
    }
}
