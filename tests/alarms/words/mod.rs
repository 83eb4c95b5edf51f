//! What alarms say: the worst moment while a level is held, numbers that were measured, advice that does not contradict
//! itself at any speed and weight.

mod any;

use std::path::PathBuf;
use std::sync::Arc;

use flexdrill::alarms::{AlarmBook, AlarmId};
use flexdrill::bag::{Losses, Problem};
use flexdrill::dds::port::Health;
use flexdrill::health::conditions::{NodeConditions, NodeState, RecordingState};
use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{Alarm, AlarmEvent, AlarmList, CdrError};
use flexdrill_config::Config;
use flexdrill_core::inputs::{Conditioner, InputKind};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{ModelQuality, QualityCause, QualityLevel, Snapshot};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_motion::{DriveState, Hazard, HazardKind, Hold, Severity, ToolLocation};
use flexdrill_realtime::link::RunState;
use flexdrill_realtime::{Pace, PaceReading};
use proptest::prelude::*;

pub(super) use any::any_snapshot;

pub(super) const SECOND: i64 = 1_000_000_000;

pub(super) fn config() -> Arc<Config> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    Arc::new(Config::load(root.join("config/default.yaml")).unwrap())
}

pub(super) fn snapshot(rpm: f64, kn: f64, hazards: &[Hazard]) -> Snapshot {
    let mut snapshot = Snapshot::default();
    snapshot.applied.rotary_speed = rpm_to_rad_per_s(rpm);
    snapshot.applied.weight_on_bit = kn_to_n(kn);
    snapshot.hazards.drive = DriveState::Turning;
    for hazard in hazards {
        snapshot.hazards.list[hazard.kind as usize] = *hazard;
    }
    snapshot
}

pub(super) fn hazard(kind: HazardKind, severity: Severity) -> Hazard {
    Hazard {
        severity,
        value: 3.4,
        threshold: 3.0,
        ..Hazard::calm(kind)
    }
}

pub(super) fn list(book: &AlarmBook) -> AlarmList {
    book.list(Header::default())
}

pub(super) fn find<'a>(list: &'a AlarmList, id: &str) -> &'a Alarm {
    list.alarms.iter().find(|alarm| alarm.id == id).unwrap()
}

/// The list and all events so far.
pub(super) fn said(book: &mut AlarmBook) -> (AlarmList, Vec<AlarmEvent>) {
    let events = book.publish::<CdrError>(Header::default(), 0, |_| Ok(())).unwrap();
    (list(book), events)
}

