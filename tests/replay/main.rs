//! Recordings and field logs through the model, and the page made of them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../common/mod.rs"]
mod common;

mod balances;
mod calibration;
mod clock;
mod earlier;
mod field_log;
mod following;
mod growing_hole;
mod hidden_rigs;
mod hole_ahead;
mod logs;
mod look_ahead;
mod measured;
mod posterior;
mod report;
mod safe_window;
mod shapes;
mod surveys;
