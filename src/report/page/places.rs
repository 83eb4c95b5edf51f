//! Where it was worst, and the envelopes along the tool.

use maud::{Markup, html};

use super::drawn;
use super::text::{number, percent, place};
use crate::messages::{WhirlState, words};
use crate::report::ReportError;
use crate::report::places::{NAMED, WhirlPlace};
use crate::report::plots;
use crate::report::reading::Summary;
use flexdrill_core::units::rad_to_deg;

fn joint_name(summary: &Summary, depth: f64) -> String {
    match summary.places.nearest_joint(depth) {
        Some(joint) => format!("near joint {:02}", joint + 1),
        None => String::new(),
    }
}

/// The largest forces and moments, whirl, and the orbits there.
pub(super) fn worst(summary: &Summary) -> Result<Markup, ReportError> {
    let places = &summary.places;
    let turns = plots::worst_orbits(summary)
        .iter()
        .map(plots::OrbitOf::samples_per_turn)
        .fold(f64::INFINITY, f64::min);
    let room = if summary.config.is_some() {
        "Dashed: the room that pipe and guide leave the pipe's axis in the bore. "
    } else {
        ""
    };
    let caption = format!(
        "Path of the pipe's axis about the bore's axis, seen down the hole, within four seconds of the worst moment. {room}{}",
        if turns.is_finite() {
            format!(
                "At least {} samples per turn of the tool; below eight the samples are not joined.",
                number(turns)
            )
        } else {
            String::new()
        }
    );
    let figure = drawn(plots::orbits(summary), &caption)?;
    Ok(html! {
        section {
            h2 { "Worst places" }
            table {
                thead { tr { th { "what" } th.n { "value" } th { "unit" } th.n { "at (s)" } th { "where" } th {} } }
                tbody {
                    @for (layer, name) in ["force, pipe on guide", "force, guide on wall"].into_iter().enumerate() {
                        @for station in places.worst_stations(layer) {
                            @if let Some(peak) = places.peak[layer].at(station) {
                                @let depth = places.station_depth[station];
                                tr {
                                    td { (name) } td.n { (number(peak.max / 1e3)) } td { "kN" }
                                    td.n { (format!("{:.1}", peak.when)) }
                                    td { (place(0, depth, places.station_inclination[station])) }
                                    td { (joint_name(summary, depth)) }
                                }
                            }
                        }
                    }
                    @for (name, unit, factor, envelope) in [
                        ("bend of a joint", "deg", rad_to_deg(1.0), &places.bend),
                        ("moment of a joint's stop", "N m", 1.0, &places.stop_moment),
                        ("shear force through a joint", "kN", 1e-3, &places.shear_force),
                        ("torque through a joint", "N m", 1.0, &places.torque),
                    ] {
                        @for joint in envelope.largest(&places.joint_depth, 0.0, 1) {
                            @if let Some(at) = envelope.at(joint) {
                                tr {
                                    td { (name) } td.n { (number(factor * at.size())) } td { (unit) }
                                    td.n { (format!("{:.1}", at.when)) }
                                    td { (place(0, places.joint_depth[joint], places.joint_inclination[joint])) }
                                    td { "joint " (format!("{:02}", joint + 1)) }
                                }
                            }
                        }
                    }
                    @for (layer, name) in ["shock, pipe on guide", "shock, guide on wall"].into_iter().enumerate() {
                        @for station in places.shock[layer].largest(&places.station_depth, 0.0, 1) {
                            @if let Some(at) = places.shock[layer].at(station) {
                                @let depth = places.station_depth[station];
                                tr {
                                    td { (name) } td.n { (number(at.max)) } td { "N s" }
                                    td.n { (format!("{:.1}", at.when)) }
                                    td { (place(0, depth, places.station_inclination[station])) }
                                    td { (joint_name(summary, depth)) }
                                }
                            }
                        }
                    }
                }
            }
            (whirl(summary))
            (figure)
        }
    })
}

/// Whirl, place by place.
fn whirl(summary: &Summary) -> Markup {
    let worst = summary.places.worst_whirl();
    html! {
        @if summary.places.whirl.is_empty() {
            // That the topic is missing is said on top.
        } @else if worst.is_empty() {
            p { "No whirl reached a level at any watched place." }
        } @else {
            h3 { "Whirl" }
            table {
                thead { tr {
                    th { "level" } th { "kind" } th { "where" } th.n { "at (s)" } th.n { "rate / speed" } th.n { "of the gap" }
                    th.n { "in contact" } th { "kinds over the time" }
                } }
                tbody { @for place in &worst { (whirl_row(place)) } }
            }
            @if worst.len() == NAMED { p.note { "The " (NAMED) " worst places that lie apart." } }
        }
    }
}

fn whirl_row(at: &WhirlPlace) -> Markup {
    let body = if at.body == WhirlState::GUIDE { "guide" } else { "pipe" };
    html! {
        tr {
            td { span.priority.(level_class(at.severity)) { (words::severity(at.severity).to_uppercase()) } }
            td { (words::whirl_kind(at.kind)) }
            td { (body) ", " (place(0, at.measured_depth, at.inclination)) }
            td.n { (format!("{:.1}", at.time)) }
            td.n { (number(at.ratio)) }
            td.n { (percent(at.clearance_ratio)) }
            td.n { (percent(at.duty)) }
            td {
                @for (index, (kind, count)) in at.kinds.iter().enumerate() {
                    @if index > 0 { ", " }
                    (words::whirl_kind(*kind)) " " (percent(*count as f64 / at.evaluations as f64))
                }
            }
        }
    }
}

fn level_class(severity: u8) -> &'static str {
    ["none", "low", "medium", "high"]
        .get(usize::from(severity))
        .copied()
        .unwrap_or("none")
}

/// Forces and moments along the tool.
pub(super) fn envelopes(summary: &Summary) -> Result<Markup, ReportError> {
    let figure = drawn(
        plots::envelopes(summary),
        "Over the whole recording. Largest normal forces are those within each publishing interval, since collisions are \
         shorter; forces through the joints are taken at the stamps of the messages.",
    )?;
    Ok(html! {
        section {
            h2 { "Along the tool" }
            (figure)
        }
    })
}
