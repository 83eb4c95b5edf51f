//! A tool with the rig's physics, through what a rig does in any order: pump on and off, lifted off bottom, reamed back,
//! turned back, the bit held by the rock, the drive at its limit. Every step is taken, no reading is other than a number,
//! the energy closes, and a checkpoint continues to the same bits.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::{Energies, StepOutcome};
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{
    AddedMass, DepthOfCut, Direction, Feed, FrictionLaw, Hoist, Location, MudDamping, MudDescription, MudFilm, Piece,
    PressureDescription, PressureEnd, PressureSource, RockLaw, SectionProperties, Shortening, SpeedController,
    StringDescription, ToolDescription, TopDrive, Tube, Weakening, WellSection,
};
use flexdrill_core::twin::{Simulation, SimulationSettings};
use flexdrill_core::units::rpm_to_rad_per_s;
use proptest::prelude::*;
use support::{same_bits, simulation};

/// Largest torque of the drive (N m): below what the bit takes under 40 kN.
const TORQUE_LIMIT: f64 = 150.0;

/// What a rig does for a while.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Drill,
    NoWeight,
    LiftOff,
    ReamBack,
    TurnBack,
    Stand,
    Stick,
    Limit,
}

const PHASES: [Phase; 8] = [
    Phase::Drill,
    Phase::NoWeight,
    Phase::LiftOff,
    Phase::ReamBack,
    Phase::TurnBack,
    Phase::Stand,
    Phase::Stick,
    Phase::Limit,
];

impl Phase {
    fn inputs(self, pump: bool) -> Inputs {
        // r/min, kN, m/h.
        let (speed, weight, rate) = match self {
            Self::Drill => (40.0, 10.0, 3.0),
            Self::NoWeight => (40.0, 0.0, 0.0),
            Self::LiftOff => (20.0, 0.0, -20.0),
            Self::ReamBack => (60.0, 2.0, -100.0),
            Self::TurnBack => (-30.0, 5.0, 1.0),
            Self::Stand => (0.0, 10.0, 0.0),
            Self::Stick => (3.0, 50.0, 20.0),
            Self::Limit => (120.0, 50.0, 20.0),
        };
        Inputs {
            rotary_speed: rpm_to_rad_per_s(speed),
            weight_on_bit: 1e3 * weight,
            rate_of_penetration: rate / 3600.0,
            standpipe_pressure: if pump { 5e6 } else { 0.0 },
        }
    }
}

/// The tool of four links with all of the rig's physics: below 100 m of string on a rock that holds the bit, or without a
/// string on rock that weakens.
fn rig(feed: Option<Feed>, end: PressureEnd) -> ToolDescription {
    // Links as long as the paper's: longer ones jam in the arc.
    let mut tool = ToolDescription::paper().with_mesh(4, 2);
    tool.well.sections = vec![WellSection::Arc {
        radius: 3.2,
        angle: 0.19,
    }];
    tool.inner.friction_law = FrictionLaw::Vector;
    tool.outer.friction_law = FrictionLaw::Bristle;
    tool.joint.friction.coefficient = 0.1;
    tool.shortening = Shortening::SecondOrder;
    tool.mud = Some(MudDescription {
        density: 1100.0,
        viscosity: 0.02,
        frequency: 4.0 / 3.0,
        added_mass: AddedMass::Concentric,
        damping: MudDamping::Viscous,
        film: MudFilm::None,
    });
    tool.pressure = Some(PressureDescription {
        at_top: PressureSource::Standpipe,
        drop_per_metre: 0.01,
        end,
        joint_seal_diameter: 0.062,
    });
    let weakening = Weakening {
        ratio: 1.3,
        rate: rpm_to_rad_per_s(30.0),
    };
    let Some(feed) = feed else {
        tool.rock = RockLaw::Weakening(weakening);
        return tool;
    };
    let tube = Tube {
        outer_diameter: 0.0730,
        inner_diameter: 0.0546,
    };
    tool.string = Some(StringDescription {
        pieces: vec![Piece::of(&SectionProperties::of(tube, tool.material, 1.0), 100.0)],
        drive: TopDrive::Controlled(SpeedController {
            inertia: 10.0,
            proportional: 200.0,
            integral: 400.0,
            torque_limit: TORQUE_LIMIT,
        }),
        hoist: Some(Hoist {
            stiffness: 5e6,
            response_time: 1.0,
            fastest: 30e-3,
            touch_down: 3e-3,
            clearance: 1e-3,
            feed,
        }),
        weight: 10e3,
    });
    tool.rock = RockLaw::DepthOfCut(DepthOfCut {
        blades: 4,
        specific_energy: 30e6,
        cutter_inclination: 0.6,
        wear_flat_force: 8670.0,
        wear_flat_friction: 0.106,
        wear_flat_travel: 1e-4,
        cutting_weakening: 0.0,
        weakening,
    });
    for support in &mut tool.supports {
        if support.location == Location::Top {
            support.directions.retain(|&direction| direction != Direction::U);
        }
    }
    tool
}

