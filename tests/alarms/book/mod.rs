//! From hazards and the node's state to alarms, their words, and what is kept over a restart; the alarms of a replay.

mod agreement;
mod node;

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
