//! From hazards and the node's state to alarms, their words, and what is kept over a restart; the alarms of a replay.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use flexdrill::alarms::{AlarmBook, AlarmId, Request};
use flexdrill::bag::{Losses, Problem};
use flexdrill::dds::port::Health;
use flexdrill::health::conditions::{NodeConditions, NodeState, RecordingState};
use flexdrill::health::diagnostics::{self, RigEvidence};
use flexdrill::health::motion::MotionEvidence;
use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::diagnostic_msgs::DiagnosticStatus;
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{
    AcknowledgeAlarmRequest, Alarm, AlarmEvent, AlarmList, Bands, CdrError, ShelveAlarmRequest, TwinStatus, from_cdr,
    topics,
};
use flexdrill::rig_inputs::{Driver, DriverId, Drivers, Rule};
use flexdrill::rig_inputs::{Measured, Surveys};
use flexdrill_config::Config;
use flexdrill_core::dynamics::{FailureCause, StepFailure};
use flexdrill_core::inputs::{Conditioner, InputKind, InputRoute};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{ModelQuality, QualityCause, QualityLevel, Snapshot};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_motion::{DriveState, Hazard, HazardKind, Severity, ToolLocation};
use flexdrill_outputs::ParameterChange;
use flexdrill_realtime::link::RunState;
use flexdrill_realtime::{Pace, PaceReading};

const SECOND: i64 = 1_000_000_000;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn config() -> Arc<Config> {
    Arc::new(Config::load(root().join("config/default.yaml")).unwrap())
}

/// Plausible tools that all say otherwise, as where a sensor lies to them, silence no alarm of the twin: the list is the
/// same but for a sentence of its evidence, and without bands to the letter.
#[test]
fn plausible_tools_say_what_they_do_and_silence_nothing() {
    let config = config();
    const BEGUN: i64 = 1_700_000_000 * SECOND;
    let stood = |bands: &dyn Fn() -> Bands| {
        let mut book = AlarmBook::fresh(Arc::clone(&config), BEGUN);
        for second in 0..60 {
            let now = BEGUN + second * SECOND;
            book.observe_tool(&snapshot(&[rolling()]), now);
            let mut bands = bands();
            bands.header.stamp = Time::from_nanoseconds(now);
            book.observe_tools(&bands);
        }
        let header = Header {
            stamp: Time::from_nanoseconds(BEGUN + 59 * SECOND),
            ..Header::default()
        };
        book.list(header)
    };
    let without = stood(&|| Bands {
        members: 7,
        no_bands: "7 plausible tools".to_owned(),
        ..Bands::default()
    });
    let mut with = stood(&|| Bands {
        members: 12,
        ..Bands::default()
    });
    let whirl = with
        .alarms
        .iter_mut()
        .find(|alarm| alarm.id == "backward_whirl")
        .unwrap();
    assert!(whirl.active && whirl.priority == Alarm::HIGH);
    // 1,700,000,000 s are 22:13:20; the second that is spoken of is 11 s old.
    let words = " At 22:14:08 UTC it stood in none of 12 plausible tools.";
    let evidence = whirl
        .evidence
        .strip_suffix(words)
        .unwrap_or_else(|| panic!("{}", whirl.evidence));
    whirl.evidence = evidence.to_owned();
    // By their words: values that are not known are not equal to themselves.
    assert_eq!(format!("{with:?}"), format!("{without:?}"));
}

/// A tool that turns at 120 r/min under 10 kN with these hazards.
fn snapshot(hazards: &[Hazard]) -> Snapshot {
    snapshot_at(120.0, 10.0, hazards)
}

fn snapshot_at(rpm: f64, kn: f64, hazards: &[Hazard]) -> Snapshot {
    let mut snapshot = Snapshot::default();
    snapshot.applied.rotary_speed = rpm_to_rad_per_s(rpm);
    snapshot.applied.weight_on_bit = kn_to_n(kn);
    snapshot.hazards.drive = DriveState::Turning;
    for hazard in hazards {
        snapshot.hazards.list[hazard.kind as usize] = *hazard;
    }
    snapshot
}

fn rolling() -> Hazard {
    Hazard {
        severity: Severity::Critical,
        place: Some(ToolLocation {
            station: 75,
            body: Body::Pipe,
            measured_depth: 2.31,
            inclination: 0.733,
        }),
        value: 4.4,
        threshold: 3.0,
        whirl_ratio: -3.4,
        rolling_share: 0.92,
        confidence: 0.9,
        ..Hazard::calm(HazardKind::BackwardWhirl)
    }
}

fn stick_slip() -> Hazard {
    Hazard {
        severity: Severity::Watch,
        value: 0.6,
        threshold: 0.5,
        ..Hazard::calm(HazardKind::StickSlip)
    }
}

/// Shows a snapshot for so many seconds, every 0.1 s, from an instant (s) on.
fn show(book: &mut AlarmBook, from: i64, seconds: i64, snapshot: &Snapshot) {
    for tenth in 0..seconds * 10 {
        let stamp = from * SECOND + tenth * SECOND / 10;
        book.advance(stamp);
        book.observe_tool(snapshot, stamp);
    }
}

