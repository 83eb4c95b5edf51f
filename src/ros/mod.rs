//! The ROS 2 node.

pub mod args;
