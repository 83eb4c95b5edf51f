//! Motion that comes and goes within some seconds, in real runs of the twin: its alarm is announced once and not with
//! every episode, it stands whenever the motion does, and the first alarm of the list is one that stands.
//!
//! The table of `docs/alarms.md` has the rows of
//!
//!     cargo test --release --test alarms chatter:: -- --include-ignored --nocapture --test-threads 1

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::with_off_delay;
use flexdrill::alarms::{AlarmBook, AlarmId, Request};
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{AcknowledgeAlarmRequest, Alarm, CdrError};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{Simulation, Snapshot};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_motion::{HazardKind, Hold, Severity};

/// Model time between two looks at the alarms (s), as in the node.
const LOOK: f64 = 0.1;
/// Length of a run (s): the seven minutes in which one whirl was announced 28 times.
const LENGTH: f64 = 420.0;
/// The same in every run of the tests: ten episodes of whirl.
const SHORT: f64 = 160.0;
/// Time after which an operator acknowledges what is to be acknowledged (s).
const ACKNOWLEDGED_AFTER: f64 = 20.0;
/// Most announcements of one alarm in a run.
const MOST: u64 = 3;

/// A drive whose speed goes up and down between two values.
struct Case {
    name: &'static str,
    /// Between pipe and guide.
    friction: f64,
    kn: f64,
    /// Each speed (r/min), with the time for which it is asked for (s).
    speeds: [(f64, f64); 2],
}

const CASES: [Case; 3] = [
    Case {
        name: "in and out of whirl, 10 s and 6 s",
        friction: 0.7,
        kn: 10.0,
        speeds: [(115.0, 10.0), (60.0, 6.0)],
    },
    Case {
        name: "about the limit of whirl",
        friction: 0.7,
        kn: 10.0,
        speeds: [(88.0, 12.0), (76.0, 8.0)],
    },
    Case {
        name: "steady at the limit of whirl",
        friction: 0.7,
        kn: 10.0,
        speeds: [(82.0, 10.0), (82.0, 10.0)],
    },
];

/// What came of a run.
#[derive(Debug, Default)]
struct Outcome {
    /// Announcements by alarm.
    announced: BTreeMap<String, u64>,
    /// Time (s) and priority of the announcements of backward whirl.
    whirl: Vec<(f64, u8)>,
    /// Times that backward whirl came, by its analysis.
    episodes: u32,
    /// Looks at which a level called and its alarm did not stand with its priority.
    missed: u32,
    /// Looks at which the first alarm of the list did not stand although one did, or referred to another one.
    misled: u32,
    /// Times of a change of the first alarm's action, without its numbers (s).
    changes: Vec<f64>,
    looks: u32,
}

/// The alarms of a run with one off-delay.
struct Watch {
    book: AlarmBook,
    outcome: Outcome,
    /// The action of the first alarm.
    headline: String,
}

impl Watch {
    fn new(config: Config) -> Self {
        Self {
            book: AlarmBook::fresh(Arc::new(config), 0),
            outcome: Outcome::default(),
            headline: String::new(),
        }
    }

    fn look(&mut self, snapshot: &Snapshot) {
        let stamp = (snapshot.time * 1e9).round() as i64;
        self.book.advance(stamp);
        self.book.observe_tool(snapshot, stamp);
        let events = self.book.publish::<CdrError>(Header::default(), stamp, |_| Ok(()));
        for event in events.unwrap() {
            if event.annunciates && event.id == AlarmId::BackwardWhirl.id() {
                self.outcome.whirl.push((snapshot.time.round(), event.priority));
            }
            *self.outcome.announced.entry(event.id).or_default() += u64::from(event.annunciates);
        }
        let list = self.book.list(Header::default()).alarms;
        self.acknowledge(&list, stamp);
        self.outcome.missed += snapshot
            .hazards
            .list
            .iter()
            .filter(|hazard| hazard.severity >= Severity::Warning)
            .filter(|hazard| {
                let id = AlarmId::of_hazard(hazard.kind).id();
                let alarm = list.iter().find(|alarm| alarm.id == id).unwrap();
                !alarm.active || u32::from(alarm.priority) < hazard.severity as u32
            })
            .count() as u32;
        let first = &list[0];
        let stands = |alarm: &Alarm| alarm.active && !alarm.ended;
        if !list.iter().any(stands) {
            return;
        }
        self.outcome.looks += 1;
        self.outcome.misled += u32::from(!stands(first) || !first.follows.is_empty());
        // The action without the present value.
        let action = first.what_to_do.split(" (").next().unwrap();
        let now = format!("{}: {action}", first.id);
        if now != self.headline {
            self.headline = now;
            self.outcome.changes.push(snapshot.time);
        }
    }

