//! The tool below a string, on a rock that holds the bit: weight, depth, energy, determinism, and what a rig does to it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use std::f64::consts::TAU;

use flexdrill_core::Instructions;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::SolverKind;
use flexdrill_core::tool::{
    Body, DepthOfCut, Direction, Feed, Hoist, Location, Material, Piece, RockLaw, SectionProperties, SpeedController,
    StringDescription, Support, ToolDescription, TopDrive, Tube, WallFriction, Weakening, WellSection,
};
use flexdrill_core::twin::{QualityCause, QualityLevel, Simulation, SimulationSettings, Snapshot};
use flexdrill_core::units::rpm_to_rad_per_s;
use support::{Random, same_bits};

const STEEL: Material = Material {
    youngs_modulus: 206e9,
    poisson_ratio: 0.3,
    density: 7850.0,
};

/// Mid-hard rock under four blades: 10 kN at 3 m/h and 40 r/min.
const ROCK: DepthOfCut = DepthOfCut {
    blades: 4,
    specific_energy: 30e6,
    cutter_inclination: 0.6,
    wear_flat_force: 8672.5,
    wear_flat_friction: 0.106_17,
    wear_flat_travel: 1e-4,
    cutting_weakening: 0.0,
    weakening: Weakening::NONE,
};

/// 200 m of 73.0/54.6 mm in two pieces, the lower end of the first of which rubs.
fn string(feed: Feed) -> StringDescription {
    let tube = Tube {
        outer_diameter: 0.0730,
        inner_diameter: 0.0546,
    };
    let section = SectionProperties::of(tube, STEEL, 1.0);
    let mut pieces = vec![Piece::of(&section, 120.0).with_loss(0.01), Piece::of(&section, 80.0)];
    pieces[0].friction = Some(WallFriction {
        sliding: 300.0,
        static_ratio: 1.3,
        static_speed: 0.01,
        radius: 0.0365,
    });
    StringDescription {
        pieces,
        drive: TopDrive::Controlled(SpeedController {
            inertia: 50.0,
            proportional: 200.0,
            integral: 400.0,
            torque_limit: 2000.0,
        }),
        hoist: Some(Hoist {
            stiffness: 5e6,
            response_time: 1.0,
            fastest: 8e-3,
            touch_down: 3e-3,
            clearance: 10e-3,
            feed,
        }),
        weight: 20e3,
    }
}

/// Four links in a straight hole below the string, on the rock.
fn rig(feed: Feed) -> ToolDescription {
    let mut tool = ToolDescription::paper().with_mesh(4, 2);
    tool.well.sections = vec![WellSection::Straight { length: 2.0 }];
    // Nothing else keeps a guide in a straight hole from turning.
    tool.supports.push(Support {
        location: Location::Top,
        body: Body::Guide,
        directions: vec![Direction::Psi],
    });
    below_a_string(tool, feed)
}

/// A tool below the string, on the rock.
fn below_a_string(mut tool: ToolDescription, feed: Feed) -> ToolDescription {
    tool.string = Some(string(feed));
    tool.rock = RockLaw::DepthOfCut(ROCK);
    for support in &mut tool.supports {
        if support.location == Location::Top {
            support.directions.retain(|&direction| direction != Direction::U);
        }
    }
    tool
}

fn drilling() -> Inputs {
    Inputs {
        rotary_speed: rpm_to_rad_per_s(40.0),
        weight_on_bit: 10e3,
        rate_of_penetration: 3.0 / 3600.0,
        ..Inputs::default()
    }
}

fn settings() -> SimulationSettings {
    SimulationSettings::default().with(|settings| {
        // The rate of penetration is there at once.
        settings.rate_of_penetration_slew = 1.0;
    })
}

fn simulation(tool: &ToolDescription) -> Simulation {
    Simulation::new(tool, &settings()).unwrap()
}

/// Runs until a time (s), every step taken.
fn run(simulation: &mut Simulation, until: f64, inputs: impl Fn(f64) -> Inputs) {
    while simulation.time() < until {
        let at = inputs(simulation.time());
        let outcome = simulation.advance(&at);
        assert!(matches!(outcome, StepOutcome::Advanced { .. }), "{outcome:?}");
    }
}

