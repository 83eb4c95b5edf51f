//! Links that shorten along the chord as they tilt across it.

use std::f64::consts::TAU;

use super::case::{CaseTwin, crossing_frequency};
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

/// The law is of second order, and so is the closed form; the static start leaves some 10 mN of 1.2 kN.
const TOGGLE: f64 = 1e-4;
/// 10 mN of 56 N, and the pull's own stretch of the link, which is taken into account.
const LIFT: f64 = 1e-3;
/// To second order a link keeps w = L x tilt, and its inertia grows with the square of the tilt: a quarter of that square,
/// 2e-5 of the frequency. The step's (omega h)^2 / 12 is less.
const SWING: f64 = 1e-4;
/// Of the energy of the swing over six periods, in which the quadrature of the stretch over a step is all that is lost.
const AUDIT: f64 = 1e-3;

pub(super) fn toggle() -> Result<Vec<Row>, VerifyError> {
    let case = "toggle";
    let twin = CaseTwin::new(case)?;
    let tool = twin.config.tool();
    let length = 0.5 * twin.config.well.length();
    let axial = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0).axial;
    let expected = length * (1198.5 / axial).cbrt();
    let joint = twin.simulation.joint_stations()[0];
    let got = twin.displacement(joint, Body::Pipe, Direction::W);
    Ok(vec![Row::relative(
        case,
        "deflection of the joint, L (P / EA)^(1/3) (m)",
        expected,
        got,
        TOGGLE,
    )])
}

pub(super) fn tilted() -> Result<Vec<Row>, VerifyError> {
    let case = "tilted_link";
    let twin = CaseTwin::new(case)?;
    let (last, tool, length) = (twin.last(), twin.config.tool(), twin.config.well.length());
    let section = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
    let [along, across] = [Direction::U, Direction::W].map(|direction| twin.displacement(last, Body::Pipe, direction));
    let stretch = 1000.0 * length / section.axial;
    Ok(vec![
        Row::relative(case, "across, F L / N (m)", 55.81 / 1000.0 * length, across, LIFT),
        Row::relative(
            case,
            "lower end up, d^2 / (2 L) (m)",
            across * across / (2.0 * length),
            stretch - along,
            LIFT,
        ),
    ])
}

pub(super) fn hanging() -> Result<Vec<Row>, VerifyError> {
    let case = "hanging_link";
    let mut rows = Vec::new();
    for shortening in ["none", "second_order"] {
        let mut twin = CaseTwin::within(case, 1e-3, |config| config.with_value("tool.shortening", shortening))?;
        let (last, tool, length) = (twin.last(), twin.config.tool(), twin.config.well.length());
        let section = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
        let expected = (1.5 * 9.81 / length).sqrt() / TAU;
        let mut samples = Vec::new();
        twin.run_to(0.01)?;
        let before = *twin.simulation.energy();
        while twin.time() < 4.0 {
            twin.step()?;
            samples.push(twin.displacement(last, Body::Pipe, Direction::W));
        }
        let frequency = crossing_frequency(&samples, 0.00025).ok_or(VerifyError::Missing { case, what: "a swing" })?;
        let quantity = format!("swing, shortening {shortening} (Hz)");
        rows.push(Row::relative(case, quantity, expected, frequency, SWING));
        let largest = samples.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        // Energy of a rigid swing by so much at its end.
        let energy = 0.25 * section.mass * 9.81 * largest * largest;
        let after = twin.simulation.energy();
        rows.push(Row::scaled(
            case,
            format!("error of the audit, shortening {shortening} (J)"),
            0.0,
            after.error - before.error,
            energy,
            AUDIT,
        ));
    }
    Ok(rows)
}
