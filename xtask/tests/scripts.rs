//! The scripts show how a build gets on, and pass through what a user must see of it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::path::Path;
use std::process::Command;

/// Builds a package of three crates with `build` of `launch_scripts/common.sh`; its exit code and what it printed.
fn build(folder: &Path, main: &str) -> (Option<i32>, String) {
    let manifest = |name: &str| format!("[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n");
    for name in ["first", "second"] {
        std::fs::create_dir_all(folder.join(name).join("src")).unwrap();
        std::fs::write(folder.join(name).join("src/lib.rs"), "").unwrap();
        std::fs::write(folder.join(name).join("Cargo.toml"), manifest(name)).unwrap();
    }
    std::fs::create_dir_all(folder.join("src")).unwrap();
    std::fs::write(folder.join("src/main.rs"), main).unwrap();
    let own = "rust-version = \"1.85\"\n[workspace]\nmembers = [\"first\", \"second\"]\n\
               [dependencies]\nfirst = { path = \"first\" }\nsecond = { path = \"second\" }\n";
    std::fs::write(folder.join("Cargo.toml"), format!("{}{own}", manifest("product"))).unwrap();
    let script = "set -euo pipefail\n. \"$1\"\nroot=$2\nneed_packages() { :; }\n\
                  (cd \"$root\" && cargo generate-lockfile --offline --quiet)\nbuild\necho \"built: $flexdrill\"";
    let common = concat!(env!("CARGO_MANIFEST_DIR"), "/../launch_scripts/common.sh");
    let output = Command::new("bash")
        .args(["-c", script, "demo.sh", common])
        .arg(folder)
        .env_remove("CARGO_TARGET_DIR")
        .output()
        .unwrap();
    let printed = [output.stdout, output.stderr].concat();
    (output.status.code(), String::from_utf8_lossy(&printed).into_owned())
}

#[test]
fn a_build_shows_its_progress_and_its_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let (code, printed) = build(folder.path(), "fn main() { let unused = 1; }\n");
    assert_eq!(code, Some(0), "{printed}");
    let progress = |line: &str| line.starts_with("[demo.sh] built ") && line.contains(" of 3");
    assert!(printed.lines().any(progress), "{printed}");
    assert!(printed.contains("warning: unused variable"), "{printed}");
    assert!(printed.contains("Finished `release`"), "{printed}");
    assert!(printed.contains("/target/release/flexdrill"), "{printed}");
    assert!(!printed.contains("Compiling") && !printed.contains('\r'), "{printed}");
}

#[test]
fn a_build_that_fails_shows_why() {
    let folder = tempfile::tempdir().unwrap();
    let (code, printed) = build(folder.path(), "fn main() { missing }\n");
    assert_eq!(code, Some(1), "{printed}");
    assert!(printed.contains("cannot find value `missing`"), "{printed}");
    assert!(printed.contains("the build failed; see above"), "{printed}");
}

/// The time that is left, by `time_left` of the same file.
#[test]
fn the_time_that_is_left_follows_the_share_that_is_done() {
    let common = concat!(env!("CARGO_MANIFEST_DIR"), "/../launch_scripts/common.sh");
    let time_left = |arguments: &str| {
        let output = Command::new("bash")
            .args(["-c", &format!(". \"$1\"; time_left {arguments}"), "demo.sh", common])
            .output()
            .unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    // Nothing is said before there is something to go by.
    assert_eq!(time_left("0 10 400 5"), "");
    // Half of the steps take less than half of the time.
    assert!(time_left("0 200 400 60").contains("minutes left"));
    assert!(time_left("0 399 400 300").contains("less than a minute left"));
    // Steps of an earlier build took no time: the one step that is done took all of these 100 s.
    assert!(time_left("380 390 400 100").contains("minutes left"));
}

/// What a user sees who has not installed anything: the packages, and no trace of calls.
#[test]
fn examples_name_the_packages_that_they_need() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/examples");
    let mut tried = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "py") {
            continue;
        }
        // Isolated, and without the packages of the machine.
        let output = Command::new("python3").args(["-I", "-S"]).arg(&path).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains(" is missing: pip install "), "{}: {said}", path.display());
        assert!(!said.contains("Traceback"), "{}: {said}", path.display());
        let text = std::fs::read_to_string(&path).unwrap();
        let needs = said.trim().rsplit_once("pip install ").unwrap().1;
        let begin = text.split("import ").next().unwrap_or_default();
        assert!(
            begin.contains(needs),
            "{}: its text does not name {needs}",
            path.display()
        );
        tried += 1;
    }
    assert!(tried >= 4, "{tried}");
}