/// What is published: events as given back, and the list, if any, as sent.
fn publish(book: &mut AlarmBook, second: i64) -> (Vec<AlarmEvent>, Option<AlarmList>) {
    let mut list = None;
    let sent = book.publish::<CdrError>(Header::default(), second * SECOND, |encoded| {
        if encoded.topic.name == topics::ALARMS.name {
            list = Some(from_cdr(encoded.cdr)?);
        }
        Ok(())
    });
    (sent.unwrap(), list)
}

fn find<'a>(list: &'a AlarmList, id: &str) -> &'a Alarm {
    list.alarms.iter().find(|alarm| alarm.id == id).unwrap()
}

fn acknowledge(id: &str) -> Request {
    Request::Acknowledge(AcknowledgeAlarmRequest {
        id: id.to_owned(),
        operator_name: "ann".to_owned(),
        reason: "seen".to_owned(),
    })
}

fn shelve(id: &str, duration: f64) -> Request {
    Request::Shelve(ShelveAlarmRequest {
        id: id.to_owned(),
        one_shot: false,
        duration,
        operator_name: "ann".to_owned(),
        reason: "reaming".to_owned(),
    })
}

#[test]
fn the_worst_is_first_with_cause_consequence_and_what_to_do() {
    let mut book = AlarmBook::fresh(config(), 0);
    show(&mut book, 10, 1, &snapshot(&[stick_slip(), rolling()]));
    let (events, list) = publish(&mut book, 11);
    let list = list.unwrap();
    assert_eq!(list.alarms.len(), AlarmId::ALL.len(), "all of them are listed");
    assert_eq!((list.sequence, list.unacknowledged, events.len()), (2, 2, 2));
    let worst = &list.alarms[0];
    assert_eq!((worst.id.as_str(), worst.priority), ("backward_whirl", Alarm::HIGH));
    assert_eq!((worst.state, worst.body), (Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::PIPE));
    assert_eq!((worst.value, worst.threshold, worst.measured_depth), (4.4, 3.0, 2.31));
    assert_eq!(
        worst.evidence,
        "Backward whirl of the pipe at 2.31 m (42 deg), rolling, whirl rate 3.4 times the rotary speed."
    );
    assert_eq!(worst.cause, "Friction between pipe and guide drives the whirl.");
    assert_eq!(worst.consequence, "Each link bends 4.4 times per turn; joint fatigue.");
    assert_eq!(
        worst.what_to_do,
        "Lower the speed below 80 r/min (120 r/min now) and keep the weight on bit. If it persists, pick up off bottom and \
         stop the drive."
    );
    assert!(worst.what_the_engineer_can_do.contains("inspect the joints"));
    assert!(!worst.ended && worst.worst_at == Time::from_nanoseconds(10 * SECOND + 9 * SECOND / 10));
    let next = &list.alarms[1];
    assert_eq!((next.id.as_str(), next.priority), ("stick_slip", Alarm::LOW));
    assert_eq!(
        next.what_to_do,
        "Follow the advice for backward whirl first, then check this alarm again."
    );
    assert!(next.measured_depth.is_nan() && next.body == Alarm::NOWHERE);
    assert!(
        events
            .iter()
            .all(|event| event.annunciates && event.change == AlarmEvent::ACTIVATED)
    );
    // Nothing changes, so the list is due again after a second only.
    assert_eq!(publish(&mut book, 11), (Vec::new(), None));
    assert!(!book.is_due(11 * SECOND + SECOND / 2) && book.is_due(12 * SECOND));
}

#[test]
fn what_has_gone_is_shown_until_it_is_acknowledged() {
    let mut book = AlarmBook::fresh(config(), 0);
    show(&mut book, 10, 1, &snapshot(&[rolling()]));
    // For longer than the alarm is held.
    show(&mut book, 11, 31, &snapshot(&[]));
    let list = publish(&mut book, 42).1.unwrap();
    let returned = &list.alarms[0];
    assert_eq!(
        (returned.id.as_str(), returned.state, returned.priority, returned.active),
        ("backward_whirl", Alarm::RETURNED_UNACKNOWLEDGED, Alarm::HIGH, false)
    );
    assert!(returned.evidence.contains("rolling"), "{}", returned.evidence);
    assert!(
        returned.ended && returned.evidence.ends_with("ended at model time 10 s."),
        "{}",
        returned.evidence
    );
    assert_eq!(returned.what_to_do, "No further action: acknowledge the alarm.");
    assert_eq!(
        book.request(&acknowledge(""), 43 * SECOND).unwrap(),
        "alarms acknowledged: 1"
    );
    show(&mut book, 43, 1, &snapshot(&[]));
    let (events, list) = publish(&mut book, 44);
    let list = list.unwrap();
    let normal = find(&list, "backward_whirl");
    assert_eq!((normal.state, normal.evidence.as_str()), (Alarm::NORMAL, ""));
    let last = events.last().unwrap();
    assert_eq!(
        (last.change, last.operator_name.as_str(), last.reason.as_str()),
        (AlarmEvent::ACKNOWLEDGED, "ann", "seen")
    );
}

