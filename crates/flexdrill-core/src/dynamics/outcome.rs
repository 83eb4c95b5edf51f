//! What a step came to.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::inputs::{InputKind, Inputs};
use crate::tool::description::Body;

/// Result of one advance by the configured step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[must_use]
pub enum StepOutcome {
    /// The step was taken.
    Advanced {
        /// Newton iterations over all sub-steps, rejected ones included.
        iterations: u32,
        /// Deepest split that was needed: the smallest sub-step is step / 2^halvings.
        halvings: u32,
    },
    /// No sub-step size down to the limit converged; the state is that before the step.
    Failed(StepFailure),
}

impl StepOutcome {
    /// The failure as an error, for `?`.
    ///
    /// # Errors
    /// When the step failed.
    pub fn ok(self) -> Result<(), StepFailure> {
        match self {
            Self::Advanced { .. } => Ok(()),
            Self::Failed(failure) => Err(failure),
        }
    }
}

/// Why and where a step or sub-step was not accepted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[must_use]
pub struct StepFailure {
    /// Why the sub-step was not accepted.
    pub cause: FailureCause,
    /// Model time at the start of the sub-step (s).
    pub time: f64,
    /// Size of the sub-step (s).
    pub step: f64,
    /// Station of the worst residual or correction, 0-based from the top.
    pub station: usize,
    /// Which pipe, where that makes sense.
    pub body: Body,
    /// Worst residual (N or N m); for a singular system, the pivot; for an input out of its bounds, the input (rad/s or
    /// N).
    pub value: f64,
}

/// Causes of a rejected step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum FailureCause {
    /// Newton's corrections did not shrink below the limits in the allowed iterations.
    NotConverged,
    /// A number in the state or residual is not finite.
    NotFinite,
    /// A pivot of the linear system vanished.
    Singular,
    /// A displacement or tilt left the range in which the model holds.
    OutOfRange,
    /// An input is not finite or outside [`Inputs::bounds`]. No sub-step was tried; station and body have no meaning.
    InputOutOfBounds(InputKind),
}

impl FailureCause {
    /// One word, as in messages: `not_converged`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::NotConverged => "not_converged",
            Self::NotFinite => "not_finite",
            Self::Singular => "singular",
            Self::OutOfRange => "out_of_range",
            Self::InputOutOfBounds(InputKind::RotarySpeed) => "rotary_speed_out_of_bounds",
            Self::InputOutOfBounds(InputKind::WeightOnBit) => "weight_on_bit_out_of_bounds",
            Self::InputOutOfBounds(InputKind::RateOfPenetration) => "rate_of_penetration_out_of_bounds",
            Self::InputOutOfBounds(InputKind::StandpipePressure) => "standpipe_pressure_out_of_bounds",
        }
    }
}

impl fmt::Display for FailureCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotConverged => "Newton's iterations did not converge",
            Self::NotFinite => "a number is not finite",
            Self::Singular => "the linear system is singular",
            Self::OutOfRange => "a displacement or tilt left the model's range",
            Self::InputOutOfBounds(InputKind::RotarySpeed) => "the rotary speed asked for is out of its bounds",
            Self::InputOutOfBounds(InputKind::WeightOnBit) => "the weight on bit asked for is out of its bounds",
            Self::InputOutOfBounds(InputKind::RateOfPenetration) => {
                "the rate of penetration asked for is out of its bounds"
            }
            Self::InputOutOfBounds(InputKind::StandpipePressure) => {
                "the standpipe pressure asked for is out of its bounds"
            }
        })
    }
}

impl fmt::Display for StepFailure {
    /// Cause, location and size, without the time, which the caller adds by its own clock.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let FailureCause::InputOutOfBounds(kind) = self.cause {
            let ([low, high], unit) = (Inputs::bounds(kind), kind.si_unit());
            return write!(
                f,
                "{}: inputs.{kind} = {} {unit}: must be {low} to {high} {unit}",
                self.cause, self.value
            );
        }
        write!(
            f,
            "{} (station {} of the {}, worst value {:.3e}, sub-step {:.3e} s)",
            self.cause, self.station, self.body, self.value, self.step
        )
    }
}

impl std::error::Error for StepFailure {}
