//! The state of the node in figures (`twin/status`) and as items of `/diagnostics`, with the alarms, and the conditions of the
//! alarms on it. The room knows the messages, and no middleware.

mod alarms;
pub mod conditions;
pub mod diagnostics;
mod item;
mod items;
pub mod motion;
pub mod status;
pub mod step_times;