#[test]
fn a_drive_that_runs_up_suppresses_the_tool_by_design() {
    let mut book = AlarmBook::fresh(config(), 0);
    let mut running_up = snapshot(&[rolling()]);
    running_up.hazards.drive = DriveState::RunningUp;
    show(&mut book, 10, 5, &running_up);
    let list = publish(&mut book, 15).1.unwrap();
    let suppressed = list
        .alarms
        .iter()
        .filter(|alarm| alarm.state == Alarm::SUPPRESSED_BY_DESIGN);
    assert_eq!((suppressed.count(), list.unacknowledged), (HazardKind::ALL.len(), 0));
    show(&mut book, 15, 1, &snapshot(&[rolling()]));
    let (events, list) = publish(&mut book, 16);
    assert_eq!(
        find(&list.unwrap(), "backward_whirl").state,
        Alarm::ACTIVE_UNACKNOWLEDGED
    );
    assert!(events.iter().any(|event| event.change == AlarmEvent::RELEASED));
}

#[test]
fn a_model_that_contradicts_itself_calls_also_while_the_drive_stands() {
    let mut book = AlarmBook::fresh(config(), 0);
    let mut poor = Snapshot::default();
    poor.quality = ModelQuality {
        level: QualityLevel::Poor,
        cause: Some(QualityCause::EnergyError),
        value: 0.56,
        bound: 0.53,
        judged: true,
        ..ModelQuality::default()
    };
    show(&mut book, 10, 1, &poor);
    let list = publish(&mut book, 11).1.unwrap();
    let first = &list.alarms[0];
    assert_eq!((first.id.as_str(), first.priority), ("model_quality", Alarm::MEDIUM));
    assert!(
        first.evidence.contains("energy errors reach 56 %"),
        "{}",
        first.evidence
    );
}

#[test]
fn acknowledged_and_shelved_outlast_a_restart() {
    let mut book = AlarmBook::fresh(config(), 0);
    let motion = snapshot(&[rolling(), stick_slip()]);
    show(&mut book, 10, 1, &motion);
    book.request(&acknowledge("backward_whirl"), 11 * SECOND).unwrap();
    assert_eq!(
        book.request(&shelve("stick_slip", 60.0), 11 * SECOND).unwrap(),
        "stick_slip shelved for 60 s"
    );
    let refused = book
        .request(&shelve("stick_slip", 1e9), 11 * SECOND)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("at most 3600 s"), "{refused}");
    let refused = book
        .request(&acknowledge("wobble"), 11 * SECOND)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("backward_whirl, forward_whirl"), "{refused}");
    let before = publish(&mut book, 12).1.unwrap();

    let text = serde_json::to_string(&book.save()).unwrap();
    let mut again = AlarmBook::new(config(), Some(&serde_json::from_str(&text).unwrap()), 20 * SECOND).unwrap();
    show(&mut again, 20, 1, &motion);
    let (events, after) = publish(&mut again, 21);
    let after = after.unwrap();
    assert_eq!(events, [], "nothing has changed");
    assert_eq!(after.sequence, before.sequence);
    for id in ["backward_whirl", "stick_slip"] {
        let (was, is) = (find(&before, id), find(&after, id));
        assert_eq!(
            (was.state, &was.since, &was.shelved_until),
            (is.state, &is.since, &is.shelved_until)
        );
    }
    show(&mut again, 70, 2, &motion);
    let (events, list) = publish(&mut again, 72);
    assert_eq!(find(&list.unwrap(), "stick_slip").state, Alarm::ACTIVE_UNACKNOWLEDGED);
    assert_eq!(
        (events[0].change, events[0].reason.as_str()),
        (AlarmEvent::UNSHELVED, "its time is over")
    );
}

#[test]
fn out_of_service_is_the_configurations_word() {
    let config = Arc::new(config().with_value("alarms.stick_slip.in_service", false).unwrap());
    let mut book = AlarmBook::fresh(config, 0);
    show(&mut book, 10, 3, &snapshot(&[stick_slip()]));
    let (events, list) = publish(&mut book, 13);
    let list = list.unwrap();
    let last = list.alarms.last().unwrap();
    assert_eq!((last.id.as_str(), last.state), ("stick_slip", Alarm::OUT_OF_SERVICE));
    assert_eq!(
        events.iter().map(|event| event.change).collect::<Vec<_>>(),
        [AlarmEvent::TAKEN_OUT]
    );
    let refused = book
        .request(&shelve("stick_slip", 60.0), 13 * SECOND)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("out of service"), "{refused}");
}

