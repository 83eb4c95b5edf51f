//! Forks: another simulation in the same state moves to the same bits with the same inputs, whatever either did since, and
//! so does one that is restored to it again and again.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use std::f64::consts::TAU;
use std::time::Instant;

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{LiveParameters, ToolDescription, WobPath};
use flexdrill_core::twin::{CheckpointError, Simulation};
use flexdrill_core::units::rpm_to_rad_per_s;
use proptest::prelude::*;
use support::{Random, coarse, hinged, same_bits, simulation, small, tiny};

/// Tools that differ in what they keep: stops, hinges, a tie, sticking friction.
fn tools() -> impl Strategy<Value = ToolDescription> {
    prop_oneof![
        Just(tiny()),
        Just(small()),
        Just(hinged().with_mesh(4, 2)),
        Just(small().with(|tool| tool.wob_path = WobPath::Shared)),
        Just(small().with(|tool| tool.outer.friction_tangential = 0.7)),
    ]
}

fn inputs() -> impl Strategy<Value = Inputs> {
    (0.0..20.0, 0.0..40e3).prop_map(|(rotary_speed, weight_on_bit)| Inputs {
        rotary_speed,
        weight_on_bit,
        ..Inputs::ZERO
    })
}

/// Advances, a failed step or not; a failure is part of what has to be the same.
fn run(simulation: &mut Simulation, inputs: &Inputs, steps: u32) {
    for _ in 0..steps {
        let _ = simulation.advance(inputs);
    }
}

/// Whether both are in the same state, to the bit, and look the same.
fn same(a: &mut Simulation, b: &mut Simulation) -> bool {
    let (mut seen, mut other) = (a.new_snapshot(), b.new_snapshot());
    a.snapshot(&mut seen, false);
    b.snapshot(&mut other, false);
    same_bits(&seen, &other) && a.checkpoint().unwrap() == b.checkpoint().unwrap()
}

/// Stations that touch something.
fn touching(simulation: &mut Simulation) -> usize {
    let mut seen = simulation.new_snapshot();
    simulation.snapshot(&mut seen, false);
    let layers = [&seen.contacts.pipe_guide, &seen.contacts.guide_wall];
    layers
        .iter()
        .map(|layer| layer.normal.iter().filter(|&&force| force > 0.0).count())
        .sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_fork_moves_to_the_same_bits_and_neither_knows_of_the_other(
        tool in tools(),
        before in 0_u32..400,
        after in 1_u32..200,
        [first, then, other] in [inputs(), inputs(), inputs()],
    ) {
        let mut live = simulation(&tool);
        run(&mut live, &first, before);
        let mut fork = live.fork();
        let mut astray = live.fork();
        prop_assert!(same(&mut live, &mut fork));
        // In turn, with a third that goes elsewhere in between.
        for _ in 0..after {
            run(&mut live, &then, 1);
            run(&mut astray, &other, 1);
            astray.set_live(LiveParameters { outer_friction: [0.9, 0.1], ..astray.live() }).unwrap();
            run(&mut fork, &then, 1);
        }
        prop_assert!(same(&mut live, &mut fork));
        // A fork of a fork, and one that starts over.
        let mut again = fork.fork();
        prop_assert!(same(&mut again, &mut live));
        fork.reset();
        let mut fresh = simulation(&tool);
        prop_assert_eq!(fork.step(), 0);
        run(&mut fork, &then, 50);
        run(&mut fresh, &then, 50);
        let (mut seen, mut expected) = (fork.new_snapshot(), fresh.new_snapshot());
        fork.snapshot(&mut seen, false);
        fresh.snapshot(&mut expected, false);
        prop_assert_eq!(format!("{:?}", seen.shape), format!("{:?}", expected.shape));
    }

    #[test]
    fn restored_twice_with_other_runs_in_between_it_gives_the_same_bits(
        tool in tools(),
        before in 0_u32..400,
        between in 1_u32..200,
        [first, then, other] in [inputs(), inputs(), inputs()],
    ) {
        let mut live = simulation(&tool);
        run(&mut live, &first, before);
        let mut room = vec![0; 2 * live.checkpoint().unwrap().len()];
        let length = live.checkpoint_into(&mut room).unwrap();
        prop_assert_eq!(&room[..length], &live.checkpoint().unwrap()[..]);
        let mut worker = live.fork();
        run(&mut live, &then, 100);
        for steps in [between, 2 * between] {
            run(&mut worker, &other, steps);
            worker.restore(&room[..length]).unwrap();
            run(&mut worker, &then, 100);
            prop_assert!(same(&mut worker, &mut live));
        }
    }
}