/// Means of bit torque (N m), weight (N) and speed (rad/s) over some seconds.
fn means(simulation: &mut Simulation, seconds: f64) -> [f64; 3] {
    let mut snapshot = simulation.new_snapshot();
    let (mut sums, mut count) = ([0.0; 3], 0.0);
    let end = simulation.time() + seconds;
    while simulation.time() < end {
        let until = simulation.time() + 2e-3;
        run(simulation, until, |_| drilling());
        simulation.snapshot(&mut snapshot, false);
        let bit = &snapshot.bit;
        for (sum, x) in sums.iter_mut().zip([bit.torque, bit.weight_on_bit, bit.rotary_speed]) {
            *sum += x;
        }
        count += 1.0;
    }
    sums.map(|sum| sum / count)
}

/// rig_physics: d = V 2 pi / omega = 1.25 mm per turn, W = zeta e a d + W_f, T = e a^2 d / 2 + mu_g a W_f / 2.
#[test]
fn a_prescribed_rate_gives_the_weight_and_the_torque_of_the_rock() {
    let mut twin = simulation(&rig(Feed::Rate));
    run(&mut twin, 25.0, |_| drilling());
    let [torque, weight, speed] = means(&mut twin, 15.0);
    let (radius, depth) = (0.059, 3.0 / 3600.0 * TAU / rpm_to_rad_per_s(40.0));
    let expected_weight = ROCK.cutter_inclination * ROCK.specific_energy * radius * depth + ROCK.wear_flat_force;
    let expected_torque = 0.5 * ROCK.specific_energy * radius * radius * depth
        + 0.5 * ROCK.wear_flat_friction * radius * ROCK.wear_flat_force;
    assert!((expected_weight - 10e3).abs() < 1.0 && (expected_torque - 92.43).abs() < 0.01);
    // Mean values over whole turns of a motion that goes on vibrating: the mean of a product is not that of the means.
    assert!((speed / rpm_to_rad_per_s(40.0) - 1.0).abs() < 2e-3, "{speed} rad/s");
    assert!((weight / expected_weight - 1.0).abs() < 0.01, "{weight} N");
    assert!((torque / expected_torque - 1.0).abs() < 0.01, "{torque} N m");
}

#[test]
fn the_auto_driller_holds_the_weight() {
    let mut twin = simulation(&rig(Feed::Weight));
    run(&mut twin, 20.0, |_| drilling());
    let [_, weight, _] = means(&mut twin, 6.0);
    // The string's wall and the guide's carry the rest.
    assert!((weight / 10e3 - 1.0).abs() < 0.05, "{weight} N");
}

/// Off bottom, pressed on, stopped, turned back, fed too fast, lifted: in turn, by a second.
fn rough(time: f64) -> Inputs {
    let phase = time as usize % 8;
    let speeds = [0.0, 40.0, 40.0, 0.0, -20.0, 60.0, 120.0, 10.0];
    let weights = [0.0, 10e3, 30e3, 15e3, 0.0, 10e3, 5e3, 25e3];
    Inputs {
        rotary_speed: rpm_to_rad_per_s(speeds[phase]),
        weight_on_bit: weights[phase],
        rate_of_penetration: [0.0, 3.0, 20.0, -5.0, -20.0, 5.0, 1.0, 0.0][phase] / 3600.0,
        ..Inputs::default()
    }
}

#[test]
fn a_rough_rig_is_followed_and_the_energy_closes() {
    for feed in [Feed::Weight, Feed::Rate] {
        let mut twin = simulation(&rig(feed));
        let (mut moved, mut most) = (0.0_f64, 0.0_f64);
        let mut snapshot = twin.new_snapshot();
        while twin.time() < 24.0 {
            let until = twin.time() + 0.05;
            run(&mut twin, until, rough);
            twin.snapshot(&mut snapshot, true);
            moved = moved.max(snapshot.energy.drive.abs());
            most = most.max(snapshot.bit.weight_on_bit);
            assert!(snapshot.bit.weight_on_bit >= 0.0, "the rock pulls: {:?}", snapshot.bit);
        }
        assert!(most > 8e3, "the bit was pressed on: {most} N");
        let energy = snapshot.energy;
        // As the tool's own audit: collisions and breaking loose in whole steps.
        assert!(energy.error.abs() < 5e-3 * moved, "{energy:?} of {moved} J");
        assert!(energy.string > 0.0);
    }
}