#[test]
fn inputs_pace_and_recording_call_too() {
    let config = config();
    let mut conditioner = Conditioner::new(config.inputs.rules());
    for kind in InputKind::ALL {
        conditioner.offer(kind, 10.0, 0.0).unwrap();
    }
    let mut book = AlarmBook::fresh(config, 0);
    let mut conditions = NodeConditions::default();
    // 15 s without a sample: past max_age and hold_before_safe, so that the safe values act.
    for tenth in 0..200 {
        let state = NodeState {
            conditioner: &conditioner,
            now: tenth as f64 * 0.1,
            drivers: Default::default(),
            run_state: RunState::Running,
            failure: None,
            pace: PaceReading {
                level: Pace::FarBehind,
                factor: Some(0.85),
            },
            recording: Some(RecordingState {
                error: Some(Problem {
                    text: "no space left".to_owned(),
                    cause: "The disk is full.",
                    remedy: "Free disk space.",
                }),
                notice: None,
                losses: Losses {
                    unwritten: 3,
                    ..Losses::default()
                },
            }),
            dds: Health::default(),
            namesakes: Vec::new(),
        };
        conditions.observe(&mut book, &state, tenth * SECOND / 10);
    }
    let (events, list) = publish(&mut book, 20);
    let list = list.unwrap();
    let priority = |id: &str| find(&list, id).priority;
    assert_eq!(
        (priority("rotary_speed_input"), priority("weight_on_bit_input")),
        (Alarm::HIGH, Alarm::HIGH)
    );
    assert_eq!(
        (priority("real_time"), priority("recording")),
        (Alarm::MEDIUM, Alarm::MEDIUM)
    );
    assert_eq!(priority("solver"), Alarm::NO_PRIORITY);
    let recording = &find(&list, "recording").evidence;
    assert!(recording.contains("no space left"), "{recording}");
    // Stale for some seconds first, on safe values then.
    let speed: Vec<_> = events
        .iter()
        .filter(|event| event.id == "rotary_speed_input")
        .map(|event| (event.change, event.priority))
        .collect();
    assert_eq!(
        speed,
        [
            (AlarmEvent::ACTIVATED, Alarm::MEDIUM),
            (AlarmEvent::RAISED, Alarm::HIGH)
        ]
    );
}

/// Losses of a moment outlast the alarm's delay, and so does what is over already.
#[test]
fn a_recording_that_lost_something_calls_even_when_it_goes_on() {
    let calls = |recording: &dyn Fn(i64) -> RecordingState| {
        let config = config();
        let conditioner = Conditioner::new(config.inputs.rules());
        let mut book = AlarmBook::fresh(config, 0);
        let mut conditions = NodeConditions::default();
        for tenth in 0..40 {
            let state = NodeState {
                conditioner: &conditioner,
                now: tenth as f64 * 0.1,
                run_state: RunState::Running,
                failure: None,
                pace: PaceReading::default(),
                recording: Some(recording(tenth)),
                dds: Health::default(),
                namesakes: Vec::new(),
                drivers: Default::default(),
            };
            conditions.observe(&mut book, &state, tenth * SECOND / 10);
        }
        let (_, list) = publish(&mut book, 4);
        let alarm = find(&list.unwrap(), "recording").clone();
        let cause = format!("{} {}", alarm.cause, alarm.what_the_engineer_can_do);
        (alarm.priority, alarm.evidence, cause)
    };
    let good = RecordingState::default();
    assert_eq!(calls(&|_| good.clone()).0, Alarm::NO_PRIORITY);
    let lost = |tenth| RecordingState {
        losses: Losses {
            flooded: if tenth < 5 { 0 } else { 7 },
            ..Losses::default()
        },
        ..RecordingState::default()
    };
    let (priority, evidence, cause) = calls(&lost);
    assert_eq!(priority, Alarm::LOW);
    assert!(evidence.contains("7 messages"), "{evidence}");
    assert!(cause.contains("7 arrived faster") && !cause.contains("disk"), "{cause}");
    let over = |_| RecordingState {
        notice: Some(Problem {
            text: "its folder was removed".to_owned(),
            cause: "The recording's file or its folder was removed, moved or replaced.",
            remedy: "Mount the disk again.",
        }),
        ..RecordingState::default()
    };
    let (priority, evidence, cause) = calls(&over);
    assert_eq!(priority, Alarm::MEDIUM);
    assert!(evidence.contains("its folder was removed"), "{evidence}");
    assert!(cause.contains("removed") && !cause.contains("full"), "{cause}");
}

/// A replay of the small tool with levels so low that there are alarms; what it says.
fn replay(folder: &Path, name: &str) -> String {
    let text = std::fs::read_to_string(root().join("tests/data/small.yaml")).unwrap();
    let config = folder.join("small.yaml");
    std::fs::write(
        &config,
        text + "\nshock:\n  levels: {watch: 0.01, warning: 0.02, critical: 0.03}\n",
    )
    .unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("replay")
        .arg(root().join("config/field_logs/demo.csv"))
        .arg("--mapping")
        .arg(root().join("config/field_logs/rig_1hz.yaml"))
        .args(["--from", "45", "--duration", "20", "--config"])
        .arg(&config)
        .arg("--out")
        .arg(folder.join(name))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    said
}

