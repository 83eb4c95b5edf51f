//! Alarms on inputs, pace, recording and the computer of a node.

use super::*;

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

/// The alarm itself says whether it is for the driller or for whoever runs the computer.
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