/// Inputs that act within a tenth of a second, so that short runs see all of them.
fn settings() -> SimulationSettings {
    SimulationSettings::default().with(|settings| {
        settings.rotary_speed_slew = 100.0;
        settings.weight_on_bit_slew = 500e3;
        settings.rate_of_penetration_slew = 1.0;
        settings.standpipe_pressure_slew = 20e6;
    })
}

/// What a run came through.
#[derive(Debug, Default, Clone, Copy)]
struct Seen {
    /// The drive's torque was at its limit.
    limit: bool,
    /// The bit stood while the drive turned.
    stuck: bool,
    /// The bit carried nothing after it had carried weight.
    lifted: bool,
    loaded: bool,
    /// The bit turned backwards.
    back: bool,
    /// Largest sum of the magnitudes of the works (J).
    moved: f64,
}

/// Sum of the magnitudes of what was put in and taken (J).
fn moved(energy: &Energies) -> f64 {
    [
        energy.drive,
        energy.hoist,
        energy.weight_on_bit,
        energy.feed,
        energy.pressure,
        energy.bit,
        energy.friction,
        energy.stored,
    ]
    .iter()
    .map(|work| work.abs())
    .sum()
}

/// Steps through a phase; every step is taken, and every reading of the motion is finite.
fn run(twin: &mut Simulation, phase: Phase, pump: bool, steps: u32, seen: &mut Seen) {
    let inputs = phase.inputs(pump);
    let mut snapshot = twin.new_snapshot();
    for step in 0..steps {
        let outcome = twin.advance(&inputs);
        assert!(
            matches!(outcome, StepOutcome::Advanced { .. }),
            "{phase:?}: {outcome:?}"
        );
        if step % 20 != 0 {
            continue;
        }
        twin.snapshot(&mut snapshot, true);
        let (bit, joints, contacts) = (&snapshot.bit, &snapshot.joints, &snapshot.contacts);
        let readings = [bit.torque, bit.rotary_speed, bit.weight_on_bit, snapshot.energy.error];
        let lists = [
            &joints.bend_angle,
            &joints.axial_force,
            &joints.torque,
            &joints.spin_rate,
            &contacts.pipe_guide.normal,
            &contacts.guide_wall.normal,
            &contacts.guide_wall.axial,
        ];
        let all = readings.iter().chain(lists.into_iter().flatten());
        assert!(all.clone().all(|value| value.is_finite()), "{phase:?}: {snapshot:?}");
        if let Some((speed, limited)) = twin.top_drive() {
            seen.limit |= limited;
            seen.stuck |= speed.abs() > 0.2 && bit.rotary_speed.abs() < 0.02 && bit.weight_on_bit > 1e3;
        }
        seen.loaded |= bit.weight_on_bit > 3e3;
        seen.lifted |= seen.loaded && bit.weight_on_bit == 0.0;
        seen.back |= bit.rotary_speed < -1.0;
        seen.moved = seen.moved.max(moved(&snapshot.energy));
        // The pins' share is a part of the friction, by the same rule: contacts, which have the rest, take and do not give,
        // but for what a slip that reverses within a step makes of the trapezoid rule.
        let of_contacts = snapshot.energy.friction - snapshot.energy.joint_friction;
        assert!(
            of_contacts > -1e-3 * seen.moved - 1e-6,
            "{phase:?}: {of_contacts} J, {:?}",
            snapshot.energy
        );
    }
}

