//! What several tests need: tools, settings, a random generator, a clock.

#![allow(dead_code)] // every test takes what it needs

use std::sync::OnceLock;
use std::time::Instant;

use flexdrill_core::tool::{GapDescription, HingeAngle, JointKind, ToolDescription, Tube, WellSection};
use flexdrill_core::twin::{Simulation, SimulationSettings, Snapshot};

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

/// A small deterministic generator (splitmix64), so that a test is the same everywhere.
#[derive(Debug, Clone)]
pub struct Random(pub u64);

impl Random {
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Evenly in `from..to`.
    pub fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Evenly in -1..1.
    pub fn next(&mut self) -> f64 {
        self.within(-1.0, 1.0)
    }

    pub fn sign(&mut self) -> f64 {
        if self.next_u64() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// Standard normal (Box-Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.within(1e-12, 1.0).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.within(0.0, 1.0)).cos()
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
