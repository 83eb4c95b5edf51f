//! What whirl costs, in counts: the steps of a pipe that is thrown round its guide converge like those of a calm one.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{Simulation, SimulationSettings};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

/// What is run: friction of pipe and guide (-), rotary speed (r/min), weight on bit (kN).
#[derive(Debug, Clone, Copy)]
struct Case {
    friction: f64,
    rpm: f64,
    wob: f64,
}

/// Per step, after the motion has developed.
#[derive(Debug)]
struct Cost {
    iterations: f64,
    /// Part of the steps that were halved.
    halved: f64,
    /// Collision losses (J).
    collisions: f64,
}

const CALM: Case = Case {
    friction: 0.2,
    rpm: 40.0,
    wob: 10.0,
};

fn cost(case: Case, refinement: u32) -> Cost {
    let mut tool = ToolDescription::paper();
    tool.inner.friction_tangential = case.friction;
    tool.inner.friction_axial = case.friction;
    let mut settings = SimulationSettings::default();
    settings.initial_inputs.weight_on_bit = kn_to_n(case.wob);
    // The fastest case has its speed after a second, and whirls a turn later.
    settings.rotary_speed_slew = rpm_to_rad_per_s(200.0);
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(case.rpm),
        weight_on_bit: kn_to_n(case.wob),
        ..Inputs::default()
    };
    let mut simulation = Simulation::new(&tool, &settings).unwrap();
    simulation.set_refinement(refinement);
    let run = |simulation: &mut Simulation, duration: f64| {
        let steps = (duration / settings.time_step).round() as u32;
        for _ in 0..steps {
            let outcome = simulation.advance(&inputs);
            assert!(matches!(outcome, StepOutcome::Advanced { .. }), "{case:?}: {outcome:?}");
        }
        let (counters, energy) = (simulation.solver_counters(), simulation.energy());
        (steps, counters, energy.contact_damping)
    };
    let (_, before, collisions_before) = run(&mut simulation, 2.0);
    let (steps, after, collisions) = run(&mut simulation, 2.0);
    let per_step = |count: u64| count as f64 / f64::from(steps);
    Cost {
        iterations: per_step(after.newton_iterations - before.newton_iterations),
        halved: per_step(after.halved_steps - before.halved_steps),
        collisions: collisions - collisions_before,
    }
}

/// Holds `case` to `most` times the iterations of the calm one, at whole steps and at halves.
fn converges_like_the_calm_one(case: Case, most: f64) {
    for refinement in [0, 1] {
        let (calm, hard) = (cost(CALM, refinement), cost(case, refinement));
        let ratio = hard.iterations / calm.iterations;
        println!("{case:?} in 2^{refinement} parts: {hard:?}, {ratio:.2} times the calm one's iterations, {calm:?}");
        // Otherwise the pipe is not thrown, and nothing is shown.
        assert!(hard.collisions > 5.0 * calm.collisions, "{hard:?} against {calm:?}");
        // Runs of 2 s scatter by 3 %; the bounds are a tenth above what was measured.
        assert!(ratio < most, "{hard:?} against {calm:?}");
        // Friction that turned between two corrections once halved 13 % of the steps at 120 r/min and 36 % at 200; what
        // is left is a rare collision.
        assert!(hard.halved < 2e-3, "{hard:?}");
    }
}

#[test]
fn backward_whirl_converges() {
    let case = Case {
        friction: 0.7,
        rpm: 120.0,
        wob: 10.0,
    };
    converges_like_the_calm_one(case, 1.65);
}

#[test]
fn fast_backward_whirl_converges() {
    let case = Case {
        friction: 0.7,
        rpm: 200.0,
        wob: 10.0,
    };
    converges_like_the_calm_one(case, 1.9);
}

#[test]
fn a_pipe_that_is_thrown_at_little_weight_converges() {
    let case = Case {
        friction: 0.7,
        rpm: 80.0,
        wob: 5.0,
    };
    converges_like_the_calm_one(case, 1.4);
}
