//! The time integration: order and drift.

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::SectionProperties;
use flexdrill_core::tool::{Body, Direction};

const CASE: &str = "free_vibration";

fn with_step(step: f64) -> Result<CaseTwin, VerifyError> {
    CaseTwin::with(CASE, |config| config.with_value("solver.time_step", step))
}

/// Tip deflection after 50 ms.
fn tip(step: f64) -> Result<f64, VerifyError> {
    let mut twin = with_step(step)?;
    twin.run_to(0.05)?;
    Ok(twin.displacement(twin.last(), Body::Pipe, Direction::W))
}

pub(super) fn free_vibration() -> Result<Vec<Row>, VerifyError> {
    let exact = tip(1.25e-6)?;
    let (coarse, fine) = ((tip(4e-5)? - exact).abs(), (tip(2e-5)? - exact).abs());
    let order = (coarse / fine).log2();
    let mut rows = vec![Row::scaled(
        CASE,
        "order of Newmark at gamma 1/2",
        2.0,
        order,
        1.0,
        0.05,
    )];

    // 1e5 periods at five steps each: nothing of the energy may go or come. A correction in single precision leaves
    // 1e-7 of the forces, of one sign step after step; the next one takes it.
    let mut twin = CaseTwin::within(CASE, 1e-6, |config| config.with_value("solver.time_step", 0.01))?;
    let tool = twin.config.tool();
    let section = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
    let length = twin.config.well.length() / (tool.links * tool.elements_per_link) as f64;
    let speed = twin.velocity(twin.last(), Body::Pipe, Direction::W);
    // First frequency of the cantilever, 3.516 sqrt(EI / rho A L^4) / 2 pi.
    let frequency = 3.516 / std::f64::consts::TAU * (section.bending / section.mass).sqrt();
    let start = 0.5 * section.mass * length * speed * speed;
    let before = twin.simulation.energy().stored;
    twin.run_to(1e5 / frequency)?;
    let drift = twin.simulation.energy().stored - before;
    rows.push(Row::scaled(
        CASE,
        "energy after 1e5 periods less that before (J)",
        0.0,
        drift,
        start,
        1e-6,
    ));
    Ok(rows)
}
