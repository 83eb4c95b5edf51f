//! The values on their way to what a page steers towards.

use std::time::Instant;

use super::PERIOD;
use crate::dashboard::session::Limit;
use crate::messages::TwinStatus;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// A stamp of the twin that is further from the clock than this is that of a recording's or simulator's clock (ns).
const OTHER_CLOCK: i64 = 10_000_000_000;

/// While the page steers. Values are speed (r/min) and weight (kN).
#[derive(Debug, Clone)]
pub(super) struct Drive {
    pub operator: String,
    pub target: [f64; 2],
    pub sent: [f64; 2],
    pub limits: [Limit; 2],
    pub renewed: Instant,
}

impl Drive {
    /// One period towards the targets, no faster than the model follows.
    pub fn advance(&mut self) {
        for ((sent, target), limit) in self.sent.iter_mut().zip(self.target).zip(self.limits) {
            let most = limit.slew * PERIOD.as_secs_f64();
            *sent += (target - *sent).clamp(-most, most);
        }
    }
}

/// What acts on the model (r/min, kN).
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

/// The present time on the rig's clock: the system's, or where the twin follows another clock, that one (ns since 1970).
pub(super) fn measured(status: Option<(&TwinStatus, Instant)>) -> i64 {
    let clock = crate::dashboard::now();
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
    fn the_values_sent_go_to_the_target_no_faster_than_the_slew_limit() {
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
