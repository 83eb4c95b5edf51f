//! The worst step is bounded: what Newton and halving can cost at most, and what is left when even that does not help.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::State;
use flexdrill_core::dynamics::{FailureCause, StepOutcome};
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::rpm_to_rad_per_s;
use support::{coarse, hard_settings};

/// The tool at 120 r/min and 30 kN with `max_iterations` and `max_halvings`, in steps of 2 ms, eight times what
/// converges well: joints strike their stops and the pipe strikes the guide within a step.
fn hard(max_iterations: u32, max_halvings: u32) -> (Simulation, Inputs) {
    let settings = hard_settings(max_iterations, max_halvings)
        .with(|settings| settings.rotary_speed_slew = rpm_to_rad_per_s(120.0));
    let inputs = Inputs {
        rotary_speed: 12.57,
        weight_on_bit: 30e3,
        ..Inputs::default()
    };
    (Simulation::new(&coarse(), &settings).unwrap(), inputs)
}

/// All numbers of a state, bit by bit: equal floats may differ in their zeros' signs.
fn bits(state: &State) -> Vec<u64> {
    let scalars = [state.time, state.drive_angle];
    let vectors = [&state.q, &state.v, &state.a, &state.pipe_axial, &state.guide_axial];
    vectors
        .into_iter()
        .flatten()
        .chain(&scalars)
        .map(|x| x.to_bits())
        .collect()
}

/// What a run of hard steps came to.
#[derive(Debug, Default)]
struct Seen {
    /// Most Newton iterations and sub-steps rejected in one step.
    iterations: u64,
    rejected: u64,
    failed: u64,
    halved: u64,
}

/// Takes `steps` steps and holds each to the bound; after a failed one everything must be as before.
fn drive(max_iterations: u32, max_halvings: u32, steps: u32) -> Seen {
    let (mut simulation, inputs) = hard(max_iterations, max_halvings);
    let mut seen = Seen::default();
    for _ in 0..steps {
        let counters = simulation.solver_counters();
        let state = bits(&simulation.state());
        let audit = *simulation.energy();
        let outcome = simulation.advance(&inputs);
        let after = simulation.solver_counters();
        let made = after.newton_iterations - counters.newton_iterations;
        let rejected = after.rejected - counters.rejected;
        assert!(made <= simulation.most_iterations(), "{made} iterations");
        seen.iterations = seen.iterations.max(made);
        seen.rejected = seen.rejected.max(rejected);
        match outcome {
            StepOutcome::Advanced { iterations, halvings } => {
                assert_eq!(u64::from(iterations), made);
                assert!(halvings <= max_halvings);
                seen.halved += u64::from(halvings > 0);
            }
            StepOutcome::Failed(failure) => {
                assert_eq!(failure.cause, FailureCause::NotConverged);
                assert_eq!(bits(&simulation.state()), state);
                assert_eq!(simulation.energy(), &audit);
                assert_eq!(after.failed_steps, counters.failed_steps + 1);
                seen.failed += 1;
            }
        }
    }
    seen
}

#[test]
fn the_bound_is_most_attempts_times_most_iterations() {
    // 3 x 2^(n-1) + n - 1 attempts of n = 6 halvings, proved over all ways through a step beside `most_attempts`.
    assert_eq!(hard(15, 6).0.most_iterations(), 101 * 15);
    assert_eq!(hard(4, 0).0.most_iterations(), 4);
}

#[test]
fn hard_steps_stay_below_the_bound_and_failed_ones_change_nothing() {
    let mut total = Seen::default();
    for (max_iterations, max_halvings) in [(2, 0), (2, 3), (2, 6), (3, 2), (4, 6), (15, 6)] {
        let seen = drive(max_iterations, max_halvings, 600);
        println!("{max_iterations} iterations, {max_halvings} halvings: {seen:?}");
        total.failed += seen.failed;
        total.halved += seen.halved;
    }
    // The cases are hard enough to mean something: steps were saved by halving, and steps failed.
    assert!(total.failed > 0 && total.halved > 0);
}

#[test]
fn a_failed_step_goes_on_once_it_can() {
    // The same steps fail with two iterations and pass with fifteen; the failed attempts leave no trace in the motion.
    let (mut tight, inputs) = hard(2, 1);
    let steps = (0..4000)
        .take_while(|_| matches!(tight.advance(&inputs), StepOutcome::Advanced { .. }))
        .count();
    assert!(steps < 4000, "no step failed");
    let (mut free, _) = hard(15, 6);
    let mut copy = tight.checkpoint().unwrap();
    free.restore(&copy).unwrap();
    for _ in 0..3 {
        assert!(matches!(tight.advance(&inputs), StepOutcome::Failed(_)));
    }
    copy = tight.checkpoint().unwrap();
    let (mut after, _) = hard(15, 6);
    after.restore(&copy).unwrap();
    assert!(matches!(free.advance(&inputs), StepOutcome::Advanced { .. }));
    assert!(matches!(after.advance(&inputs), StepOutcome::Advanced { .. }));
    assert_eq!(bits(&free.state()), bits(&after.state()));
}
