//! The published forces from outside balance: at rest among themselves, in motion with inertia and damping, however the
//! tool is solved.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::Instructions;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::SolverKind;
use flexdrill_core::tool::{
    AddedMass, Body, Direction, FreeCurvature, LoadHistory, Location, MudDamping, MudDescription, MudFilm, PointLoad,
    PointMass, PressureDescription, PressureEnd, PressureSource, ToolDescription,
};
use flexdrill_core::twin::{Holder, Reactions, Simulation, SimulationSettings};
use nalgebra::Vector3;

/// Newton leaves at most 10 mN on a node at rest. The paper's tool has 166 stations of two nodes each.
const AT_REST: f64 = 166.0 * 2.0 * 0.010;

/// Under a weight on bit of 10 kN from the start.
fn simulation(tool: &ToolDescription, solver: SolverKind) -> Simulation {
    let settings = SimulationSettings::default().with(|settings| {
        settings.initial_inputs = Inputs {
            rotary_speed: 0.0,
            weight_on_bit: 10e3,
            ..Inputs::default()
        }
    });
    Simulation::with_solver(tool, &settings, solver, Instructions::best()).unwrap()
}

fn outside(reactions: &Reactions) -> Vector3<f64> {
    [
        reactions.supports,
        reactions.weight,
        reactions.wall,
        reactions.bit,
        reactions.loads,
    ]
    .into_iter()
    .map(Vector3::from)
    .sum()
}

/// The paper's tool with what else can act on one: a mass with an eccentricity, a load across the pipe, a guide with a
/// preload, pressure on a sealed end, mud.
fn loaded() -> ToolDescription {
    let mut tool = ToolDescription::paper();
    tool.masses.push(PointMass {
        location: Location::Joint(3),
        body: Body::Guide,
        mass: 12.0,
        axial_inertia: 0.02,
        transverse_inertia: 0.02,
        eccentricity: 0.005,
        eccentricity_phase: 0.4,
    });
    tool.guide_free_curvature = Some(FreeCurvature {
        curvature: 0.3,
        phase: 0.0,
    });
    tool.pressure = Some(PressureDescription {
        at_top: PressureSource::Constant(1e5),
        drop_per_metre: 0.05,
        end: PressureEnd::Sealed { diameter: 0.063 },
        joint_seal_diameter: 0.062,
    });
    tool.mud = Some(MudDescription {
        density: 1100.0,
        viscosity: 0.1,
        frequency: 2.0,
        added_mass: AddedMass::Eccentric,
        damping: MudDamping::Viscous,
        film: MudFilm::Squeeze,
    });
    tool.loads.push(PointLoad {
        location: Location::Joint(10),
        body: Body::Pipe,
        direction: Direction::W,
        history: LoadHistory::Constant(250.0),
    });
    tool
}

#[test]
fn at_rest_supports_carry_weight_load_and_weight_on_bit() {
    for solver in [SolverKind::Chain, SolverKind::Stations] {
        for tool in [ToolDescription::paper(), loaded()] {
            let simulation = simulation(&tool, solver);
            let reactions = simulation.new_snapshot().reactions;
            let left = outside(&reactions).norm();
            let supports: Vector3<f64> = reactions.force.iter().map(|&force| Vector3::from(force)).sum();
            println!(
                "{solver:?}: {left:.4} N left of {:.0} N",
                Vector3::from(reactions.bit).norm()
            );
            assert!(left < AT_REST, "{solver:?}: {reactions:?}");
            assert!((supports - Vector3::from(reactions.supports)).norm() < 1e-9);
            assert!(Vector3::from(reactions.bit).norm() > 1e3 && reactions.weight[2] > 1e3);
            assert_eq!(reactions.force.len(), reactions.measured_depth.len());
            let held = [Body::Pipe, Body::Guide].map(Holder::Support);
            assert!(held.iter().all(|holder| reactions.holder.contains(holder)));
        }
    }
}

#[test]
fn in_motion_inertia_and_damping_close_the_balance() {
    for solver in [SolverKind::Chain, SolverKind::Stations] {
        let mut simulation = simulation(&loaded(), solver);
        let mut snapshot = simulation.new_snapshot();
        let inputs = Inputs {
            rotary_speed: 8.0,
            weight_on_bit: 10e3,
            ..Inputs::default()
        };
        let (mut left, mut inertia) = (0.0_f64, 0.0_f64);
        for step in 0..2400 {
            simulation.advance(&inputs).ok().unwrap();
            if step % 7 == 0 {
                simulation.snapshot(&mut snapshot, false);
                left = left.max(Vector3::from(snapshot.reactions.unbalance).norm());
                inertia = inertia.max(Vector3::from(snapshot.reactions.inertia).norm());
            }
        }
        println!("{solver:?}: at most {left:.3} N left, inertia up to {inertia:.1} N");
        // In motion a node may be left with 1 N, of either sign; the sum came to 1.1 N over both paths.
        assert!(left < AT_REST, "{left}");
        // Else inertia would not be held by this.
        assert!(inertia > 20.0 * AT_REST, "{inertia}");
    }
}