/// The tool below a string that carries `sliding` (N) of friction on the wall, after the first window of its quality.
fn judged(mut tool: ToolDescription, sliding: f64) -> Snapshot {
    for piece in &mut tool.string.as_mut().unwrap().pieces {
        piece.friction = piece.friction.map(|friction| WallFriction { sliding, ..friction });
    }
    let mut twin = simulation(&tool);
    run(&mut twin, 10.5, |_| drilling());
    let mut snapshot = twin.new_snapshot();
    twin.snapshot(&mut snapshot, false);
    snapshot
}

/// In the frame that advances, the wall moves up past the string: its friction does work there even where the string
/// sticks. With 400 m of string in an inclined hole this is 11 J at a start, more than the tool's damping takes in ten
/// seconds.
#[test]
fn the_work_of_the_wall_on_a_string_that_advances_is_in_the_audit() {
    let snapshot = judged(rig(Feed::Rate), 3e3);
    let energy = snapshot.energy;
    assert!(energy.string > 1e3, "the string rubs: {energy:?}");
    assert!(energy.feed > 0.1, "the wall moves past it: {energy:?}");
    // Breaking loose within a step is what the trapezoid rule leaves.
    assert!(energy.error.abs() < 0.05 * energy.feed, "{energy:?}");
    assert_eq!(snapshot.quality.level, QualityLevel::Good, "{:?}", snapshot.quality);
}

/// Friction of the string is no part of what the steps' errors are compared with: contacts much shorter than the step stay
/// poor, however much the string rubs.
#[test]
fn friction_of_the_string_hides_no_poor_step() {
    let curved = |stiffness: [f64; 2]| {
        let mut tool = ToolDescription::paper();
        [tool.inner.stiffness, tool.outer.stiffness] = stiffness;
        judged(below_a_string(tool, Feed::Weight), 3e3).quality
    };
    let usual = curved([1e7, 2e7]);
    assert_eq!(usual.level, QualityLevel::Good, "{usual:?}");
    let poor = curved([1e8, 5e8]);
    assert_eq!(
        (poor.level, poor.cause),
        (QualityLevel::Poor, Some(QualityCause::EnergyError)),
        "{poor:?}"
    );
}

#[test]
fn random_inputs_are_followed() {
    let mut random = Random(25);
    for case in 0..4 {
        let mut twin = simulation(&rig(if case % 2 == 0 { Feed::Weight } else { Feed::Rate }));
        let mut inputs = drilling();
        let (mut moved, mut snapshot) = (0.0_f64, twin.new_snapshot());
        while twin.time() < 6.0 {
            let until = twin.time() + 0.02 + random.within(0.0, 0.5);
            run(&mut twin, until, |_| inputs);
            inputs = Inputs {
                rotary_speed: random.within(-10.0, 25.0),
                weight_on_bit: random.within(0.0, 50e3),
                rate_of_penetration: random.within(-0.01, 0.02),
                ..inputs
            };
            twin.snapshot(&mut snapshot, true);
            moved = moved.max(snapshot.energy.drive.abs());
        }
        assert!(
            snapshot.energy.error.abs() < 1e-2 * moved,
            "{:?} of {moved} J",
            snapshot.energy
        );
    }
}

#[test]
fn chain_and_stations_agree_below_a_string() {
    let tool = rig(Feed::Rate);
    let run_with = |solver| {
        let mut twin = Simulation::with_solver(&tool, &settings(), solver, Instructions::best()).unwrap();
        run(&mut twin, 1.5, |_| drilling());
        let mut snapshot = twin.new_snapshot();
        twin.snapshot(&mut snapshot, true);
        snapshot.bit
    };
    let (chain, stations) = (run_with(SolverKind::Chain), run_with(SolverKind::Stations));
    assert!(chain.weight_on_bit > 1e3, "{chain:?}");
    // The chain leaves out what vibrates inside a span.
    for (a, b) in [
        (chain.weight_on_bit, stations.weight_on_bit),
        (chain.torque, stations.torque),
        (chain.rotary_speed, stations.rotary_speed),
    ] {
        assert!((a / b - 1.0).abs() < 0.02, "{chain:?} instead of {stations:?}");
    }
}

