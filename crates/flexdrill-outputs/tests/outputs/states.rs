//! What every figure of `twin/transfer`, `twin/bit_state` and `twin/reactions` is in each state of a rig: drilling, standing
//! on bottom, off bottom, in reverse, at a stall, and with the pump off. The comments of the messages say the same.

use std::collections::BTreeMap;

use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{Simulation, Snapshot};
use flexdrill_core::units::rpm_to_rad_per_s;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::{BitState, Reactions, Transfer};
use flexdrill_outputs::fill;
use serde_json::Value;

/// The states, in the order of the columns of [`TABLE`].
const STATES: [&str; 6] = ["drilling", "standing", "off bottom", "reverse", "stall", "pump off"];

/// Per figure, one sign per state, and the reason. `+` and `-`: a value of that sign. `0`: nothing. `N`: the figure does not
/// exist, and NaN is published. `.`: a value of either sign, or none, whose sign is no matter of the state.
const TABLE: &[(&str, &str, &str)] = &[
    (
        "transfer.duration",
        "++++++",
        "the means cover the window in every state",
    ),
    (
        "transfer.surface_torque",
        "+.+-++",
        "what turns the string, with the sign of the rotation; wound up while it stands",
    ),
    (
        "transfer.surface_torque_rms",
        "++++++",
        "a root mean square has no sign",
    ),
    (
        "transfer.kickoff_torque",
        "+..-++",
        "as at the surface; off bottom only what the tool takes, which may be next to nothing",
    ),
    (
        "transfer.kickoff_torque_rms",
        "++++++",
        "a root mean square has no sign",
    ),
    (
        "transfer.bit_torque",
        "+.0-++",
        "the rock opposes the rotation, and holds a string that is wound up; off bottom there is none",
    ),
    ("transfer.bit_torque_rms", "+.0+++", "a root mean square has no sign"),
    (
        "transfer.torque_efficiency",
        "+N0+N+",
        "a quotient of torques of one rotation; off bottom nothing arrives",
    ),
    (
        "transfer.pipe_guide_friction_torque",
        "+N+-N+",
        "a power over the speed: it opposes the rotation, which there must be",
    ),
    (
        "transfer.guide_wall_friction_torque",
        ".N..N.",
        "the guide hardly turns: what is left of its power over the speed",
    ),
    ("transfer.joint_friction_torque", "+N+-N+", "a power over the speed"),
    (
        "transfer.string_friction_torque",
        "+.+-.+",
        "opposes the rotation, and holds the string where it stands",
    ),
    (
        "transfer.surface_weight",
        "++0+++",
        "slacked off; off bottom the hook carries all",
    ),
    (
        "transfer.surface_weight_rms",
        "++.+++",
        "a root mean square; off bottom that of vibration",
    ),
    (
        "transfer.kickoff_weight",
        "++-+++",
        "the string pushes the guide, which off bottom hangs on it",
    ),
    (
        "transfer.kickoff_weight_rms",
        "++++++",
        "a root mean square has no sign",
    ),
    ("transfer.bit_weight", "++0+++", "the rock carries it"),
    ("transfer.bit_weight_rms", "++0+++", "a root mean square has no sign"),
    (
        "transfer.hook_load",
        "++++++",
        "string, guide and pipe less what stands on the bottom",
    ),
    (
        "transfer.pipe_guide_axial_drag",
        "......",
        "the pipe slides around: what is left along it has either sign",
    ),
    (
        "transfer.guide_wall_axial_drag",
        "......",
        "opposes the last sliding of the guide along the wall",
    ),
    (
        "transfer.string_axial_drag",
        "......",
        "a string that turns slides around: what is left along it has either sign",
    ),
    (
        "transfer.depth_of_cut",
        "+.00.+",
        "a blade cuts forward only; one that stands keeps the depth that it has reached",
    ),
    (
        "transfer.rate_of_penetration",
        "+00.0+",
        "the hole deepens where the bit turns forward under weight",
    ),
    (
        "transfer.drive_power",
        "+0++0+",
        "torque times speed, positive in both senses; a drive that stands or stalls gives none",
    ),
    (
        "transfer.hoist_power",
        "......",
        "in the frame of the block: what the spring of the lines takes or gives",
    ),
    (
        "transfer.weight_on_bit_power",
        "-0000-",
        "minus what the rock takes along the hole, while the bit advances",
    ),
    ("transfer.gravity_power", "......", "of the motion about a mean"),
    ("transfer.load_power", "000000", "the tool has no loads"),
    (
        "transfer.feed_power",
        "......",
        "the friction of the wall times the advance",
    ),
    (
        "transfer.pressure_power",
        ".....0",
        "of the motion of the pipe's end; without a pump there is none",
    ),
    ("transfer.bit_power", "+00+0+", "torque times speed at the bit"),
    ("transfer.friction_power", "+0++0+", "friction takes what moves"),
    ("transfer.pipe_guide_friction_power", "+0++0+", "as above"),
    (
        "transfer.guide_wall_friction_power",
        "......",
        "a bristle gives back what it held: of either sign over a window",
    ),
    ("transfer.joint_friction_power", "+0++0+", "as above"),
    (
        "transfer.contact_damping_power",
        ".0..0.",
        "of collisions, where there are any",
    ),
    (
        "transfer.rayleigh_damping_power",
        "+0++0+",
        "the steel of a tool that bends as it turns",
    ),
    (
        "transfer.numerical_damping_power",
        "......",
        "small against the others, of either sign",
    ),
    ("transfer.string_power", "+0++0+", "friction and mud along the string"),
    (
        "transfer.axial_update_power",
        "......",
        "small against the others, of either sign",
    ),
    (
        "transfer.stored_power",
        "......",
        "what the window's end has more than its beginning",
    ),
    ("transfer.error_power", "......", "the error of the audit"),
    ("transfer.mud_power", "+0++0+", "mud takes what moves"),
    ("transfer.drive_at_limit", "0000+0", "a stall is a drive at its limit"),
    (
        "transfer.weight_arrives",
        "++++++",
        "what the friction of the arc leaves depends on no motion",
    ),
    ("bit_state.torque", "+.0-++", "as transfer.bit_torque"),
    ("bit_state.rotary_speed", "+0+-0+", "the bit's own speed"),
    ("bit_state.weight_on_bit", "++0+++", "as transfer.bit_weight"),
    (
        "bit_state.stick_slip_index",
        ".0....",
        "0 while the drive stands, at least 1 at a stall (below)",
    ),
    ("bit_state.tangential_acceleration", "+0++.+", "of a bit that turns"),
    ("bit_state.axial_acceleration", "+.++.+", "of a tool that vibrates"),
    ("bit_state.lateral_acceleration", "+.++.+", "as above"),
    ("bit_state.lateral_acceleration_peak", "+.++.+", "as above"),
    ("bit_state.lateral_impulse", "+.++.+", "as above"),
    ("bit_state.stick_slip_severity", ".0....", "the drive must turn"),
    (
        "reactions.drive_torque",
        "+.+-++",
        "on the top of the pipe, as transfer.kickoff_torque",
    ),
    ("reactions.bit_torque", "+.0-++", "of the instant"),
];

