//! The state of the twin in figures (`twin/status`), and the alarms with these figures as items of `/diagnostics`. It
//! knows the messages and no middleware.

mod alarms;
pub mod diagnostics;
mod item;
mod items;
pub mod motion;
pub mod status;
pub mod step_times;
