//! Which alarm leads the list, and when its condition counts as one that stands, is less severe or has ended.

use super::words::{SECOND, any_snapshot, config, find, hazard, list, said, snapshot};
use flexdrill::alarms::{AlarmBook, AlarmId, Request};
use flexdrill::dds::port::Health;
use flexdrill::health::conditions::{NodeConditions, NodeState};
use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::{AcknowledgeAlarmRequest, Alarm, AlarmEvent, AlarmList, ShelveAlarmRequest};
use flexdrill_core::inputs::Conditioner;
use flexdrill_motion::{Hazard, HazardKind, Hold, Severity};
use flexdrill_realtime::link::RunState;
use flexdrill_realtime::{Pace, PaceReading};
use proptest::prelude::*;

/// A level that is held for a motion that has become weaker has not ended.
#[test]
fn a_weaker_motion_is_less_severe_and_has_not_ended() {
    let mut book = AlarmBook::fresh(config(), 0);
    let show = |book: &mut AlarmBook, time: i64, hazard: Hazard| {
        let mut snapshot = snapshot(120.0, 10.0, &[hazard]);
        snapshot.time = time as f64;
        book.observe_tool(&snapshot, time * SECOND);
    };
    let whirl = hazard(HazardKind::BackwardWhirl, Severity::Critical);
    show(&mut book, 30, Hazard { seen: 30.0, ..whirl });
    let weaker = Hold::Less {
        severity: Severity::Warning,
        since: 31.0,
    };
    show(
        &mut book,
        33,
        Hazard {
            seen: 30.0,
            hold: weaker,
            ..whirl
        },
    );
    let alarm = find(&list(&book), "backward_whirl").clone();
    assert!(!alarm.ended && alarm.ended_at == Time::default(), "{alarm:?}");
    assert_eq!(alarm.less_severe_since, Time::from_nanoseconds(31 * SECOND));
    assert!(
        alarm.evidence.ends_with("less severe since model time 31 s."),
        "{}",
        alarm.evidence
    );
    assert!(
        alarm.what_to_do.starts_with("Lower the speed below 80"),
        "{}",
        alarm.what_to_do
    );
    assert!(!alarm.what_to_do.contains("No further action"));
    // Then it ends.
    show(
        &mut book,
        36,
        Hazard {
            seen: 30.0,
            hold: Hold::Ended { at: 34.0 },
            ..whirl
        },
    );
    let alarm = find(&list(&book), "backward_whirl").clone();
    assert!(
        alarm.ended && alarm.ended_at == Time::from_nanoseconds(34 * SECOND),
        "{alarm:?}"
    );
    assert_eq!(alarm.less_severe_since, Time::default());
}

/// Whirl for 4 s in every 12 s: one announcement, with the count of its episodes. From the second on a pause is no end.
#[test]
fn motion_that_comes_and_goes_is_one_alarm_that_stands() {
    let mut book = AlarmBook::fresh(config(), 0);
    let mut events = Vec::new();
    let mut texts = std::collections::BTreeSet::new();
    for tenth in 0..4200_i64 {
        let phase = tenth % 120;
        let time = tenth as f64 / 10.0;
        let whirl = hazard(HazardKind::BackwardWhirl, Severity::Critical);
        let whirl = match phase {
            0..40 => Hazard { seen: time, ..whirl },
            // The level is held for its hold-off.
            40..60 => Hazard {
                seen: time - (phase - 39) as f64 / 10.0,
                ..whirl
            },
            _ => Hazard::calm(HazardKind::BackwardWhirl),
        };
        let mut snapshot = snapshot(120.0, 10.0, &[whirl]);
        snapshot.time = time;
        let stamp = tenth * SECOND / 10;
        book.advance(stamp);
        book.observe_tool(&snapshot, stamp);
        let (list, new) = said(&mut book);
        events.extend(new);
        let alarm = &list.alarms[0];
        assert_eq!(
            (alarm.id.as_str(), alarm.priority),
            ("backward_whirl", Alarm::HIGH),
            "at {time} s"
        );
        // The first episode ends at 5.9 s, and the motion is back at 12 s.
        assert_eq!(
            alarm.ended,
            (60..120).contains(&tenth),
            "at {time} s: {}",
            alarm.evidence
        );
        assert_eq!(i64::from(alarm.episodes), tenth / 120 + 1, "at {time} s");
        if !alarm.ended {
            texts.insert(alarm.what_to_do.clone());
        }
    }
    let changes: Vec<u8> = events.iter().map(|event| event.change).collect();
    assert_eq!(changes, [AlarmEvent::ACTIVATED]);
    assert_eq!(texts.len(), 1, "{texts:?}");
}

