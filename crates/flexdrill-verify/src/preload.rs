//! A guide whose curvature as made is not that of the hole: its shape, its force on the wall, its freedom to turn.

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

/// Chords of 20 elements depart from the arc by (L / 20 R)^2 / 12 = 2e-5.
const SHAPE: f64 = 1e-4;
/// The thrust that the shear becomes, 23 kN x b / 2, softens a tube of that length by 0.15 %; the closed form has none.
const WALL: f64 = 3e-3;
/// The independent program has the beam's curve where the model has chords, and the same contacts.
const TOOL: f64 = 2e-3;
/// Chords turn about axes that are half the turn of an element off the tube's, cos^2 (L / 40 R) = 1 - 6e-5, and elements
/// of L / 20 resolve the turn along the tube within (a L / 20)^2 / 12 = 3e-5.
const TURN: f64 = 2e-4;

/// Radius of all arcs here (m).
pub(super) const RADIUS: f64 = 3.2;
/// Torque on the lower end of the guide that turns (N m).
const TORQUE: f64 = 100.0;

fn guide(twin: &CaseTwin) -> SectionProperties {
    let tool = twin.config.tool();
    SectionProperties::of(tool.guide_section, tool.material, tool.guide_bending_factor)
}

/// How far the middle of a straight tube lies from the arc between its ends (m).
pub(super) fn chord(length: f64) -> f64 {
    RADIUS * (1.0 / (0.5 * length / RADIUS).cos() - 1.0)
}

pub(super) fn at_its_ends() -> Result<Vec<Row>, VerifyError> {
    let case = "preload_chord";
    let mut rows = Vec::new();
    for factor in [1.0, 0.05] {
        let twin = CaseTwin::with(case, |config| config.with_value("tool.guide.bending_factor", factor))?;
        let last = twin.last();
        let w = |station| twin.displacement(station, Body::Guide, Direction::W);
        let quantity = format!("middle of a chord, bending factor {factor} (m)");
        let expected = -chord(twin.config.well.length());
        rows.push(Row::relative(case, quantity, expected, w(last / 2), SHAPE));
        // What is straight has turned at its ends by half the angle of the arc, in the plane.
        let tilt = twin.displacement(0, Body::Guide, Direction::PhiY);
        let angle = (0.5 * twin.config.well.length() / RADIUS).tan();
        rows.push(Row::relative(
            case,
            "tilt at its end, tan(L / 2R) (-)",
            angle,
            tilt,
            SHAPE,
        ));
    }
    Ok(rows)
}

pub(super) fn on_the_wall() -> Result<Vec<Row>, VerifyError> {
    let case = "preload_wall";
    let twin = CaseTwin::new(case)?;
    let (length, bending) = (twin.config.well.length(), guide(&twin).bending);
    let half = 0.5 * length / RADIUS;
    let compliance = RADIUS.powi(3) * (0.5 * half - 0.25 * (2.0 * half).sin()) / (2.0 * bending * half.cos().powi(2));
    let missing = chord(length) - twin.config.outer_clearance();
    let expected = missing / (compliance + 1.0 / twin.config.tool().outer.stiffness);
    let got = twin.simulation.normal_force(1, Body::Guide).unwrap_or(f64::NAN);
    Ok(vec![Row::relative(
        case,
        "force on the wall in the middle (N)",
        expected,
        got,
        WALL,
    )])
}

pub(super) fn in_the_tool() -> Result<Vec<Row>, VerifyError> {
    let case = "preload_tool";
    let twin = CaseTwin::new(case)?;
    let last = twin.last();
    let spacing = twin.config.well.length() / last as f64;
    let force = |station| twin.simulation.normal_force(station, Body::Guide).unwrap_or(f64::NAN);
    let side = |station| twin.displacement(station, Body::Guide, Direction::W);
    // Force (N) and its centre (m from the end) on the high side within 1 m of an end.
    let near = |end: usize| {
        let (mut sum, mut moment) = (0.0, 0.0);
        for station in (0..=last).filter(|station| side(*station) < 0.0) {
            let away = station.abs_diff(end) as f64 * spacing;
            if away < 1.0 {
                sum += force(station);
                moment += force(station) * away;
            }
        }
        (sum, moment / sum)
    };
    let (upper, at_upper) = near(0);
    let (lower, at_lower) = near(last);
    let low_side: f64 = (0..=last).filter(|station| side(*station) > 0.0).map(force).sum();
    let row = |quantity: &str, expected, got| Row::relative(case, quantity, expected, got, TOOL);
    Ok(vec![
        row("high side near the upper end (N)", 24.603e3, upper),
        row("its centre from the end (m)", 0.3642, at_upper),
        row("high side near the lower end (N)", 24.603e3, lower),
        row("its centre from the end (m)", 0.3642, at_lower),
        row("low side in the middle (N)", 1134.0, low_side),
    ])
}

pub(super) fn turning() -> Result<Vec<Row>, VerifyError> {
    let case = "preload_turning";
    let mut rows = Vec::new();
    let built = 1.0 / RADIUS;
    for (value, curvature, quantity) in [
        (None, built, "as built, end under 100 N m (rad)"),
        (Some(0.5 * built), 0.5 * built, "bent by half, end under 100 N m (rad)"),
    ] {
        let twin = CaseTwin::with(case, |config| match value {
            Some(value) => config.with_value("tool.guide.free_curvature", value),
            None => Ok(config),
        })?;
        let (s, length) = (guide(&twin), twin.config.well.length());
        let a = (s.bending * curvature / RADIUS / s.torsion).sqrt();
        let expected = TORQUE / (s.torsion * a * (a * length).tanh());
        let got = twin.displacement(twin.last(), Body::Guide, Direction::Psi);
        rows.push(Row::relative(case, quantity, expected, got, TURN));
    }
    let mut twin = CaseTwin::with(case, |config| {
        config
            .with_value("tool.guide.free_curvature", 0.0)?
            .with_value("start", "as_given")
    })?;
    let time = 0.05;
    twin.run_to(time)?;
    let last = twin.last();
    let psi = |station| twin.displacement(station, Body::Guide, Direction::Psi);
    let mean = ((1..last).map(psi).sum::<f64>() + 0.5 * (psi(0) + psi(last))) / last as f64;
    let inertia = guide(&twin).spin_inertia * twin.config.well.length();
    let expected = 0.5 * TORQUE * time * time / inertia;
    rows.push(Row::relative(
        case,
        "straight, mean turn after 50 ms, M t^2 / (2 rho J L) (rad)",
        expected,
        mean,
        TURN,
    ));
    Ok(rows)
}
