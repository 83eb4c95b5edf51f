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
use flexdrill_core::units::rpm_to_rad_per_s;

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
    fn new(set: &[(&str, f64)]) -> Self {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let config = set
            .iter()
            .fold(Config::load(root.join("config/rig.yaml")), |config, (key, value)| {
                config.and_then(|config| config.with_value(key, *value))
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
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: 1e3 * kn,
            ..Inputs::default()
        };
        let mut called = Vec::new();
        while self.simulation.time() < until {
            for _ in 0..self.steps {
                let outcome = self.simulation.advance(&inputs);
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