/// One strong episode in four: an operator who has acknowledged the alarm is not called with each of them.
#[test]
fn a_stronger_episode_of_an_acknowledged_alarm_does_not_call_again() {
    let mut book = AlarmBook::fresh(config(), 0);
    let mut events = Vec::new();
    for tenth in 0..4200_i64 {
        let time = tenth as f64 / 10.0;
        let severity = match (tenth / 120 % 4, tenth % 120) {
            (_, 40..) => Severity::Ok,
            (0, _) => Severity::Critical,
            _ => Severity::Warning,
        };
        let mut snapshot = snapshot(120.0, 10.0, &[hazard(HazardKind::BackwardWhirl, severity)]);
        snapshot.time = time;
        let stamp = tenth * SECOND / 10;
        book.advance(stamp);
        book.observe_tool(&snapshot, stamp);
        if tenth == 50 {
            let request = AcknowledgeAlarmRequest {
                id: "backward_whirl".to_owned(),
                operator_name: "ann".to_owned(),
                reason: String::new(),
            };
            book.request(&Request::Acknowledge(request), stamp).unwrap();
        }
        events.extend(said(&mut book).1);
        let alarm = find(&list(&book), "backward_whirl").clone();
        assert_eq!((alarm.active, alarm.priority), (true, Alarm::HIGH), "at {time} s");
    }
    let changes: Vec<u8> = events.iter().map(|event| event.change).collect();
    assert_eq!(changes, [AlarmEvent::ACTIVATED, AlarmEvent::ACKNOWLEDGED]);
}

/// Whether the condition of an alarm stands, and it is neither shelved nor suppressed.
fn stands(alarm: &Alarm) -> bool {
    let states = [Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::ACTIVE_ACKNOWLEDGED];
    states.contains(&alarm.state) && !alarm.ended
}

/// The first alarm of a list, and the first of each category, stands if any of them stands, and has an action of its own.
fn leads_rightly(list: &AlarmList) -> Result<(), TestCaseError> {
    let refers = ["Follow ", "The change advised for ", "No further action"];
    let all = |_: &&Alarm| true;
    let of = |category: u8| move |alarm: &&Alarm| alarm.category == category;
    let drilling: Vec<&Alarm> = list.alarms.iter().filter(of(Alarm::DRILLING)).collect();
    let system: Vec<&Alarm> = list.alarms.iter().filter(of(Alarm::SYSTEM)).collect();
    for alarms in [list.alarms.iter().filter(all).collect(), drilling, system] {
        let standing: Vec<bool> = alarms.iter().map(|alarm| stands(alarm)).collect();
        prop_assert!(
            standing.is_sorted_by(|a, b| a >= b),
            "one that has ended precedes one that stands"
        );
        if standing.first() == Some(&true) {
            let first = alarms[0];
            prop_assert!(first.follows.is_empty(), "{} follows {}", first.id, first.follows);
            let text = &first.what_to_do;
            prop_assert!(
                !refers.iter().any(|start| text.starts_with(start)),
                "{}: {text}",
                first.id
            );
        }
    }
    for alarm in list.alarms.iter().filter(|alarm| !alarm.follows.is_empty()) {
        let followed = list.alarms.iter().find(|other| other.id == alarm.follows).unwrap();
        prop_assert!(
            followed.active && !followed.ended,
            "{} follows {}, which has ended",
            alarm.id,
            followed.id
        );
        prop_assert!(alarm.what_to_do.contains(&followed.name), "{}", alarm.what_to_do);
    }
    for alarm in &list.alarms {
        let less = alarm.less_severe_since != Time::default();
        prop_assert!(!(less && alarm.ended), "{} has ended and is less severe", alarm.id);
    }
    Ok(())
}

/// A request of an operator for one alarm, if any.
fn any_request() -> impl Strategy<Value = Option<Request>> {
    let id = || (0..AlarmId::ALL.len()).prop_map(|index| AlarmId::ALL[index].id().to_owned());
    let acknowledge = id().prop_map(|id| {
        Some(Request::Acknowledge(AcknowledgeAlarmRequest {
            id,
            operator_name: "ann".to_owned(),
            reason: String::new(),
        }))
    });
    let shelve = (id(), any::<bool>()).prop_map(|(id, one_shot)| {
        Some(Request::Shelve(ShelveAlarmRequest {
            id,
            one_shot,
            duration: 20.0,
            operator_name: "ann".to_owned(),
            reason: "reaming".to_owned(),
        }))
    });
    prop_oneof![Just(None), acknowledge, shelve]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Whatever stands, has ended, is acknowledged or shelved, whether the rig is known or not, and however time passes.
    #[test]
    fn the_first_alarm_of_any_list_stands_and_says_what_to_do(
        moments in proptest::collection::vec(
            (any_snapshot(), any_request(), prop_oneof![Just(0.1), Just(2.0), Just(40.0)], any::<bool>()),
            1..8,
        ),
        level in prop_oneof![Just(Pace::Kept), Just(Pace::FarBehind)],
    ) {
        let config = config();
        let conditioner = Conditioner::new(config.inputs.rules());
        let mut book = AlarmBook::fresh(config, 0);
        let mut conditions = NodeConditions::default();
        let mut now = 0.0;
        for (snapshot, request, step, of_node) in &moments {
            for _ in 0..3 {
                now += step;
                let stamp = (now * 1e9) as i64;
                book.advance(stamp);
                book.observe_tool(snapshot, stamp);
                if *of_node {
                    let state = NodeState {
                        conditioner: &conditioner,
                        now: 10.0 * now,
                        drivers: Default::default(),
                        run_state: RunState::Running,
                        failure: None,
                        pace: PaceReading { level, factor: Some(0.5) },
                        recording: None,
                        dds: Health::default(),
                        namesakes: Vec::new(),
                    };
                    conditions.observe(&mut book, &state, stamp);
                }
                leads_rightly(&list(&book))?;
            }
            if let Some(request) = request {
                // A request may be refused.
                let _ = book.request(request, (now * 1e9) as i64);
                leads_rightly(&list(&book))?;
            }
        }
    }
}
