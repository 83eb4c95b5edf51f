//! The items of `/diagnostics` that are judged from the status: pacing, solver, inputs, recording.

use super::judgement::Judgement;
use crate::messages::diagnostic_msgs::DiagnosticStatus;
use crate::messages::{TwinStatus, words};
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

pub(super) fn pacing(status: &TwinStatus, previous: &TwinStatus) -> Judgement {
    let factor = status.pace_factor;
    let skipped = status.steps_skipped.saturating_sub(previous.steps_skipped);
    let dropped = status.frames_dropped.saturating_sub(previous.frames_dropped);
    let lost = status.events_lost.saturating_sub(previous.events_lost);
    let (level, message) = match (status.state, status.pace) {
        (TwinStatus::STARTING, _) => (DiagnosticStatus::OK, "the tool is being brought to rest".to_owned()),
        (TwinStatus::PAUSED, _) => (DiagnosticStatus::WARN, "paused: model time stands still".to_owned()),
        (TwinStatus::FAILED, _) => (DiagnosticStatus::OK, "model time stands still, see solver".to_owned()),
        (_, TwinStatus::PACE_FAR_BEHIND) => (DiagnosticStatus::ERROR, not_in_real_time(factor)),
        (_, TwinStatus::PACE_LATE) => (DiagnosticStatus::WARN, not_in_real_time(factor)),
        _ if dropped > 0 || lost > 0 => (
            DiagnosticStatus::WARN,
            format!(
                "the publisher's thread got no processor: {dropped} snapshots and {lost} changes of inputs were not published; end other programs"
            ),
        ),
        _ if skipped > 0 => (
            DiagnosticStatus::WARN,
            format!("the model was late and skipped {skipped} steps since the last report"),
        ),
        (_, TwinStatus::PACE_NOT_JUDGED) => (
            DiagnosticStatus::OK,
            "not judged yet: the model has run for less than 10 s".to_owned(),
        ),
        _ => (DiagnosticStatus::OK, "in real time".to_owned()),
    };
    Judgement {
        name: "pacing",
        level,
        message,
        values: vec![
            ("real_time_factor", format!("{:.4}", status.real_time_factor)),
            ("real_time_factor over 10 s", format!("{factor:.4}")),
            ("lateness (s)", format!("{:.6}", status.lateness)),
            ("deadline_misses", status.deadline_misses.to_string()),
            ("steps_skipped", status.steps_skipped.to_string()),
            ("steps_stood_still", status.steps_stood_still.to_string()),
            ("frames_dropped", status.frames_dropped.to_string()),
            ("events_lost", status.events_lost.to_string()),
            ("step_time_p50 (ms)", milliseconds(status.step_time_p50)),
            ("step_time_p99 (ms)", milliseconds(status.step_time_p99)),
            ("step_time_max (ms)", milliseconds(status.step_time_max)),
        ],
    }
}

pub(super) fn solver(status: &TwinStatus, previous: &TwinStatus, failure: Option<StepFailure>) -> Judgement {
    let halved = status.halved_steps.saturating_sub(previous.halved_steps);
    let steps = status.step_count.saturating_sub(previous.step_count);
    let (level, message) = if let Some(failure) = failure {
        let message = format!(
            "a step failed at model time {:.4} s: {}; the outputs stand still until the inputs change or ~/reset is called",
            failure.time, failure
        );
        (DiagnosticStatus::ERROR, message)
    } else if status.model_quality == TwinStatus::QUALITY_POOR {
        (
            DiagnosticStatus::ERROR,
            format!("the motion is not to be relied on: {}", status.model_quality_cause),
        )
    } else if steps > 0 && halved * 20 > steps {
        (
            DiagnosticStatus::WARN,
            format!("{halved} of the last {steps} steps had to be split"),
        )
    } else if status.model_quality == TwinStatus::QUALITY_DEGRADED {
        (
            DiagnosticStatus::WARN,
            format!("the motion is doubtful: {}", status.model_quality_cause),
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
            ("energy_error_share", format!("{:.3}", status.energy_error_share)),
            ("model_quality", words::model_quality(status.model_quality).to_owned()),
        ],
    }
}

