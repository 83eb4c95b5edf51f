//! Programs of others run again, and print what the table of `flexdrill_verify` has. SKIPPED without Python or the package;
//! with CI set, as `.ci/run` does, that fails.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use flexdrill_verify::{SOFT_STRINGS, WELLENG};
use serde_json::{Value, json};

/// Exit code of a script that lacks its packages.
const MISSING: i32 = 77;
/// Exit code of a script whose packages are not made for this Python.
const TOO_OLD: i32 = 78;

fn skipped(why: &str) -> Option<Value> {
    let ci = std::env::var("CI").unwrap_or_default();
    assert!(
        ["", "0", "false"].contains(&ci.as_str()),
        "this test must not be skipped in CI: {why}"
    );
    unavailable(why)
}

fn unavailable(why: &str) -> Option<Value> {
    // The test runner drops what the macros print of a test that passes; this line has to be seen.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {why}");
    None
}

/// What a script of `tests/python` prints; `None`, with a line that says so, where it cannot run.
fn foreign(script: &str, input: &Value) -> Option<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let given = std::env::var_os("FLEXDRILL_PYTHON").map(PathBuf::from);
    let mut pythons = given.into_iter().chain([root.join(".venv/bin/python")]);
    let Some(python) = pythons.find(|python| python.exists()) else {
        return skipped("no Python; run launch_scripts/test.sh or set FLEXDRILL_PYTHON");
    };
    let mut child = Command::new(python)
        .arg(root.join("tests/python").join(script))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // A script without its packages ends before it reads.
    let _ = child.stdin.take().unwrap().write_all(input.to_string().as_bytes());
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    match output.status.code() {
        Some(MISSING) => skipped(said.trim()),
        Some(TOO_OLD) => unavailable(said.trim()),
        _ => {
            assert!(output.status.success(), "{script}: {said}");
            Some(serde_json::from_slice(&output.stdout).unwrap())
        }
    }
}

#[test]
fn interop_welleng_prints_the_figures_of_the_table() {
    let cases: Vec<Value> = SOFT_STRINGS
        .iter()
        .map(|string| {
            let of = string.inputs().unwrap();
            json!({
                "friction": of.friction,
                "radius": of.radius,
                "weight_on_bit": of.weight_on_bit,
                "weight": of.weight,
                "outer_diameter": of.outer_diameter,
            })
        })
        .collect();
    let Some(printed) = foreign("soft_string.py", &json!({"cases": cases, "stations": 2000})) else {
        return;
    };
    assert_eq!(printed["version"], WELLENG);
    let results: Vec<[f64; 2]> = serde_json::from_value(printed["results"].clone()).unwrap();
    assert_eq!(results.len(), SOFT_STRINGS.len());
    for (string, [as_released, upwards]) in SOFT_STRINGS.iter().zip(results) {
        // The table has two decimals.
        for (has, prints) in [(string.as_released, as_released), (string.upwards, upwards)] {
            assert!((has - prints).abs() <= 0.0051, "{string:?}: {prints} N");
        }
    }
}
