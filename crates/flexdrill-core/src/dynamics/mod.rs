//! The tool in motion: state, time scheme, Newton, joints, energy.

pub(crate) mod carried;
pub(crate) mod conditions;
pub(crate) mod energy;
pub(crate) mod joints;
pub(crate) mod newton;
pub(crate) mod numbered;
pub(crate) mod outcome;
pub mod phases;
pub(crate) mod scheme;
pub(crate) mod state;
pub(crate) mod tolerances;
pub(crate) mod view;

pub use flexdrill_base::energies::Energies;
pub use outcome::{FailureCause, StepFailure, StepOutcome};
pub use scheme::Scheme;
pub use state::State;
