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
    /// Target rate of penetration (m/s): advance of the tool along the hole, negative when it is pulled back.
    pub rate_of_penetration: f64,
    /// Target standpipe pressure (Pa): inside minus outside at the tool's top.
    pub standpipe_pressure: f64,
}

/// Fastest rotary speed in either sense (rad/s): 9549 r/min, above any drive and any configuration (5000 r/min).
const FASTEST: f64 = 1000.0;
/// Largest weight on bit (N): five times what a configuration may allow (2000 kN).
const HEAVIEST: f64 = 1e7;
/// Fastest advance in either direction (m/s): 3600 m/h, faster than a pipe is tripped.
const FASTEST_ADVANCE: f64 = 1.0;
/// Highest pressure in either sense (Pa): seven times what a configuration may allow (150 MPa).
const HIGHEST_PRESSURE: f64 = 1e9;

impl Inputs {
    /// At rest without any load.
    pub const ZERO: Self = Self {
        rotary_speed: 0.0,
        weight_on_bit: 0.0,
        rate_of_penetration: 0.0,
        standpipe_pressure: 0.0,
    };

    /// Smallest and largest value of an input, SI. A value outside is an error of the caller; the mechanics
    /// would compute meaningless forces from it.
    pub const fn bounds(kind: InputKind) -> [f64; 2] {
        match kind {
            InputKind::RotarySpeed => [-FASTEST, FASTEST],
            InputKind::WeightOnBit => [0.0, HEAVIEST],
            InputKind::RateOfPenetration => [-FASTEST_ADVANCE, FASTEST_ADVANCE],
            InputKind::StandpipePressure => [-HIGHEST_PRESSURE, HIGHEST_PRESSURE],
        }
    }

    /// The value of an input, SI.
    pub const fn get(&self, kind: InputKind) -> f64 {
        match kind {
            InputKind::RotarySpeed => self.rotary_speed,
            InputKind::WeightOnBit => self.weight_on_bit,
            InputKind::RateOfPenetration => self.rate_of_penetration,
            InputKind::StandpipePressure => self.standpipe_pressure,
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
