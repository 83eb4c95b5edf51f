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

/// Energy since the start (J). Signs: `drive`, `hoist`, `weight_on_bit`, `gravity`, `loads`, `feed` and `pressure` are work
/// done on the tool and the string above it; `bit`, `friction`, `contact_damping`, `rayleigh_damping`, `numerical_damping`,
/// `string`, `mud` are taken from them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct EnergyAudit {
    /// Work of the top drive.
    pub drive: f64,
    /// Work of the weight on bit; below a hoist over the whole way of the bit, the advance of the frame included.
    pub weight_on_bit: f64,
    /// Work of gravity.
    pub gravity: f64,
    /// Work of the configured point loads.
    pub loads: f64,
    /// Work of the advance against the axial friction of the wall; below a hoist with that of the weight on bit and less that
    /// of the string's force over the advance. The tool moves in a frame that advances, string and rock in that of the hole.
    pub feed: f64,
    /// Energy taken by the rock.
    pub bit: f64,
    /// Energy taken by friction in both layers and in the joints' pins.
    pub friction: f64,
    /// Part of it that the joints' pins took.
    pub joint_friction: f64,
    /// Energy taken by the damping of contacts, joint stops and joints with play.
    pub contact_damping: f64,
    /// Energy taken by Rayleigh damping.
    pub rayleigh_damping: f64,
    /// Energy taken by the time integration itself.
    pub numerical_damping: f64,
    /// Work of updating the axial force in the geometric stiffness between steps.
    pub axial_update: f64,
    /// Part of it that belongs to no physical law: the work of the foreseen axial forces less that of the axial forces of
    /// the displacements at the end of each step. Positive feeds the motion.
    pub axial_foresight: f64,
    /// Magnitudes of `error` less `axial_foresight`, sub-step by sub-step: what cancels over time counts here.
    pub against_laws: f64,
    /// Change of kinetic plus elastic plus contact energy since the start.
    pub stored: f64,
    /// Work in, less energy out, less stored: zero for an exact integration.
    pub error: f64,
    /// Work of the hoist on the string above.
    pub hoist: f64,
    /// Energy that the string above has lost, to friction on the wall and inside.
    pub string: f64,
    /// Work of the pressure in the pipe: on its lower end, and by stretching its wall.
    pub pressure: f64,
    /// Energy taken by the viscosity of the mud around the pipes.
    pub mud: f64,
}
