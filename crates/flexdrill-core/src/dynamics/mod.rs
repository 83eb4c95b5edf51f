//! The whole tool in motion: residual, tangent, scheme, Newton, steps, statics, energy.

pub(crate) mod assembly;
pub(crate) mod conditions;
pub(crate) mod contacts;
pub(crate) mod energy;
pub(crate) mod factors;
pub(crate) mod joints;
pub(crate) mod newton;
pub(crate) mod outcome;
pub mod phases;
pub(crate) mod residual;
pub(crate) mod scheme;
pub(crate) mod state;
pub(crate) mod statics;
pub(crate) mod station_equations;
pub(crate) mod stepper;
pub(crate) mod sub_steps;
pub(crate) mod tangent;
pub(crate) mod tolerances;
pub(crate) mod track;
pub(crate) mod view;

pub use outcome::{EnergyAudit, FailureCause, StepFailure, StepOutcome};
pub use scheme::Scheme;
pub use state::State;
pub use statics::StartError;
pub use stepper::{MOST_REFINEMENT, SolverKind};

#[cfg(test)]
mod tests;
