//! Alarms of what is on the way from the surface to the bit, with the real model: each is called in a run in which its
//! condition is there, and none in normal drilling with the rig's tool.

use std::path::PathBuf;
use std::sync::Arc;

use flexdrill::alarms::{AlarmBook, AlarmId};
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{Alarm, AlarmEvent, CdrError};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::rpm_to_rad_per_s;
use flexdrill_motion::Transfer;

/// Model time between two looks at the alarms (s), as in the node.
const LOOK: f64 = 0.1;

fn text(name: &str) -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("config").join(name);
    std::fs::read_to_string(path).unwrap()
}

/// A configuration with parts of its text replaced; each must be there.
fn changed(name: &str, changes: &[(&str, &str)]) -> Config {
    let mut text = text(name);
    for (from, to) in changes {
        assert!(text.contains(from), "{name} has no {from:?}");
        text = text.replacen(from, to, 1);
    }
    Config::from_text(name, &text).unwrap()
}

/// What a run came to.
struct Outcome {
    /// Alarms that came, with their time (s), priority and evidence.
    came: Vec<(String, f64, u8, String)>,
    transfer: Transfer,
    /// Least and largest speed of the bit (rad/s) in the last ten seconds.
    bit_speed: [f64; 2],
}

impl Outcome {
    /// The first annunciation of an alarm, with its time (s).
    fn of(&self, id: AlarmId) -> Option<&(String, f64, u8, String)> {
        self.came.iter().find(|(came, ..)| came == id.id())
    }
}

/// Drills at a speed (r/min) and a weight (kN) for some seconds.
fn drill(config: Config, rpm: f64, kn: f64, seconds: f64) -> Outcome {
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut snapshot = simulation.new_snapshot();
    let steps = (LOOK / config.solver.time_step).round() as u32;
    let mut book = AlarmBook::fresh(Arc::new(config), 0);
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(rpm),
        weight_on_bit: 1e3 * kn,
        standpipe_pressure: 0.0,
        ..Inputs::default()
    };
    let (mut came, mut bit_speed) = (Vec::new(), [f64::MAX, f64::MIN]);
    while simulation.time() < seconds {
        for _ in 0..steps {
            assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
        }
        simulation.snapshot(&mut snapshot, true);
        if snapshot.time > seconds - 10.0 {
            let speed = snapshot.bit.rotary_speed;
            bit_speed = [bit_speed[0].min(speed), bit_speed[1].max(speed)];
        }
        let stamp = (snapshot.time * 1e9).round() as i64;
        book.advance(stamp);
        book.observe_tool(&snapshot, stamp);
        let events: Vec<AlarmEvent> = book.publish::<CdrError>(Header::default(), stamp, |_| Ok(())).unwrap();
        for event in events {
            if [AlarmEvent::ACTIVATED, AlarmEvent::RAISED].contains(&event.change) {
                came.push((event.id, snapshot.time, event.priority, event.evidence));
            }
        }
    }
    let outcome = Outcome {
        came,
        transfer: snapshot.transfer,
        bit_speed,
    };
    println!("{:?} bit speed {:?}", outcome.came, outcome.bit_speed);
    println!(
        "torque {:.0?} N m, weight {:.0?} N",
        outcome.transfer.torque.mean, outcome.transfer.weight.mean
    );
    outcome
}

/// The inclined string that takes torque: 1000 m nearly horizontal, with a friction of 0.4.
const INCLINED: [(&str, &str); 2] = [
    (
        "- {length: 1000.0, outer_diameter: 0.0730, inner_diameter: 0.0546}",
        "- {length: 1000.0, outer_diameter: 0.0730, inner_diameter: 0.0546, inclination_deg: 80}",
    ),
    ("  top_drive:\n", "  friction: {coefficient: 0.4}\n  top_drive:\n"),
];

/// A guide that a ring of cuttings holds back: it sticks, and hardly any weight reaches the bit.
const HELD_BACK: [(&str, &str); 2] = [
    (
        "    friction: bristle ",
        "    friction_axial: 2.0\n    friction_tangential: 2.0\n    friction: bristle ",
    ),
    (
        "contact:\n",
        "contact:\n  wall_friction_factors: {before_arc: 1.5, arc: 1.5, after_arc: 1.5}\n",
    ),
];

#[test]
fn weight_that_does_not_arrive_is_called() {
    let outcome = drill(changed("rig.yaml", &HELD_BACK), 40.0, 45.0, 40.0);
    let (_, _, _, evidence) = outcome.of(AlarmId::WeightTransfer).unwrap();
    assert!(evidence.starts_with("Weight does not arrive: 9"), "{evidence}");
    assert!(outcome.of(AlarmId::TorqueTransfer).is_none(), "{:?}", outcome.came);
}