#[test]
fn checkpoints_resets_and_repetitions_give_the_same_bits() {
    let tool = rig(Feed::Weight);
    let snapshot_at = |twin: &mut Simulation, until: f64| {
        run(twin, until, rough);
        let mut snapshot = twin.new_snapshot();
        twin.snapshot(&mut snapshot, false);
        snapshot
    };
    let mut whole = simulation(&tool);
    snapshot_at(&mut whole, 2.6);
    let bytes = whole.checkpoint().unwrap();
    let expected = snapshot_at(&mut whole, 5.3);
    let mut resumed = simulation(&tool);
    snapshot_at(&mut resumed, 1.0);
    resumed.restore(&bytes).unwrap();
    assert!(same_bits(&snapshot_at(&mut resumed, 5.3), &expected));
    resumed.reset();
    snapshot_at(&mut resumed, 2.6);
    let mut again = snapshot_at(&mut resumed, 5.3);
    again.warning.sequence = expected.warning.sequence;
    assert!(same_bits(&again, &expected));
}

/// Below a string no drive prescribes the first link's speed, over which the power of the pins is a torque.
#[test]
fn the_torque_of_the_pins_is_their_power_over_the_first_links_own_speed() {
    let mut tool = below_a_string(support::coarse(), Feed::Weight);
    tool.joint.friction.coefficient = 0.1;
    let mut twin = simulation(&tool);
    run(&mut twin, 1.0, |_| drilling());
    let power: f64 = twin.joint_friction().iter().sum();
    let speed = twin.velocity(0, Body::Pipe, Direction::Psi).unwrap();
    let torque = twin.joint_friction_torque();
    assert!(power > 0.0 && speed.abs() > 0.1, "{power} W, {speed} rad/s");
    // Three roundings.
    assert!((torque * speed.abs() - power).abs() < 1e-12 * power, "{torque} N m");
}

#[test]
fn a_failed_step_leaves_string_and_rock_as_they_were() {
    // In the quarter circle the links touch the guide.
    let tool = below_a_string(support::coarse(), Feed::Weight);
    // Few corrections and one halving are too few as soon as contacts close and friction turns.
    let hard = settings().with(|settings| {
        settings.max_iterations = 2;
        settings.max_halvings = 1;
    });
    let (mut twin, mut harder) = (simulation(&tool), Simulation::new(&tool, &hard).unwrap());
    let (mut resumed, mut failed, mut halved) = (simulation(&tool), 0, 0);
    for second in 1..8 {
        run(&mut twin, f64::from(second) + 0.3, rough);
        harder.restore(&twin.checkpoint().unwrap()).unwrap();
        // Until a step fails, whose first half may have been taken.
        let mut steps = 0;
        let failure = loop {
            let before = harder.solver_counters().rejected;
            match harder.advance(&rough(harder.time())) {
                StepOutcome::Failed(failure) => break Some(failure),
                StepOutcome::Advanced { .. } if steps > 2000 => break None,
                StepOutcome::Advanced { .. } => {
                    steps += 1;
                    halved += u64::from(harder.solver_counters().rejected > before);
                }
            }
        };
        if failure.is_none() {
            continue;
        }
        failed += 1;
        // The same steps, without the one that failed.
        resumed.restore(&twin.checkpoint().unwrap()).unwrap();
        let mut reference = Simulation::new(&tool, &hard).unwrap();
        reference.restore(&twin.checkpoint().unwrap()).unwrap();
        for _ in 0..steps {
            let at = rough(reference.time());
            assert!(matches!(reference.advance(&at), StepOutcome::Advanced { .. }));
        }
        resumed.restore(&reference.checkpoint().unwrap()).unwrap();
        let mut after = simulation(&tool);
        after.restore(&harder.checkpoint().unwrap()).unwrap();
        let until = after.time() + 0.02;
        run(&mut after, until, rough);
        run(&mut resumed, until, rough);
        assert_eq!(after.state(), resumed.state());
    }
    assert!(
        failed > 0 && halved > 0,
        "{failed} steps failed, {halved} were halved: the test shows nothing"
    );
}

