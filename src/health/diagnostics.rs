//! `/diagnostics`: the alarms, grouped into items, each with the figures that belong to it. The alarms alone decide the
//! levels, with their own delays, so that a dashboard of diagnostics never contradicts the list of alarms.

use super::alarms::alarms;
use super::items::{configuration, inputs, measured, network, pacing, recording, solver, surveys};
use super::motion::MotionEvidence;
use crate::messages::diagnostic_msgs::DiagnosticStatus;
use crate::messages::{AlarmList, Residuals, TwinStatus};
use crate::rig_inputs::{Measured, Surveys};

/// What is known of the rig besides its inputs.
#[derive(Debug)]
pub struct RigEvidence<'a> {
    /// What it measured.
    pub measured: &'a Measured,
    /// Its surveys of the hole.
    pub surveys: &'a Surveys,
    /// The present instant of the conditioner's clock (s).
    pub now: f64,
    /// The present instant of the stamps (ns since 1970).
    pub stamp_time: i64,
    /// The newest comparison with the twin.
    pub residuals: Option<&'a Residuals>,
}

/// All items. `node` is the prefix of their names, as in `node: pacing`.
pub fn items(
    node: &str,
    status: &TwinStatus,
    rig: &RigEvidence<'_>,
    motion: &MotionEvidence,
    list: &AlarmList,
) -> Vec<DiagnosticStatus> {
    let items = [
        pacing(status),
        solver(status),
        inputs(status),
        measured(rig),
        surveys(rig),
        configuration(status),
        motion.whirl(),
        motion.stick_slip(),
        motion.shock(),
        motion.joint_load(),
        motion.transfer(),
        MotionEvidence::hole(),
        recording(status),
        network(status),
    ];
    items
        .into_iter()
        .map(|item| item.with(list))
        .chain([alarms(list)])
        .map(|item| DiagnosticStatus {
            name: format!("{node}: {}", item.name),
            hardware_id: "flexdrill".into(),
            ..item
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alarms::AlarmId;
    use crate::messages::Alarm;

    fn running() -> TwinStatus {
        TwinStatus {
            state: TwinStatus::RUNNING,
            real_time_factor: 1.0,
            pace: TwinStatus::PACE_KEPT,
            pace_factor: 1.0,
            input_name: vec!["rotary_speed".into(), "weight_on_bit".into()],
            input_state: vec![TwinStatus::INPUT_OK; 2],
            input_age: vec![0.1; 2],
            input_received: vec![1.0; 2],
            input_applied: vec![1.0; 2],
            input_rejected: vec![0; 2],
            dds_up: true,
            ..TwinStatus::default()
        }
    }

    /// Of a rig that has sent nothing.
    fn nothing<'a>(measured: &'a Measured, surveys: &'a Surveys) -> RigEvidence<'a> {
        RigEvidence {
            measured,
            surveys,
            now: 0.0,
            stamp_time: 0,
            residuals: None,
        }
    }

    fn item(name: &str, status: &TwinStatus, alarms: &[Alarm]) -> DiagnosticStatus {
        let list = AlarmList {
            alarms: alarms.to_vec(),
            ..AlarmList::default()
        };
        let items = items(
            "n",
            status,
            &nothing(&Measured::default(), &Surveys::default()),
            &MotionEvidence::default(),
            &list,
        );
        items
            .into_iter()
            .find(|item| item.name == format!("n: {name}"))
            .unwrap()
    }

    fn alarm(id: &str, state: u8, priority: u8) -> Alarm {
        Alarm {
            id: id.into(),
            name: id.replace('_', " "),
            state,
            priority,
            evidence: "The evidence.".into(),
            ..Alarm::default()
        }
    }

    #[test]
    fn without_an_alarm_the_figures_speak_and_the_level_is_ok() {
        let status = TwinStatus {
            input_several_drivers: vec![true, false],
            input_suspect: vec![false, true],
            input_publishers: vec!["/rig @ 10.0.0.7 (0a), /player @ 10.0.0.9 (0b)".into(), String::new()],
            input_not_driving: vec![7, 0],
            input_unreadable: vec![0, 3],
            ..running()
        };
        let item = item("inputs", &status, &[]);
        assert_eq!(item.level, DiagnosticStatus::OK);
        assert_eq!(
            item.message,
            "rotary_speed ok, SEVERAL PUBLISHERS AT ONCE, weight_on_bit ok, marked suspect by its source"
        );
        let values: Vec<&str> = item.values.iter().map(|pair| pair.value.as_str()).collect();
        assert!(
            values[1].starts_with("/rig @ 10.0.0.7 (0a), /player") && values[1].contains("7 samples of others"),
            "{values:?}"
        );
        assert_eq!(values[3], "none; 0 samples of others refused, 3 unreadable");
    }

    #[test]
    fn an_alarm_gives_its_item_the_level_and_the_text() {
        let status = TwinStatus {
            pace: TwinStatus::PACE_FAR_BEHIND,
            pace_factor: 0.5,
            ..running()
        };
        // The alarm's delay is not over.
        let before = item(
            "pacing",
            &status,
            &[alarm("real_time", Alarm::NORMAL, Alarm::NO_PRIORITY)],
        );
        assert_eq!(before.level, DiagnosticStatus::OK);
        assert!(
            before
                .message
                .starts_with("not in real time: the model advanced 0.50 s")
        );
        let late = item(
            "pacing",
            &status,
            &[alarm("real_time", Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::MEDIUM)],
        );
        assert_eq!(late.level, DiagnosticStatus::WARN);
        assert_eq!(late.message, "MEDIUM real time (active, unacknowledged): The evidence.");
        let state = late.values.iter().find(|pair| pair.key == "alarm real_time").unwrap();
        assert_eq!(state.value, "medium, active, unacknowledged");
        // The alarm's off-delay is not over: the item does not clear before the alarm.
        let held = item(
            "pacing",
            &running(),
            &[alarm("real_time", Alarm::ACTIVE_ACKNOWLEDGED, Alarm::MEDIUM)],
        );
        assert_eq!(held.level, DiagnosticStatus::WARN);
        let shelved = item(
            "pacing",
            &running(),
            &[alarm("real_time", Alarm::SHELVED, Alarm::MEDIUM)],
        );
        assert_eq!(
            (shelved.level, shelved.message.as_str()),
            (DiagnosticStatus::OK, "in real time (shelved: real time)")
        );
    }

    /// An alarm without an item would leave `/diagnostics` OK while it stands.
    #[test]
    fn every_alarm_belongs_to_one_item() {
        for id in AlarmId::ALL {
            let list = AlarmList {
                alarms: vec![alarm(id.id(), Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::HIGH)],
                ..AlarmList::default()
            };
            let items = items(
                "n",
                &running(),
                &nothing(&Measured::default(), &Surveys::default()),
                &MotionEvidence::default(),
                &list,
            );
            let bad = items.iter().filter(|item| item.level == DiagnosticStatus::ERROR);
            let names: Vec<&str> = bad.map(|item| item.name.as_str()).collect();
            assert!(names.len() == 2 && names[1] == "n: alarms", "{}: {names:?}", id.id());
        }
    }

    #[test]
    fn several_alarms_of_an_item_are_all_named_and_the_worst_decides() {
        let alarms = [
            alarm("weight_on_bit_input", Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::HIGH),
            alarm("two_drivers", Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::MEDIUM),
            alarm("shock", Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::HIGH),
        ];
        let inputs = item("inputs", &running(), &alarms);
        assert_eq!(inputs.level, DiagnosticStatus::ERROR);
        assert!(
            inputs.message.contains("HIGH weight on bit input") && inputs.message.contains("MEDIUM two drivers"),
            "{}",
            inputs.message
        );
        assert_eq!(item("solver", &running(), &alarms).level, DiagnosticStatus::OK);
    }

    /// One survey in order, a late one, one below the bit, one in degrees, and one that waits.
    #[test]
    fn surveys_are_counted_and_the_last_refusal_is_there() {
        let text = include_str!("../../config/default.yaml").replace("\nwell:\n", "\nwell:\n  kick_off_depth: 2000\n");
        let mut surveys = Surveys::new(&flexdrill_config::Config::from_text("a deep kick-off", &text).unwrap());
        let measured = Measured::default();
        let shown = |surveys: &Surveys| {
            let rig = RigEvidence {
                stamp_time: 1_000_045_000_000_000,
                ..nothing(&measured, surveys)
            };
            let list = AlarmList::default();
            let all = items("n", &running(), &rig, &MotionEvidence::default(), &list);
            let item = all.into_iter().find(|item| item.name == "n: surveys").unwrap();
            let value = |key: &str| {
                let pair = item.values.iter().find(|pair| pair.key == key);
                pair.unwrap_or_else(|| panic!("{key}")).value.clone()
            };
            let keys = [
                "accepted",
                "refused",
                "late",
                "waiting",
                "age of the newest (s)",
                "last refusal",
            ];
            (item.message.clone(), keys.map(value))
        };
        let (calm, values) = shown(&surveys);
        assert_eq!(calm, "no survey of the hole is known");
        assert_eq!(values, ["0", "0", "0", "0", "not measured", "none"]);

        let mut send = |depth: f64, inclination: f64| {
            let message = crate::messages::RigSurvey {
                header: crate::messages::std_msgs::Header {
                    stamp: crate::messages::builtin_interfaces::Time::from_nanoseconds(1_000_000_000_000_000),
                    ..Default::default()
                },
                measured_depth: depth,
                inclination,
                azimuth: f64::NAN,
                ..Default::default()
            };
            surveys.accept(&message, 1_000_000_000_000_000, 0.5).is_ok()
        };
        assert!(send(2004.0, 1.2) && send(2003.0, 1.0) && send(2006.0, 1.6));
        assert!(!send(2004.5, 70.0) && !send(1999.0, 0.1));
        let (calm, values) = shown(&surveys);
        assert_eq!(
            calm,
            "2 surveys of the hole, the deepest at 2004.00 m, the newest 45 s old; 1 below the bit waits for the hole as drilled"
        );
        assert_eq!(values[..5], ["3", "2", "1", "1", "45"]);
        assert!(values[5].contains("measured_depth = 1999.00 m"), "{}", values[5]);
    }

    #[test]
    fn a_figure_that_was_not_measured_is_not_a_number() {
        let resumed = TwinStatus {
            real_time_factor: f64::NAN,
            pace_factor: f64::NAN,
            pace: TwinStatus::PACE_NOT_JUDGED,
            steps_stood_still: 5000,
            input_state: vec![TwinStatus::INPUT_NOT_RECEIVED; 2],
            input_age: vec![f64::NAN; 2],
            input_received: vec![f64::NAN; 2],
            ..running()
        };
        let motion = MotionEvidence {
            stick_slip_index: f64::NAN,
            ..MotionEvidence::default()
        };
        let items = items(
            "n",
            &resumed,
            &nothing(&Measured::default(), &Surveys::default()),
            &motion,
            &AlarmList::default(),
        );
        for item in &items {
            let values = item.values.iter().map(|pair| &pair.value);
            for text in values.chain([&item.message]) {
                assert!(!text.contains("NaN"), "{}: {text}", item.name);
            }
        }
        assert_eq!(items[0].message, "not judged yet: the model has run for less than 10 s");
    }
}
