//! `/diagnostics`: items judged from the status, the newest snapshot and the alarms, with hysteresis.

use super::alarms::alarms;
use super::items::{inputs, network, pacing, recording, solver};
use super::motion::MotionEvidence;
use crate::messages::diagnostic_msgs::{DiagnosticStatus, KeyValue};
use crate::messages::{AlarmList, TwinStatus};
use flexdrill_core::dynamics::StepFailure;

/// Judgements in a row that must be better before an item's level falls.
const CALM: u32 = 3;

/// A level that rises at once and falls when things have been better for a while, with the sentence that belongs to it.
#[derive(Debug, Clone, Default)]
struct Hysteresis {
    level: u8,
    message: String,
    better: u32,
}

impl Hysteresis {
    /// The level that holds and its sentence: while a level is held, that of its last judgement, never of a better one.
    fn judge(&mut self, level: u8, message: String) -> (u8, String) {
        if level < self.level && self.better + 1 < CALM {
            self.better += 1;
            let held = format!(
                "{} (better in the last {} of {CALM} reports)",
                self.message, self.better
            );
            return (self.level, held);
        }
        *self = Self {
            level,
            message,
            better: 0,
        };
        (level, self.message.clone())
    }
}

/// Keeps what the next judgement needs.
#[derive(Debug, Default)]
pub struct Diagnostics {
    levels: [Hysteresis; 9],
    previous: Option<TwinStatus>,
}

/// What beside the status is judged.
#[derive(Debug, Clone, Default)]
pub struct Evidence {
    /// Cause and place of the failed step, while the model stands still.
    pub failure: Option<StepFailure>,
    /// What the analysis says of the motion.
    pub motion: MotionEvidence,
    /// The alarms as they stand.
    pub alarms: AlarmList,
}

