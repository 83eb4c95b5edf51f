//! Inputs from the rig: units, limits, age and state. Pure: time is handed in, nothing allocates.
//!
//! [`Conditioner`] takes samples in the driller's units as the topics, bags and field logs carry them, refuses what
//! cannot be right, and says at any instant what the twin is asked for in SI.

mod conditioner;
mod kind;
mod rejection;
mod route;
mod rule;
mod state;
mod wanted;

pub use conditioner::{Conditioner, Counts};
pub use kind::InputKind;
pub use rejection::{Rejection, RejectionReason};
pub use route::{InputRoute, Stamp};
pub use rule::{InputRule, InputRules};
pub use state::InputState;
pub use wanted::Inputs;
