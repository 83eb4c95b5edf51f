//! Steps in parts: the same motion as that of shorter steps, no jump where the parts change, the same bits from a
//! checkpoint.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::MOST_REFINEMENT;
use flexdrill_core::tool::{Body, ToolDescription};
use flexdrill_core::twin::{Run, Schedule, Simulation, SimulationSettings, Snapshot, StepRule};

const LOAD: f64 = 10e3;
const TURNING: Inputs = Inputs {
    rotary_speed: 40.0 * std::f64::consts::TAU / 60.0,
    weight_on_bit: LOAD,
    ..Inputs::ZERO
};

/// Without bit torque, which lets small differences grow.
fn calm() -> ToolDescription {
    let mut tool = ToolDescription::paper();
    tool.bit.friction_factor = 0.0;
    tool
}

fn simulation(tool: &ToolDescription, time_step: f64) -> Simulation {
    let mut settings = SimulationSettings::default().with(|settings| settings.time_step = time_step);
    settings.initial_inputs.weight_on_bit = LOAD;
    Simulation::new(tool, &settings).unwrap()
}

fn advance(simulation: &mut Simulation) {
    assert!(matches!(simulation.advance(&TURNING), StepOutcome::Advanced { .. }));
}

/// Lateral positions of all joints, y then z.
fn joints(simulation: &Simulation) -> Vec<f64> {
    let stations = simulation.joint_stations().iter();
    stations
        .flat_map(|&station| simulation.lateral(station, Body::Pipe).unwrap())
        .collect()
}

#[test]
fn parts_of_a_step_are_shorter_steps() {
    let tool = calm();
    let step = SimulationSettings::default().time_step;
    for refinement in 1..=MOST_REFINEMENT {
        let parts = 1 << refinement;
        let mut refined = simulation(&tool, step);
        refined.set_refinement(refinement);
        let mut shorter = simulation(&tool, step / f64::from(parts));
        let mut coarse = simulation(&tool, step);
        let (mut apart, mut coarser) = (0.0_f64, 0.0_f64);
        for _ in 0..2000 {
            advance(&mut refined);
            advance(&mut coarse);
            (0..parts).for_each(|_| advance(&mut shorter));
            let exact = joints(&shorter);
            let away = |other: &Simulation| {
                let pairs = joints(other).into_iter().zip(&exact);
                pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            (apart, coarser) = (apart.max(away(&refined)), coarser.max(away(&coarse)));
        }
        println!("{parts} parts: {apart:.1e} m apart, the whole step {coarser:.1e} m");
        // Left is where the drive's slewing ends within a step, and rounding; what a whole step changes is the measure.
        assert!(apart < 1e-3 * coarser, "{apart:e} m, whole step {coarser:e} m");
    }
}

/// What is published of forces, so that a jump in any of them shows: sums over stations and joints (N, N m).
fn forces(snapshot: &Snapshot) -> [f64; 5] {
    let (contacts, joints) = (&snapshot.contacts, &snapshot.joints);
    [
        contacts.pipe_guide.normal.iter().sum(),
        contacts.guide_wall.normal.iter().sum(),
        joints.axial_force.iter().sum(),
        joints.shear_force.iter().sum(),
        joints.torque.iter().sum(),
    ]
}

#[test]
fn a_change_of_the_parts_is_no_jump() {
    let mut simulation = simulation(&calm(), SimulationSettings::default().time_step);
    let mut snapshot = simulation.new_snapshot();
    let mut series = Vec::new();
    let changes = [(6000, 1), (6500, 2), (7000, 0), (7500, 2), (8000, 0)];
    for step in 0..8500 {
        if let Some((_, refinement)) = changes.iter().find(|(at, _)| *at == step) {
            simulation.set_refinement(*refinement);
        }
        advance(&mut simulation);
        simulation.snapshot(&mut snapshot, true);
        series.push(forces(&snapshot));
    }
    for (at, refinement) in changes {
        let largest = |steps: std::ops::Range<usize>| {
            let mut largest = [0.0_f64; 5];
            for pair in series[steps.start - 1..steps.end].windows(2) {
                for (largest, (before, after)) in largest.iter_mut().zip(pair[0].iter().zip(&pair[1])) {
                    *largest = largest.max((after - before).abs());
                }
            }
            largest
        };
        let (usual, after) = (largest(at - 400..at), largest(at..at + 20));
        for (force, (usual, after)) in usual.iter().zip(&after).enumerate() {
            // Rounding of the sums where nothing moves; else the motion's own changes, and half as much again since
            // those of twenty steps are held against those of the twelve periods of the tool's vibration before.
            assert!(
                *after <= 1.5 * usual + 1e-3,
                "to 2^{refinement} parts at step {at}: force {force} changes by {after:e}, before by {usual:e} at most"
            );
        }
    }
}

#[test]
fn a_checkpoint_keeps_the_parts() {
    let tool = calm();
    let step = SimulationSettings::default().time_step;
    let mut first = simulation(&tool, step);
    first.set_refinement(1);
    (0..200).for_each(|_| advance(&mut first));
    let bytes = first.checkpoint().unwrap();
    let mut second = simulation(&tool, step);
    second.restore(&bytes).unwrap();
    (0..50).for_each(|_| {
        advance(&mut first);
        advance(&mut second);
    });
    let bits = |simulation: &Simulation| joints(simulation).into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(&first), bits(&second));
    second.set_refinement(0);
    advance(&mut first);
    advance(&mut second);
    assert_ne!(bits(&first), bits(&second));
}