/// The state's inputs: rotary speed (r/min) and weight (N) with which the run begins, those that follow, pressure (Pa), limit
/// of the drive's torque (N m).
fn plan(state: &str) -> ([f64; 2], [f64; 2], f64, f64) {
    let drilling = [40.0, 10e3];
    match state {
        "standing" => (drilling, [0.0, 10e3], 2e6, 5000.0),
        "off bottom" => (drilling, [40.0, 0.0], 2e6, 5000.0),
        "reverse" => ([-40.0, 10e3], [-40.0, 10e3], 2e6, 5000.0),
        // Below what the rock asks for at this weight.
        "stall" => (drilling, drilling, 2e6, 150.0),
        "pump off" => (drilling, drilling, 0.0, 5000.0),
        _ => (drilling, drilling, 2e6, 5000.0),
    }
}

/// The tool in a state: all figures of the three messages by name, with what they are made from.
fn run(state: &str) -> (BTreeMap<String, Value>, Snapshot) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/outputs/states.yaml");
    let (first, then, pressure, limit) = plan(state);
    let config = Config::load(path).unwrap();
    let config = config.with_value("string.top_drive.torque_limit", limit).unwrap();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut snapshot = simulation.new_snapshot();
    let inputs = |[rpm, weight]: [f64; 2]| Inputs {
        rotary_speed: rpm_to_rad_per_s(rpm),
        weight_on_bit: weight,
        standpipe_pressure: pressure,
        ..Inputs::ZERO
    };
    for (until, inputs) in [(25.0, inputs(first)), (60.0, inputs(then))] {
        while simulation.time() < until {
            let outcome = simulation.advance(&inputs);
            assert!(matches!(outcome, StepOutcome::Advanced { .. }), "{state}: {outcome:?}");
            // The last message of the bit covers five seconds, as transfer does.
            if simulation.time() < 55.0 {
                simulation.snapshot(&mut snapshot, true);
            }
        }
    }
    simulation.snapshot(&mut snapshot, false);
    let header = Header::default();
    let (mut transfer, mut bit, mut reactions) = (Transfer::default(), BitState::default(), Reactions::default());
    fill::transfer(&snapshot, &header, &mut transfer);
    fill::bit_state(&snapshot, &header, &mut bit);
    fill::reactions(&snapshot, &header, &mut reactions);
    let mut all = BTreeMap::new();
    for (topic, message) in [
        ("transfer", serde_json::to_value(&transfer).unwrap()),
        ("bit_state", serde_json::to_value(&bit).unwrap()),
        ("reactions", serde_json::to_value(&reactions).unwrap()),
    ] {
        for (name, value) in message.as_object().unwrap() {
            all.insert(format!("{topic}.{name}"), value.clone());
        }
    }
    (all, snapshot)
}

