//! ROS 2 parameters: declared with descriptions and ranges, set all or none, refused in words.

mod configured;
mod declare;
mod live;
mod overrides;
mod refusal;
mod services;
mod store;

pub use configured::reconfigured;
pub use declare::{declare, refresh_ranges};
pub use overrides::{OverrideError, Started, apply_overrides, config_file};
pub use refusal::Refusal;
pub use services::{Parameters, Task, serve};
pub use store::{Declaration, NumberRange, ParameterStore};
