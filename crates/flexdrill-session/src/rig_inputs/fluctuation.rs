//! By how much a rig's speed and weight waver while its driller changes neither.

use flexdrill_config::InputsConfig;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

/// Parts of an input's range and of its value by which it wavers: a rig's weight is steady to a kilonewton at best, and
/// its speed to a turn per minute.
const OF_RANGE: f64 = 0.025;
const OF_VALUE: f64 = 0.05;

/// Speeds and weights that count as the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fluctuation {
    /// Speed (rad/s) and weight (N) by which they may differ at least.
    least: [f64; 2],
}

impl Fluctuation {
    /// Of a rig with these inputs.
    pub fn of(inputs: &InputsConfig) -> Self {
        Self {
            least: [
                rpm_to_rad_per_s(OF_RANGE * inputs.rotary_speed.max_rpm),
                kn_to_n(OF_RANGE * inputs.weight_on_bit.max_kn),
            ],
        }
    }

    /// Whether speed (rad/s) and weight (N) of `now` count as those of `then`.
    pub fn covers(&self, then: [f64; 2], now: [f64; 2]) -> bool {
        let mut all = then.iter().zip(now).zip(&self.least);
        all.all(|((then, now), least)| (now - then).abs() <= least.max(OF_VALUE * then.abs()))
    }
}
