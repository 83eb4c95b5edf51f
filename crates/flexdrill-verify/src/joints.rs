//! Cross joints: the ripple of one, cancelled by a second, multiplied by a chain.

use std::f64::consts::TAU;

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction};

/// Part of the ripple's amplitude.
const RIPPLE: f64 = 1e-3;

/// (angle of the drive, speed of the last node) over the last turn of two, when the start has died away.
fn last_turn(twin: &mut CaseTwin) -> Result<Vec<(f64, f64)>, VerifyError> {
    let last = twin.last();
    let mut samples = Vec::new();
    twin.run_to(1.0)?;
    while twin.time() < 2.0 {
        twin.step()?;
        samples.push((
            twin.displacement(0, Body::Pipe, Direction::Psi),
            twin.velocity(last, Body::Pipe, Direction::Psi),
        ));
    }
    Ok(samples)
}

/// Speed ratio of a cross joint at bend `b` with the driving arm at `psi` from the plane of the bend.
fn ratio(b: f64, psi: f64) -> f64 {
    b.cos() / (1.0 - (b.sin() * psi.cos()).powi(2))
}

fn bend(twin: &CaseTwin) -> f64 {
    twin.simulation.bend_as_built(0).unwrap_or(f64::NAN)
}

pub(super) fn single() -> Result<Vec<Row>, VerifyError> {
    let case = "hooke_single";
    let mut twin = CaseTwin::new(case)?;
    let b = bend(&twin);
    let turn = last_turn(&mut twin)?;
    let amplitude = 0.5 * TAU * (1.0 / b.cos() - b.cos());
    let worst = turn
        .iter()
        .map(|&(psi, speed)| speed - TAU * ratio(b, psi))
        .fold(0.0, farther);
    let quantity = format!("farthest from the formula, ripple {amplitude:.4} (rad/s)");
    Ok(vec![Row::scaled(case, quantity, 0.0, worst, amplitude, RIPPLE)])
}

pub(super) fn pair() -> Result<Vec<Row>, VerifyError> {
    let case = "hooke_pair";
    let mut twin = CaseTwin::new(case)?;
    let b = bend(&twin);
    let turn = last_turn(&mut twin)?;
    let amplitude = 0.5 * TAU * (1.0 / b.cos() - b.cos());
    let worst = turn.iter().map(|&(_, speed)| speed - TAU).fold(0.0, farther);
    let quantity = format!("ripple left of {amplitude:.4} (rad/s)");
    Ok(vec![Row::scaled(case, quantity, 0.0, worst, amplitude, RIPPLE)])
}

pub(super) fn chain() -> Result<Vec<Row>, VerifyError> {
    let case = "hooke_chain";
    let mut twin = CaseTwin::new(case)?;
    let b = bend(&twin);
    let joints = twin.simulation.joint_stations().len();
    let turn = last_turn(&mut twin)?;
    let n = i32::try_from(joints).unwrap_or(i32::MAX);
    let (high, low) = (b.cos().powi(-n), b.cos().powi(n));
    let fastest = turn.iter().fold(f64::MIN, |m, &(_, speed)| m.max(speed)) / TAU;
    let slowest = turn.iter().fold(f64::MAX, |m, &(_, speed)| m.min(speed)) / TAU;
    let amplitude = 0.5 * (high - low);
    Ok(vec![
        Row::scaled(
            case,
            format!("fastest over drive, 1 / cos^{n} b"),
            high,
            fastest,
            amplitude,
            RIPPLE,
        ),
        Row::scaled(
            case,
            format!("slowest over drive, cos^{n} b"),
            low,
            slowest,
            amplitude,
            RIPPLE,
        ),
    ])
}

fn farther(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}