    fn acknowledge(&mut self, list: &[Alarm], stamp: i64) {
        let waits = |alarm: &Alarm| (stamp - alarm.since.to_nanoseconds()) as f64 * 1e-9;
        for alarm in list
            .iter()
            .filter(|alarm| !alarm.acknowledged && waits(alarm) >= ACKNOWLEDGED_AFTER)
        {
            let request = AcknowledgeAlarmRequest {
                id: alarm.id.clone(),
                operator_name: "ann".to_owned(),
                reason: String::new(),
            };
            self.book.request(&Request::Acknowledge(request), stamp).unwrap();
        }
    }
}

/// The alarms of one run with the default off-delay, and with one of a second.
fn run(case: &Case, length: f64) -> [Outcome; 2] {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let config = Config::load(root.join("config/coarse.yaml"))
        .and_then(|config| config.with_value("contact.inner.friction_tangential", case.friction))
        .and_then(|config| config.with_value("inputs.weight_on_bit.initial_kn", case.kn))
        .unwrap();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut snapshot = simulation.new_snapshot();
    let steps = (LOOK / config.solver.time_step).round() as u32;
    let mut watches = [with_off_delay(config.clone(), 1.0), config].map(Watch::new);
    let period: f64 = case.speeds.iter().map(|(_, lasts)| lasts).sum();
    let (mut episodes, mut whirled) = (0, false);
    while snapshot.time < length {
        let phase = snapshot.time % period;
        let (rpm, _) = case.speeds[usize::from(phase >= case.speeds[0].1)];
        let inputs = Inputs {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: kn_to_n(case.kn),
            ..Inputs::default()
        };
        for _ in 0..steps {
            assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
        }
        simulation.snapshot(&mut snapshot, true);
        let whirl = &snapshot.hazards.list[HazardKind::BackwardWhirl as usize];
        let whirls = whirl.severity >= Severity::Warning && !matches!(whirl.hold, Hold::Ended { .. });
        episodes += u32::from(whirls && !whirled);
        whirled = whirls;
        for watch in &mut watches {
            watch.look(&snapshot);
        }
    }
    let [short, default] = watches.map(|watch| Outcome {
        episodes,
        ..watch.outcome
    });
    print(case, "1 s", &short);
    print(case, "default", &default);
    [short, default]
}

fn print(case: &Case, off_delay: &str, outcome: &Outcome) {
    let others: Vec<_> = outcome.announced.iter().filter(|(_, times)| **times > 0).collect();
    println!(
        "| {} | {} | {off_delay} | {} | {:?} | {others:?} | {} of {} | {} | {:.0?} |",
        case.name,
        case.friction,
        outcome.episodes,
        outcome.whirl,
        outcome.misled,
        outcome.looks,
        outcome.missed,
        outcome.changes
    );
}

fn holds(case: &Case, length: f64) -> Outcome {
    let [short, outcome] = run(case, length);
    assert!(
        outcome.episodes >= 8,
        "only {} episodes: the case shows nothing",
        outcome.episodes
    );
    let of = |outcome: &Outcome| outcome.announced["backward_whirl"];
    assert!(
        of(&outcome) >= 1 && of(&short) > MOST,
        "the off-delay makes no difference"
    );
    for (id, announced) in &outcome.announced {
        assert!(*announced <= MOST, "{id} was announced {announced} times");
    }
    assert_eq!((outcome.missed, outcome.misled), (0, 0));
    outcome
}

#[test]
fn whirl_in_and_out_is_one_alarm() {
    let outcome = holds(&CASES[0], SHORT);
    assert_eq!(outcome.announced["backward_whirl"], 1, "{:?}", outcome.whirl);
}

#[test]
#[ignore = "a run of seven minutes"]
fn whirl_in_and_out_is_announced_three_times_at_most() {
    holds(&CASES[0], LENGTH);
}

#[test]
#[ignore = "a run of seven minutes"]
fn whirl_about_its_limit_is_announced_three_times_at_most() {
    holds(&CASES[1], LENGTH);
}

#[test]
#[ignore = "a run of seven minutes"]
fn whirl_at_its_limit_is_announced_three_times_at_most() {
    let outcome = holds(&CASES[2], LENGTH);
    // Speed and weight stay, so that the advice has no reason to change with the episodes.
    let flips = outcome
        .changes
        .windows(2)
        .filter(|pair| pair[1] - pair[0] < 20.0)
        .count();
    assert_eq!(flips, 0, "{:?}", outcome.changes);
}
