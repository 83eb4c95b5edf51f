//! What a stepper is given, and what it counts.

use serde::{Deserialize, Serialize};

use crate::dynamics::outcome::StepFailure;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::tolerances::Tolerances;
use crate::simd::Instructions;

/// Inputs over one step: both change linearly from its start to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forcing {
    /// Speed of the top drive at start and end (rad/s).
    pub rotary_speed: [f64; 2],
    /// Weight on bit at start and end (N).
    pub weight_on_bit: [f64; 2],
}

/// Which linear solver to use.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SolverKind {
    /// Over the chain of nodes.
    #[default]
    Chain,
    /// Over all stations by block LU: slower and plain, to hold the chain against.
    Stations,
    /// faer's sparse LU over all stations, which the tests hold block LU against.
    #[cfg(test)]
    Reference,
}

/// How steps are taken.
#[derive(Debug, Clone, Copy)]
pub struct StepperSettings {
    /// Size of a whole step (s).
    pub time_step: f64,
    /// How time is integrated.
    pub scheme: Scheme,
    /// When an iterate is accepted.
    pub tolerances: Tolerances,
    /// Most halvings of a step.
    pub max_halvings: u32,
    /// The linear solver.
    pub solver: SolverKind,
    /// Vector instructions.
    pub instructions: Instructions,
}

/// Counters since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Counters {
    /// Newton iterations, rejected ones included.
    pub iterations: u64,
    /// Sub-steps that did not converge and were tried again at half the size.
    pub rejected: u64,
    /// Steps that were split.
    pub halved_steps: u64,
    /// Most halvings that a step has needed.
    pub deepest_halving: u32,
    /// Steps that did not converge at the smallest sub-step; the state stayed that before.
    pub failed_steps: u64,
    /// Why and where the last sub-step was rejected.
    pub last_rejection: Option<StepFailure>,
}
