//! What several tests need: tools, settings, a random generator, a clock.

#![allow(dead_code, unused_imports)] // every test takes what it needs

mod figures;
mod random;

use std::sync::OnceLock;
use std::time::Instant;

pub use figures::{figure, scaled_figure};
use flexdrill_core::tool::{HingeAngle, JointKind, ToolDescription, Tube, WellSection};
use flexdrill_core::twin::{Simulation, SimulationSettings, Snapshot};
pub use random::Random;

/// The paper's case with two elements per link: a third of the work.
pub fn coarse() -> ToolDescription {
    ToolDescription::paper().with_mesh(33, 2)
}

/// Two links of one element in a short arc: steps of some microseconds.
pub fn tiny() -> ToolDescription {
    let mut tool = ToolDescription::paper().with_mesh(2, 1);
    tool.well.sections = vec![WellSection::Arc {
        radius: 3.2,
        angle: 0.1,
    }];
    tool
}

/// Four links of two elements in the paper's quarter circle. A wide limit leaves some of the stops shut and some open.
pub fn small() -> ToolDescription {
    let mut tool = ToolDescription::paper().with_mesh(4, 2);
    tool.joint.limit = 0.39;
    tool
}

/// A tool like that of `config/paper.yaml`: hinges as built, thick pipe, soft guide, high friction.
pub fn hinged() -> ToolDescription {
    let paper = ToolDescription::paper().with_pipe(Tube {
        outer_diameter: 0.0703,
        inner_diameter: 0.0461,
    });
    paper.with(|tool| {
        tool.guide_section = Tube {
            outer_diameter: 0.110,
            inner_diameter: 0.0743,
        };
        tool.guide_bending_factor = 0.05;
        (tool.inner.stiffness, tool.outer.stiffness) = (1.57e7, 1.8e8);
        (tool.inner.friction_tangential, tool.inner.friction_axial) = (0.423, 0.423);
        (tool.outer.friction_tangential, tool.outer.friction_axial) = (0.195, 0.195);
        tool.joint.kind = JointKind::Revolute;
        tool.joint.hinge_angle = HingeAngle::AsBuilt;
        tool.joint.cross_phase = 122_f64.to_radians();
        tool.rayleigh.beta = 1e-3;
    })
}

/// A simulation with the default settings.
pub fn simulation(tool: &ToolDescription) -> Simulation {
    Simulation::new(tool, &SimulationSettings::default()).unwrap()
}

/// Large steps with few corrections and halvings: collisions are hard to get through.
pub fn hard_settings(max_iterations: u32, max_halvings: u32) -> SimulationSettings {
    SimulationSettings::default().with(|settings| {
        settings.time_step = 2e-3;
        settings.max_iterations = max_iterations;
        settings.max_halvings = max_halvings;
    })
}

/// Nanoseconds since the first call.
pub fn clock() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    // One more, so that the first call does not look like no time.
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64 + 1
}

/// Whether two snapshots have the same bits, by what they print: different numbers print differently, and NaN, which
/// stands where there is no ratio, is not equal to itself.
pub fn same_bits(a: &Snapshot, b: &Snapshot) -> bool {
    format!("{a:?}") == format!("{b:?}")
}