/// Bytes of the alarms' messages in their order.
fn alarms_in(bag: &Path) -> Vec<(String, Vec<u8>)> {
    flexdrill::bag::open(bag)
        .unwrap()
        .map(Result::unwrap)
        .filter(|message| message.topic.is("twin/alarms") || message.topic.is("twin/alarm_events"))
        .map(|message| (message.topic.name.clone(), message.data))
        .collect()
}

#[test]
fn a_replay_has_its_alarms_and_a_second_one_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let said = replay(folder.path(), "one");
    replay(folder.path(), "two");
    let (one, two) = (
        alarms_in(&folder.path().join("one")),
        alarms_in(&folder.path().join("two")),
    );
    assert!(one == two, "two replays differ");
    let events: Vec<AlarmEvent> = one
        .iter()
        .filter(|(topic, _)| topic == "/twin/alarm_events")
        .map(|(_, bytes)| from_cdr(bytes).unwrap())
        .collect();
    for (index, event) in events.iter().enumerate() {
        assert_eq!(event.sequence, index as u64 + 1);
    }
    assert!(
        events.iter().any(|event| event.id == "shock" && event.annunciates),
        "no shock at such levels: {events:?}"
    );
    let lists: Vec<AlarmList> = one
        .iter()
        .filter(|(topic, _)| topic == "/twin/alarms")
        .map(|(_, bytes)| from_cdr(bytes).unwrap())
        .collect();
    // Every second of 20 s, and with every change.
    assert!(lists.len() >= 20, "{} lists", lists.len());
    assert_eq!(lists.last().unwrap().sequence, events.len() as u64);
    for part in ["alarms: ", "lateral shock", "per hour", "in flood", "within 60 s"] {
        assert!(said.contains(part), "'{part}' is not in\n{said}");
    }
}

#[test]
fn two_drivers_call_with_who_they_are() {
    let config = config();
    let mut conditioner = Conditioner::new(config.inputs.rules());
    let mut drivers = Drivers::new(Rule::of(&config.inputs));
    let mut book = AlarmBook::fresh(config, 0);
    let mut conditions = NodeConditions::default();
    let ids = [1, 2].map(|byte| DriverId([byte; 16]));
    drivers.describe(Driver {
        id: ids[1],
        node: Some("/log_player".to_owned()),
        host: Some("10.0.0.9".to_owned()),
        source: String::new(),
    });
    for tenth in 0..200_i64 {
        let now = tenth as f64 * 0.1;
        // Both send for 10 s, then the rig alone.
        for id in ids.iter().take(if tenth < 100 { 2 } else { 1 }) {
            drivers
                .offer(InputKind::RotarySpeed, InputRoute::Plain, *id, "", now, 40.0)
                .unwrap();
        }
        for kind in InputKind::ALL {
            conditioner.offer(kind, 10.0, now).unwrap();
        }
        let state = NodeState {
            conditioner: &conditioner,
            now,
            drivers: InputKind::ALL.map(|kind| drivers.summary(kind, now)),
            run_state: RunState::Running,
            failure: None,
            pace: PaceReading::default(),
            recording: None,
            dds: Health::default(),
            namesakes: Vec::new(),
        };
        conditions.observe(&mut book, &state, tenth * SECOND / 10);
        if tenth == 90 {
            let list = publish(&mut book, 9).1.unwrap();
            let alarm = find(&list, "two_drivers");
            assert_eq!(
                (alarm.state, alarm.priority),
                (Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::MEDIUM)
            );
            assert!(
                alarm.evidence.starts_with("Rotary speed is published by ")
                    && alarm.evidence.contains("/log_player @ 10.0.0.9 (0202")
                    && alarm.evidence.contains("unnamed node @ unknown host (0101"),
                "{}",
                alarm.evidence
            );
            let engineer = &alarm.what_the_engineer_can_do;
            assert!(engineer.contains("inputs.driver.policy"), "{engineer}");
        }
    }
    // Silent for max_age (5 s), then gone for the alarm's own 5 s.
    let list = publish(&mut book, 20).1.unwrap();
    assert!(!find(&list, "two_drivers").active);
}

/// List and diagnostics show a value that a client has changed and that alarms depend on, until it is set back; the journal
/// names the client.
#[test]
fn a_twin_that_differs_from_its_configuration_says_so() {
    let begun = config();
    let mut book = AlarmBook::fresh(Arc::clone(&begun), 0);
    let key = "whirl.backward_cycles.critical";
    let value = begun.whirl.backward_cycles.critical;
    let mut second = 0;
    let mut set = |book: &mut AlarmBook, value: f64| {
        let now = Arc::new(begun.with_live_values("a test", [(key, value)]).unwrap());
        let request = ParameterChange {
            name: key.to_owned(),
            value,
            asked_by: "service set_parameters, client ann".to_owned(),
        };
        book.reconfigure(&now, &[request]);
        for _ in 0..3 {
            second += 1;
            book.observe_tool(&snapshot(&[]), second * SECOND);
        }
        let (events, list) = publish(book, second);
        let item = configuration_item(list.as_ref().unwrap());
        (events, find(list.as_ref().unwrap(), "changed_parameters").clone(), item)
    };
    let (events, alarm, item) = set(&mut book, 1.1 * value);
    assert_eq!(
        (alarm.state, alarm.priority),
        (Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::LOW)
    );
    assert!(
        alarm.evidence.contains(key) && alarm.evidence.contains("configured"),
        "{}",
        alarm.evidence
    );
    assert_eq!(item.level, DiagnosticStatus::WARN);
    let entry = events
        .iter()
        .find(|event| event.change == AlarmEvent::ADJUSTED)
        .unwrap();
    assert_eq!(entry.id, "changed_parameters");
    assert!(
        entry.operator_name.ends_with("client ann") && entry.reason.starts_with(key),
        "{entry:?}"
    );
    let (events, alarm, item) = set(&mut book, value);
    assert!(!alarm.active, "{alarm:?}");
    assert_eq!(item.level, DiagnosticStatus::OK);
    assert!(events.iter().any(|event| event.change == AlarmEvent::ADJUSTED));
}

