//! Inputs from the rig: units, limits, age and state. The caller passes the time; nothing here allocates.
//!
//! [`Conditioner`] takes samples in the driller's units, as topics, bags and field logs carry them, refuses values that
//! cannot be right, and returns the twin's targets in SI for any instant.

mod conditioner;
mod kind;
mod measured;
mod rejection;
mod route;
mod rule;
mod state;
mod unit;
mod unit_spelling;
mod wanted;

pub use conditioner::{Conditioner, Counts};
pub use kind::InputKind;
pub use measured::MeasuredKind;
pub use rejection::{Rejection, RejectionReason};
pub use route::{InputRoute, Stamp};
pub use rule::{InputRule, InputRules};
pub use state::InputState;
pub use unit::{Dimension, Unit};
pub use wanted::Inputs;
