//! Whatever the bytes are that others give us, reading them ends: in a value or in an error with words, soon, and in
//! memory of the size of the input. What is accepted and written again reads as the same.
//!
//! Two seconds a target;
//! `FLEXDRILL_FUZZ_SECONDS=3600 cargo test --release --features full --test fuzz -- --nocapture --test-threads 1` is an
//! hour for each. `FLEXDRILL_FUZZ_SEED=N` begins with execution N, to see one again or to go on behind others.
//! Inputs are mutations of seeds that are made here and of what stands in `tests/data/fuzz/TARGET`: cases once found.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[path = "../bag_support/mod.rs"]
mod bag_support;
#[path = "../../crates/flexdrill-core/tests/support/random.rs"]
#[allow(dead_code, reason = "each test uses some of it")]
mod random;

mod bags;
mod engine;
mod lines;
mod messages;
mod mutator;
mod shapes;
mod states;
mod sweeps;
mod texts;

use std::path::PathBuf;

/// The repository's file as bytes.
fn file(name: &str) -> Vec<u8> {
    std::fs::read(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

/// A folder in memory where there is one: thousands of files are written.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").unwrap_or_else(|_| tempfile::tempdir().unwrap())
}

/// Words that a person can use.
fn says_why(error: &impl std::fmt::Display) -> bool {
    let text = error.to_string();
    assert!(text.trim().len() > 8, "an error without words: {text:?}");
    false
}

/// Whether a text of YAML is a mapping; what it is written as is the same mapping.
fn is_mapping<M: serde::Serialize, E: std::fmt::Display>(
    bytes: &[u8],
    from_text: impl Fn(&str, &str) -> Result<M, E>,
) -> bool {
    match from_text("fuzz.yaml", &String::from_utf8_lossy(bytes)) {
        Ok(mapping) => {
            let written = serde_saphyr::to_string(&mapping).unwrap();
            let again = from_text("again.yaml", &written).unwrap_or_else(|error| panic!("{error}\n{written}"));
            // As text: NaN, which stands for no value in some logs, is not equal to itself.
            assert_eq!(serde_saphyr::to_string(&again).unwrap(), written);
            true
        }
        Err(error) => says_why(&error),
    }
}
