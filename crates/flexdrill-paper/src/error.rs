//! Errors of the paper's case.

use std::path::PathBuf;

use super::figures::DrawError;
use flexdrill_config::ConfigError;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::twin::BuildError;
use flexdrill_verify::VerifyError;

/// Largest error of the energy audit, relative to the drive's work, with which figures are drawn. Healthy runs stay
/// below 0.1 %; a chain that the integration feeds is far above 1 %.
pub const ENERGY_LIMIT: f64 = 0.01;

/// Newton iterations per step from which a run of the search is given up: healthy ones take two to four.
pub const ITERATION_LIMIT: u64 = 8;

/// Why the paper's case could not be run or drawn.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// The configuration, or a changed value in it, is refused.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The tool cannot be built or started.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The case of Fig. 9 could not be run.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// The drive stands still.
    #[error("paper: rotary speed {rpm} r/min, must be above 0: give inputs.rotary_speed.initial_rpm or --rpm")]
    Standing {
        /// Rotary speed (r/min).
        rpm: f64,
    },
    /// A step failed.
    #[error(
        "paper: step failed at {:.4} s: {failure}; a smaller solver.time_step may help",
        failure.time
    )]
    Step {
        /// Why and where.
        failure: StepFailure,
    },
    /// Steps take too many iterations.
    #[error("paper: given up: {iterations} Newton iterations in {steps} steps, more than {ITERATION_LIMIT} per step")]
    Slow {
        /// So far.
        iterations: u64,
        /// Steps so far.
        steps: u64,
    },
    /// The energy audit failed: errors of the integration may dominate the motion.
    #[error(
        "paper: energy audit failed: error {error:.3e} J is {:.2} % of the drive's work of {drive:.3e} J, limit {} %. \
         No figure is drawn from such a run; use a smaller solver.time_step",
        100.0 * error.abs() / drive.abs().max(f64::MIN_POSITIVE), 100.0 * ENERGY_LIMIT
    )]
    Energy {
        /// Energy that the integration has gained or lost (J).
        error: f64,
        /// Work of the drive (J).
        drive: f64,
    },
    /// A figure could not be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// A file could not be written.
    #[error("paper: cannot write {}: {reason}", path.display())]
    Write {
        /// File that it is about.
        path: PathBuf,
        /// Why it could not be drawn or written.
        reason: String,
    },
}