impl Diagnostics {
    /// Judges the present status. `node` names the items: `node: pacing`.
    pub fn judge(&mut self, node: &str, status: &TwinStatus, evidence: &Evidence) -> Vec<DiagnosticStatus> {
        let previous = self.previous.replace(status.clone()).unwrap_or_else(|| status.clone());
        let judgements = [
            pacing(status, &previous),
            solver(status, &previous, evidence.failure),
            inputs(status),
            evidence.motion.whirl(),
            evidence.motion.stick_slip(),
            evidence.motion.shock(),
            recording(status, &previous),
            network(status, &previous),
            alarms(&evidence.alarms),
        ];
        judgements
            .into_iter()
            .zip(&mut self.levels)
            .map(|(judgement, hysteresis)| {
                let (level, message) = hysteresis.judge(judgement.level, judgement.message);
                DiagnosticStatus {
                    level,
                    name: format!("{node}: {}", judgement.name),
                    message,
                    hardware_id: "flexdrill".into(),
                    values: judgement
                        .values
                        .into_iter()
                        .map(|(key, value)| KeyValue { key: key.into(), value })
                        .collect(),
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_core::dynamics::FailureCause;
    use flexdrill_core::tool::Body;

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

    fn level(items: &[DiagnosticStatus], name: &str) -> u8 {
        items.iter().find(|item| item.name.ends_with(name)).unwrap().level
    }

    #[test]
    fn inputs_say_who_sends_and_how_they_are() {
        let status = TwinStatus {
            input_several_drivers: vec![true, false],
            input_suspect: vec![false, true],
            input_publishers: vec!["/rig @ 10.0.0.7 (0a), /player @ 10.0.0.9 (0b)".into(), String::new()],
            input_not_driving: vec![7, 0],
            input_unreadable: vec![0, 3],
            ..running()
        };
        let items = Diagnostics::default().judge("n", &status, &Evidence::default());
        assert_eq!(level(&items, "inputs"), DiagnosticStatus::WARN);
        let item = items.iter().find(|item| item.name.ends_with("inputs")).unwrap();
        assert_eq!(
            item.message,
            "rotary_speed ok, SEVERAL PUBLISHERS AT ONCE, weight_on_bit ok, its source has doubts"
        );
        let said: Vec<&str> = item.values.iter().map(|value| value.value.as_str()).collect();
        assert!(
            said[1].starts_with("/rig @ 10.0.0.7 (0a), /player") && said[1].contains("7 samples of others"),
            "{said:?}"
        );
        assert_eq!(said[3], "none; 0 samples of others refused, 3 unreadable");
    }

    #[test]
    fn levels_rise_at_once_and_fall_after_a_while_with_the_sentence_that_belongs_to_them() {
        let mut diagnostics = Diagnostics::default();
        let mut pacing = |status: &TwinStatus| {
            let items = diagnostics.judge("n", status, &Evidence::default());
            let item = items.into_iter().find(|item| item.name == "n: pacing").unwrap();
            (item.level, item.message)
        };
        let late = TwinStatus {
            pace: TwinStatus::PACE_FAR_BEHIND,
            pace_factor: 0.5,
            ..running()
        };
        let (in_time, not_in_time) = ("in real time".to_owned(), crate::health::not_in_real_time(0.5));
        assert_eq!(pacing(&running()), (DiagnosticStatus::OK, in_time.clone()));
        assert_eq!(pacing(&late), (DiagnosticStatus::ERROR, not_in_time.clone()));
        for report in 1..CALM {
            let held = format!("{not_in_time} (better in the last {report} of {CALM} reports)");
            assert_eq!(pacing(&running()), (DiagnosticStatus::ERROR, held));
        }
        assert_eq!(pacing(&running()), (DiagnosticStatus::OK, in_time));
    }

    #[test]
    fn a_pause_and_the_first_seconds_after_it_are_no_lateness() {
        let mut diagnostics = Diagnostics::default();
        let mut level_of = |status: TwinStatus| level(&diagnostics.judge("n", &status, &Evidence::default()), "pacing");
        assert_eq!(level_of(running()), DiagnosticStatus::OK);
        let resumed = TwinStatus {
            real_time_factor: f64::NAN,
            pace_factor: f64::NAN,
            pace: TwinStatus::PACE_NOT_JUDGED,
            steps_stood_still: 5000,
            ..running()
        };
        assert_eq!(level_of(resumed), DiagnosticStatus::OK);
    }

    #[test]
    fn a_failure_is_reported_with_cause_and_place() {
        let failure = StepFailure {
            cause: FailureCause::NotConverged,
            time: 1.5,
            step: 1e-5,
            station: 42,
            body: Body::Guide,
            value: 3.0,
        };
        let evidence = Evidence {
            failure: Some(failure),
            ..Evidence::default()
        };
        let items = Diagnostics::default().judge(
            "n",
            &TwinStatus {
                state: TwinStatus::FAILED,
                ..running()
            },
            &evidence,
        );
        let solver = items.iter().find(|item| item.name == "n: solver").unwrap();
        assert_eq!(solver.level, DiagnosticStatus::ERROR);
        for part in ["station 42", "guide pipe", "did not converge", "~/reset"] {
            assert!(solver.message.contains(part), "{}", solver.message);
        }
    }

    #[test]
    fn a_motion_that_is_not_the_tools_is_an_error_with_its_cause() {
        let said = |quality| {
            let status = TwinStatus {
                model_quality: quality,
                model_quality_cause: "energy errors of the steps come to 56 %".into(),
                // Of the drive's work: what most of a run's errors look like from there.
                energy_error_ratio: 0.0008,
                ..running()
            };
            let items = Diagnostics::default().judge("n", &status, &Evidence::default());
            items.into_iter().find(|item| item.name == "n: solver").unwrap()
        };
        assert_eq!(said(TwinStatus::QUALITY_GOOD).message, "converging");
        let degraded = said(TwinStatus::QUALITY_DEGRADED);
        assert_eq!(degraded.level, DiagnosticStatus::WARN);
        assert!(
            degraded.message.contains("doubtful: energy errors"),
            "{}",
            degraded.message
        );
        let poor = said(TwinStatus::QUALITY_POOR);
        assert_eq!(poor.level, DiagnosticStatus::ERROR);
        assert!(poor.message.contains("56 %"), "{}", poor.message);
        assert!(
            poor.values
                .iter()
                .any(|pair| pair.key == "model_quality" && pair.value == "poor")
        );
    }

    #[test]
    fn the_worse_input_counts() {
        let stale = TwinStatus {
            input_state: vec![TwinStatus::INPUT_OK, TwinStatus::INPUT_STALE],
            ..running()
        };
        let items = Diagnostics::default().judge("n", &stale, &Evidence::default());
        assert_eq!(level(&items, "inputs"), DiagnosticStatus::ERROR);
        assert!(items.iter().any(|item| item.message.contains("weight_on_bit stale")));
    }
}
