//! ROS 2 parameters: declared with descriptions and ranges, set all or none, refused in words.

pub mod configured;
pub mod services;
pub mod store;

pub use services::{Parameters, Task, serve};
pub use store::{Declaration, ParameterStore};
