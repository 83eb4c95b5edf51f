//! `cargo build` and the tests with all features share one compilation of every crate that both need.

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

/// A dependency of a test or of a feature that asks for another feature of a package would have that package, and all that
/// use it, compiled once for the default build and once more for the tests. The product alone is another with other
/// features: `launch_scripts/demo.sh` builds the default, `launch_scripts/test.sh` everything.
#[test]
fn building_and_testing_resolve_the_same_features() {
    let built = packages(&["--edges", "normal,build"]);
    let tested = packages(&[
        "--workspace",
        "--exclude",
        "flexdrill-benches",
        "--features",
        "flexdrill/full",
        "--edges",
        "normal,build,dev",
    ]);
    assert!(built.len() > 250, "{} packages", built.len());
    let is_product = |package: &&String| package.starts_with("flexdrill v");
    let apart: Vec<&String> = built
        .difference(&tested)
        .filter(|package| !is_product(package))
        .collect();
    assert!(
        apart.is_empty(),
        "the tests' dependencies or features ask for other features of these packages; give them the same in Cargo.toml: \
         {apart:#?}"
    );
}

/// Whether a package of this name is among these.
fn has(packages: &BTreeSet<String>, name: &str) -> bool {
    let begin = format!("{name} v");
    packages.iter().any(|package| package.starts_with(&begin))
}

/// What a demonstration does not need is compiled by no first build.
#[test]
fn the_default_build_leaves_out_what_features_bring() {
    let built = packages(&["--edges", "normal,build"]);
    let full = packages(&["--edges", "normal,build", "--features", "full"]);
    for name in [
        "async-opcua",
        "flexdrill-bench",
        "flexdrill-bridge",
        "flexdrill-paper",
        "flexdrill-plot",
        "flexdrill-report",
        "flexdrill-sweep",
        "libsqlite3-sys",
        "rumqttc-v4-next",
        "rustls",
    ] {
        assert!(has(&full, name), "{name}: no feature brings it");
        assert!(!has(&built, name), "{name} is in the default build");
    }
}

/// The twin for Python is a host of the session, whose alarms need no middleware, no server and no format of recordings.
#[test]
fn the_twin_for_python_brings_no_middleware() {
    let all = packages(&["--edges", "normal,build"]);
    let python = packages(&["--package", "flexdrill-python", "--edges", "normal"]);
    assert!(has(&python, "flexdrill-session"));
    for name in ["flexdrill-ros2", "hyper", "mcap", "rustdds", "socket2", "tokio"] {
        assert!(has(&all, name), "{name}: the program does not need it either");
        assert!(!has(&python, name), "{name} comes with the package for Python");
    }
}
