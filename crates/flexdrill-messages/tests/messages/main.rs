//! The message types: generated code, CDR bytes, and the reference of the rig page's decoders.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod cdr;
mod generated;
mod page;
