//! `/diagnostics`: seven items judged from the status and the newest snapshot, with hysteresis.

use super::motion::MotionEvidence;
use crate::messages::TwinStatus;
use crate::messages::diagnostic_msgs::{DiagnosticStatus, KeyValue};
use flexdrill_core::dynamics::outcome::StepFailure;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// Judgements in a row that must be better before an item's level falls.
const CALM: u32 = 3;
/// Below this real-time factor the model does not keep up.
const KEEPS_UP: f64 = 0.98;
/// Below this it is far behind.
const FAR_BEHIND: f64 = 0.9;
/// An energy error above this part of the drive's work makes the motion doubtful.
const DOUBTFUL_ENERGY: f64 = 0.02;
/// The error means nothing before the drive has done some work (J).
const LITTLE_WORK: f64 = 1.0;

/// A level that rises at once and falls when things have been better for a while.
#[derive(Debug, Clone, Copy, Default)]
struct Hysteresis {
    level: u8,
    better: u32,
}

impl Hysteresis {
    fn judge(&mut self, level: u8) -> u8 {
        if level >= self.level {
            *self = Self { level, better: 0 };
        } else {
            self.better += 1;
            if self.better >= CALM {
                *self = Self { level, better: 0 };
            }
        }
        self.level
    }
}

/// Keeps what the next judgement needs.
#[derive(Debug, Default)]
pub struct Diagnostics {
    levels: [Hysteresis; 7],
    previous: Option<TwinStatus>,
}

/// What beside the status is judged.
#[derive(Debug, Clone, Copy, Default)]
pub struct Evidence {
    /// Cause and place of the failed step, while the model stands still.
    pub failure: Option<StepFailure>,
    /// What the analysis says of the motion.
    pub motion: MotionEvidence,
}

