//! Friction in the pins of cross joints, and play about their shafts.

use std::f64::consts::TAU;

use super::case::{CaseTwin, crossing_frequency};
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

/// The regularised friction falls short of Coulomb's by 4e-4 (the slip rate over the swing's, squared, times a
/// logarithm), and friction about the upper arm, M b / T = 1.4e-3 at 2.7 degrees and 3.1e-3 at 6, carries a part of the torque.
const LOST_TORQUE: f64 = 4e-3;
/// The pin force is that of the step before: 0.03 h t against 0.0049 t^2 / 2 at t = 0.1 s and h = 0.05 ms is 6e-3. Below the
/// slip rate, in the first 4 ms, the regularised friction is below its full value: another 6e-3.
const FOLDING: f64 = 2e-2;
/// Newton leaves 0.01 mN m of 52 mN m unbalanced, which the steep end of the smooth sign makes 1e-3 of the rate; the link's
/// own acceleration as the torque grows is less.
const CREEP: f64 = 1e-2;
/// The static start leaves some 1 mN m per node of 10 N m.
const LOST_MOTION: f64 = 1e-3;
/// Entering and leaving a contact within a step of 0.1 ms, four times in a period of 55 ms.
const PERIOD: f64 = 2e-3;

/// Moment (N m) with which slipping pins resist under a torque (N m).
fn pin_moment(twin: &CaseTwin, torque: f64) -> f64 {
    let pins = twin.config.tool().joint.friction;
    2.0 * pins.coefficient * pins.pin_radius * torque / pins.circle_diameter
}

/// Rows of one turn at the bend of the case's `change`.
fn lost_torque(case: &'static str, mut twin: CaseTwin, rows: &mut Vec<Row>) -> Result<(), VerifyError> {
    let b = twin.simulation.bend_as_built(0).unwrap_or(f64::NAN);
    let moment = pin_moment(&twin, 92.43);
    let expected = 8.0 * moment * b * (1.0 + 0.25 * b * b) / TAU;
    twin.run_to(1.0)?;
    let before = *twin.simulation.energy();
    twin.run_to(2.0)?;
    let after = twin.simulation.energy();
    let degrees = b.to_degrees();
    let supplied = (after.drive - before.drive + after.loads - before.loads) / TAU;
    rows.push(Row::relative(
        case,
        format!("b {degrees:.3} deg, drive less load, 8 M b / 2 pi (N m)"),
        expected,
        supplied,
        LOST_TORQUE,
    ));
    let taken = (after.joint_friction - before.joint_friction) / TAU;
    rows.push(Row::relative(
        case,
        format!("b {degrees:.3} deg, taken by the pins (N m)"),
        expected,
        taken,
        LOST_TORQUE,
    ));
    let error = after.error - before.error;
    rows.push(Row::scaled(
        case,
        format!("b {degrees:.3} deg, error of the audit over a turn (J)"),
        0.0,
        error,
        TAU * expected,
        LOST_TORQUE,
    ));
    Ok(())
}

pub(super) fn friction() -> Result<Vec<Row>, VerifyError> {
    let case = "pin_friction";
    let mut rows = Vec::new();
    lost_torque(case, CaseTwin::new(case)?, &mut rows)?;
    let steep = CaseTwin::with(case, |config| {
        config
            .with_value("well.sections.0.arc.build_angle_deg", 12.0)?
            .with_value("well.sections.0.arc.radius", 1.4323)
    })?;
    lost_torque(case, steep, &mut rows)?;
    Ok(rows)
}

pub(super) fn holding() -> Result<Vec<Row>, VerifyError> {
    let case = "pin_holding";
    let length = 0.15;
    // Rate at which the upper link turns out of the plane of the bend after 0.1 s (rad/s).
    let turned = |degrees: f64| -> Result<(CaseTwin, f64), VerifyError> {
        let angle = 2.0 * degrees;
        let mut twin = CaseTwin::within(case, 1e-3, |config| {
            config
                .with_value("well.sections.0.arc.build_angle_deg", angle)?
                .with_value("well.sections.0.arc.radius", 2.0 * length / angle.to_radians())
        })?;
        twin.run_to(0.1)?;
        let rate = twin.velocity(0, Body::Pipe, Direction::V).abs() / length;
        Ok((twin, rate))
    };
    let (twin, folding) = turned(2.0)?;
    let resists = pin_moment(&twin, 1.0);
    let tool = twin.config.tool();
    let mass = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0).mass * length;
    let inertia = mass * length * length / 3.0;
    let expected = 20.0 * 0.01 * (2.0_f64.to_radians().sin() - resists) / (2.0 * inertia);
    let (_, creeping) = turned(1.5)?;
    let x = 1.5_f64.to_radians().sin() / resists;
    let creep = tool.joint.friction.slip_rate * x / (1.0 - x * x).sqrt();
    Ok(vec![
        Row::relative(
            case,
            "2 deg folds, rate after 0.1 s (rad/s)",
            expected,
            folding,
            FOLDING,
        ),
        Row::relative(case, "1.5 deg holds, creep (rad/s)", creep, creeping, CREEP),
    ])
}

pub(super) fn play() -> Result<Vec<Row>, VerifyError> {
    let case = "joint_play";
    let twist = |torque: f64| -> Result<(CaseTwin, f64), VerifyError> {
        let twin = CaseTwin::with(case, |config| config.with_value("loads.0.history.constant", torque))?;
        let at = twin.displacement(twin.last(), Body::Pipe, Direction::Psi);
        Ok((twin, at))
    };
    let torque = 10.0;
    let ((twin, forward), (_, back)) = (twist(torque)?, twist(-torque)?);
    let tool = twin.config.tool();
    let pipe = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
    let joints = twin.simulation.joint_stations().len() as f64;
    let by_torque = joints / tool.joint.play.stiffness + twin.config.well.length() / pipe.torsion;
    let expected = joints * 2.0 * tool.joint.play.half_angle + 2.0 * torque * by_torque;
    Ok(vec![Row::relative(
        case,
        "two joints of 0.29 deg, turned back (rad)",
        expected,
        forward - back,
        LOST_MOTION,
    )])
}

pub(super) fn rotor() -> Result<Vec<Row>, VerifyError> {
    let case = "play_rotor";
    let mut twin = CaseTwin::new(case)?;
    let (last, tool) = (twin.last(), twin.config.tool());
    let (delta, k) = (tool.joint.play.half_angle, tool.joint.play.stiffness);
    let speed = tool.initial_spin_rate;
    let inertia = tool.masses[0].axial_inertia;
    let expected = 4.0 * delta / speed + TAU * (inertia / k).sqrt();
    let mut samples = Vec::new();
    let mut fastest = 0.0_f64;
    while twin.time() < 1.0 {
        twin.step()?;
        samples.push(twin.displacement(last, Body::Pipe, Direction::Psi));
        if twin.time() > 0.9 {
            fastest = fastest.max(twin.velocity(last, Body::Pipe, Direction::Psi).abs());
        }
    }
    let frequency = crossing_frequency(&samples, 1e-4).ok_or(VerifyError::Missing { case, what: "a swing" })?;
    let stored = 0.5 * inertia * speed * speed;
    Ok(vec![
        Row::relative(case, "period (s)", expected, 1.0 / frequency, PERIOD),
        Row::relative(
            case,
            "speed within the play after 18 periods (rad/s)",
            speed,
            fastest,
            PERIOD,
        ),
        Row::scaled(
            case,
            "error of the audit, of the rotor's energy (J)",
            0.0,
            twin.simulation.energy().error,
            stored,
            PERIOD,
        ),
    ])
}
