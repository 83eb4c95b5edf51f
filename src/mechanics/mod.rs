//! The paper's mechanics: pure numbers in, pure numbers out. Nothing here knows of files, clocks, logs or middleware.
//!
//! | file | paper |
//! |---|---|
//! | [`well`], [`model`] | Fig. 2, 4; geometry and numbering |
//! | [`section`], [`beam`], [`element_form`] | Eq. 2 to 10 |
//! | [`joint`], [`joint_group`], [`rotation`], [`jet`], [`number`] | Eq. 11 to 18 |
//! | [`gap`] | Eq. 20 to 34, Table 2 |
//! | [`conditions`] | Eq. 1, loads |
//! | [`assembly`] | Eq. 35, 40 to 42 |
//! | [`scheme`], [`newton`], [`stepper`], [`halving`] | Eq. 36 to 44 |
//! | [`statics`] | the start |
//! | [`energy`] | the audit |
//! | [`linear`] | the solvers |
//! | [`phases`] | where the time goes |

pub mod assembly;
pub mod beam;
pub mod conditions;
pub mod description;
pub mod element_force;
pub mod element_form;
pub mod energy;
pub mod gap;
pub mod halving;
pub mod jet;
pub mod joint;
pub mod joint_group;
pub mod linear;
pub mod model;
pub mod newton;
pub mod number;
mod outcome;
pub mod phases;
pub mod rotation;
pub mod scheme;
pub mod section;
pub mod state;
pub mod statics;
pub mod stepper;
pub mod well;

pub use description::*;
pub use model::{Model, ModelError};
pub use newton::Tolerances;
pub use outcome::{EnergyAudit, FailureCause, StepFailure, StepOutcome};
pub use scheme::Scheme;
pub use state::State;
pub use statics::StartError;
pub use stepper::{Counters, Forcing, SolverKind, Stepper, StepperCheckpoint};
