//! The alarms of the rig's tool (`config/rig.yaml`): silent while it drills steadily, and there when the motion is.

use std::path::PathBuf;
use std::sync::Arc;

use flexdrill::alarms::{AlarmBook, AlarmId};
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{AlarmEvent, CdrError};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::{m_per_h_to_m_per_s, rpm_to_rad_per_s};
use flexdrill_motion::BIT;
use serde_json::{Value, json};

/// Model time between two looks at the alarms (s), as in the node.
const LOOK: f64 = 0.1;

/// A twin with its alarms.
struct Rig {
    simulation: Simulation,
    snapshot: flexdrill_core::twin::Snapshot,
    book: AlarmBook,
    steps: u32,
}

impl Rig {
    fn new(set: &[(&str, Value)]) -> Self {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let config = set
            .iter()
            .fold(Config::load(root.join("config/rig.yaml")), |config, (key, value)| {
                config.and_then(|config| config.with_value(key, value.clone()))
            })
            .unwrap();
        let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
        Self {
            snapshot: simulation.new_snapshot(),
            steps: (LOOK / config.solver.time_step).round() as u32,
            book: AlarmBook::fresh(Arc::new(config), 0),
            simulation,
        }
    }

    /// Runs on to a time (s) at a speed (r/min) and a weight (kN) and gives the alarms that came or were raised, with
    /// their times (s).
    fn run(&mut self, until: f64, rpm: f64, kn: f64) -> Vec<(f64, String)> {
        self.run_with(
            until,
            &Inputs {
                rotary_speed: rpm_to_rad_per_s(rpm),
                weight_on_bit: 1e3 * kn,
                ..Inputs::default()
            },
        )
    }

    /// The same with all inputs.
    fn run_with(&mut self, until: f64, inputs: &Inputs) -> Vec<(f64, String)> {
        let mut called = Vec::new();
        while self.simulation.time() < until {
            for _ in 0..self.steps {
                let outcome = self.simulation.advance(inputs);
                assert!(matches!(outcome, StepOutcome::Advanced { .. }), "{outcome:?}");
            }
            self.simulation.snapshot(&mut self.snapshot, true);
            let stamp = (self.snapshot.time * 1e9).round() as i64;
            self.book.advance(stamp);
            self.book.observe_tool(&self.snapshot, stamp);
            let events: Vec<AlarmEvent> = self
                .book
                .publish::<CdrError>(Header::default(), stamp, |_| Ok(()))
                .unwrap();
            let comes = |event: &&AlarmEvent| [AlarmEvent::ACTIVATED, AlarmEvent::RAISED].contains(&event.change);
            called.extend(
                events
                    .iter()
                    .filter(comes)
                    .map(|event| (self.snapshot.time, event.id.clone())),
            );
        }
        called
    }
}

/// 15 s of turning off bottom, then 110 s of drilling in which nothing is wrong.
#[test]
fn steady_drilling_is_quiet() {
    let mut rig = Rig::new(&[]);
    let mut called = rig.run(15.0, 40.0, 0.0);
    called.extend(rig.run(125.0, 40.0, 10.0));
    assert!(called.is_empty(), "{called:?}");
    // The bit drills: the test is not quiet because nothing happens.
    let bit = &rig.snapshot.bit;
    assert!(bit.weight_on_bit > 5e3 && bit.rotary_speed > 3.0, "{bit:?}");
}

/// 25 kN at 20 r/min: the bit stops and breaks loose again, and that is called within three turns of the drive.
#[test]
fn a_bit_that_stops_is_called_within_three_turns() {
    let (rpm, turn) = (20.0, 3.0);
    let mut rig = Rig::new(&[]);
    assert!(rig.run(8.0, rpm, 0.0).is_empty());
    let (mut stopped, mut called) = (None, None);
    while rig.simulation.time() < 45.0 && called.is_none() {
        let until = rig.simulation.time() + LOOK;
        let events = rig.run(until, rpm, 25.0);
        // A tenth of the speed asked for: the bit stands.
        if rig.snapshot.bit.rotary_speed < 0.1 * rpm_to_rad_per_s(rpm) {
            stopped = stopped.or(Some(until));
        }
        if events.iter().any(|(_, id)| id == AlarmId::StickSlip.id()) {
            called = Some(until);
        }
    }
    let called = called.expect("called");
    assert!(
        stopped.is_none_or(|stopped| called - stopped <= 3.0 * turn),
        "{stopped:?} {called}"
    );
    let bit = &rig.snapshot.bit;
    assert!(bit.stick_slip_index > 0.4, "{bit:?}");
}

