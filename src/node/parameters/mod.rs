//! The twin's ROS 2 parameters: every value of the configuration under its dotted name.

mod configured;
mod declare;
mod live;
mod overrides;

pub use configured::reconfigured;
pub use declare::{declare, refresh_ranges};
pub use overrides::{OverrideError, Started, apply_overrides, config_file};