/// The energy closes: 1 % of what has moved, the bound of the rig's other random runs. Collisions in whole steps cost most.
/// A microjoule is the rounding of the elastic energy of a tool that stands.
fn closes(twin: &Simulation, seen: &Seen) -> bool {
    twin.energy().error.abs() < 1e-2 * seen.moved + 1e-6
}

/// Runs the phases with steps of a `parts`-th; the audit where it does not close.
fn follow(tool: &ToolDescription, phases: &[(Phase, bool, u32)], parts: u32) -> Result<(), String> {
    let settings = settings().with(|settings| settings.time_step /= f64::from(parts));
    let (mut twin, mut seen) = (Simulation::new(tool, &settings).unwrap(), Seen::default());
    for &(phase, pump, steps) in phases {
        run(&mut twin, phase, pump, parts * steps, &mut seen);
        if !closes(&twin, &seen) {
            return Err(format!("{phase:?}: {:?} of {seen:?}", twin.energy()));
        }
    }
    Ok(())
}

fn feeds() -> impl Strategy<Value = Option<Feed>> {
    prop_oneof![Just(Some(Feed::Weight)), Just(Some(Feed::Rate)), Just(None)]
}

fn ends() -> impl Strategy<Value = PressureEnd> {
    prop_oneof![Just(PressureEnd::Closed), Just(PressureEnd::Sealed { diameter: 0.063 })]
}

fn sequences() -> impl Strategy<Value = Vec<(Phase, bool, u32)>> {
    prop::collection::vec(
        ((0..PHASES.len()).prop_map(|at| PHASES[at]), any::<bool>(), 50_u32..800),
        2..7,
    )
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    #[test]
    fn whatever_a_rig_does_is_followed_and_the_energy_closes(feed in feeds(), end in ends(), phases in sequences()) {
        let tool = rig(feed, end);
        // A chain that folds as the pump comes on costs up to a tenth of its work in whole steps: an error of the steps,
        // which finer ones do not have, and no term that the audit lacks.
        if let Err(coarse) = follow(&tool, &phases, 1) {
            let fine = follow(&tool, &phases, 8);
            prop_assert!(fine.is_ok(), "whole steps: {coarse}; eighths: {fine:?}");
        }
    }

    /// Also into a simulation that has run something else.
    #[test]
    fn a_checkpoint_between_any_phases_continues_to_the_same_bits(
        feed in feeds(),
        end in ends(),
        phases in sequences(),
        at in 0_usize..6,
    ) {
        let tool = rig(feed, end);
        let new = || Simulation::new(&tool, &settings()).unwrap();
        let (mut twin, mut other, mut seen) = (new(), new(), Seen::default());
        run(&mut other, Phase::TurnBack, true, 300, &mut seen);
        let at = at % phases.len();
        for &(phase, pump, steps) in &phases[..at] {
            run(&mut twin, phase, pump, steps, &mut seen);
        }
        other.restore(&twin.checkpoint().unwrap()).unwrap();
        for &(phase, pump, steps) in &phases[at..] {
            run(&mut twin, phase, pump, steps, &mut seen);
            run(&mut other, phase, pump, steps, &mut seen);
        }
        let (mut one, mut two) = (twin.new_snapshot(), other.new_snapshot());
        twin.snapshot(&mut one, false);
        other.snapshot(&mut two, false);
        prop_assert!(same_bits(&one, &two) && twin.checkpoint().unwrap() == other.checkpoint().unwrap());
    }

    /// Steps that have too few corrections are retreated from: the state is that before, and what follows is what
    /// follows from there.
    #[test]
    fn a_step_that_is_given_up_leaves_everything_as_it_was(feed in feeds(), end in ends(), phases in sequences()) {
        let tool = rig(feed, end);
        let hard = settings().with(|settings| (settings.max_iterations, settings.max_halvings) = (2, 0));
        let (mut twin, mut harder) = (Simulation::new(&tool, &settings()).unwrap(), Simulation::new(&tool, &hard).unwrap());
        let mut seen = Seen::default();
        for (phase, pump, steps) in phases {
            run(&mut twin, phase, pump, steps, &mut seen);
            harder.restore(&twin.checkpoint().unwrap()).unwrap();
            for _ in 0..200 {
                let before = harder.state();
                if let StepOutcome::Failed(_) = harder.advance(&phase.inputs(pump)) {
                    prop_assert_eq!(harder.state(), before);
                    let mut after = Simulation::new(&tool, &settings()).unwrap();
                    after.restore(&harder.checkpoint().unwrap()).unwrap();
                    run(&mut after, phase, pump, 40, &mut seen);
                    break;
                }
            }
        }
    }
}

