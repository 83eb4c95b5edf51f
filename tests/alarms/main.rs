//! What the motion means for an operator: the whirl analysis on the real mechanics, and the alarms made of it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[allow(dead_code, reason = "each test takes what it needs")]
#[path = "../../crates/flexdrill-core/tests/support/random.rs"]
mod random;

mod advice;
mod ahead;
mod book;
mod disagrees;
mod forecast;
mod rig;
mod transfer;
mod whirl;
mod words;