/// The item `configuration` of the diagnostics with a list of alarms.
fn configuration_item(list: &AlarmList) -> DiagnosticStatus {
    let rig = RigEvidence {
        measured: &Measured::default(),
        surveys: &Surveys::default(),
        now: 0.0,
        stamp_time: 0,
        residuals: None,
    };
    let items = diagnostics::items("n", &TwinStatus::default(), &rig, &MotionEvidence::default(), list);
    items.into_iter().find(|item| item.name == "n: configuration").unwrap()
}

/// The rig sends, but nothing that can be right: that is no silence, and the alarm says what is wrong.
#[test]
fn an_input_that_is_only_refused_is_stale_and_says_why() {
    let config = config();
    let mut conditioner = Conditioner::new(config.inputs.rules());
    let mut book = AlarmBook::fresh(config, 0);
    let mut conditions = NodeConditions::default();
    for tenth in 0..=200_i64 {
        let now = tenth as f64 * 0.1;
        conditioner.offer(InputKind::RotarySpeed, 500.0, now).unwrap_err();
        let state = NodeState {
            conditioner: &conditioner,
            now,
            drivers: Default::default(),
            run_state: RunState::Running,
            failure: None,
            pace: PaceReading::default(),
            recording: None,
            dds: Health::default(),
            namesakes: Vec::new(),
        };
        conditions.observe(&mut book, &state, tenth * SECOND / 10);
        // Stale after max_age of 5 s, on its safe value after 10 s more; each calls after the alarm's delay of 2 s.
        let expected = match tenth {
            40 => Some((Alarm::LOW, "refused: above the maximum of 120 r/min")),
            80 => Some((Alarm::MEDIUM, "No good sample on rig/rotary_speed_rpm for 8 s")),
            200 => Some((Alarm::HIGH, "No good sample on rig/rotary_speed_rpm for 20 s")),
            _ => None,
        };
        if let Some((priority, words)) = expected {
            let list = publish(&mut book, tenth / 10).1.unwrap();
            let alarm = find(&list, "rotary_speed_input");
            assert_eq!(alarm.priority, priority, "at {now} s: {}", alarm.evidence);
            assert!(alarm.evidence.contains(words), "{}", alarm.evidence);
            assert!(alarm.evidence.contains("500 r/min refused"), "{}", alarm.evidence);
            assert!(alarm.cause.contains("limits are too narrow"), "{}", alarm.cause);
        }
    }
}

/// A rig is connected some time after the twin: until then a missing first sample is no alarm, and a missing second is.
#[test]
fn an_input_that_has_never_sent_calls_after_the_configured_time_only() {
    let config = config();
    let wait = config.alarms.first_sample_within;
    let conditioner = Conditioner::new(config.inputs.rules());
    let mut book = AlarmBook::fresh(config, 0);
    let mut conditions = NodeConditions::default();
    let mut states = Vec::new();
    for second in 0..=(wait as i64 + 10) {
        let state = NodeState {
            conditioner: &conditioner,
            now: 1000.0 + second as f64,
            drivers: Default::default(),
            run_state: RunState::Running,
            failure: None,
            pace: PaceReading::default(),
            recording: None,
            dds: Health::default(),
            namesakes: Vec::new(),
        };
        conditions.observe(&mut book, &state, second * SECOND);
        let list = book.list(Header::default());
        let found = ["rotary_speed_input", "weight_on_bit_input"].map(|id| find(&list, id).state);
        assert_eq!(found[0], found[1]);
        if states.last().is_none_or(|(_, state)| *state != found[0]) {
            states.push((second as f64, found[0]));
        }
    }
    let [
        (0.0, Alarm::SUPPRESSED_BY_DESIGN),
        (released, Alarm::NORMAL),
        (called, Alarm::ACTIVE_UNACKNOWLEDGED),
    ] = states[..]
    else {
        panic!("{states:?}");
    };
    // The alarm's own delay follows.
    assert_eq!((released, called), (wait, wait + 2.0));
}