#[test]
fn a_held_alarm_shows_its_worst_moment_and_when_it_ended() {
    let mut book = AlarmBook::fresh(config(), 0);
    let whirl = Hazard {
        place: Some(ToolLocation {
            station: 75,
            body: Body::Pipe,
            measured_depth: 1.5,
            inclination: 0.471,
        }),
        whirl_ratio: -2.4,
        ..hazard(HazardKind::BackwardWhirl, Severity::Critical)
    };
    // The clock of the rig at model time 0.
    let begin = 1_700_000_000 * SECOND;
    let show = |book: &mut AlarmBook, time: f64, hazard: Hazard| {
        let mut snapshot = snapshot(120.0, 10.0, &[hazard]);
        snapshot.time = time;
        book.observe_tool(&snapshot, begin + (time * 1e9) as i64);
    };
    show(&mut book, 30.0, Hazard { seen: 30.0, ..whirl });
    let now = find(&list(&book), "backward_whirl").clone();
    assert_eq!(
        now.evidence,
        "Backward whirl of the pipe at 1.50 m (27 deg), whirl rate 2.4 times the rotary speed."
    );
    assert!(!now.ended && now.ended_at == Time::default());
    // The level is held for a moment of some seconds ago.
    show(&mut book, 36.0, Hazard { seen: 31.0, ..whirl });
    let held = find(&list(&book), "backward_whirl").clone();
    assert!(
        held.evidence.ends_with("rotary speed. Worst at 22:13:51 UTC."),
        "{}",
        held.evidence
    );
    assert_eq!(held.worst_at, Time::from_nanoseconds(begin + 31 * SECOND));
    // The motion has ended, the level is held.
    let over = Hazard {
        seen: 31.0,
        hold: Hold::Ended { at: 37.0 },
        ..whirl
    };
    show(&mut book, 39.0, over);
    let ended = find(&list(&book), "backward_whirl").clone();
    assert_eq!(
        (ended.state, ended.priority),
        (Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::HIGH)
    );
    assert!(
        ended
            .evidence
            .ends_with("Worst at 22:13:51 UTC; ended at 22:13:57 UTC, being watched."),
        "{}",
        ended.evidence
    );
    assert!(ended.ended && ended.ended_at == Time::from_nanoseconds(begin + 37 * SECOND));
    assert!(
        ended.what_to_do.starts_with("No further action"),
        "{}",
        ended.what_to_do
    );
    assert_eq!((ended.value, ended.measured_depth), (3.4, 1.5));
    // The level falls to one that is lower, at another place: what is to be acknowledged is still the worst.
    for tenth in 0..60 {
        let lower = Hazard {
            value: 1.2,
            whirl_ratio: -0.2,
            seen: 40.0,
            ..hazard(HazardKind::BackwardWhirl, Severity::Watch)
        };
        show(&mut book, 40.0 + f64::from(tenth) / 10.0, lower);
    }
    let lower = find(&list(&book), "backward_whirl").clone();
    assert_eq!((lower.active, lower.priority, lower.value), (true, Alarm::HIGH, 3.4));
    assert!(
        lower
            .evidence
            .ends_with("it came 2 times since 22:13:50 UTC; less severe since 22:13:57 UTC."),
        "{}",
        lower.evidence
    );
    // The condition stands: its end is not that of its priority.
    assert!(!lower.ended && lower.ended_at == Time::default() && lower.episodes == 2);
    assert_eq!(lower.less_severe_since, Time::from_nanoseconds(begin + 37 * SECOND));
    assert!(
        lower.what_to_do.starts_with("Lower the speed below 80"),
        "{}",
        lower.what_to_do
    );
    // The journal keeps the end of the motion with the return, which comes after the off-delay of 30 s.
    for tenth in 0..310 {
        show(
            &mut book,
            46.0 + f64::from(tenth) / 10.0,
            Hazard::calm(HazardKind::BackwardWhirl),
        );
    }
    let (_, events) = said(&mut book);
    let returned = events
        .iter()
        .find(|event| event.change == AlarmEvent::RETURNED)
        .unwrap();
    // The last look at the weaker motion, but for the rounding of its time.
    let ended = returned.ended_at.to_nanoseconds() - begin;
    assert!((ended - 459 * SECOND / 10).abs() < 1000, "{ended}");
    assert_eq!((returned.what_to_do.as_str(), returned.follows.as_str()), ("", ""));
}

/// With inputs that are stale, the speed and weight of the twin are a ramp of its own.
#[test]
fn with_stale_inputs_the_motion_says_first_that_the_rig_is_unknown() {
    let config = config();
    let mut conditioner = Conditioner::new(config.inputs.rules());
    for kind in InputKind::ALL {
        conditioner.offer(kind, 10.0, 0.0).unwrap();
    }
    let mut book = AlarmBook::fresh(config, 0);
    let mut conditions = NodeConditions::default();
    let mut told = |now: f64| {
        let state = NodeState {
            conditioner: &conditioner,
            now,
            drivers: Default::default(),
            run_state: RunState::Running,
            failure: None,
            pace: PaceReading {
                level: Pace::Kept,
                factor: Some(1.0),
            },
            recording: None,
            dds: Health::default(),
            namesakes: Vec::new(),
        };
        let stamp = (now * 1e9) as i64;
        conditions.observe(&mut book, &state, stamp);
        let chaos = hazard(HazardKind::ChaoticWhirl, Severity::Critical);
        book.observe_tool(&snapshot(95.0, 10.0, &[chaos]), stamp);
        find(&list(&book), "chaotic_whirl").what_to_do.clone()
    };
    assert!(told(0.5).starts_with("Lower the speed below 50 r/min (95 r/min now)"));
    let text = told(60.0);
    assert!(
        text.starts_with("The rig's speed and weight on bit are unknown to the twin."),
        "{text}"
    );
    assert!(!text.contains("now)") && !text.contains("95"), "{text}");
    assert!(
        text.contains("If the speed is above 50 r/min, lower it below that"),
        "{text}"
    );
}

