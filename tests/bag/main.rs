//! Recordings: what is written is read back, whatever happens to the file, the disk or the process.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../bag_support/mod.rs"]
mod bag_support;

mod crash_disk;
mod crash_file;
mod property;
mod round_trip;
