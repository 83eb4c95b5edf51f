//! Whatever the motion is, texts are whole sentences without a number that was not measured.

use super::*;

/// Any number at all.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(f64::NEG_INFINITY),
        -10.0..10.0,
    ]
}

fn any_severity() -> impl Strategy<Value = Severity> {
    prop_oneof![
        Just(Severity::Ok),
        Just(Severity::Watch),
        Just(Severity::Warning),
        Just(Severity::Critical)
    ]
}

fn any_hold() -> impl Strategy<Value = Hold> {
    prop_oneof![
        2 => Just(Hold::Met),
        1 => (any_severity(), any_number()).prop_map(|(severity, since)| Hold::Less { severity, since }),
        1 => any_number().prop_map(|at| Hold::Ended { at }),
    ]
}

fn any_hazard(kind: HazardKind) -> impl Strategy<Value = Hazard> {
    (
        any_severity(),
        proptest::array::uniform8(any_number()),
        proptest::array::uniform4(any_number()),
        proptest::option::of((any_number(), any_number(), any::<bool>())),
        any_hold(),
        any_number(),
    )
        .prop_map(move |(severity, a, b, place, hold, least_speed)| Hazard {
            kind,
            severity,
            place: place.map(|(measured_depth, inclination, pipe)| ToolLocation {
                station: 0,
                body: if pipe { Body::Pipe } else { Body::Guide },
                measured_depth,
                inclination,
            }),
            value: a[0],
            threshold: a[1],
            whirl_ratio: a[2],
            rolling_share: a[3],
            orbit_speed: a[4],
            impulse: a[5],
            impact_rate: a[6],
            friction_power: a[7],
            confidence: b[0],
            since: b[1],
            seen: b[2],
            hold,
            least_speed,
        })
}

pub(crate) fn any_snapshot() -> impl Strategy<Value = Snapshot> {
    let hazards: Vec<_> = HazardKind::ALL.into_iter().map(any_hazard).collect();
    (
        hazards,
        any::<bool>(),
        proptest::array::uniform5(any_number()),
        any::<bool>(),
    )
        .prop_map(|(hazards, turning, a, poor)| {
            let mut snapshot = snapshot(0.0, 0.0, &hazards);
            snapshot.hazards.drive = if turning {
                DriveState::Turning
            } else {
                DriveState::RunningUp
            };
            (
                snapshot.time,
                snapshot.applied.rotary_speed,
                snapshot.applied.weight_on_bit,
            ) = (a[0], a[1], a[2]);
            snapshot.quality = ModelQuality {
                level: if poor { QualityLevel::Poor } else { QualityLevel::Good },
                cause: Some(QualityCause::EnergyError),
                value: a[3],
                bound: a[4],
                judged: true,
                ..ModelQuality::default()
            };
            snapshot
        })
}

/// Whether a text has a number that was not measured.
fn is_readable(text: &str) -> bool {
    let lower = text.to_lowercase();
    let words = lower.split(|letter: char| !letter.is_alphanumeric());
    words.clone().all(|word| word != "nan" && word != "inf" && word != "infinity")
        // Longer than any measurement: 1e300 in full.
        && words.clone().all(|word| word.len() < 24)
        && !lower.contains("-0 ")
}

/// Whether a text is for a driller: no file, parameter, topic or mesh.
fn is_for_a_driller(text: &str) -> bool {
    let dotted = |word: &str| {
        let (before, after) = word.split_once('.').unwrap_or(("", ""));
        before.chars().next_back().is_some_and(char::is_alphabetic)
            && after.chars().next().is_some_and(char::is_alphabetic)
    };
    !text.contains('_')
        && !text.contains("~/")
        && !text.contains("--")
        && !text.to_lowercase().contains("mesh")
        && !text.split(' ').any(dotted)
}

fn check(list: &AlarmList, events: &[AlarmEvent]) -> Result<(), TestCaseError> {
    for alarm in &list.alarms {
        let texts = [
            &alarm.evidence,
            &alarm.cause,
            &alarm.consequence,
            &alarm.what_to_do,
            &alarm.what_the_engineer_can_do,
        ];
        for text in texts {
            prop_assert!(is_readable(text), "{}: {text}", alarm.id);
            prop_assert!(text.is_empty() || text.ends_with('.'), "{}: {text}", alarm.id);
        }
        prop_assert!(
            is_for_a_driller(&alarm.what_to_do),
            "{}: {}",
            alarm.id,
            alarm.what_to_do
        );
        if alarm.active && alarm.priority > Alarm::NO_PRIORITY {
            prop_assert!(!alarm.what_to_do.is_empty(), "{} has no action", alarm.id);
        }
    }
    for event in events {
        for text in [&event.evidence, &event.what_to_do, &event.what_the_engineer_can_do] {
            prop_assert!(is_readable(text), "{}: {text}", event.id);
        }
        prop_assert!(
            is_for_a_driller(&event.what_to_do),
            "{}: {}",
            event.id,
            event.what_to_do
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn no_text_has_a_number_that_was_not_measured(snapshots in proptest::collection::vec(any_snapshot(), 1..6)) {
        let mut book = AlarmBook::fresh(config(), 0);
        let mut time = 0;
        for snapshot in &snapshots {
            for _ in 0..4 {
                time += SECOND;
                book.advance(time);
                book.observe_tool(snapshot, time);
                let (list, events) = said(&mut book);
                check(&list, &events)?;
            }
        }
    }

    #[test]
    fn no_text_of_the_node_has_one_either(
        level in prop_oneof![Just(Pace::Kept), Just(Pace::Late), Just(Pace::FarBehind)],
        factor in proptest::option::of(any_number()),
        now in 0.0..1e6,
        too_slow in any::<u32>(),
        error in any::<bool>(),
    ) {
        let config = config();
        let conditioner = Conditioner::new(config.inputs.rules());
        let mut book = AlarmBook::fresh(config, 0);
        let mut conditions = NodeConditions::default();
        for second in 0..30 {
            let state = NodeState {
                conditioner: &conditioner,
                now: now + 60.0 * f64::from(second),
                drivers: Default::default(),
                run_state: RunState::Running,
                failure: None,
                pace: PaceReading { level, factor },
                recording: Some(RecordingState {
                    error: error.then(|| Problem {
                        text: "no space left".to_owned(),
                        cause: "The disk is full.",
                        remedy: "Free disk space.",
                    }),
                    notice: None,
                    losses: Losses {
                        too_slow: u64::from(too_slow),
                        ..Losses::default()
                    },
                }),
                dds: Health::default(),
                namesakes: Vec::new(),
            };
            conditions.observe(&mut book, &state, i64::from(second) * SECOND);
            let (list, events) = said(&mut book);
            check(&list, &events)?;
        }
    }
}
