//! What several tests need: tools, settings, a random generator, a clock.

#![allow(dead_code, unused_imports)] // every test takes what it needs

mod random;

use std::sync::OnceLock;
use std::time::Instant;

use flexdrill_core::tool::{GapDescription, HingeAngle, JointKind, ToolDescription, Tube, WellSection};
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
    let mut tool = ToolDescription {
        guide_section: Tube {
            outer_diameter: 0.110,
            inner_diameter: 0.0743,
        },
        guide_bending_factor: 0.05,
        inner: GapDescription {
            stiffness: 1.57e7,
            friction_tangential: 0.423,
            friction_axial: 0.423,
            ..paper.inner
        },
        outer: GapDescription {
            stiffness: 1.8e8,
            friction_tangential: 0.195,
            friction_axial: 0.195,
            ..paper.outer
        },
        ..paper
    };
    tool.joint.kind = JointKind::Revolute;
    tool.joint.hinge_angle = HingeAngle::AsBuilt;
    tool.joint.cross_phase = 122_f64.to_radians();
    tool.rayleigh.beta = 1e-3;
    tool
}

/// A simulation with the default settings.
pub fn simulation(tool: &ToolDescription) -> Simulation {
    Simulation::new(tool, &SimulationSettings::default()).unwrap()
}

/// Large steps with few corrections and halvings: collisions are hard to get through.
pub fn hard_settings(max_iterations: u32, max_halvings: u32) -> SimulationSettings {
    SimulationSettings {
        time_step: 2e-3,
        max_iterations,
        max_halvings,
        ..SimulationSettings::default()
    }
}

/// Nanoseconds since the first call.
pub fn clock() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    // One more, so that the first call does not look like no time.
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64 + 1
}

/// Whether two snapshots have the same bits, by what they print: every number has a text of its own, and NaN, which stands
/// where there is no ratio, is not equal to itself.
pub fn same_bits(a: &Snapshot, b: &Snapshot) -> bool {
    format!("{a:?}") == format!("{b:?}")
}
