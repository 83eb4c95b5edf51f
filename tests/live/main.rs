//! Viewers over WebSocket and the dashboard: what they see, what they may steer, and what they can take of the node.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../common/mod.rs"]
mod common;

mod bounds;
mod dashboard;
mod layouts;
mod steering;
mod viewer;
