//! What a stepper is given, and what it counts.

use serde::{Deserialize, Serialize};

use crate::dynamics::outcome::StepFailure;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::tolerances::Tolerances;
use crate::inputs::Inputs;
use crate::simd::Instructions;

/// Inputs over one step: each changes linearly from its start to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forcing {
    /// Speed of the top drive at start and end (rad/s).
    pub rotary_speed: [f64; 2],
    /// Weight on bit at start and end (N).
    pub weight_on_bit: [f64; 2],
    /// Rate of penetration at start and end (m/s).
    pub rate_of_penetration: [f64; 2],
    /// Standpipe pressure at start and end (Pa).
    pub standpipe_pressure: [f64; 2],
}

impl Forcing {
    /// From one set of inputs to another.
    pub fn between(start: &Inputs, end: &Inputs) -> Self {
        Self {
            rotary_speed: [start.rotary_speed, end.rotary_speed],
            weight_on_bit: [start.weight_on_bit, end.weight_on_bit],
            rate_of_penetration: [start.rate_of_penetration, end.rate_of_penetration],
            standpipe_pressure: [start.standpipe_pressure, end.standpipe_pressure],
        }
    }

    /// The inputs at a part of the step, 0 (start) to 1 (end).
    pub fn at(&self, part: f64) -> Inputs {
        let at = |[start, end]: [f64; 2]| start + (end - start) * part;
        Inputs {
            rotary_speed: at(self.rotary_speed),
            weight_on_bit: at(self.weight_on_bit),
            rate_of_penetration: at(self.rate_of_penetration),
            standpipe_pressure: at(self.standpipe_pressure),
        }
    }

    /// The inputs at the end of the step.
    pub fn end(&self) -> Inputs {
        Inputs {
            rotary_speed: self.rotary_speed[1],
            weight_on_bit: self.weight_on_bit[1],
            rate_of_penetration: self.rate_of_penetration[1],
            standpipe_pressure: self.standpipe_pressure[1],
        }
    }
}

/// Over which nodes steps are taken.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SolverKind {
    /// Over the fewest nodes that a step resolves, corrections in single precision where that is enough.
    #[default]
    Chain,
    /// Over a chain with a node at every station, in double precision: slower, nothing slaved, to hold the other against.
    Stations,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_change_linearly_over_a_step() {
        let [start, end] =
            [[1.0, 2e3, -1e-3, 1e6], [3.0, 4e3, 3e-3, 5e6]].map(|[speed, weight, rate, pressure]| Inputs {
                rotary_speed: speed,
                weight_on_bit: weight,
                rate_of_penetration: rate,
                standpipe_pressure: pressure,
            });
        let forcing = Forcing::between(&start, &end);
        assert_eq!((forcing.at(0.0), forcing.end()), (start, end));
        let middle = Inputs {
            rotary_speed: 1.5,
            weight_on_bit: 2.5e3,
            rate_of_penetration: 0.0,
            standpipe_pressure: 2e6,
        };
        assert_eq!(forcing.at(0.25), middle);
    }
}
