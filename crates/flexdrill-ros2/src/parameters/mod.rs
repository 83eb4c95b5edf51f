//! ROS 2 parameters: declared with descriptions and ranges, set atomically, refused with a reason.

mod refusal;
mod services;
mod store;

pub use refusal::Refusal;
pub use ros2_client::{Parameter, ParameterValue};
pub use services::{Apply, NameClient, Observer, Parameters, serve};
pub use store::{Declaration, NumberRange, ParameterStore};
