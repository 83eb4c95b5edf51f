//! How a simulation runs.

use serde::{Deserialize, Serialize};

use crate::dynamics::Scheme;
use crate::inputs::Inputs;
use crate::motion::{ShockSettings, StickSlipSettings, WhirlSettings};
use crate::tool::Body;

/// How the simulation runs, beside the tool itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulationSettings {
    /// Model step (s).
    pub time_step: f64,
    /// How time is integrated.
    pub scheme: Scheme,
    /// Most Newton iterations per sub-step.
    pub max_iterations: u32,
    /// Most halvings of a step.
    pub max_halvings: u32,
    /// Inputs at the start.
    pub initial_inputs: Inputs,
    /// Slew limit of the rotary speed (rad/s2).
    pub rotary_speed_slew: f64,
    /// Slew limit of the weight on bit (N/s).
    pub weight_on_bit_slew: f64,
    /// How whirl is found and judged.
    pub whirl: WhirlSettings,
    /// How the stick-slip index is formed.
    pub stick_slip: StickSlipSettings,
    /// How lateral shock is measured and judged.
    pub shock: ShockSettings,
    /// Stations and pipes whose orbits are watched; empty watches both pipes at every joint.
    pub watched: Vec<(usize, Body)>,
    /// Time between samples of the whirl analysis (s), rounded to whole steps.
    pub whirl_sample_interval: f64,
}
