//! Error of the time step: the same run at an eighth of it, compared point by point where the motion is stable
//! ([`Calm`]) and by its statistics where it is chaotic ([`Statistics`]).
//!
//! Without bit torque small differences decay. With it they grow by a factor e every 15 to 30 ms, so that after a
//! second two runs with nearly equal starts share their statistics only. The scatter of these statistics is measured by
//! runs with perturbed starts.

mod calm;
mod record;
mod statistics;

pub use calm::Calm;
pub use record::{Course, Record};
pub use statistics::{Figure, Profile, Statistics};

use flexdrill_config::{Config, ConfigError};
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::twin::BuildError;

/// The finer step is the step over this number.
pub const REFINEMENT: f64 = 8.0;

/// Weight by which the starts of the runs differ (N), on for the first interval.
pub const NUDGES: [f64; 3] = [0.0, 1.0, -1.0];

/// Why a run failed.
#[derive(Debug, thiserror::Error)]
pub enum StepErrorFailure {
    /// A value that the comparison sets is refused.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The tool cannot be built or started.
    #[error("comparison of steps: {0}")]
    Build(#[from] BuildError),
    /// A step failed.
    #[error("comparison of steps, at {step} s: a step failed: {failure}")]
    Step {
        /// Time step of the run (s).
        step: f64,
        /// Why and where.
        failure: StepFailure,
    },
}

/// `config` with a [`REFINEMENT`]th of its step.
///
/// # Errors
/// When the configuration refuses that step.
pub fn refined(config: &Config) -> Result<Config, ConfigError> {
    config.with_value("solver.time_step", config.solver.time_step / REFINEMENT)
}

/// Difference between the largest and the smallest value; negative without values.
fn range(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
    high - low
}
