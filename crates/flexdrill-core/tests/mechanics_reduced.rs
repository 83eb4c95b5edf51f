//! The chain of nodes moves as the tool over all stations does.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::Instructions;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::SolverKind;
use flexdrill_core::tool::{Body, ToolDescription, WobPath};
use flexdrill_core::twin::{Simulation, SimulationSettings};

/// Lateral positions of all joints every 20 ms, without bit torque, which lets small differences grow.
fn calm(tool: &ToolDescription, solver: SolverKind, weight_on_bit: f64, steps: usize) -> Vec<Vec<f64>> {
    let mut tool = tool.clone();
    tool.bit.friction_factor = 0.0;
    let mut settings = SimulationSettings::default();
    settings.initial_inputs.weight_on_bit = weight_on_bit;
    let mut simulation = Simulation::with_solver(&tool, &settings, solver, Instructions::best()).unwrap();
    let inputs = Inputs {
        rotary_speed: 40.0 * std::f64::consts::TAU / 60.0,
        weight_on_bit,
        ..Inputs::default()
    };
    let joints = simulation.joint_stations().to_vec();
    let mut out = vec![Vec::new(); 2 * joints.len()];
    for step in 0..steps {
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
        if step % (steps / 150).max(1) == 0 {
            for (joint, &station) in joints.iter().enumerate() {
                let at = simulation.lateral(station, Body::Pipe).unwrap();
                out[2 * joint].push(at[0]);
                out[2 * joint + 1].push(at[1]);
            }
        }
    }
    out
}

#[test]
fn calm_joints_are_where_they_are_with_all_stations() {
    let default = ToolDescription::paper();
    let tied = default.clone().with(|tool| tool.wob_path = WobPath::Shared);
    // Between its joints such a guide gives way by a micrometre under its contacts.
    let mut soft = default.clone();
    soft.guide_bending_factor = 0.05;
    let hinged = support::hinged();
    let fixed = default.clone().with(|tool| tool.guide_fixed = true);
    for (name, tool, load, steps) in [
        ("default", &default, 10e3, 6000),
        ("tied", &tied, 10e3, 6000),
        ("soft guide", &soft, 20e3, 6000),
        ("fixed guide", &fixed, 10e3, 6000),
        // Not calm for longer.
        ("hinged", &hinged, 10e3, 200),
    ] {
        let (reduced, whole) = (
            calm(tool, SolverKind::Chain, load, steps),
            calm(tool, SolverKind::Stations, load, steps),
        );
        let range = |values: &[f64]| {
            let (least, most) = values
                .iter()
                .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
            most - least
        };
        let largest = whole.iter().map(|values| range(values)).fold(0.0, f64::max);
        let apart = reduced
            .iter()
            .flatten()
            .zip(whole.iter().flatten())
            .map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max);
        println!("{name}: {:.2e} m apart of {:.2e} m", apart, largest);
        // What the slaving is promised to change, of the range of the joint that moves most.
        assert!(apart < 5e-4 * largest, "{name}: {apart:e} m of {largest:e} m");
    }
}