#[test]
fn a_bit_that_stops_is_told_without_a_share_of_its_mean() {
    let evidence = |value: f64, least_speed: f64| {
        let mut book = AlarmBook::fresh(config(), 0);
        let bit = Hazard {
            value,
            least_speed,
            ..hazard(HazardKind::StickSlip, Severity::Critical)
        };
        book.observe_tool(&snapshot(60.0, 30.0, &[bit]), SECOND);
        find(&list(&book), "stick_slip").evidence.clone()
    };
    assert_eq!(
        evidence(0.84, 0.2),
        "Stick-slip: the bit speed swings 84 % above and below its mean; at 100 % the bit stops."
    );
    assert_eq!(evidence(1.2, -0.02), "Stick-slip: the bit stops and then breaks free.");
    assert_eq!(
        evidence(18.58, -1.3),
        "Stick-slip: the bit stops and spins back before it breaks free."
    );
}

/// ISA-18.2: no alarm without an action. The state stays in the hazards.
#[test]
fn a_watch_level_without_an_action_is_no_alarm() {
    let watch = |kind, rpm| {
        let mut book = AlarmBook::fresh(config(), 0);
        for tenth in 0..30 {
            let snapshot = snapshot(rpm, 10.0, &[hazard(kind, Severity::Watch)]);
            book.observe_tool(&snapshot, tenth * SECOND / 10);
        }
        let list = list(&book);
        let alarm = find(&list, AlarmId::of_hazard(kind).id());
        (alarm.priority, alarm.what_to_do.clone())
    };
    // Below its rule's speed nothing would change backward whirl; above it there is something to do.
    assert_eq!(watch(HazardKind::BackwardWhirl, 40.0).0, Alarm::NO_PRIORITY);
    let (priority, text) = watch(HazardKind::BackwardWhirl, 120.0);
    assert_eq!(priority, Alarm::LOW);
    assert!(text.starts_with("Lower the speed"), "{text}");
    // Forward whirl that does not wear the pipe is a state.
    assert_eq!(watch(HazardKind::ForwardWhirl, 120.0).0, Alarm::NO_PRIORITY);
}

/// A drive's speed wavers by some percent about any limit.
#[test]
fn a_wavering_speed_does_not_switch_an_alarm() {
    let mut book = AlarmBook::fresh(config(), 0);
    for tenth in 0..600 {
        let rpm = 80.0 + 2.0 * (tenth as f64 * 0.7).sin();
        let snapshot = snapshot(rpm, 10.0, &[hazard(HazardKind::BackwardWhirl, Severity::Watch)]);
        book.observe_tool(&snapshot, tenth * SECOND / 10);
    }
    let (_, events) = said(&mut book);
    assert_eq!(
        events.iter().map(|event| event.change).collect::<Vec<_>>(),
        [AlarmEvent::ACTIVATED]
    );
}

/// The engineer is sent to keys that exist in the configuration and act on its tool.
#[test]
fn the_engineer_is_named_keys_that_act() {
    for name in ["default", "rig"] {
        let config = Config::load(format!("{}/config/{name}.yaml", env!("CARGO_MANIFEST_DIR"))).unwrap();
        let config = Arc::new(config);
        let mut book = AlarmBook::fresh(Arc::clone(&config), 0);
        let all = HazardKind::ALL.map(|kind| hazard(kind, Severity::Critical));
        book.observe_tool(&snapshot(120.0, 10.0, &all), SECOND);
        let texts: Vec<String> = list(&book)
            .alarms
            .iter()
            .map(|alarm| alarm.what_the_engineer_can_do.clone())
            .collect();
        let is_of_key = |c: char| c.is_ascii_lowercase() || c == '_' || c == '.';
        let keys: Vec<&str> = texts
            .iter()
            .flat_map(|text| text.split(|c: char| !is_of_key(c)))
            .map(|word| word.trim_end_matches('.'))
            .filter(|word| word.contains('.'))
            .collect();
        assert!(keys.len() > 3, "{keys:?}");
        for key in &keys {
            assert!(config.has(key), "{name}: {key}");
        }
        // The paper's law has the one and cutting has the other.
        let cuts = name == "rig";
        assert_eq!(keys.contains(&"rock.depth_of_cut.specific_energy"), cuts, "{keys:?}");
        assert_eq!(keys.contains(&"tool.bit.friction_factor"), !cuts, "{keys:?}");
    }
}

#[test]
fn the_document_lists_every_alarm_and_their_number() {
    let text = include_str!("../../../docs/alarms.md");
    assert!(
        text.contains(&format!("There are {} of them", AlarmId::ALL.len())),
        "docs/alarms.md gives another number than {}",
        AlarmId::ALL.len()
    );
    for id in AlarmId::ALL {
        let row = format!("`{}`", id.id());
        assert!(
            text.lines().any(|line| line.starts_with('|') && line.contains(&row)),
            "docs/alarms.md has no row for {}",
            id.id()
        );
    }
}

