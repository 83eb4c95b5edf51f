//! The items of `/diagnostics` whose figures are in the status: pacing, solver, inputs, recording, network.

use super::conditions::{another_of_this_name, not_in_real_time};
use super::diagnostics::RigEvidence;
use super::item::{Item, figure, figure_in};
use crate::alarms::AlarmId;
use crate::messages::{Residuals, TwinStatus};
use flexdrill_core::inputs::{InputKind, MeasuredKind};
use flexdrill_outputs::words;
use flexdrill_text::counted;

/// Said of a rig whose measured values were not compared with the twin yet.
const NOT_COMPARED: &str = "nothing: rig and twin were not compared yet";

pub(super) fn pacing(status: &TwinStatus) -> Item {
    let calm = match (status.state, status.pace) {
        (TwinStatus::STARTING, _) => "starting: the model computes the tool at rest".to_owned(),
        (TwinStatus::PAUSED, _) => "paused on request: model time does not advance".to_owned(),
        (TwinStatus::FAILED, _) => "the model has stopped; see the item solver".to_owned(),
        (_, TwinStatus::PACE_LATE | TwinStatus::PACE_FAR_BEHIND) => {
            format!("not in real time: {}", not_in_real_time(status.pace_factor))
        }
        _ if status.frames_dropped > 0 || status.events_lost > 0 => format!(
            "the publisher's thread got no processor: {} snapshots and {} changes of inputs were not published since \
             the start",
            status.frames_dropped, status.events_lost
        ),
        (_, TwinStatus::PACE_NOT_JUDGED) => "not judged yet: the model has run for less than 10 s".to_owned(),
        _ => "in real time".to_owned(),
    };
    Item {
        name: "pacing",
        alarms: &[AlarmId::RealTime],
        calm,
        values: vec![
            ("real_time_factor", figure(status.real_time_factor, 4)),
            ("real_time_factor over 10 s", figure(status.pace_factor, 4)),
            ("lateness (s)", figure(status.lateness, 6)),
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

pub(super) fn solver(status: &TwinStatus) -> Item {
    let quality = words::model_quality(status.model_quality);
    let calm = match (status.state, status.model_quality) {
        (TwinStatus::FAILED, _) => format!("the model has stopped: {}", status.last_rejection_cause),
        (_, TwinStatus::QUALITY_GOOD) if status.model_quality_cause.is_empty() => "converging".to_owned(),
        _ => format!("converging, model quality {quality}: {}", status.model_quality_cause),
    };
    Item {
        name: "solver",
        alarms: &[AlarmId::Solver, AlarmId::ModelQuality],
        calm,
        values: vec![
            ("newton_iterations_mean", figure(status.newton_iterations_mean, 2)),
            ("rejected_steps", status.rejected_steps.to_string()),
            ("halved_steps", status.halved_steps.to_string()),
            ("failed_steps", status.failed_steps.to_string()),
            ("last_rejection_cause", status.last_rejection_cause.clone()),
            ("last_rejection_station", status.last_rejection_station.to_string()),
            ("energy_error (J)", figure(status.energy_error, 3)),
            ("energy_error_ratio", scientific(status.energy_error_ratio)),
            ("energy_error_share", figure(status.energy_error_share, 3)),
            ("model_quality", quality.to_owned()),
        ],
    }
}

/// What the rig measures besides the inputs, and what follows it. Its alarm, `rig_disagrees`, is among the inputs.
pub(super) fn measured(rig: &RigEvidence<'_>) -> Item {
    let RigEvidence { measured, now, .. } = *rig;
    let newest = |kind| measured.newest(kind).map(|value| (kind, value));
    let given: Vec<String> = MeasuredKind::ALL
        .into_iter()
        .filter_map(newest)
        .map(|(kind, value)| {
            let doubt = if value.suspect {
                ", marked suspect by its source"
            } else {
                ""
            };
            let age = figure_in(now - value.arrived, 1, "s");
            format!("{kind} {} ({age} ago{doubt})", figure_in(value.value, 3, kind.unit()))
        })
        .collect();
    let [received, refused, unreadable, overrun] = measured.counts();
    let refusal = measured.newest_refusal().map(|refused| refused.to_string());
    Item {
        name: "measured",
        alarms: &[],
        calm: if given.is_empty() {
            "the rig has sent no measured values".to_owned()
        } else {
            given.join(", ")
        },
        values: vec![
            ("messages received", received.to_string()),
            ("messages refused", refused.to_string()),
            ("newest refusal", refusal.unwrap_or_else(|| "none".to_owned())),
            ("messages unreadable", unreadable.to_string()),
            ("messages that came too fast to be taken", overrun.to_string()),
            (
                "follows the rig",
                rig.residuals.map_or_else(|| NOT_COMPARED.to_owned(), followed),
            ),
        ],
    }
}

/// The surveys of the hole. Their alarm, on the plan, is that of the hole.
pub(super) fn surveys(rig: &RigEvidence<'_>) -> Item {
    let counts = rig.surveys.counts();
    let age = counts
        .newest
        .map_or(f64::NAN, |stamp| rig.stamp_time.saturating_sub(stamp) as f64 * 1e-9);
    let mut calm = match counts.deepest {
        None => "no survey of the hole is known".to_owned(),
        Some(depth) => format!(
            "{} of the hole, the deepest at {depth:.2} m, the newest {} old",
            counted(counts.known, "survey"),
            figure_in(age, 0, "s")
        ),
    };
    if counts.earlier > 0 {
        calm += &format!("; {} of them came in an earlier run", counts.earlier);
    }
    match counts.waiting {
        0 => {}
        1 => calm += "; 1 below the bit waits for the hole as drilled",
        several => calm += &format!("; {several} below the bit wait for the hole as drilled"),
    }
    let refusal = rig.surveys.newest_refusal().map(|refused| refused.to_string());
    Item {
        name: "surveys",
        alarms: &[],
        calm,
        values: vec![
            ("accepted", (counts.received - counts.refused).to_string()),
            ("refused", counts.refused.to_string()),
            ("last refusal", refusal.unwrap_or_else(|| "none".to_owned())),
            ("late", counts.late.to_string()),
            ("waiting", counts.waiting.to_string()),
            ("known", counts.known.to_string()),
            ("of an earlier run", counts.earlier.to_string()),
            ("age of the newest (s)", figure(age, 0)),
            ("unreadable", counts.unreadable.to_string()),
            ("came too fast to be taken", counts.overrun.to_string()),
        ],
    }
}

/// What follows the rig, how far it has moved, and why it does not move.
fn followed(newest: &Residuals) -> String {
    if !newest.following {
        return format!("nothing: {}", newest.following_held);
    }
    let held = match newest.following_held.as_str() {
        "" => String::new(),
        held => format!("; held: {held}"),
    };
    format!(
        "friction factor {}, configured {}; torque tare {}, configured {}{held}",
        figure(newest.applied_friction_factor, 3),
        figure(newest.configured_friction_factor, 3),
        figure_in(newest.applied_torque_tare, 1, "N m"),
        figure_in(newest.configured_torque_tare, 1, "N m"),
    )
}

pub(super) fn inputs(status: &TwinStatus) -> Item {
    // The calm text is shown while none of the item's alarms stands, so the states of all inputs are in it.
    let states: Vec<String> = status
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
                flag(&status.input_safe, ", at its safe value"),
                flag(&status.input_suspect, ", marked suspect by its source"),
                flag(&status.input_several_drivers, ", SEVERAL PUBLISHERS AT ONCE"),
            )
        })
        .collect();
    let mut values = Vec::new();
    for (index, name) in status.input_name.iter().enumerate() {
        // A name that this version does not know is left out of the values but is in the text above.
        let Some(kind) = InputKind::of_name(name) else {
            continue;
        };
        let (key, publishers_key) = match kind {
            InputKind::RotarySpeed => ("rotary_speed", "rotary_speed publishers"),
            InputKind::WeightOnBit => ("weight_on_bit", "weight_on_bit publishers"),
            InputKind::RateOfPenetration => ("rate_of_penetration", "rate_of_penetration publishers"),
            InputKind::StandpipePressure => ("standpipe_pressure", "standpipe_pressure publishers"),
        };
        let get = |values: &[f64]| values.get(index).copied().unwrap_or(f64::NAN);
        let in_unit = |value: f64| figure_in(kind.from_si(value), 2, kind.unit());
        values.push((
            key,
            format!(
                "received {}, applied {}, age {}, {} refused",
                in_unit(get(&status.input_received)),
                in_unit(get(&status.input_applied)),
                figure_in(get(&status.input_age), 2, "s"),
                status.input_rejected.get(index).copied().unwrap_or_default()
            ),
        ));
        let count = |counts: &[u64]| counts.get(index).copied().unwrap_or_default();
        let publishers = status.input_publishers.get(index).map_or("", String::as_str);
        // Publishers are a separate value: monitors plot the first, people read the second.
        values.push((
            publishers_key,
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
    Item {
        name: "inputs",
        alarms: &[
            AlarmId::RotarySpeedInput,
            AlarmId::WeightOnBitInput,
            AlarmId::RateOfPenetrationInput,
            AlarmId::StandpipePressureInput,
            AlarmId::TwoDrivers,
            AlarmId::KnownWindow,
            AlarmId::RigDisagrees,
        ],
        calm: states.join(", "),
        values,
    }
}

/// What differs from the configuration that the run began with.
pub(super) fn configuration(status: &TwinStatus) -> Item {
    let changed = &status.changed_parameter;
    Item {
        name: "configuration",
        alarms: &[AlarmId::ChangedParameters],
        calm: if changed.is_empty() {
            "as at the start".to_owned()
        } else {
            changed.join("; ")
        },
        values: vec![
            ("hash", status.config_hash.clone()),
            ("values that differ", changed.len().to_string()),
        ],
    }
}

pub(super) fn recording(status: &TwinStatus) -> Item {
    let path = &status.recording_path;
    let calm = match status.recording_state {
        TwinStatus::RECORDING_FAILED => format!("the recording to {path} stopped; the twin continues"),
        TwinStatus::RECORDING_ON if status.recording_drops > 0 => {
            format!(
                "recording to {path}; lost since the start: {}",
                status.recording_drops_cause
            )
        }
        TwinStatus::RECORDING_ON => format!("recording to {path}"),
        _ => "not recording".to_owned(),
    };
    Item {
        name: "recording",
        alarms: &[AlarmId::Recording],
        calm,
        values: vec![
            ("messages", status.recording_messages.to_string()),
            ("drops", status.recording_drops.to_string()),
        ],
    }
}

pub(super) fn network(status: &TwinStatus) -> Item {
    let calm = if !status.dds_up {
        format!("DDS restarts: {}", status.dds_restart_cause)
    } else if !status.namesake.is_empty() {
        another_of_this_name(&status.namesake)
    } else if !status.dds_stalled_reader.is_empty() {
        status.dds_stalled_reader.clone()
    } else if status.clock_set_by != 0.0 {
        format!(
            "the system clock was set by {:+.1} s; stamps follow the clock at the start until the node is restarted",
            status.clock_set_by
        )
    } else {
        "up".to_owned()
    };
    Item {
        name: "network",
        alarms: &[AlarmId::Network],
        calm,
        values: vec![
            ("dds_restarts", status.dds_restarts.to_string()),
            ("clock_set_by (s)", format!("{:.1}", status.clock_set_by)),
        ],
    }
}

fn scientific(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.2e}")
    } else {
        figure(value, 2)
    }
}

fn milliseconds(seconds: f64) -> String {
    figure(seconds * 1e3, 4)
}
