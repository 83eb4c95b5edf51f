//! The tool in motion: steps, Newton, time scheme, interactions, energy, and the static start.

pub(crate) mod conditions;
pub(crate) mod energy;
pub(crate) mod factors;
pub(crate) mod interactions;
pub(crate) mod newton;
pub(crate) mod numbered;
pub(crate) mod outcome;
pub mod phases;
pub(crate) mod scheme;
pub(crate) mod state;
pub(crate) mod statics;
pub(crate) mod stepper;
pub(crate) mod sub_steps;
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
