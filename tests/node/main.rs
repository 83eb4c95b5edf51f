//! The node as a process: its command line, clock, alarms and recording.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../common/mod.rs"]
mod common;

mod alarms;
#[cfg(feature = "full")]
mod bridge;
mod clock;
#[cfg(feature = "full")]
mod command_line;
mod demo;
#[cfg(feature = "full")]
mod first_sample;
mod following;
#[cfg(feature = "full")]
mod life;
#[cfg(feature = "full")]
mod mqtt;
#[cfg(feature = "full")]
mod opcua;
mod recording;
#[cfg(feature = "full")]
mod safe_window;
mod surveys;
mod what_if;
