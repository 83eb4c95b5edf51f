//! Following the advice of an alarm ends it and raises no worse one: every default rule with the real model of the tool
//! (mesh of `config/coarse.yaml`, whole steps). The motion is chaotic, so that a run with another start is another
//! sample; `docs/alarms.md` lists several of them:
//!
//!     cargo test --release --test alarms advice:: -- --ignored --nocapture --test-threads 1

use std::path::PathBuf;
use std::sync::Arc;

use super::with_off_delay;
use flexdrill::alarms::{AlarmBook, AlarmId};
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{Alarm, AlarmEvent, CdrError};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::rpm_to_rad_per_s;

/// Model time between two looks at the alarms (s), as in the node.
const LOOK: f64 = 0.1;
/// The motion is left to itself for so long after the alarm stands (s), so that it is fully there.
const DEVELOPS: f64 = 3.0;
/// Time that each change but the last has to take effect (s): the weight is down after 3.3 s.
const CHANGE: f64 = 5.0;

/// A rule and a case for it.
#[derive(Clone, Copy)]
struct Case {
    alarm: AlarmId,
    /// The priority from which on the advice is followed.
    priority: u8,
    /// Of the pipe in the guide.
    friction: f64,
    /// r/min and kN at which the alarm comes.
    at: [f64; 2],
    /// r/min and kN as the advice says, one change after the other.
    followed: &'static [[f64; 2]],
    /// Longest time until the alarm stands, and from following the advice to its end (s of model time).
    within: [f64; 2],
}

const BACKWARD_WHIRL: Case = Case {
    alarm: AlarmId::BackwardWhirl,
    priority: Alarm::HIGH,
    friction: 0.7,
    at: [120.0, 10.0],
    followed: &[[78.0, 10.0]],
    within: [15.0, 20.0],
};

const FORWARD_WHIRL: Case = Case {
    alarm: AlarmId::ForwardWhirl,
    priority: Alarm::MEDIUM,
    friction: 0.3,
    at: [120.0, 45.0],
    followed: &[[58.0, 45.0]],
    within: [25.0, 20.0],
};

const SHOCK: Case = Case {
    alarm: AlarmId::Shock,
    priority: Alarm::LOW,
    friction: 0.2,
    at: [120.0, 50.0],
    followed: &[[120.0, 19.0]],
    within: [25.0, 30.0],
};

const STICK_SLIP: Case = Case {
    alarm: AlarmId::StickSlip,
    priority: Alarm::HIGH,
    friction: 0.7,
    at: [20.0, 40.0],
    followed: &[[20.0, 7.5], [57.0, 7.5]],
    within: [20.0, 30.0],
};

const JOINT_LOAD: Case = Case {
    alarm: AlarmId::JointLoad,
    priority: Alarm::MEDIUM,
    friction: 0.2,
    at: [60.0, 60.0],
    followed: &[[60.0, 38.0]],
    within: [25.0, 20.0],
};

const CHAOTIC_WHIRL: Case = Case {
    alarm: AlarmId::ChaoticWhirl,
    priority: Alarm::MEDIUM,
    friction: 0.7,
    at: [80.0, 10.0],
    followed: &[[48.0, 10.0]],
    within: [15.0, 25.0],
};

/// What came of it.
struct Outcome {
    /// Model time at which the alarm stood, and from following the advice to the end of the condition and of the alarm
    /// (s).
    stood: f64,
    ended: Option<f64>,
    returned: Option<f64>,
    /// What the advice said when it was followed.
    advice: String,
    /// The highest priority before the advice was followed, and of every alarm that came after.
    before: u8,
    after: Vec<(String, u8)>,
}

