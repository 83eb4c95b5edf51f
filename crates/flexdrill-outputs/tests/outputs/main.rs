//! The messages of the outputs: their table of figures, how snapshots fill them, the signs of their figures in each
//! state of a rig, and the sources that name a figure.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod figures;
mod fill;
mod places;
mod states;
