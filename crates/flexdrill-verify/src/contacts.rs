//! Contact and friction: a mass onto a gap, a sliding mass, a rolling rotor.

use std::f64::consts::{PI, TAU};

use super::bench::Bench;
use super::{Row, VerifyError};
use flexdrill_core::tool::SectionProperties;
use flexdrill_core::tool::{Body, Direction};

pub(super) fn mass_onto_gap() -> Result<Vec<Row>, VerifyError> {
    let case = "mass_onto_gap";
    let mut bench = Bench::new(case)?;
    let dt = bench.simulation.settings().time_step;
    let approach = bench.velocity(0, Body::Pipe, Direction::W);
    let (mut touched, mut steps) = (false, 0_u32);
    let mut left = None;
    while bench.time() < 0.03 && left.is_none() {
        bench.step()?;
        if bench.inner_normal(0) > 0.0 {
            touched = true;
            steps += 1;
        } else if touched {
            left = Some(bench.velocity(0, Body::Pipe, Direction::W));
        }
    }
    let left = left.ok_or(VerifyError::Missing {
        case,
        what: "the rebound",
    })?;
    let tool = bench.config.tool();
    let section = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
    let elements = (tool.links * tool.elements_per_link) as f64;
    let mass = section.mass * bench.config.well.length() / elements;
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
    let mut bench = Bench::new(case)?;
    let speed = bench.velocity(0, Body::Pipe, Direction::U);
    let tool = bench.config.tool();
    let friction = tool.inner.friction_axial * tool.gravity;
    let mut stopped = None;
    while bench.time() < 0.1 {
        bench.step()?;
        // The regularised friction lets a thousandth of the speed creep away.
        if stopped.is_none() && bench.velocity(0, Body::Pipe, Direction::U) < 1e-3 * speed {
            stopped = Some(bench.time());
        }
    }
    let stopped = stopped.ok_or(VerifyError::Missing { case, what: "the stop" })?;
    let travelled = bench.displacement(0, Body::Pipe, Direction::U);
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
    let mut bench = Bench::new(case)?;
    let angle = |bench: &Bench| {
        let at = |direction| bench.displacement(0, Body::Pipe, direction);
        at(Direction::W).atan2(at(Direction::V))
    };
    bench.run_to(1.0)?;
    let start = bench.time();
    let (mut before, mut turned) = (angle(&bench), 0.0);
    while bench.time() < 2.0 {
        bench.step()?;
        let now = angle(&bench);
        turned += (now - before + PI).rem_euclid(TAU) - PI;
        before = now;
    }
    let got = turned / (bench.time() - start);
    let tool = bench.config.tool();
    let (inner, outer) = (tool.pipe_contact_diameters[0], tool.guide_section.inner_diameter);
    let speed = bench.config.simulation().initial_inputs.rotary_speed;
    let expected = -speed * inner / (outer - inner);
    Ok(vec![Row::relative(
        case,
        "whirl rate -Omega d / (D - d) (rad/s)",
        expected,
        got,
        0.02,
    )])
}
