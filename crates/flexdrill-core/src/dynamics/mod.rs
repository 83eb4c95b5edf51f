//! The whole tool in motion: residual, tangent, scheme, Newton, steps, statics, energy.

pub mod assembly;
pub mod conditions;
pub mod contacts;
pub mod energy;
#[cfg(test)]
mod motion_tangent;
pub mod joints;
pub mod newton;
pub mod outcome;
pub mod phases;
pub mod residual;
pub mod scheme;
pub mod state;
pub mod statics;
pub mod stepper;
pub mod sub_steps;
pub mod tangent;

pub use newton::Tolerances;
pub use outcome::{EnergyAudit, FailureCause, StepFailure, StepOutcome};
pub use scheme::Scheme;
pub use state::State;
pub use statics::StartError;
pub use stepper::{Counters, Forcing, SolverKind, Stepper, StepperCheckpoint};
