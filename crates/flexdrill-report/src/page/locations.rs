//! The worst locations, and the envelopes along the tool.

use maud::{Markup, html};

use super::drawn;
use super::text::{location, number, percent};
use crate::ReportError;
use crate::locations::{NAMED, WhirlStation};
use crate::plots;
use crate::reading::Summary;
use flexdrill_core::units::rad_to_deg;
use flexdrill_messages::WhirlState;
use flexdrill_outputs::words;

fn joint_name(summary: &Summary, depth: f64) -> String {
    match summary.locations.nearest_joint(depth) {
        Some(joint) => format!("near joint {:02}", joint + 1),
        None => String::new(),
    }
}

/// The section about the largest forces and moments, whirl, and the orbits.
pub(super) fn worst(summary: &Summary) -> Result<Markup, ReportError> {
    let locations = &summary.locations;
    // The fewest samples per turn of all orbits decide what the caption may promise.
    let turns = plots::worst_orbits(summary)
        .iter()
        .map(plots::OrbitOf::samples_per_turn)
        .fold(f64::INFINITY, f64::min);
    let limit = if summary.config.is_some() {
        "Dashed: the limit of the pipe's axis, the sum of both clearances. "
    } else {
        ""
    };
    let caption = format!(
        "Path of the pipe's axis around the bore's axis, viewed downhole, over four seconds around the worst moment. \
         {limit}{}",
        if turns.is_finite() {
            format!(
                "At least {} samples per turn of the tool; below eight, no line joins the samples.",
                number(turns)
            )
        } else {
            String::new()
        }
    );
    let figure = drawn(plots::orbits(summary), &caption)?;
    Ok(html! {
        section {
            h2 { "Worst locations" }
            table {
                thead { tr { th { "what" } th.n { "value" } th { "unit" } th.n { "at (s)" } th { "where" } th {} } }
                tbody {
                    // Several stations per layer, because the largest forces of a whirling tool wander.
                    @for (layer, name) in ["force, pipe on guide", "force, guide on wall"].into_iter().enumerate() {
                        @for station in locations.worst_stations(layer) {
                            @if let Some(peak) = locations.peak[layer].at(station) {
                                @let depth = locations.station_depth[station];
                                tr {
                                    td { (name) } td.n { (number(peak.max / 1e3)) } td { "kN" }
                                    td.n { (format!("{:.1}", peak.when)) }
                                    td { (location(0, depth, locations.station_inclination[station])) }
                                    td { (joint_name(summary, depth)) }
                                }
                            }
                        }
                    }
                    @for (name, unit, factor, envelope) in [
                        ("bend of a joint", "deg", rad_to_deg(1.0), &locations.bend),
                        ("moment of a joint's stop", "N m", 1.0, &locations.stop_moment),
                        ("shear force through a joint", "kN", 1e-3, &locations.shear_force),
                        ("torque through a joint", "N m", 1.0, &locations.torque),
                    ] {
                        // One joint per quantity here; the envelopes show the others.
                        @for joint in envelope.largest(&locations.joint_depth, 0.0, 1) {
                            @if let Some(at) = envelope.at(joint) {
                                tr {
                                    td { (name) } td.n { (number(factor * at.size())) } td { (unit) }
                                    td.n { (format!("{:.1}", at.when)) }
                                    td { (location(0, locations.joint_depth[joint], locations.joint_inclination[joint])) }
                                    td { "joint " (format!("{:02}", joint + 1)) }
                                }
                            }
                        }
                    }
                    // Shock has its own rows, because it is an impulse and no force.
                    @for (layer, name) in ["shock, pipe on guide", "shock, guide on wall"].into_iter().enumerate() {
                        @for station in locations.shock[layer].largest(&locations.station_depth, 0.0, 1) {
                            @if let Some(at) = locations.shock[layer].at(station) {
                                @let depth = locations.station_depth[station];
                                tr {
                                    td { (name) } td.n { (number(at.max)) } td { "N s" }
                                    td.n { (format!("{:.1}", at.when)) }
                                    td { (location(0, depth, locations.station_inclination[station])) }
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

fn whirl(summary: &Summary) -> Markup {
    let worst = summary.locations.worst_whirl();
    html! {
        @if summary.locations.whirl.is_empty() {
            // The list of missing data mentions the topic.
        } @else if worst.is_empty() {
            p { "No whirl reached a warning level at any watched station." }
        } @else {
            h3 { "Whirl" }
            table {
                thead { tr {
                    th { "level" } th { "kind" } th { "where" } th.n { "at (s)" } th.n { "rate / speed" } th.n { "orbit / clearance" }
                    th.n { "in contact" } th { "kinds, share of the time" }
                } }
                tbody { @for station in &worst { (whirl_row(station)) } }
            }
            @if worst.len() == NAMED { p.note { "The " (NAMED) " worst stations that are not adjacent." } }
        }
    }
}

fn whirl_row(at: &WhirlStation) -> Markup {
    let body = if at.body == WhirlState::GUIDE { "guide" } else { "pipe" };
    html! {
        tr {
            td { span.priority.(level_class(at.severity)) { (words::severity(at.severity).to_uppercase()) } }
            td { (words::whirl_kind(at.kind)) }
            td { (body) ", " (location(0, at.measured_depth, at.inclination)) }
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
        "Over the whole recording. The largest normal forces include the peaks within each publishing interval, since \
         collisions are shorter; forces through the joints are those at the stamps of the messages.",
    )?;
    Ok(html! {
        section {
            h2 { "Along the tool" }
            (figure)
        }
    })
}
