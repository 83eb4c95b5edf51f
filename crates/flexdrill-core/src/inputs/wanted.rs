//! The twin's targets.

use serde::{Deserialize, Serialize};

use super::InputKind;

/// The rig's targets in a step, SI: conditioned (limits, age), not yet slewed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Target speed of the top drive (rad/s).
    pub rotary_speed: f64,
    /// Target weight on bit (N).
    pub weight_on_bit: f64,
}

/// Fastest rotary speed in either sense (rad/s): 9549 r/min, above any drive and any configuration (5000 r/min).
const FASTEST: f64 = 1000.0;
/// Largest weight on bit (N): five times what a configuration may allow (2000 kN).
const HEAVIEST: f64 = 1e7;

impl Inputs {
    /// Smallest and largest value of an input (rad/s or N). A value outside is an error of the caller; the mechanics
    /// would compute meaningless forces from it.
    pub const fn bounds(kind: InputKind) -> [f64; 2] {
        match kind {
            InputKind::RotarySpeed => [-FASTEST, FASTEST],
            InputKind::WeightOnBit => [0.0, HEAVIEST],
        }
    }

    /// The value of an input (rad/s or N).
    pub const fn get(&self, kind: InputKind) -> f64 {
        match kind {
            InputKind::RotarySpeed => self.rotary_speed,
            InputKind::WeightOnBit => self.weight_on_bit,
        }
    }

    /// The first input that is not finite or out of its bounds.
    pub fn out_of_bounds(&self) -> Option<InputKind> {
        InputKind::ALL.into_iter().find(|kind| {
            let [low, high] = Self::bounds(*kind);
            !(low..=high).contains(&self.get(*kind))
        })
    }
}
