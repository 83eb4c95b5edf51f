//! Programs of other vendors read and drive the twin: Cyclone DDS, Fast DDS, rosbags, mcap-ros2-support.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../bag_support/mod.rs"]
mod bag_support;
#[path = "../common/mod.rs"]
mod common;

#[cfg(feature = "sqlite")]
mod bag;
mod fast;
mod inputs;
mod latency;
mod messages;
mod node;
mod security;
mod simulator;
