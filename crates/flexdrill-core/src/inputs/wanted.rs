//! What is asked of the twin.

use serde::{Deserialize, Serialize};

/// What the rig asks for in a step, SI: conditioned (limits, age), not yet slewed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Target speed of the top drive (rad/s).
    pub rotary_speed: f64,
    /// Target weight on bit (N).
    pub weight_on_bit: f64,
}
