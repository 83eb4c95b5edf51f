//! The messages of the outputs: their table of figures, how snapshots fill them, and the signs of their figures in each
//! state of a rig.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod figures;
mod fill;
mod states;