/// What a sentence asks for: each `(raise, is the speed, limit)`, and whether it says to stop at once, or has another
/// action than a change of speed or weight.
fn asked(text: &str) -> (Vec<(bool, bool, f64)>, bool) {
    let mut asked = Vec::new();
    for (verb, raise) in [("Raise the ", true), ("Lower the ", false)] {
        for part in text.split(verb).skip(1) {
            let side = if raise { " above " } else { " below " };
            let (quantity, rest) = part.split_once(side).unwrap();
            let limit = rest.split(' ').next().unwrap().parse().unwrap();
            asked.push((raise, quantity.starts_with("speed"), limit));
        }
    }
    let actions = [
        "Pick up",
        "Do not push the tool",
        "Reduce the pump rate",
        "Stop the rotation",
    ];
    (asked, actions.iter().any(|action| text.starts_with(action)))
}

/// All subsets of the tool's alarms at three levels, over the whole range of speed and weight: all texts together ask
/// for one change at most, so that no two ask for opposite directions, and it changes the present inputs. Alarms without
/// limits of speed and weight come by turns with all subsets of the others.
#[test]
fn standing_alarms_never_contradict_each_other() {
    let config = config();
    let (most_rpm, most_kn) = (config.inputs.rotary_speed.max_rpm, config.inputs.weight_on_bit.max_kn);
    let with_limits = |kind: &HazardKind| (*kind as u32) < HazardKind::WeightTransfer as u32;
    let (limited, others): (Vec<_>, Vec<_>) = HazardKind::ALL.into_iter().partition(with_limits);
    let levels = |kinds: &[HazardKind], subset: u32| -> Vec<Hazard> {
        let level = |index: usize| subset / 4_u32.pow(index as u32) % 4;
        let raised = |(index, kind): (usize, &HazardKind)| {
            let severity = *Severity::RAISED.get((level(index) as usize).checked_sub(1)?)?;
            Some(hazard(*kind, severity))
        };
        kinds.iter().enumerate().filter_map(raised).collect()
    };
    let count = limited.len() as u32;
    let mut steps = 0;
    for subset in 1..4_u32.pow(count) {
        let hazards = levels(&limited, subset);
        // Every tenth of both ranges, by turns with the subsets: all of them come with all pairs of levels.
        for cell in (subset % 3..121).step_by(3) {
            let (rpm, kn) = (
                most_rpm * f64::from(cell % 11) / 10.0,
                most_kn * f64::from(cell / 11) / 10.0,
            );
            // Half of the cells have none of the others.
            let other = if cell % 2 == 0 {
                0
            } else {
                (7 * subset + cell) % 4_u32.pow(others.len() as u32)
            };
            let hazards = [hazards.clone(), levels(&others, other)].concat();
            let mut book = AlarmBook::fresh(Arc::clone(&config), 0);
            book.observe_tool(&snapshot(rpm, kn, &hazards), SECOND);
            let list = list(&book);
            let texts: Vec<&str> = list
                .alarms
                .iter()
                .filter(|alarm| alarm.active)
                .map(|alarm| alarm.what_to_do.as_str())
                .collect();
            let all: Vec<_> = texts.iter().map(|text| asked(text)).collect();
            let changes: Vec<_> = all.iter().flat_map(|(changes, _)| changes).collect();
            let stops = all.iter().filter(|(_, stop)| *stop).count();
            assert!(changes.len() + stops <= 1, "at {rpm} r/min, {kn} kN: {texts:?}");
            assert!(texts.iter().all(|text| !text.is_empty()), "{texts:?}");
            // A high alarm is never left without an action of its own or one that goes before it.
            let high = list
                .alarms
                .iter()
                .any(|alarm| alarm.active && alarm.priority == Alarm::HIGH);
            assert!(
                !high || changes.len() + stops == 1,
                "at {rpm} r/min, {kn} kN: {texts:?}"
            );
            for (raise, speed, limit) in changes {
                steps += 1;
                let now = if *speed { rpm } else { kn };
                // An input wavers by 5 % about a limit.
                let changes = if *raise {
                    now <= 1.05 * limit
                } else {
                    now >= 0.95 * limit
                };
                assert!(changes, "at {rpm} r/min, {kn} kN: {texts:?}");
            }
        }
    }
    assert!(steps > 1000, "{steps} texts ask for a change");
}
