//! DDS on networks that fail, that reach too far, or that do not reach far enough.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../common/mod.rs"]
mod common;

mod cable;
mod faults;
mod loopback_end;
mod others;
mod outsider;
mod peers;
mod replies;
mod surveys;
