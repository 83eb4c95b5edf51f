//! What the motion means for an operator: the whirl analysis on the real mechanics, and the alarms made of it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod advice;
mod book;
mod whirl;
mod words;
