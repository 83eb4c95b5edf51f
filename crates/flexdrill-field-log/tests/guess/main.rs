//! The mapping that is proposed for a log: right, or left out.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail by panicking"
)]

mod logs;
mod made;
mod rig;
