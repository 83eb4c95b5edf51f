//! Bodies on nodes: rotary inertia at the end of a rod, an unbalance on a shaft.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::case::{CaseTwin, crossing_frequency};
use super::{Row, VerifyError};
use flexdrill_config::{Config, ConfigError};
use flexdrill_core::tool::SectionProperties;
use flexdrill_core::tool::{Body, Direction};

/// 20 elements give the first frequency within (b / 20)^2 / 24 = 1e-4, the step within 1e-5.
const FREQUENCY: f64 = 1e-3;
/// Newmark follows omega with an error of (omega h)^2 / 12 = 1e-4, which the distance to the critical speed doubles.
const AMPLITUDE: f64 = 1e-3;

fn section(twin: &CaseTwin) -> SectionProperties {
    let tool = twin.config.tool();
    SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0)
}

/// b of b tan b = `ratio`, by bisection.
fn root(ratio: f64) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if middle * middle.tan() < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

pub(super) fn torsion_pendulum() -> Result<Vec<Row>, VerifyError> {
    let case = "torsion_pendulum";
    let as_bit = |config: Config| -> Result<Config, ConfigError> {
        let inertia = config.masses[0].inertia;
        config
            .with_value("masses.0.inertia", 0.0)?
            .with_value("tool.bit.inertia", inertia)
    };
    Ok(vec![
        swing(case, CaseTwin::new(case)?, "with a body, first frequency (Hz)")?,
        swing(
            case,
            CaseTwin::with(case, as_bit)?,
            "the same as the bit's inertia (Hz)",
        )?,
    ])
}

fn swing(case: &'static str, mut twin: CaseTwin, quantity: &str) -> Result<Row, VerifyError> {
    let (s, tool) = (section(&twin), twin.config.tool());
    let (last, length) = (twin.last(), twin.config.well.length());
    let inertia = tool.bit.inertia + tool.masses[0].axial_inertia;
    let rod = s.spin_inertia * length;
    let b = root(rod / inertia);
    let expected = b / length * (s.torsion / s.spin_inertia).sqrt() / TAU;
    twin.run_to(0.001)?;
    // The first mode, sin(b x / L), out of those that a sudden release excites: weighted with the inertia it moves.
    let mode = |station: usize| (b * station as f64 / last as f64).sin();
    let end = 0.5 + inertia * last as f64 / rod;
    let mut samples = Vec::new();
    while twin.time() < 0.05 {
        twin.step()?;
        let turned = |station: usize| mode(station) * twin.displacement(station, Body::Pipe, Direction::Psi);
        samples.push((0..last).map(turned).sum::<f64>() + end * turned(last));
    }
    let got = crossing_frequency(&samples, twin.simulation.settings().time_step)
        .ok_or(VerifyError::Missing { case, what: "a swing" })?;
    Ok(Row::relative(case, quantity, expected, got, FREQUENCY))
}

pub(super) fn unbalanced_rotor() -> Result<Vec<Row>, VerifyError> {
    let case = "unbalanced_rotor";
    [0.6, 1.6]
        .into_iter()
        .map(|ratio| {
            let twin = CaseTwin::new(case)?;
            let (tool, length) = (twin.config.tool(), twin.config.well.length());
            let disc = tool.masses[0];
            let critical = (48.0 * section(&twin).bending / (disc.mass * length.powi(3))).sqrt();
            let (speed, alpha) = (ratio * critical, tool.rayleigh.alpha);
            let rpm = 60.0 * speed / TAU;
            let mut twin = CaseTwin::with(case, |config| {
                config
                    .with_value("inputs.rotary_speed.max_rpm", 2.0 * rpm)?
                    .with_value("inputs.rotary_speed.initial_rpm", rpm)?
                    .with_value("initial.spin_rpm", rpm)
            })?;
            twin.run_to(1.5)?;
            let at = |direction| twin.displacement(1, Body::Pipe, direction);
            let got = at(Direction::V).hypot(at(Direction::W));
            let damped = (alpha * speed).powi(2);
            let detuned = (critical * critical - speed * speed).powi(2);
            let expected = disc.eccentricity * ((speed.powi(4) + damped) / (detuned + damped)).sqrt();
            let quantity = format!("whirl at {ratio} of the critical speed (m)");
            Ok(Row::relative(case, quantity, expected, got, AMPLITUDE))
        })
        .collect()
}
