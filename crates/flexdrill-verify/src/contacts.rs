//! Contact and friction: a mass onto a gap, a sliding mass, a rolling rotor.

use std::f64::consts::{PI, TAU};

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::SectionProperties;
use flexdrill_core::tool::{Body, Direction};

pub(super) fn mass_onto_gap() -> Result<Vec<Row>, VerifyError> {
    let case = "mass_onto_gap";
    let mut twin = CaseTwin::new(case)?;
    let dt = twin.simulation.settings().time_step;
    let approach = twin.velocity(0, Body::Pipe, Direction::W);
    let (mut touched, mut steps) = (false, 0_u32);
    let mut left = None;
    while twin.time() < 0.03 && left.is_none() {
        twin.step()?;
        if twin.inner_normal(0) > 0.0 {
            touched = true;
            steps += 1;
        } else if touched {
            left = Some(twin.velocity(0, Body::Pipe, Direction::W));
        }
    }
    let left = left.ok_or(VerifyError::Missing {
        case,
        what: "the rebound",
    })?;
    let tool = twin.config.tool();
    let section = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
    let elements = (tool.links * tool.elements_per_link) as f64;
    let mass = section.mass * twin.config.well.length() / elements;
    let duration = PI * (mass / (2.0 * tool.inner.stiffness)).sqrt();
    Ok(vec![
        Row::relative(
            case,
            "contact time pi sqrt(m / 2k) (s)",
            duration,
            f64::from(steps) * dt,
            0.01,
        ),
        Row::relative(case, "rebound speed (m/s)", -approach, left, 0.01),
    ])
}

pub(super) fn sliding_mass() -> Result<Vec<Row>, VerifyError> {
    let case = "sliding_mass";
    let mut twin = CaseTwin::new(case)?;
    let speed = twin.velocity(0, Body::Pipe, Direction::U);
    let tool = twin.config.tool();
    let friction = tool.inner.friction_axial * tool.gravity;
    let mut stopped = None;
    while twin.time() < 0.1 {
        twin.step()?;
        // The regularised friction lets a thousandth of the speed creep away.
        if stopped.is_none() && twin.velocity(0, Body::Pipe, Direction::U) < 1e-3 * speed {
            stopped = Some(twin.time());
        }
    }
    let stopped = stopped.ok_or(VerifyError::Missing { case, what: "the stop" })?;
    let travelled = twin.displacement(0, Body::Pipe, Direction::U);
    Ok(vec![
        Row::relative(
            case,
            "distance v^2 / (2 mu g) (m)",
            speed * speed / (2.0 * friction),
            travelled,
            0.01,
        ),
        Row::relative(case, "time v / (mu g) (s)", speed / friction, stopped, 0.01),
    ])
}

pub(super) fn rolling_rotor() -> Result<Vec<Row>, VerifyError> {
    let case = "rolling_rotor";
    let mut twin = CaseTwin::new(case)?;
    let angle = |twin: &CaseTwin| {
        let at = |direction| twin.displacement(0, Body::Pipe, direction);
        at(Direction::W).atan2(at(Direction::V))
    };
    twin.run_to(1.0)?;
    let start = twin.time();
    let (mut before, mut turned) = (angle(&twin), 0.0);
    while twin.time() < 2.0 {
        twin.step()?;
        let now = angle(&twin);
        turned += (now - before + PI).rem_euclid(TAU) - PI;
        before = now;
    }
    let got = turned / (twin.time() - start);
    let tool = twin.config.tool();
    let (inner, outer) = (tool.pipe_contact_diameters[0], tool.guide_section.inner_diameter);
    let speed = twin.config.simulation().initial_inputs.rotary_speed;
    let expected = -speed * inner / (outer - inner);
    Ok(vec![Row::relative(
        case,
        "whirl rate -Omega d / (D - d) (rad/s)",
        expected,
        got,
        0.02,
    )])
}
