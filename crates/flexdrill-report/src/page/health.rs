//! Health of the model, its pace and the recording.

use maud::{Markup, html};

use super::drawn;
use super::text::{duration, number, percent};
use crate::ReportError;
use crate::plots;
use crate::reading::Summary;
use crate::shares::Shares;
use flexdrill_messages::TwinStatus;
use flexdrill_outputs::words;

/// The section about the trust in the numbers.
pub(super) fn section(summary: &Summary) -> Result<Markup, ReportError> {
    let health = &summary.health;
    let figure = drawn(
        plots::pace(summary),
        "As reported by the twin, each value over the last second.",
    )?;
    Ok(html! {
        // The order is that of the questions: is the model right, was it on time, was anything lost.
        section {
            h2 { "Health" }
            @match &health.newest {
                None => p { "The bag has no " code { "twin/status" } ": pace and model quality are not known. A replay has none." },
                Some(status) => {
                    table.pairs { tbody {
                        tr { th { "model quality" } td { (shares(&health.quality, words::model_quality)) } }
                        @if !health.quality_cause.is_empty() {
                            tr { th { "last reason for a lower quality" } td { (health.quality_cause) } }
                        }
                        tr { th { "state" } td { (shares(&health.states, words::twin_state)) } }
                        tr { th { "real-time factor" } td {
                            @if let Some(range) = health.real_time_factor.range() {
                                (number(range.min)) " to " (number(range.max)) ", mean " (number(range.mean))
                            }
                        } }
                        tr { th { "largest lateness" } td {
                            @if let Some(range) = health.lateness.range() { (number(1e3 * range.max)) " ms" }
                        } }
                        tr { th { "deadlines missed, periods skipped" } td { (status.deadline_misses) ", " (status.steps_skipped) } }
                        tr { th { "longest step" } td {
                            (number(1e3 * health.step_time_max)) " ms of computing time for " (number(1e3 * status.time_step)) " ms of model time"
                        } }
                        tr { th { "sub-steps rejected, steps halved, failed" } td {
                            (status.rejected_steps) ", " (status.halved_steps) ", " (status.failed_steps)
                            @if !status.last_rejection_cause.is_empty() {
                                "; the last: " (status.last_rejection_cause) " at "
                                (format!("{:.2}", status.last_rejection_measured_depth)) " m"
                            }
                        } }
                        tr { th { "energy error relative to the drive's work" } td { (percent(status.energy_error_ratio)) } }
                        tr { th { "longest time without a heartbeat" } td {
                            (duration(health.longest_silence.0)) " at " (format!("{:.1}", health.longest_silence.1)) " s"
                        } }
                        tr { th { "DDS restarts" } td {
                            (status.dds_restarts)
                            @if !status.dds_restart_cause.is_empty() { "; the last: " (status.dds_restart_cause) }
                        } }
                        // Only of a rig that sends surveys.
                        @if status.surveys_known + status.surveys_waiting + status.surveys_refused > 0 {
                            tr { th { "surveys taken into account, waiting below the bit, refused" } td {
                                (status.surveys_known) ", " (status.surveys_waiting) ", " (status.surveys_refused)
                            } }
                        }
                        tr { th { "messages lost" } td { (lost(status)) } }
                        // Only where the clock was set, which is rare.
                        @if status.clock_set_by != 0.0 {
                            tr { th { "system clock set by" } td { (number(status.clock_set_by)) " s" } }
                        }
                    } }
                    (figure)
                },
            }
        }
    })
}

/// The codes with their shares of time.
pub(super) fn shares(shares: &Shares, word: impl Fn(u8) -> &'static str) -> Markup {
    html! {
        @for (index, (code, share)) in shares.iter().enumerate() {
            @if index > 0 { ", " }
            (word(code)) " " (percent(share))
        }
    }
}

/// Lost messages by cause.
fn lost(status: &TwinStatus) -> String {
    let mut parts: Vec<String> = status
        .output_topic
        .iter()
        .zip(&status.output_dropped)
        .filter(|(_, dropped)| **dropped > 0)
        .map(|(topic, dropped)| format!("{topic} {dropped}"))
        .collect();
    for (what, count) in [
        ("recording", status.recording_drops),
        ("snapshots", status.frames_dropped),
        ("changes of the inputs", status.events_lost),
    ] {
        if count > 0 {
            parts.push(format!("{what} {count}"));
        }
    }
    if parts.is_empty() {
        "none".to_owned()
    } else {
        parts.join(", ")
    }
}