#[test]
fn torque_that_does_not_arrive_is_called() {
    let outcome = drill(changed("rig.yaml", &INCLINED), 40.0, 15.0, 40.0);
    let (_, _, _, evidence) = outcome.of(AlarmId::TorqueTransfer).unwrap();
    assert!(
        evidence.starts_with("Torque does not arrive: friction takes 9"),
        "{evidence}"
    );
    assert!(outcome.of(AlarmId::WeightTransfer).is_none(), "{:?}", outcome.came);
}

/// The bit sticks below a stiff drive, with a rock whose torque falls with the speed.
#[test]
fn stick_slip_of_the_string_is_called_from_the_bits_own_speed() {
    let config = changed(
        "rig.yaml",
        &[
            ("tuning: soft_torque", "tuning: stiff"),
            ("rate_rpm: 20", "rate_rpm: 60"),
            ("wear_flat_force: 3200", "wear_flat_force: 8000"),
        ],
    );
    let outcome = drill(config, 30.0, 10.0, 60.0);
    assert!(outcome.of(AlarmId::StickSlip).is_some(), "{:?}", outcome.came);
    // The bit stops, and springs to twice the speed of the drive at least.
    let drive = rpm_to_rad_per_s(30.0);
    assert!(
        outcome.bit_speed[0] < 0.1 * drive && outcome.bit_speed[1] > 1.8 * drive,
        "{:?}",
        outcome.bit_speed
    );
}

/// A drive with a limit of 100 N m above a rock that asks for more: it winds the string up and stalls, and the bit stays
/// where it is. With the limit of the shipped rig, at the same weight, it drills.
#[test]
fn a_bit_that_is_stuck_below_a_drive_at_its_limit_is_called() {
    let limited = [("torque_limit: 5000", "torque_limit: 100")];
    let outcome = drill(changed("rig.yaml", &limited), 40.0, 20.0, 60.0);
    let (_, time, priority, evidence) = outcome.of(AlarmId::BitStuck).unwrap();
    assert!(
        evidence.starts_with("The bit is stuck and the drive stalls: for ") && *priority >= Alarm::MEDIUM,
        "{time} s: {evidence}"
    );
    assert!(
        (outcome.transfer.mean.drive_at_limit - 1.0).abs() < 1e-9,
        "{:?}",
        outcome.transfer.mean
    );
    assert!(
        outcome.bit_speed[1].abs() < 0.1 * rpm_to_rad_per_s(40.0),
        "{:?}",
        outcome.bit_speed
    );
    assert!(outcome.transfer.torque_efficiency.is_nan());
    let outcome = drill(changed("rig.yaml", &[]), 40.0, 20.0, 40.0);
    assert!(outcome.of(AlarmId::BitStuck).is_none(), "{:?}", outcome.came);
}

/// A straight guide with a twentieth of a tube's stiffness carries EI / R = 10.6 kN m in the arc; one whose slots close at
/// 0.25 1/m carries 8.5 kN m and the whole tube's 680 kN m2 times 0.0625 1/m, 51 kN m.
#[test]
fn a_guide_beyond_its_rating_is_called_and_one_below_is_not() {
    for (rated, slots, called) in [(8e3, "never", true), (16e3, "never", false), (40e3, "0.25", true)] {
        let guide = "guide: {outer_diameter: 0.102, inner_diameter: 0.080";
        let rating = format!("guide_preload: {{rated_moment_nm: {rated}}}\n\nwell:");
        let config = changed(
            "coarse.yaml",
            &[
                (
                    guide,
                    &format!("{guide}, bending_factor: 0.05, free_curvature: 0, slots_close_at: {slots}"),
                ),
                ("well:", &rating),
            ],
        );
        let outcome = drill(config, 40.0, 10.0, 15.0);
        let found = outcome.of(AlarmId::GuidePreload);
        assert_eq!(found.is_some(), called, "rated {rated} N m: {:?}", outcome.came);
    }
}

/// A pressure of 5 MPa on a seal of 63 mm compresses the pipe by 15.6 kN.
#[test]
fn folding_under_pressure_is_called_beyond_the_rating() {
    for (pressure, rated, called) in [(5e6, 10.0, true), (5e6, 30.0, false), (0.0, 1.0, false)] {
        let config = changed(
            "coarse.yaml",
            &[(
                "well:",
                &format!(
                    "pressure_folding: {{rated_compression_kn: {rated}}}\nenvironment: {{pressure: {{at_top: {pressure}, end: \
                     sealed, seal_diameter: 0.063}}}}\n\nwell:"
                ),
            )],
        );
        let outcome = drill(config, 40.0, 10.0, 15.0);
        let found = outcome.of(AlarmId::PressureFolding);
        assert_eq!(
            found.is_some(),
            called,
            "{pressure} Pa, rated {rated} kN: {:?}",
            outcome.came
        );
    }
}