/// A figure; NaN is null in JSON.
fn number(all: &BTreeMap<String, Value>, name: &str) -> f64 {
    let value = all.get(name).unwrap_or_else(|| panic!("no figure {name}"));
    if value.is_null() {
        f64::NAN
    } else {
        value.as_f64().unwrap()
    }
}

#[test]
fn every_figure_is_in_every_state_what_its_page_says() {
    let runs = STATES.map(run);
    let reference = &runs[0].0;
    let mut wrong = Vec::new();
    for (name, signs, why) in TABLE {
        assert_eq!(signs.len(), STATES.len(), "{name}");
        let values: Vec<f64> = runs.iter().map(|(all, _)| number(all, name)).collect();
        println!("{name:42} {signs} {values:12.5?}");
        // Nothing is less than a thousandth of what there is while drilling; what is nothing there too is exactly 0.
        let nothing = 1e-3 * number(reference, name).abs();
        for ((state, sign), value) in STATES.iter().zip(signs.chars()).zip(&values) {
            let right = match sign {
                '+' => *value > nothing,
                '-' => *value < -nothing,
                '0' => value.abs() <= nothing,
                'N' => value.is_nan(),
                '.' => value.is_finite(),
                other => panic!("{name}: {other}"),
            };
            if !right {
                wrong.push(format!("{name} is {value} {state}, expected {sign}: {why}"));
            }
        }
    }
    // No figure is left out: the rest are lists and vectors, whose sums `the_lists_have_their_sums` holds, and stamps.
    for name in reference.keys() {
        let listed = TABLE.iter().any(|(known, ..)| known == name);
        let vector = reference[name].is_array() || name.ends_with(".header");
        assert!(listed != vector, "{name} has no row in the table");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// In every state the list of what holds the tool adds up to the published sum, the string is in it, and all forces balance.
#[test]
fn the_lists_have_their_sums() {
    for state in STATES {
        let (all, snapshot) = run(state);
        let list = |name: &str| -> Vec<f64> {
            let values = all[&format!("reactions.{name}")].as_array().unwrap();
            values.iter().map(|value| value.as_f64().unwrap()).collect()
        };
        let bodies = list("body");
        let strings = bodies
            .iter()
            .filter(|body| **body == f64::from(Reactions::STRING))
            .count();
        assert_eq!(strings, 1, "{state}: {bodies:?}");
        let sum = list("support_force");
        for (axis, name) in ["force_x", "force_y", "force_z"].into_iter().enumerate() {
            let forces = list(name);
            assert_eq!(forces.len(), bodies.len());
            // Rounding of a sum of forces of some kilonewtons.
            assert!((forces.iter().sum::<f64>() - sum[axis]).abs() < 1e-9, "{state}: {name}");
        }
        let kickoff = snapshot.applied.weight_at_kickoff.unwrap();
        let at = bodies
            .iter()
            .position(|body| *body == f64::from(Reactions::STRING))
            .unwrap();
        // The hole begins vertical: along Z, but for rounding.
        assert!(
            (list("force_z")[at] - kickoff).abs() < 1e-9 * kickoff.abs().max(1.0),
            "{state}"
        );
        let sums = [
            "support_force",
            "weight",
            "wall_force",
            "bit_force",
            "load_force",
            "inertia_force",
            "damping_force",
        ];
        let left = list("unbalanced_force");
        for (axis, left) in left.iter().enumerate() {
            let total: f64 = sums.iter().map(|name| list(name)[axis]).sum();
            assert!((total - left).abs() < 1e-8, "{state}: {total} N");
        }
    }
}

/// Laws that the figures keep among themselves while the tool drills, is off bottom and stalls.
#[test]
fn figures_agree_with_each_other() {
    let (drilling, _) = run("drilling");
    let of = |name: &str| number(&drilling, name);
    // Rock removed: the depth of cut per turn times the turns is the rate at which the hole deepens.
    let cut = of("transfer.depth_of_cut") * of("bit_state.rotary_speed") / std::f64::consts::TAU;
    let rate = of("transfer.rate_of_penetration");
    // The depth of cut swings about its mean with the chatter of the bit: 2 % over a window of 5 s, as in the core's tests.
    assert!((rate / cut - 1.0).abs() < 0.03, "{rate} m/s for {cut} m/s");
    // Torque from the surface to the bit: losses explain what does not arrive, but for damping and what waves store.
    let lost = of("transfer.kickoff_torque") - of("transfer.bit_torque");
    let damped = ["contact_damping", "rayleigh_damping", "numerical_damping", "mud"]
        .map(|name| of(&format!("transfer.{name}_power")))
        .iter()
        .sum::<f64>();
    let losses: f64 = ["pipe_guide", "guide_wall", "joint"]
        .map(|name| of(&format!("transfer.{name}_friction_torque")))
        .iter()
        .sum();
    println!("{lost} N m lost, {losses} N m by friction, {damped} W damped");
    assert!(
        (losses + damped / 4.19 - lost).abs() < 0.05 * of("transfer.kickoff_torque"),
        "{lost} N m"
    );
    // In reverse each torque has the other sign.
    let (reverse, _) = run("reverse");
    assert!(number(&reverse, "transfer.joint_friction_torque") < 0.0);

    // Hook load: off bottom the string hangs with the whole tool; on bottom it is less by what is slacked off.
    let (off, snapshot) = run("off bottom");
    let weight = snapshot.reactions.weight[2];
    let string = hanging();
    let hook = number(&off, "transfer.hook_load");
    println!("hook {hook} N: string {string} N, tool {weight} N");
    // The arc's wall carries a part of the tool's weight: its cosine leaves 1 - cos(16 deg) = 4 % at most.
    assert!(
        hook > string + 0.9 * weight && hook < string + 1.02 * weight,
        "{hook} N"
    );

    let (stall, _) = run("stall");
    assert!((number(&stall, "transfer.drive_at_limit") - 1.0).abs() < 1e-9);
    assert!(number(&stall, "bit_state.stick_slip_index") >= 1.0);
}

/// Weight of the string in mud along the hole (N): that of the tubes by hand.
fn hanging() -> f64 {
    let area = std::f64::consts::FRAC_PI_4 * (0.0730_f64.powi(2) - 0.0546_f64.powi(2));
    let per_metre = area * (7850.0 - 1100.0) * 9.81;
    per_metre * (150.0 * 40_f64.to_radians().cos() + 100.0)
}
