//! `cargo build` and `cargo test` share one compilation of every crate that both need.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::collections::BTreeSet;
use std::process::Command;

/// Packages with their features, as cargo resolves them for these options.
fn packages(options: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--offline", "--prefix", "none", "--no-dedupe"])
        .args(["--format", "{p} [{f}]"])
        .args(options)
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('['));
    lines.map(|line| line.replace(" (*)", "")).collect()
}

/// A test's dependency that asks for another feature of a package would have that package, and all that use it, compiled
/// once for the program and once more for the tests.
#[test]
fn building_and_testing_resolve_the_same_features() {
    let built = packages(&["--edges", "normal,build"]);
    let tested = packages(&[
        "--workspace",
        "--exclude",
        "flexdrill-benches",
        "--edges",
        "normal,build,dev",
    ]);
    assert!(built.len() > 300, "{} packages", built.len());
    let apart: Vec<&String> = built.difference(&tested).collect();
    assert!(
        apart.is_empty(),
        "the tests' dependencies ask for other features of these packages; give them the same in Cargo.toml: {apart:#?}"
    );
}