/// Each of these happens in the random runs' tool, so that they show something.
#[test]
fn a_rig_sticks_lifts_reams_and_reaches_its_limit() {
    let mut twin = Simulation::new(&rig(Some(Feed::Rate), PressureEnd::Closed), &settings()).unwrap();
    let mut seen = Seen::default();
    for (phase, pump, seconds) in [
        (Phase::Drill, true, 20.0),
        (Phase::Limit, true, 4.0),
        (Phase::Stick, false, 3.0),
        (Phase::Stand, true, 1.0),
        (Phase::ReamBack, false, 3.0),
        (Phase::LiftOff, true, 1.0),
        (Phase::TurnBack, true, 3.0),
        (Phase::NoWeight, false, 1.0),
    ] {
        run(&mut twin, phase, pump, (seconds / 0.0005) as u32, &mut seen);
        assert!(closes(&twin, &seen), "{phase:?}: {:?} of {seen:?}", twin.energy());
    }
    assert!(
        seen.limit && seen.stuck && seen.lifted && seen.back,
        "{seen:?} after {} s, drive {:?}, bit {:?}",
        twin.time(),
        twin.top_drive(),
        twin.bit()
    );
}

/// Pump on and off again: the pressure's work closes, and the tool comes back to the weight that it carried.
#[test]
fn a_pump_that_is_switched_on_and_off_leaves_no_force() {
    let mut tool = rig(None, PressureEnd::Closed);
    // Friction would hold a part of the stretch.
    (tool.inner.friction_tangential, tool.inner.friction_axial) = (0.0, 0.0);
    tool.joint.friction.coefficient = 0.0;
    let mut twin = simulation(&tool);
    let axial = |twin: &Simulation| twin.joints().axial_force.iter().sum::<f64>() / 3.0;
    let mut seen = Seen::default();
    run(&mut twin, Phase::Stand, false, 2000, &mut seen);
    let before = axial(&twin);
    // 1 MPa per second.
    run(&mut twin, Phase::Stand, true, 14_000, &mut seen);
    let under_pressure = axial(&twin);
    run(&mut twin, Phase::Stand, false, 14_000, &mut seen);
    let after = axial(&twin);
    // 5 MPa less the share that friction takes on the way, on the ball of 62 mm: 15.0 to 15.1 kN.
    let pins = under_pressure - before;
    assert!((14.9e3..15.2e3).contains(&pins), "{pins} N");
    assert!((after - before).abs() < 0.01 * pins, "{after} instead of {before} N");
    assert!(closes(&twin, &seen), "{:?}", twin.energy());
}