pub(super) fn inputs(status: &TwinStatus) -> Judgement {
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
    let several = status.input_several_drivers.contains(&true);
    let suspect = status.input_suspect.contains(&true);
    let level = if several || suspect {
        level.max(DiagnosticStatus::WARN)
    } else {
        level
    };
    let said: Vec<String> = status
        .input_name
        .iter()
        .zip(&status.input_state)
        .enumerate()
        .map(|(index, (name, state))| {
            let flag = |flags: &[bool], words: &'static str| {
                if flags.get(index) == Some(&true) { words } else { "" }
            };
            format!(
                "{name} {}{}{}{}",
                words::input_state(*state),
                flag(&status.input_safe, ", brought to its safe value"),
                flag(&status.input_suspect, ", its source has doubts"),
                flag(&status.input_several_drivers, ", SEVERAL PUBLISHERS AT ONCE"),
            )
        })
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
        let count = |counts: &[u64]| counts.get(index).copied().unwrap_or_default();
        let publishers = status.input_publishers.get(index).map_or("", String::as_str);
        let key = ["rotary_speed publishers", "weight_on_bit publishers"][index.min(1)];
        values.push((
            key,
            format!(
                "{}; {} samples of others refused, {} unreadable{}",
                if publishers.is_empty() { "none" } else { publishers },
                count(&status.input_not_driving),
                count(&status.input_unreadable),
                match count(&status.input_overrun) {
                    0 => String::new(),
                    samples => format!(", {samples} came too fast to be taken"),
                }
            ),
        ));
    }
    Judgement {
        name: "inputs",
        level,
        message: said.join(", "),
        values,
    }
}

pub(super) fn recording(status: &TwinStatus, previous: &TwinStatus) -> Judgement {
    let lost = status.recording_drops.saturating_sub(previous.recording_drops);
    let (level, message) = match status.recording_state {
        TwinStatus::RECORDING_FAILED => (
            DiagnosticStatus::ERROR,
            format!(
                "the recording to {} stopped on an error, which the alarm tells; the twin goes on",
                status.recording_path
            ),
        ),
        TwinStatus::RECORDING_ON if lost > 0 => (
            DiagnosticStatus::WARN,
            format!(
                "{lost} messages lost since the last report; since the start {}",
                status.recording_drops_cause
            ),
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

pub(super) fn network(status: &TwinStatus, previous: &TwinStatus) -> Judgement {
    let restarts = status.dds_restarts.saturating_sub(previous.dds_restarts);
    let (level, message) = if !status.dds_up {
        (
            DiagnosticStatus::ERROR,
            format!("DDS is being started again: {}", status.dds_restart_cause),
        )
    } else if restarts > 0 {
        (
            DiagnosticStatus::WARN,
            format!("DDS was started again: {}", status.dds_restart_cause),
        )
    } else if !status.namesake.is_empty() {
        (DiagnosticStatus::WARN, another_of_this_name(&status.namesake))
    } else if !status.dds_stalled_reader.is_empty() {
        (DiagnosticStatus::WARN, status.dds_stalled_reader.clone())
    } else if status.clock_set_by != 0.0 {
        (
            DiagnosticStatus::WARN,
            format!(
                "the system's clock was set by {:+.1} s; stamps keep to the clock at the start until the node is started again",
                status.clock_set_by
            ),
        )
    } else {
        (DiagnosticStatus::OK, "up".to_owned())
    };
    Judgement {
        name: "network",
        level,
        message,
        values: vec![
            ("dds_restarts", status.dds_restarts.to_string()),
            ("clock_set_by (s)", format!("{:.1}", status.clock_set_by)),
        ],
    }
}

/// What the log, the diagnostics and the alarm say of a model that falls behind by its factor over ten seconds.
pub(crate) fn not_in_real_time(factor: f64) -> String {
    format!("not in real time: the model gained {factor:.2} s per second over the last 10 s and skipped the rest")
}

/// What the log and the diagnostics say of other nodes with this one's name.
pub(crate) fn another_of_this_name(others: &[String]) -> String {
    format!(
        "another node has the name of this one: {}; start one of them with another --namespace",
        others.join(", ")
    )
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.4}", seconds * 1e3)
}