/// What is published of transfer is what string, tool and rock do: the means of the drive's torque, of the weight slacked off
/// and of the bit's; the hoist's rate in steady drilling; a depth of cut of the rate per turn.
#[test]
fn transfer_has_every_place_from_the_surface_to_the_bit() {
    use flexdrill_motion::{BIT, KICK_OFF, SURFACE};
    let mut twin = simulation(&rig(Feed::Rate));
    run(&mut twin, 40.0, |_| drilling());
    let mut snapshot = twin.new_snapshot();
    twin.snapshot(&mut snapshot, false);
    let transfer = &snapshot.transfer;
    let torque = &transfer.torque.mean;
    // The string's friction and the pipe's take torque on the way; what each takes explains the difference between the
    // places to a per cent of what is put in, the part of waves that are on their way.
    let lost = torque[SURFACE] - torque[KICK_OFF];
    assert!(
        torque[SURFACE] > torque[KICK_OFF] && torque[KICK_OFF] > torque[BIT],
        "{transfer:?}"
    );
    let [guide, _, _, string] = transfer.friction_torque;
    assert!((lost - string).abs() < 0.01 * torque[SURFACE], "{lost}: {transfer:?}");
    let lost = torque[KICK_OFF] - torque[BIT];
    assert!((lost - guide).abs() < 0.01 * torque[SURFACE], "{lost}: {transfer:?}");
    // A rate of penetration of 3 m/h, 1.25 mm in each turn of 1.5 s. The bit chatters on the rock, so that a mean over five
    // seconds swings by 2 %.
    assert!(
        (transfer.mean.rate_of_penetration * 3600.0 - 3.0).abs() < 0.1,
        "{transfer:?}"
    );
    assert!((transfer.mean.depth_of_cut - 1.25e-3).abs() < 0.02e-3, "{transfer:?}");
    let weight = &transfer.weight.mean;
    assert!(weight[SURFACE] > weight[BIT] && weight[BIT] > 8e3, "{transfer:?}");
    // The hook carries the string of 20 kN and what of the tool hangs on it, less what is slacked off.
    let hanging = transfer.mean.hook_load + weight[SURFACE];
    assert!(hanging > 20e3 && hanging < 20e3 + 9.81 * twin.mass(), "{transfer:?}");
    // A third is put into rock at least, and nothing is taken by what the tool does not have.
    assert!(
        transfer.power.bit > transfer.power.drive / 3.0 && transfer.power.loads == 0.0,
        "{transfer:?}"
    );
}

/// A string wound up to 60 % of what holds the bit keeps its twist: the bit does not turn. Wound further, the bit breaks off where
/// the torque of wear flats and cutters under its weight says, T = mu_g a W_f / 2 + (W - W_f) a / (2 zeta).
#[test]
fn a_stuck_bit_holds_a_wound_string_and_breaks_off_at_its_limit() {
    let mut twin = simulation(&rig(Feed::Weight));
    // Set down without rotation, then wound by 0.21 rad against string and drive, 262 N m/rad in series.
    let wound = |time: f64| Inputs {
        rotary_speed: if (15.0..15.42).contains(&time) { 0.5 } else { 0.0 },
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    run(&mut twin, 60.0, wound);
    let before = (twin.bit(), twin.displacement(8, Body::Pipe, Direction::Psi).unwrap());
    run(&mut twin, 90.0, wound);
    let (after, angle) = (twin.bit(), twin.displacement(8, Body::Pipe, Direction::Psi).unwrap());
    assert!(before.0.torque > 30.0, "the string is wound: {:?}", before.0);
    assert!(
        (after.torque / before.0.torque - 1.0).abs() < 1e-3,
        "{before:?} {after:?}"
    );
    // 3e-9 rad/s over 30 s. The swing of the winding is still decaying, to a ten-millionth of the speed that wound it.
    assert!(
        (angle - before.1).abs() < 1e-7 && after.rotary_speed.abs() < 1e-6,
        "{angle} {before:?} {after:?}"
    );

    let limit = |weight: f64| {
        let flats = ROCK.wear_flat_force.min(weight);
        0.5 * 0.059 * (ROCK.wear_flat_friction * flats + (weight - flats) / ROCK.cutter_inclination)
    };
    let mut most = after;
    while twin.time() < 120.0 && twin.bit().rotary_speed < 0.1 {
        let until = twin.time() + 1e-3;
        run(&mut twin, until, |_| Inputs {
            rotary_speed: 0.2,
            weight_on_bit: 10e3,
            ..Inputs::default()
        });
        if twin.bit().torque > most.torque {
            most = twin.bit();
        }
    }
    assert!(twin.bit().rotary_speed >= 0.1, "it breaks off");
    // Wear flats that yielded while the cutters were a part of the rock's grid behind their front bear less once these are
    // back. 4 % of the flats' weight on cutters, which take sixteen times their torque, is a sixth of the limit.
    assert!(
        (0.99..1.2).contains(&(most.torque / limit(most.weight_on_bit))),
        "{most:?}, {}",
        limit(most.weight_on_bit)
    );
}