fn run(case: &Case, start: f64) -> Outcome {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let config = Config::load(root.join("config/coarse.yaml"))
        .and_then(|config| config.with_value("contact.inner.friction_tangential", case.friction))
        .and_then(|config| config.with_value("inputs.weight_on_bit.initial_kn", case.at[1]))
        .unwrap();
    let config = with_off_delay(config, 1.0);
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut snapshot = simulation.new_snapshot();
    let steps = (LOOK / config.solver.time_step).round() as u32;
    let mut book = AlarmBook::fresh(Arc::new(config), 0);
    // The start differs by a few newtons.
    let inputs = |[rpm, kn]: [f64; 2]| Inputs {
        rotary_speed: rpm_to_rad_per_s(rpm),
        weight_on_bit: 1e3 * kn + start,
        ..Inputs::default()
    };
    let mut look = |at: [f64; 2]| {
        for _ in 0..steps {
            assert!(matches!(simulation.advance(&inputs(at)), StepOutcome::Advanced { .. }));
        }
        simulation.snapshot(&mut snapshot, true);
        let stamp = (snapshot.time * 1e9).round() as i64;
        book.advance(stamp);
        book.observe_tool(&snapshot, stamp);
        let events: Vec<AlarmEvent> = book.publish::<CdrError>(Header::default(), stamp, |_| Ok(())).unwrap();
        let list = book.list(Header::default());
        let alarm = list.alarms.iter().find(|alarm| alarm.id == case.alarm.id()).unwrap();
        let worst = list
            .alarms
            .iter()
            .filter(|alarm| alarm.active)
            .map(|alarm| alarm.priority);
        (snapshot.time, alarm.clone(), worst.max().unwrap_or_default(), events)
    };
    let mut stood = None;
    let (mut advice, mut before) = (String::new(), 0);
    loop {
        let (time, alarm, worst, _) = look(case.at);
        before = worst.max(before);
        if alarm.active && alarm.priority >= case.priority {
            stood.get_or_insert(time);
            if !alarm.ended {
                advice = alarm.what_to_do;
            }
        }
        if stood.is_some_and(|stood| time - stood >= DEVELOPS) {
            break;
        }
        assert!(
            stood.is_some() || time < case.within[0],
            "{} does not come within {} s",
            case.alarm.name(),
            case.within[0]
        );
    }
    let stood = stood.unwrap();
    let followed = stood + DEVELOPS;
    let mut waited = 0.0;
    let (mut ended, mut returned) = (None, None);
    let mut after = Vec::new();
    while returned.is_none() {
        let step = ((waited / CHANGE) as usize).min(case.followed.len() - 1);
        let (time, alarm, _, events) = look(case.followed[step]);
        waited = time - followed;
        for event in events {
            let comes = [AlarmEvent::ACTIVATED, AlarmEvent::RAISED].contains(&event.change);
            if comes && event.id != case.alarm.id() {
                after.push((event.id, event.priority));
            }
        }
        if !alarm.active {
            ended = Some(alarm.ended_at.to_nanoseconds() as f64 * 1e-9 - followed);
            returned = Some(time - followed);
        }
        if time - followed > case.within[1] {
            break;
        }
    }
    Outcome {
        stood,
        ended,
        returned,
        advice,
        before,
        after,
    }
}

/// The alarm ends in time, and what came meanwhile is not worse than what was there.
fn holds(case: &Case) {
    let outcome = run(case, 0.0);
    print(case, 0.0, &outcome);
    assert!(
        outcome.returned.is_some(),
        "{} stands {} s after its advice was followed",
        case.alarm.name(),
        case.within[1]
    );
    assert!(
        outcome.after.iter().all(|(_, priority)| *priority <= outcome.before),
        "following the advice of {} raised {:?}",
        case.alarm.name(),
        outcome.after
    );
}

fn print(case: &Case, start: f64, outcome: &Outcome) {
    let seconds = |time: Option<f64>| time.map_or("not".to_owned(), |time| format!("{time:.1} s"));
    println!(
        "| {} | {} | {:.0} r/min, {:.0} kN {start:+.0} N | {:.1} s | {:?} | {} | {} | {:?} | {} |",
        case.alarm.name(),
        case.friction,
        case.at[0],
        case.at[1],
        outcome.stood,
        case.followed,
        seconds(outcome.ended),
        seconds(outcome.returned),
        outcome.after,
        outcome.advice,
    );
}

#[test]
fn less_speed_ends_backward_whirl() {
    holds(&BACKWARD_WHIRL);
}

#[test]
fn less_speed_ends_forward_whirl() {
    holds(&FORWARD_WHIRL);
}

#[test]
fn less_weight_ends_shock() {
    holds(&SHOCK);
}

#[test]
fn less_weight_and_then_more_speed_end_stick_slip() {
    holds(&STICK_SLIP);
}

#[test]
fn less_weight_ends_joint_load() {
    holds(&JOINT_LOAD);
}

#[test]
fn less_speed_ends_chaotic_whirl() {
    holds(&CHAOTIC_WHIRL);
}

/// The table of `docs/alarms.md`.
#[test]
#[ignore = "several minutes"]
fn table_of_all_rules_with_three_starts() {
    for case in [
        BACKWARD_WHIRL,
        FORWARD_WHIRL,
        SHOCK,
        STICK_SLIP,
        JOINT_LOAD,
        CHAOTIC_WHIRL,
    ] {
        for start in [0.0, 5.0, -5.0] {
            print(&case, start, &run(&case, start));
        }
    }
}
