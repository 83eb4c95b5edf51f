//! Joints to inspect, by this recording and by all runs.

use flexdrill_life::{JointOfFile, Kind, UNKNOWN_TO_A_CLASS, Verdict, damage_in_words, damage_with_band};
use flexdrill_text::counted;
use maud::{Markup, html};

use super::text::number;
use crate::reading::Summary;

/// Joints listed whatever their damage; all of those that need an inspection are listed.
const LISTED: usize = 5;

/// Nothing for a tool without a class of its joints, unless a table of lives was given.
pub(super) fn section(summary: &Summary) -> Markup {
    let of_recording = (summary.config.as_ref()).and_then(|config| summary.life.of_recording(config));
    let lives = summary.life.lives.as_ref();
    if of_recording.is_none() && lives.is_none() {
        return html! {};
    }
    html! {
        section {
            h2 { "Joints to inspect" }
            @if let Some(lives) = lives {
                h3 { "All runs of " (lives.file) }
                (class(&lives.kind))
                (table(&lives.ranked(), lives.kind.design_factor))
            }
            @if let Some((kind, joints)) = &of_recording {
                h3 { "This recording alone" }
                @if lives.is_none() { (class(kind)) }
                @match joints {
                    Ok(joints) => { (table(joints, kind.design_factor)) }
                    Err(why) => { p { "Not known: " (why.to_string()) "." } }
                }
            }
            p { (UNKNOWN_TO_A_CLASS) }
        }
    }
}

fn class(kind: &Kind) -> Markup {
    html! {
        p {
            "Class " b { (kind.class) } " in " (kind.environment.replace('_', " ")) ", by the bending moments of the links and the \
             moments of the stops. A joint is listed from a damage of " (damage_in_words(1.0 / kind.design_factor)) " at 95 %."
        }
    }
}

fn table(joints: &[JointOfFile], design_factor: f64) -> Markup {
    let due = joints.iter().filter(|joint| joint.verdict > Verdict::Sound).count();
    let shown = due.max(LISTED.min(joints.len()));
    html! {
        table {
            thead { tr {
                th.n { "rank" } th { "joint" } th.n { "place from the bit" } th.n { "hours" } th.n { "runs" }
                th.n { "damage of the stop" } th.n { "damage of the link below" } th { "what to do" }
            } }
            tbody { @for (rank, joint) in (1..).zip(&joints[..shown]) { tr {
                td.n { (rank) }
                td { (joint.serial) }
                td.n { (joint.places.last().copied().unwrap_or_default()) }
                td.n { (number(joint.hours)) }
                td.n { (joint.runs) }
                td.n { (damage_with_band(joint.stop)) }
                td.n { (damage_with_band(joint.link)) }
                td { (joint.verdict.words()) }
            } } }
        }
        @if shown < joints.len() {
            p {
                (counted((joints.len() - shown) as u64, "joint")) " more, below a damage of "
                (damage_in_words(1.0 / design_factor)) " at 95 %: no inspection is due by fatigue."
            }
        }
    }
}
