//! Pump pressure: buckling by it, and what the pipe's end makes of it.

use std::f64::consts::PI;

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

/// 20 elements buckle within (pi / 20)^4 / 720 = 1e-6; the last extrapolation spans a hundredth of the pressure.
const BUCKLING: f64 = 1e-4;
/// The static corrections end where rounding keeps the residual from falling, some 1e-9 of 1 N across the chain.
const SHAPE: f64 = 1e-7;
/// Forces of some kN, of which 1 mN per node may stay out of balance.
const FORCE: f64 = 1e-6;

/// Area of a disc (m2).
fn disc(diameter: f64) -> f64 {
    PI / 4.0 * diameter * diameter
}

/// The pressure at which the stiffness against a lateral force vanishes, approached from below.
pub(super) fn buckling() -> Result<Vec<Row>, VerifyError> {
    let case = "pressure_buckling";
    let stiffness = |pressure: f64| -> Result<f64, VerifyError> {
        let twin = CaseTwin::with(case, |config| {
            config.with_value("environment.pressure.at_top", pressure)
        })?;
        Ok(1.0 / twin.displacement(twin.last() / 2, Body::Pipe, Direction::W))
    };
    let config = CaseTwin::new(case)?.config.clone();
    let tool = config.tool();
    let pipe = tool.pipe_sections[0];
    let bending = SectionProperties::of(pipe, tool.material, 1.0).bending;
    let expected = bending * (PI / config.well.length()).powi(2) / disc(pipe.inner_diameter);
    // Nearly a straight line: one half wave carries almost all of the deflection.
    let (mut before, mut pressure) = ((0.0, stiffness(0.0)?), 10e6);
    for _ in 0..20 {
        let now = (pressure, stiffness(pressure)?);
        let vanishes = now.0 + now.1 * (now.0 - before.0) / (before.1 - now.1);
        if vanishes - pressure < 1e-2 * vanishes {
            let quantity = "pressure, pi^2 EI / (L^2 A_i) (Pa)";
            return Ok(vec![Row::relative(case, quantity, expected, vanishes, BUCKLING)]);
        }
        (before, pressure) = (now, pressure + 0.8 * (vanishes - pressure));
    }
    Err(VerifyError::Missing { case, what: "buckling" })
}

/// Deflection of three joints (m).
fn across(twin: &CaseTwin) -> [f64; 3] {
    [0, 1, 3].map(|joint| twin.displacement(twin.simulation.joint_stations()[joint], Body::Pipe, Direction::W))
}

fn compared(case: &'static str, expected: [f64; 3], got: [f64; 3]) -> Vec<Row> {
    let pairs = ["first", "second", "last"].iter().zip(expected.into_iter().zip(got));
    pairs
        .map(|(joint, (expected, got))| Row::relative(case, format!("{joint} joint (m)"), expected, got, SHAPE))
        .collect()
}

/// A closed end, and a pipe between two supports.
pub(super) fn closed() -> Result<Vec<Row>, VerifyError> {
    let case = "pressure_closed";
    let pressure = 5e6;
    let (key, drop) = ("environment.pressure.at_top", 0.02);
    let (without, under) = (
        CaseTwin::new(case)?,
        CaseTwin::with(case, |config| config.with_value(key, pressure))?,
    );
    let mut rows = compared(case, across(&without), across(&under));
    let (length, links) = (without.config.well.length(), without.config.tool.links as f64);
    let carried = without.simulation.joints().axial_force.into_iter();
    for (joint, (before, after)) in carried.zip(under.simulation.joints().axial_force).enumerate() {
        let depth = length / links * (joint + 1) as f64;
        let expected = before + pressure * (1.0 - drop * depth) * disc(0.062);
        let quantity = format!("pins of joint {}, N_eff + p A_j (N)", joint + 1);
        rows.push(Row::relative(case, quantity, expected, after, FORCE));
    }
    let held = CaseTwin::with(case, |config| {
        config
            .with_value("tool.links", 1)?
            .with_value("environment.gravity", 0.0)?
            .with_values(
                "verify",
                [("boundary.bottom_axial", "fixed"), ("environment.pressure.end", "held")],
            )?
            .with_value(key, pressure)
    })?;
    let tool = held.config.tool();
    let bore = disc(tool.pipe_sections[0].inner_diameter);
    let mean = pressure * (1.0 - drop * 0.5 * length);
    let expected = -(1.0 - 2.0 * tool.material.poisson_ratio) * bore * mean;
    // Under compression the upper support pushes the pipe down.
    let reactions = held.simulation.new_snapshot().reactions;
    let [_, _, down] = reactions.force.first().copied().unwrap_or([f64::NAN; 3]);
    let quantity = "held, effective tension -(1 - 2 nu) p A_i (N)";
    rows.push(Row::relative(case, quantity, expected, -down, FORCE));
    Ok(rows)
}

/// An end in a seal.
pub(super) fn seal() -> Result<Vec<Row>, VerifyError> {
    let case = "pressure_seal";
    let pressure = 5e5;
    let under = CaseTwin::with(case, |config| {
        config.with_value("environment.pressure.at_top", pressure)
    })?;
    let at_end = pressure * (1.0 - 0.02 * under.config.well.length());
    let pull = 2000.0 - at_end * disc(0.040);
    let pulled = CaseTwin::with(case, |config| config.with_value("loads.1.history.constant", pull))?;
    Ok(compared(case, across(&pulled), across(&under)))
}
