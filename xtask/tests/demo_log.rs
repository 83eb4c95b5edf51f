//! The checked-in log of the demonstration is what its generator writes.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[test]
fn the_demo_log_is_what_its_generator_writes() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/field_logs/demo.csv");
    let written = std::fs::read_to_string(path).unwrap();
    assert!(
        written == xtask::demo_log::demo_log(),
        "config/field_logs/demo.csv is not up to date: cargo xtask demo-log"
    );
}