#[test]
fn a_motion_whose_steps_err_asks_for_more_parts() {
    let tool = ToolDescription::paper();
    let run = |step: StepRule, time_step: f64, model_time: f64| {
        let mut settings = SimulationSettings::default().with(|settings| {
            settings.time_step = time_step;
            settings.step = step;
        });
        settings.initial_inputs.weight_on_bit = LOAD;
        let simulation = Simulation::new(&tool, &settings).unwrap();
        let mut run = Run::new(simulation, Schedule::new(time_step, |_| 0.0));
        let mut applied = run.applied();
        applied.inputs = TURNING;
        run.apply(&applied);
        let mut wanted = Vec::new();
        for _ in 0..(model_time / time_step) as u32 {
            assert!(matches!(run.advance(), StepOutcome::Advanced { .. }));
            if wanted.last() != Some(&run.wanted_refinement()) {
                wanted.push(run.wanted_refinement());
            }
            let mut applied = run.applied();
            applied.refinement = run.wanted_refinement();
            run.apply(&applied);
        }
        (wanted, run.simulation().quality())
    };
    // Half of 1 ms errs by more than a third, half of 0.5 ms by a fifth.
    let (wanted, quality) = run(StepRule::Auto, 1e-3, 27.0);
    assert_eq!(wanted, [1, 2], "{quality:?}");
    assert!(quality.energy_error_share < 0.30, "{quality:?}");
    assert_eq!(run(StepRule::Auto, 0.5e-3, 13.0).0, [1]);
    assert_eq!(run(StepRule::Fixed, 1e-3, 13.0).0, [0]);
}

/// Inner stations follow the ends of their span where their slowest frequency times the step is at least 8: 19 for a
/// guide of a twentieth of its stiffness in whole steps, and 4.8 in quarters, which are not taken.
#[test]
fn a_soft_guide_has_no_quarter_steps() {
    let mut tool = calm();
    let step = SimulationSettings::default().time_step;
    let finest = |tool: &ToolDescription| {
        let mut simulation = simulation(tool, step);
        simulation.set_refinement(MOST_REFINEMENT);
        simulation.quality().choice.in_force
    };
    assert_eq!(finest(&tool), MOST_REFINEMENT);
    tool.guide_bending_factor = 0.05;
    assert_eq!(finest(&tool), 1);
}
