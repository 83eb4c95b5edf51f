//! How the twin is doing, in figures (`twin/status`) and judgements (`/diagnostics`). It knows the messages, no
//! middleware.

mod alarms;
pub mod diagnostics;
mod items;
mod judgement;
pub mod motion;
pub mod status;
pub mod step_times;

pub(crate) use items::{another_of_this_name, not_in_real_time};
