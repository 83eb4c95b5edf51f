//! The node as a process: its command line, clock, alarms and recording.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../common/mod.rs"]
mod common;

mod alarms;
mod bridge;
mod clock;
mod command_line;
mod following;
#[cfg(feature = "mqtt")]
mod mqtt;
#[cfg(feature = "opcua")]
mod opcua;
mod recording;
mod safe_window;
mod what_if;
