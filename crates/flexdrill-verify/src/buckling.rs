//! Torque buckling of a hanging chain, by kind of joint. The closed forms are derived in `docs/mechanics.md`.

use super::bench::Bench;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction};

const CASE: &str = "torque_buckling";
/// The chain is linear but for the squares of its tilts, 1e-5 where the search ends, and its last extrapolation reaches
/// over some thousandths of the torque.
const LIMIT: f64 = 1e-4;
/// The search ends when this part of the squared torque is left.
const LEFT: f64 = 2e-3;
/// Part of the way to the extrapolated squared torque that a step goes. At first the extrapolation lies beyond, with
/// this load at 1.73 times the square at most (crosses in phase), for it sees the next mode too.
const PART: f64 = 0.4;

/// Deflection (m) of the first joint at rest under `torque` (N m), with crosses turned by `phase_step` (degrees).
fn deflection(kind: &str, phase_step: f64, torque: f64) -> Result<f64, VerifyError> {
    let bench = Bench::with(CASE, |config| {
        config
            .with_value("tool.joint.kind", kind)?
            .with_value("tool.joint.cross_phase_step_deg", phase_step)?
            .with_value("loads.0.history.constant", torque)
    })?;
    let joint = bench.simulation.joint_stations()[0];
    Ok(bench.displacement(joint, Body::Pipe, Direction::W))
}

/// The torque (N m) at which the chain's lateral stiffness vanishes. It is even in the torque, and nearly linear in its
/// square: extrapolated so from two torques, and approached from below.
fn buckling_torque(kind: &str, phase_step: f64) -> Result<f64, VerifyError> {
    let stiffness = |square: f64| deflection(kind, phase_step, square.sqrt()).map(|deflection| 1.0 / deflection);
    let mut before = (0.0, stiffness(0.0)?);
    // Far below all that is looked for.
    let mut square = 100.0_f64.powi(2);
    for _ in 0..50 {
        let now = (square, stiffness(square)?);
        let vanishes = now.0 + now.1 * (now.0 - before.0) / (before.1 - now.1);
        if vanishes - square < LEFT * vanishes {
            return Ok(vanishes.sqrt());
        }
        square += PART * (vanishes - square);
        before = now;
    }
    Err(VerifyError::Missing {
        case: CASE,
        what: "buckling",
    })
}

pub(super) fn torque() -> Result<Vec<Row>, VerifyError> {
    let bench = Bench::new(CASE)?;
    let tool = bench.config.tool();
    let length = bench.config.well.length() / tool.links as f64;
    let unit = 1000.0 * length;
    let root = 3.0_f64.sqrt();
    let rows = [
        ("ball_cage", 90.0, "ball cage, sqrt(3) N L (N m)", root),
        (
            "universal",
            90.0,
            "crosses at 90 deg, 2 sqrt(3) N L / 5 (N m)",
            0.4 * root,
        ),
        (
            "universal",
            0.0,
            "crosses in phase, (8 sqrt(3) - 6) N L / 13 (N m)",
            (8.0 * root - 6.0) / 13.0,
        ),
    ];
    rows.into_iter()
        .map(|(kind, phase_step, quantity, factor)| {
            let got = buckling_torque(kind, phase_step)?;
            Ok(Row::relative(CASE, quantity, factor * unit, got, LIMIT))
        })
        .collect()
}
