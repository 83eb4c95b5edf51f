//! The command line as a user meets it, and the figures of the paper.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod ahead;
mod ahead_from;
mod guess;
mod life;
mod map;
mod map_points;
mod paper;
mod plan;
mod posterior;
mod program;
mod reach;
mod sensitivity;
mod surveys;
mod sweep;
mod trip;
mod usage;
mod verify;
mod wits_look;
