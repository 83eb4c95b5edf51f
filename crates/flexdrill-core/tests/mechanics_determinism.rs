//! Same build, configuration and inputs, same bits; a checkpoint goes on bit for bit; a failed step changes nothing.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::dynamics::phases::Phase;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{CheckpointError, Simulation, SimulationSettings, Snapshot};
use support::{coarse, same_bits};

fn simulation() -> Simulation {
    support::simulation(&coarse())
}

/// Inputs that change while running.
fn inputs(step: u64) -> Inputs {
    let load = if step > 700 { 15e3 } else { 10e3 };
    Inputs {
        rotary_speed: 4.0 + (step / 300) as f64,
        weight_on_bit: load,
        ..Inputs::default()
    }
}

fn run(simulation: &mut Simulation, steps: u64) -> Snapshot {
    for _ in 0..steps {
        let at = simulation.step();
        assert!(matches!(simulation.advance(&inputs(at)), StepOutcome::Advanced { .. }));
    }
    let mut snapshot = simulation.new_snapshot();
    simulation.snapshot(&mut snapshot, false);
    snapshot
}

#[test]
fn two_runs_are_equal_to_the_bit() {
    let (mut a, mut b) = (simulation(), simulation());
    assert!(same_bits(&run(&mut a, 2000), &run(&mut b, 2000)));
    assert_eq!(a.state(), b.state());
}

#[test]
fn measuring_time_changes_nothing() {
    let (mut timed, mut plain) = (simulation(), simulation());
    timed.set_clock(support::clock);
    assert!(same_bits(&run(&mut timed, 500), &run(&mut plain, 500)));
    assert_eq!(timed.state(), plain.state());
    assert_eq!(timed.checkpoint().unwrap(), plain.checkpoint().unwrap());
    // And time was measured, in every phase.
    for phase in Phase::ALL {
        assert!(timed.phase_times().of(phase) > 0, "{}", phase.name());
        assert_eq!(plain.phase_times().of(phase), 0);
    }
}

#[test]
fn a_checkpoint_goes_on_to_the_bit() {
    let mut whole = simulation();
    run(&mut whole, 1000);
    let bytes = whole.checkpoint().unwrap();
    let mut resumed = simulation();
    resumed.restore(&bytes).unwrap();
    assert!(same_bits(&run(&mut whole, 1000), &run(&mut resumed, 1000)));
}

#[test]
fn a_reset_starts_again_to_the_bit() {
    let mut simulation = simulation();
    let first = run(&mut simulation, 500);
    simulation.reset();
    let mut second = run(&mut simulation, 500);
    // The warning's sequence counts on, so that a subscriber sees that it is new.
    second.warning.sequence = first.warning.sequence;
    assert!(same_bits(&first, &second));
}

#[test]
fn a_checkpoint_of_another_mesh_is_refused_and_changes_nothing() {
    let mut simulation = simulation();
    run(&mut simulation, 10);
    let foreign = support::simulation(&coarse().with_mesh(20, 2)).checkpoint().unwrap();
    let before = simulation.state();
    assert!(matches!(
        simulation.restore(&foreign),
        Err(CheckpointError::OtherTool { .. })
    ));
    assert_eq!(simulation.state(), before);
}

#[test]
fn a_step_that_cannot_converge_is_reported_and_changes_nothing_but_counters() {
    // Two iterations and no halving: the first collision cannot be solved.
    let settings = SimulationSettings::default().with(|settings| {
        settings.max_iterations = 2;
        settings.max_halvings = 0;
    });
    let mut simulation = Simulation::new(&coarse(), &settings).unwrap();
    for _ in 0..4000 {
        let before = simulation.state();
        let audit = *simulation.energy();
        let step = simulation.step();
        if let StepOutcome::Failed(failure) = simulation.advance(&inputs(0)) {
            assert_eq!(simulation.state(), before);
            assert_eq!(simulation.energy(), &audit);
            assert_eq!(simulation.step(), step);
            assert_eq!(simulation.solver_counters().failed_steps, 1);
            assert!(failure.station <= simulation.last_station() && failure.value.abs() > 0.0);
            assert!((failure.time - before.time).abs() < 1e-12);
            return;
        }
    }
    panic!("no step failed");
}

/// A simulation can move to another thread and be looked at from several.
#[test]
fn a_simulation_is_send_and_sync() {
    fn check<T: Send + Sync>() {}
    check::<Simulation>();
}