pub(super) struct Judgement {
    pub(super) name: &'static str,
    pub(super) level: u8,
    pub(super) message: String,
    pub(super) values: Vec<(&'static str, String)>,
}

impl Diagnostics {
    /// Judges the present status. `node` names the items: `node: pacing`.
    pub fn judge(&mut self, node: &str, status: &TwinStatus, evidence: &Evidence) -> Vec<DiagnosticStatus> {
        let previous = self.previous.replace(status.clone()).unwrap_or_else(|| status.clone());
        let judgements = [
            pacing(status, &previous),
            solver(status, &previous, evidence),
            inputs(status),
            evidence.motion.whirl(),
            evidence.motion.stick_slip(),
            evidence.motion.shock(),
            recording(status, &previous),
        ];
        judgements
            .into_iter()
            .zip(&mut self.levels)
            .map(|(judgement, hysteresis)| {
                let level = hysteresis.judge(judgement.level);
                let message = if level > judgement.level {
                    format!("{} (better now, was worse a moment ago)", judgement.message)
                } else {
                    judgement.message
                };
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

fn pacing(status: &TwinStatus, previous: &TwinStatus) -> Judgement {
    let factor = status.real_time_factor;
    let skipped = status.steps_skipped.saturating_sub(previous.steps_skipped);
    let (level, message) = match status.state {
        TwinStatus::STARTING => (DiagnosticStatus::OK, "the tool is being brought to rest".to_owned()),
        TwinStatus::PAUSED => (DiagnosticStatus::WARN, "paused: model time stands still".to_owned()),
        TwinStatus::FAILED => (DiagnosticStatus::OK, "model time stands still, see solver".to_owned()),
        _ if factor < FAR_BEHIND => (
            DiagnosticStatus::ERROR,
            format!(
                "not in real time: the model gains {factor:.2} s per second; take a coarser mesh or a faster machine"
            ),
        ),
        _ if factor < KEEPS_UP || skipped > 0 => (
            DiagnosticStatus::WARN,
            format!("late: {skipped} steps skipped since the last report, factor {factor:.3}"),
        ),
        _ => (DiagnosticStatus::OK, "in real time".to_owned()),
    };
    Judgement {
        name: "pacing",
        level,
        message,
        values: vec![
            ("real_time_factor", format!("{factor:.4}")),
            ("lateness (s)", format!("{:.6}", status.lateness)),
            ("deadline_misses", status.deadline_misses.to_string()),
            ("steps_skipped", status.steps_skipped.to_string()),
            ("step_time_p50 (ms)", milliseconds(status.step_time_p50)),
            ("step_time_p99 (ms)", milliseconds(status.step_time_p99)),
            ("step_time_max (ms)", milliseconds(status.step_time_max)),
        ],
    }
}

fn solver(status: &TwinStatus, previous: &TwinStatus, evidence: &Evidence) -> Judgement {
    let halved = status.halved_steps.saturating_sub(previous.halved_steps);
    let steps = status.step_count.saturating_sub(previous.step_count);
    let (level, message) = if let Some(failure) = evidence.failure {
        let message = format!(
            "a step failed at model time {:.4} s: {}; the outputs stand still until the inputs change or ~/reset is called",
            failure.time,
            describe(&failure)
        );
        (DiagnosticStatus::ERROR, message)
    } else if steps > 0 && halved * 20 > steps {
        (
            DiagnosticStatus::WARN,
            format!("{halved} of the last {steps} steps had to be split"),
        )
    } else if status.energy_error_ratio > DOUBTFUL_ENERGY && status.energy_error.abs() > LITTLE_WORK {
        (
            DiagnosticStatus::WARN,
            format!(
                "the energy balance is off by {:.1} % of the drive's work",
                100.0 * status.energy_error_ratio
            ),
        )
    } else {
        (DiagnosticStatus::OK, "converging".to_owned())
    };
    Judgement {
        name: "solver",
        level,
        message,
        values: vec![
            (
                "newton_iterations_mean",
                format!("{:.2}", status.newton_iterations_mean),
            ),
            ("rejected_steps", status.rejected_steps.to_string()),
            ("halved_steps", status.halved_steps.to_string()),
            ("failed_steps", status.failed_steps.to_string()),
            ("last_rejection_cause", status.last_rejection_cause.clone()),
            ("last_rejection_station", status.last_rejection_station.to_string()),
            ("energy_error (J)", format!("{:.3}", status.energy_error)),
            ("energy_error_ratio", format!("{:.2e}", status.energy_error_ratio)),
        ],
    }
}

/// Cause and place of a failed step in words.
pub fn describe(failure: &StepFailure) -> String {
    let cause = match failure.cause {
        flexdrill_core::dynamics::outcome::FailureCause::NotConverged => "Newton's iterations did not converge",
        flexdrill_core::dynamics::outcome::FailureCause::NotFinite => "a number is not finite",
        flexdrill_core::dynamics::outcome::FailureCause::Singular => "the linear system is singular",
        flexdrill_core::dynamics::outcome::FailureCause::OutOfRange => "a displacement or tilt left the model's range",
    };
    let body = match failure.body {
        flexdrill_core::tool::Body::Pipe => "pipe",
        flexdrill_core::tool::Body::Guide => "guide pipe",
    };
    format!(
        "{cause} (station {} of the {body}, worst value {:.3e}, sub-step {:.3e} s)",
        failure.station, failure.value, failure.step
    )
}

fn inputs(status: &TwinStatus) -> Judgement {
    let words = ["not received yet", "ok", "slow", "stale", "rejected"];
    let level_of = |state: u8| match state {
        TwinStatus::INPUT_OK => DiagnosticStatus::OK,
        TwinStatus::INPUT_STALE => DiagnosticStatus::ERROR,
        _ => DiagnosticStatus::WARN,
    };
    let level = status
        .input_state
        .iter()
        .map(|state| level_of(*state))
        .max()
        .unwrap_or(DiagnosticStatus::OK);
    let word = |state: u8| words.get(usize::from(state)).copied().unwrap_or("unknown");
    let said: Vec<String> = status
        .input_name
        .iter()
        .zip(&status.input_state)
        .map(|(name, state)| format!("{name} {}", word(*state)))
        .collect();
    let mut values = Vec::new();
    for index in 0..status.input_name.len() {
        let get = |values: &[f64]| values.get(index).copied().unwrap_or(f64::NAN);
        let rejected = status.input_rejected.get(index).copied().unwrap_or_default();
        let (received, applied) = (get(&status.input_received), get(&status.input_applied));
        let shown = if index == 0 {
            format!(
                "received {:.2} r/min, applied {:.2} r/min",
                rad_per_s_to_rpm(received),
                rad_per_s_to_rpm(applied)
            )
        } else {
            format!(
                "received {:.2} kN, applied {:.2} kN",
                n_to_kn(received),
                n_to_kn(applied)
            )
        };
        let key = if index == 0 { "rotary_speed" } else { "weight_on_bit" };
        values.push((
            key,
            format!("{shown}, age {:.2} s, {rejected} refused", get(&status.input_age)),
        ));
    }
    Judgement {
        name: "inputs",
        level,
        message: said.join(", "),
        values,
    }
}

fn recording(status: &TwinStatus, previous: &TwinStatus) -> Judgement {
    let lost = status.recording_drops.saturating_sub(previous.recording_drops);
    let (level, message) = match status.recording_state {
        TwinStatus::RECORDING_FAILED => (
            DiagnosticStatus::ERROR,
            format!(
                "the recording to {} stopped on an error; the twin goes on",
                status.recording_path
            ),
        ),
        TwinStatus::RECORDING_ON if lost > 0 => (
            DiagnosticStatus::WARN,
            format!("{lost} messages lost: the disk is too slow"),
        ),
        TwinStatus::RECORDING_ON => (DiagnosticStatus::OK, format!("recording to {}", status.recording_path)),
        _ => (DiagnosticStatus::OK, "not recording".to_owned()),
    };
    Judgement {
        name: "recording",
        level,
        message,
        values: vec![
            ("messages", status.recording_messages.to_string()),
            ("drops", status.recording_drops.to_string()),
        ],
    }
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.4}", seconds * 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn running() -> TwinStatus {
        TwinStatus {
            state: TwinStatus::RUNNING,
            real_time_factor: 1.0,
            input_name: vec!["rotary_speed".into(), "weight_on_bit".into()],
            input_state: vec![TwinStatus::INPUT_OK; 2],
            input_age: vec![0.1; 2],
            input_received: vec![1.0; 2],
            input_applied: vec![1.0; 2],
            input_rejected: vec![0; 2],
            ..TwinStatus::default()
        }
    }

    fn level(items: &[DiagnosticStatus], name: &str) -> u8 {
        items.iter().find(|item| item.name.ends_with(name)).unwrap().level
    }

    #[test]
    fn levels_rise_at_once_and_fall_after_a_while() {
        let mut diagnostics = Diagnostics::default();
        let evidence = Evidence::default();
        assert_eq!(level(&diagnostics.judge("n", &running(), &evidence), "pacing"), 0);
        let late = TwinStatus {
            real_time_factor: 0.5,
            ..running()
        };
        assert_eq!(level(&diagnostics.judge("n", &late, &evidence), "pacing"), 2);
        assert_eq!(level(&diagnostics.judge("n", &running(), &evidence), "pacing"), 2);
        assert_eq!(level(&diagnostics.judge("n", &running(), &evidence), "pacing"), 2);
        assert_eq!(level(&diagnostics.judge("n", &running(), &evidence), "pacing"), 0);
    }

    #[test]
    fn a_failure_is_told_with_cause_and_place() {
        let failure = StepFailure {
            cause: flexdrill_core::dynamics::outcome::FailureCause::NotConverged,
            time: 1.5,
            step: 1e-5,
            station: 42,
            body: flexdrill_core::tool::Body::Guide,
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
