//! Helpers of the tests that need more than this process: a network of their own, programs in it that end with the
//! test, Python, and a DDS program of another vendor that does what it is asked.

#![allow(dead_code, reason = "each test file uses some of it")]
#![allow(unused_imports, reason = "each test file uses some of it")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a helper of tests fails by panicking"
)]

mod fast;
mod network;
mod peer;
pub mod program;
pub mod python;
mod skip;
mod web;

use std::path::{Path, PathBuf};

pub use network::Network;
pub use peer::Peer;
pub use program::Program;
pub use skip::{skipped, unavailable};

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A small tool in the same well: what is tested here is the node, not the mechanics.
pub fn small_config() -> PathBuf {
    root().join("tests/data/small.yaml")
}

/// The drilling log of a real rig at 1 Hz: the file that FLEXDRILL_RIG_LOG names. The log is not published, so that a
/// machine may lack it.
pub fn real_log() -> Option<PathBuf> {
    let named = std::env::var_os("FLEXDRILL_RIG_LOG").map(PathBuf::from);
    let log = named.unwrap_or_else(|| root().join("../shared/data/field_log/rig_log_1hz.csv"));
    if log.is_file() {
        return Some(log);
    }
    unavailable(&format!(
        "{} does not exist; FLEXDRILL_RIG_LOG names the log of a real rig",
        log.display()
    ))
}
