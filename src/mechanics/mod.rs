//! The paper's mechanics: pure numbers in, pure numbers out. Nothing here knows of files, clocks, logs or middleware.

pub mod description;
mod outcome;

pub use description::*;
pub use outcome::{EnergyAudit, FailureCause, StepFailure, StepOutcome};