/// Something that a rig does beside drilling steadily, from steady drilling on.
struct Operation {
    /// Values to change.
    set: Vec<(&'static str, Value)>,
    /// Drilling before: r/min, kN, m/h.
    drilling: [f64; 3],
    /// The operation: r/min, kN, m/h, MPa.
    inputs: [f64; 4],
    /// Model time of each (s).
    seconds: [f64; 2],
    /// The alarms that it must raise; no other may come.
    raises: &'static [AlarmId],
    /// Largest difference of the means of two windows at its end: weight at the bit (N), torque at the bit (N m).
    steady: [f64; 2],
}

/// Runs drilling and operation: every step is taken, the audit closes, the motion becomes steady, the alarms are right.
/// Gives the rig at the end.
fn operate(operation: &Operation) -> Rig {
    let mut rig = Rig::new(&operation.set);
    let [rpm, kn, rate] = operation.drilling;
    let inputs = |rpm: f64, kn: f64, rate: f64, mega: f64| Inputs {
        rotary_speed: rpm_to_rad_per_s(rpm),
        weight_on_bit: 1e3 * kn,
        rate_of_penetration: m_per_h_to_m_per_s(rate),
        standpipe_pressure: 1e6 * mega,
    };
    let before = rig.run_with(operation.seconds[0], &inputs(rpm, kn, rate, 0.0));
    assert!(before.is_empty(), "while it drills: {before:?}");
    let [rpm, kn, rate, mega] = operation.inputs;
    let (from, length) = (rig.simulation.time(), operation.seconds[1]);
    let window = rig.snapshot.transfer.duration;
    let mut called = rig.run_with(from + length - window, &inputs(rpm, kn, rate, mega));
    let earlier = rig.snapshot.transfer;
    called.extend(rig.run_with(from + length, &inputs(rpm, kn, rate, mega)));
    let later = &rig.snapshot.transfer;
    let raised = |id: &AlarmId| called.iter().any(|(_, name)| name == id.id());
    assert!(operation.raises.iter().all(raised), "{called:?}");
    let right = |(_, name): &(f64, String)| operation.raises.iter().any(|id| name == id.id());
    assert!(called.iter().all(right), "{called:?}");
    let changes = [
        later.weight.mean[BIT] - earlier.weight.mean[BIT],
        later.torque.mean[BIT] - earlier.torque.mean[BIT],
    ];
    for (change, most) in changes.iter().zip(operation.steady) {
        assert!(change.abs() <= most, "{changes:?}, {later:?}");
    }
    // The bound of the random runs of the core's own tests: breaking loose and collisions in whole steps.
    let energy = &rig.snapshot.energy;
    let moved = [
        energy.drive,
        energy.hoist,
        energy.feed,
        energy.pressure,
        energy.bit,
        energy.friction,
        energy.string,
    ];
    let moved: f64 = moved.iter().map(|work| work.abs()).sum();
    assert!(energy.error.abs() < 1e-2 * moved, "{energy:?}");
    rig
}

fn rig_feeds_by_rate() -> Vec<(&'static str, Value)> {
    vec![("string.hoist.feed", json!("rate"))]
}

/// 40 r/min and 10 kN, 45 s: the auto-driller has been at its weight for some response times of 4 s.
const DRILLING: ([f64; 3], f64) = ([40.0, 10.0, 0.0], 45.0);

/// A hundredth of the weight, and what that carries of torque by the rock's law, twice: the bit chatters.
const STEADY: [f64; 2] = [300.0, 4.0];

#[test]
fn a_weight_of_zero_lifts_the_bit_and_raises_nothing() {
    let rig = operate(&Operation {
        set: Vec::new(),
        drilling: DRILLING.0,
        inputs: [40.0, 0.0, 0.0, 0.0],
        seconds: [DRILLING.1, 40.0],
        raises: &[],
        steady: STEADY,
    });
    let bit = &rig.snapshot.bit;
    assert!(bit.weight_on_bit == 0.0 && bit.rotary_speed > 3.0, "{bit:?}");
}

#[test]
fn a_bit_that_is_pulled_up_turning_raises_nothing() {
    let rig = operate(&Operation {
        set: rig_feeds_by_rate(),
        drilling: [40.0, 10.0, 3.0],
        inputs: [40.0, 0.0, -50.0, 0.0],
        seconds: [45.0, 25.0],
        raises: &[],
        steady: STEADY,
    });
    let bit = &rig.snapshot.bit;
    assert!(bit.weight_on_bit == 0.0 && bit.rotary_speed > 3.0, "{bit:?}");
    // The wall holds a guide that is pulled up, so that the hook carries more than the string alone.
    let advance = rig.simulation.advance_rate().unwrap();
    // The frame follows the tool's top, which the wall's friction lets swing about the block's speed.
    assert!((advance / m_per_h_to_m_per_s(-50.0) - 1.0).abs() < 0.1, "{advance} m/s");
    assert!(
        rig.snapshot.transfer.weight.mean[0] < 0.0,
        "{:?}",
        rig.snapshot.transfer
    );
}

/// Off bottom, and under a weight below the wear flats' force, which a bit that turns back carries without cutting: their
/// friction, which falls with the speed, lets it swing, and nothing else is wrong.
#[test]
fn a_tool_that_is_turned_back_raises_nothing_but_its_swing() {
    for (kn, raises) in [(0.0, &[] as &[AlarmId]), (4.0, &[AlarmId::StickSlip])] {
        let rig = operate(&Operation {
            set: Vec::new(),
            drilling: DRILLING.0,
            inputs: [-30.0, kn, 0.0, 0.0],
            seconds: [DRILLING.1, 50.0],
            raises,
            steady: STEADY,
        });
        let bit = &rig.snapshot.bit;
        // The mean: a bit that swings may almost stand at one instant.
        assert!(bit.mean_rotary_speed < -2.0, "{bit:?}");
        assert!((bit.weight_on_bit > 1e3) == (kn > 0.0), "{bit:?}");
    }
}

/// The drive stalls at its limit: the bit stands though the drive is asked to turn, which is called as stick-slip.
#[test]
fn a_drive_at_its_limit_is_called_as_a_bit_that_stands() {
    let mut rig = operate(&Operation {
        set: vec![("string.top_drive.torque_limit", json!(170.0))],
        drilling: DRILLING.0,
        inputs: [40.0, 40.0, 0.0, 0.0],
        seconds: [DRILLING.1, 60.0],
        raises: &[AlarmId::StickSlip, AlarmId::BitStuck],
        // The weight still rises as the auto-driller presses on a bit that stands. A drive at its limit swings with 3.6 s and
        // some 70 N m rms on it, of which a mean over five seconds has up to 3.6 / (5 pi) of the amplitude.
        steady: [2e3, 23.0],
    });
    // At its limit the drive does not damp: it swings on the string, with 2 pi sqrt(J / (G J_s / L)) = 3.6 s. Over ten
    // periods its mean speed and that of the bit are nil against the 4.2 rad/s that are asked for.
    let (samples, begin) = (360, rig.simulation.time());
    let mut sum = [0.0; 2];
    for sample in 1..=samples {
        rig.run(begin + 0.1 * f64::from(sample), 40.0, 40.0);
        let (speed, limited) = rig.simulation.top_drive().unwrap();
        assert!(limited, "{speed} rad/s after {sample} samples");
        sum = [sum[0] + speed, sum[1] + rig.snapshot.bit.rotary_speed];
    }
    let mean = sum.map(|sum| sum / f64::from(samples));
    assert!(mean.iter().all(|mean| mean.abs() < 0.1), "{mean:?} rad/s");
}

/// 5 MPa come and go while it drills: the joints carry it, the lateral motion and the alarms do not change.
#[test]
fn a_pump_that_is_switched_on_and_off_raises_nothing() {
    let set = vec![(
        "environment.pressure",
        json!({"end": "closed", "joint_seal_diameter": 0.062}),
    )];
    let mut rig = operate(&Operation {
        set,
        drilling: DRILLING.0,
        inputs: [40.0, 10.0, 0.0, 5.0],
        seconds: [DRILLING.1, 30.0],
        raises: &[],
        steady: STEADY,
    });
    let carried = |rig: &Rig| rig.snapshot.joints.axial_force.iter().sum::<f64>();
    let under_pressure = carried(&rig);
    let off = rig.simulation.time() + 30.0;
    assert!(rig.run(off, 40.0, 10.0).is_empty());
    // 15.1 kN on every ball of 62 mm; what stays is the pipe's own motion, some hundred newtons.
    let per_joint = (under_pressure - carried(&rig)) / rig.snapshot.joints.axial_force.len() as f64;
    assert!((per_joint - 15.1e3).abs() < 0.5e3, "{per_joint} N");
}