/// Whoever runs the computer and the driller are told apart by the alarm itself.
#[test]
fn a_matter_of_the_computer_is_for_whoever_runs_it_and_comes_after_the_drillers() {
    let config = config();
    let conditioner = Conditioner::new(config.inputs.rules());
    let mut book = AlarmBook::fresh(config, 0);
    let mut conditions = NodeConditions::default();
    for second in 0..10 {
        let state = NodeState {
            conditioner: &conditioner,
            now: second as f64,
            drivers: Default::default(),
            run_state: RunState::Running,
            failure: None,
            pace: PaceReading {
                level: Pace::FarBehind,
                factor: Some(0.5),
            },
            recording: None,
            dds: Health::default(),
            namesakes: Vec::new(),
        };
        conditions.observe(&mut book, &state, second * SECOND);
    }
    show(&mut book, 10, 1, &snapshot(&[stick_slip()]));
    let (events, list) = publish(&mut book, 11);
    let list = list.unwrap();
    let first: Vec<(&str, u8, u8)> = list.alarms[..2]
        .iter()
        .map(|alarm| (alarm.id.as_str(), alarm.category, alarm.priority))
        .collect();
    assert_eq!(
        first,
        [
            ("stick_slip", Alarm::DRILLING, Alarm::LOW),
            ("real_time", Alarm::SYSTEM, Alarm::MEDIUM)
        ]
    );
    let called = events.iter().find(|event| event.id == "real_time").unwrap();
    assert_eq!(called.category, Alarm::SYSTEM);
    let alarm = &list.alarms[1];
    for text in [&alarm.evidence, &alarm.cause, &alarm.consequence, &alarm.what_to_do] {
        assert!(!text.contains("mesh") && !text.contains(".yaml"), "{text}");
    }
}

#[test]
fn a_state_of_an_earlier_run_is_marked_until_it_changes() {
    let mut book = AlarmBook::fresh(config(), 0);
    show(&mut book, 10, 1, &snapshot(&[rolling()]));
    let before = book.list(Header::default());
    let here = find(&before, "backward_whirl");
    assert!(!here.from_earlier_run && here.since.to_nanoseconds() > 0);
    let mut again = AlarmBook::new(config(), Some(&book.save()), 100 * SECOND).unwrap();
    let list = again.list(Header::default());
    assert!(find(&list, "backward_whirl").from_earlier_run);
    assert_eq!(find(&list, "backward_whirl").since, here.since);
    assert!(!find(&list, "shock").from_earlier_run, "it never changed");
    again.request(&acknowledge("backward_whirl"), 101 * SECOND).unwrap();
    let list = again.list(Header::default());
    assert!(!find(&list, "backward_whirl").from_earlier_run);
}

/// The items of `/diagnostics` with their alarms.
const ITEMS: [(&str, &[AlarmId]); 14] = [
    ("pacing", &[AlarmId::RealTime]),
    ("solver", &[AlarmId::Solver, AlarmId::ModelQuality]),
    (
        "inputs",
        &[
            AlarmId::RotarySpeedInput,
            AlarmId::WeightOnBitInput,
            AlarmId::TwoDrivers,
        ],
    ),
    ("measured", &[]),
    ("surveys", &[]),
    ("configuration", &[AlarmId::ChangedParameters]),
    (
        "whirl",
        &[AlarmId::BackwardWhirl, AlarmId::ForwardWhirl, AlarmId::ChaoticWhirl],
    ),
    ("stick-slip", &[AlarmId::StickSlip]),
    ("shock", &[AlarmId::Shock]),
    ("joint load", &[AlarmId::JointLoad]),
    (
        "transfer",
        &[
            AlarmId::WeightTransfer,
            AlarmId::TorqueTransfer,
            AlarmId::GuidePreload,
            AlarmId::PressureFolding,
        ],
    ),
    ("hole", &[AlarmId::HoleLeavesPlan, AlarmId::FrictionNearStuck]),
    ("recording", &[AlarmId::Recording]),
    ("network", &[AlarmId::Network]),
];

/// The level that the list of alarms has for some of them: ERROR for high, WARN for medium and low.
fn level_of_alarms(list: &AlarmList, ids: &[AlarmId]) -> u8 {
    let standing = ids
        .iter()
        .map(|id| find(list, id.id()))
        .filter(|alarm| [Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::ACTIVE_ACKNOWLEDGED].contains(&alarm.state));
    match standing.map(|alarm| alarm.priority).max() {
        None => DiagnosticStatus::OK,
        Some(Alarm::HIGH) => DiagnosticStatus::ERROR,
        Some(_) => DiagnosticStatus::WARN,
    }
}