#[test]
fn a_fork_in_contact_goes_on_in_contact() {
    let mut live = simulation(&coarse());
    let inputs = Inputs {
        rotary_speed: 8.0,
        weight_on_bit: 10e3,
        ..Inputs::ZERO
    };
    run(&mut live, &inputs, 2000);
    assert!(touching(&mut live) > 10);
    let mut fork = live.fork();
    run(&mut live, &inputs, 2000);
    run(&mut fork, &inputs, 2000);
    assert!(same(&mut live, &mut fork));
}

#[test]
fn room_that_is_too_small_is_refused_at_every_size() {
    let mut live = simulation(&tiny());
    run(&mut live, &Inputs::ZERO, 10);
    let bytes = live.checkpoint().unwrap();
    let mut room = vec![0; bytes.len()];
    for size in (0..bytes.len()).step_by(97).chain([bytes.len() - 1]) {
        let error = live.checkpoint_into(&mut room[..size]).unwrap_err();
        assert!(
            matches!(error, CheckpointError::NoRoom { room } if room == size),
            "{size}: {error}"
        );
    }
    assert_eq!(live.checkpoint_into(&mut room).unwrap(), bytes.len());
}

/// 10 um/s, a ten-thousandth of the speeds that the motion has, moves the pipe by less than its own roughness in a step of
/// the motion; a turn later the places differ by a good part of the clearance of 8.5 mm.
#[test]
fn a_small_disturbance_parts_forks_within_a_turn() {
    for rpm in [60.0, 120.0] {
        let mut live = simulation(&coarse());
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: 10e3,
            ..Inputs::ZERO
        };
        run(&mut live, &inputs, 10_000);
        let turn = (TAU / inputs.rotary_speed / live.settings().time_step) as u32;
        let disturbed = |seed: u64| {
            let (mut fork, mut random) = (live.fork(), Random(seed));
            fork.disturb(|| 1e-5 * random.next());
            run(&mut fork, &inputs, turn);
            fork
        };
        let (mut one, mut same, mut other) = (disturbed(1), disturbed(1), disturbed(2));
        assert_eq!(distance(&mut one, &mut same), 0.0);
        let apart = distance(&mut one, &mut other);
        assert!(apart > 5e-4, "{rpm} r/min: {apart} m");
    }
}

/// Root mean square of the differences of the pipe's places (m).
fn distance(one: &mut Simulation, other: &mut Simulation) -> f64 {
    let (mut a, mut b) = (one.new_snapshot(), other.new_snapshot());
    one.snapshot(&mut a, false);
    other.snapshot(&mut b, false);
    let squares: f64 = a
        .shape
        .pipe
        .iter()
        .zip(&b.shape.pipe)
        .map(|(a, b)| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2))
        .sum();
    (squares / a.shape.pipe.len() as f64).sqrt()
}

#[test]
#[ignore = "measures; run it alone"]
fn cost() {
    let mut live = simulation(&ToolDescription::paper());
    run(
        &mut live,
        &Inputs {
            rotary_speed: 8.0,
            weight_on_bit: 10e3,
            ..Inputs::ZERO
        },
        2000,
    );
    let mut room = vec![0; 2 * live.checkpoint().unwrap().len()];
    for _ in 0..3 {
        let begun = Instant::now();
        let mut fork = live.fork();
        let forked = begun.elapsed();
        let begun = Instant::now();
        let length = live.checkpoint_into(&mut room).unwrap();
        let written = begun.elapsed();
        let begun = Instant::now();
        fork.restore(&room[..length]).unwrap();
        println!(
            "fork {forked:?}, checkpoint {written:?} of {length} bytes, restore {:?}",
            begun.elapsed()
        );
    }
}
