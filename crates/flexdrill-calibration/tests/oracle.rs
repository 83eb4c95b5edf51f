//! The smoother's step against another one: `iterative_ensemble_smoother` of Equinor, with the same members, predictions and
//! perturbations. SKIPPED without Python or the package.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use flexdrill_calibration::smoother::update;
use nalgebra::DMatrix;
use serde_json::{Value, json};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// What the script prints; `None`, with a line that says so, where there is no Python or no package.
fn foreign(input: &Value) -> Option<Value> {
    let given = std::env::var_os("FLEXDRILL_PYTHON").map(PathBuf::from);
    let python = given
        .into_iter()
        .chain([root().join(".venv/bin/python")])
        .find(|python| python.exists());
    let Some(python) = python else {
        eprintln!("SKIPPED: no Python; run launch_scripts/test.sh or set FLEXDRILL_PYTHON");
        return None;
    };
    let mut child = Command::new(python)
        .arg(root().join("tests/python/smoother.py"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // A script without its packages ends before it reads.
    let _ = child.stdin.take().unwrap().write_all(input.to_string().as_bytes());
    let output = child.wait_with_output().unwrap();
    if output.status.code() == Some(77) {
        eprintln!("SKIPPED: {}", String::from_utf8_lossy(&output.stdout).trim());
        return None;
    }
    assert!(output.status.success());
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// Members as rows.
fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix
        .column_iter()
        .map(|column| column.iter().copied().collect())
        .collect()
}

#[test]
fn interop_a_step_is_that_of_iterative_ensemble_smoother() {
    let mut random = fastrand::Rng::with_seed(11);
    let mut normal = || (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
    let (unknowns, observations, members) = (5, 8, 60);
    let x = DMatrix::from_fn(unknowns, members, |_, _| normal());
    let g = DMatrix::from_fn(observations, unknowns, |_, _| normal());
    // A model that is not linear.
    let y = (&g * &x).map(|value| value + 0.1 * value * value);
    let e = DMatrix::from_fn(observations, members, |_, _| normal());
    let d: Vec<f64> = (0..observations).map(|_| normal()).collect();
    // Errors that depend on each other.
    let part = DMatrix::from_fn(observations, observations, |_, _| 0.3 * normal());
    let covariance = &part * part.transpose() + DMatrix::identity(observations, observations) * 0.2;
    for alpha in [1.0, 3.0_f64] {
        let factor = covariance.clone().cholesky().unwrap().l();
        let perturbed = DMatrix::from_fn(observations, members, |i, _| d[i]) + &factor * &e * alpha.sqrt();
        let ours = update(&x, &y, &perturbed, &(&covariance * alpha)).unwrap();
        let input = json!({
            "x": rows(&x),
            "y": rows(&y),
            "e": rows(&e),
            "d": d,
            "covariance": rows(&covariance),
            "alpha": alpha,
        });
        let Some(theirs) = foreign(&input) else {
            return;
        };
        let mut largest = 0.0_f64;
        for (ours, theirs) in rows(&ours).iter().zip(theirs.as_array().unwrap()) {
            for (ours, theirs) in ours.iter().zip(theirs.as_array().unwrap()) {
                largest = largest.max((ours - theirs.as_f64().unwrap()).abs());
            }
        }
        // They invert by singular values, we by Cholesky factors: rounding in a problem of condition below 1e4.
        assert!(largest < 1e-9, "alpha {alpha}: {largest}");
    }
}