/// A run in which every condition comes and goes, with an acknowledgement, a shelving and a drive at standstill: at no
/// instant does an item of `/diagnostics` have another level than its alarms, whatever the figures next to it are.
#[test]
fn diagnostics_never_contradict_the_alarms() {
    let begun = config();
    let mut conditioner = Conditioner::new(begun.inputs.rules());
    let mut book = AlarmBook::fresh(Arc::clone(&begun), 0);
    let mut conditions = NodeConditions::default();
    // Figures that would be an error by themselves throughout: they must not raise any level.
    let status = TwinStatus {
        state: TwinStatus::RUNNING,
        pace: TwinStatus::PACE_FAR_BEHIND,
        pace_factor: 0.5,
        model_quality: TwinStatus::QUALITY_POOR,
        recording_state: TwinStatus::RECORDING_FAILED,
        input_name: vec!["rotary_speed".into(), "weight_on_bit".into()],
        input_state: vec![TwinStatus::INPUT_STALE; 2],
        ..TwinStatus::default()
    };
    let motion = MotionEvidence {
        stick_slip_index: 1.5,
        shock: flexdrill_motion::ShockLevel {
            severity: Severity::Critical,
            impulse: 90.0,
            ..Default::default()
        },
        ..MotionEvidence::default()
    };
    let all_hazards = HazardKind::ALL.map(|kind| Hazard {
        severity: Severity::Critical,
        value: 9.0,
        threshold: 3.0,
        ..Hazard::calm(kind)
    });
    let mut seen: std::collections::BTreeSet<(&str, u8)> = std::collections::BTreeSet::new();
    for tenth in 0..900_i64 {
        let (now, stamp) = (tenth as f64 * 0.1, tenth * SECOND / 10);
        let bad = (200..500).contains(&tenth);
        let mut snapshot = snapshot(if bad { &all_hazards } else { &[] });
        if (300..340).contains(&tenth) {
            snapshot.hazards.drive = DriveState::RunningUp;
        }
        if [200, 500].contains(&tenth) {
            let friction = if bad {
                0.3
            } else {
                begun.contact.inner.friction_tangential
            };
            let values = [("contact.inner.friction_tangential", friction)];
            book.reconfigure(&Arc::new(begun.with_live_values("a test", values).unwrap()), &[]);
        }
        if bad {
            snapshot.quality = ModelQuality {
                level: QualityLevel::Poor,
                cause: Some(QualityCause::EnergyError),
                value: 0.7,
                bound: 0.5,
                judged: true,
                ..ModelQuality::default()
            };
        } else {
            for kind in InputKind::ALL {
                conditioner.offer(kind, 10.0, now).unwrap();
            }
        }
        let state = NodeState {
            conditioner: &conditioner,
            now,
            drivers: Default::default(),
            run_state: RunState::Running,
            failure: bad.then_some(StepFailure {
                cause: FailureCause::NotConverged,
                time: 1.5,
                step: 1e-5,
                station: 42,
                body: Body::Guide,
                value: 3.0,
            }),
            pace: PaceReading {
                level: if bad { Pace::FarBehind } else { Pace::Kept },
                factor: Some(0.5),
            },
            recording: Some(RecordingState {
                error: bad.then(|| Problem {
                    text: "no space left".to_owned(),
                    cause: "The disk is full.",
                    remedy: "Free disk space.",
                }),
                ..RecordingState::default()
            }),
            dds: Health::default(),
            namesakes: if bad {
                vec!["/flexdrill @ 10.0.0.9".to_owned()]
            } else {
                Vec::new()
            },
        };
        book.advance(stamp);
        book.observe_tool(&snapshot, stamp);
        book.observe_hole(&crate::plan::off(if bad { 1.2 } else { 0.5 }), stamp);
        conditions.observe(&mut book, &state, stamp);
        match tenth {
            250 => drop(book.request(&acknowledge("stick_slip"), stamp).unwrap()),
            260 => drop(book.request(&shelve("joint_load", 10.0), stamp).unwrap()),
            _ => {}
        }
        let list = book.list(Header::default());
        let rig = RigEvidence {
            measured: &Measured::default(),
            surveys: &Surveys::default(),
            now: 0.0,
            stamp_time: 0,
            residuals: None,
        };
        let items = diagnostics::items("n", &status, &rig, &motion, &list);
        assert_eq!(items.len(), ITEMS.len() + 1);
        for ((name, ids), item) in ITEMS.into_iter().chain([("alarms", &AlarmId::ALL[..])]).zip(&items) {
            assert_eq!(item.name, format!("n: {name}"));
            assert_eq!(
                item.level,
                level_of_alarms(&list, ids),
                "{name} at {now} s: {}",
                item.message
            );
            if item.level != DiagnosticStatus::OK {
                let named = ids
                    .iter()
                    .map(|id| find(&list, id.id()))
                    .any(|alarm| item.message.contains(&alarm.name) && item.message.contains(&alarm.evidence));
                assert!(named, "{name} at {now} s does not quote its alarm: {}", item.message);
            }
            seen.insert((name, item.level));
        }
    }
    // Every item was calm and was not: the comparison above is not empty.
    for (name, ids) in ITEMS {
        let raised = [DiagnosticStatus::WARN, DiagnosticStatus::ERROR];
        assert!(seen.contains(&(name, DiagnosticStatus::OK)), "{name} was never calm");
        assert!(
            ids.is_empty() || raised.iter().any(|level| seen.contains(&(name, *level))),
            "{name} was never raised"
        );
    }
    assert!(seen.contains(&("whirl", DiagnosticStatus::ERROR)), "{seen:?}");
}
