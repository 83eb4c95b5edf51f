//! Diagnostics and the list of alarms say the same.

use super::*;

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
