//! The page: one HTML file that contains its figures and style.

mod alarms;
mod balances;
mod bit;
pub(crate) mod comparison;
mod drive;
mod health;
mod hole;
mod life;
mod locations;
pub(crate) mod text;
mod tools;
mod transfer;
mod weight;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use self::text::{capital, duration, number, percent, times};
use super::ReportError;
use super::incidents::seconds;
use super::reading::Summary;
use flexdrill_messages::{Alarm, TwinStatus};
use flexdrill_outputs::words;
use flexdrill_plot::{Figure, svg};
use flexdrill_text::{date_time, printable};

/// The style of all pages.
pub(crate) const STYLE: &str = include_str!("style.css");

/// The whole page.
///
/// # Errors
/// When a figure cannot be drawn.
pub fn html(summary: &Summary) -> Result<String, ReportError> {
    let name = summary
        .path
        .file_name()
        .unwrap_or(summary.path.as_os_str())
        .to_string_lossy();
    let body = html! {
        header {
            h1 { "Drilling report" }
            p.of { (name) }
            (facts(summary))
        }
        (tiles(summary))
        (weight::sentences(summary))
        (missing(summary))
        (drive::inputs(summary)?)
        (alarms::section(summary))
        (locations::worst(summary)?)
        (locations::envelopes(summary)?)
        (drive::torque(summary)?)
        (bit::section(summary))
        (transfer::section(summary)?)
        (tools::section(summary)?)
        (hole::section(summary)?)
        (life::section(summary))
        (balances::section(summary))
        (health::section(summary)?)
        (limits())
        (configuration(summary))
    };
    Ok(document(&format!("Drilling report: {name}"), &body))
}

/// A page in one file: head, style and the body.
pub(crate) fn document(title: &str, body: &Markup) -> String {
    document_by(concat!("flexdrill ", env!("CARGO_PKG_VERSION")), title, body)
}

/// The same of results that a program (name and version) has made.
pub(crate) fn document_by(program: &str, title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content=(program);
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body { (body) }
        }
    };
    page.into_string()
}

/// Time, twin and tool of the recording.
fn facts(summary: &Summary) -> Markup {
    let session = summary.session.as_ref();
    html! {
        dl.facts {
            @if let Some(config) = &summary.config {
                @for (what, name) in config.run.place() { dt { (capital(what)) } dd { (printable(name)) } }
            }
            dt { "From" } dd { (date_time(summary.start)) }
            dt { "To" } dd { (date_time(summary.end)) " (" (duration(summary.seconds())) ")" }
            @if !summary.log_rows.is_empty() { dt { "Log" } dd { (summary.log_rows.all()) } }
            dt { "Twin" } dd {
                @if let Some(session) = session {
                    "flexdrill " (session.version) ", frame " code { (session.header.frame_id) } ", namespace "
                } @else { "namespace " }
                code { (summary.namespace) }
            }
            @if let Some(config) = &summary.config {
                dt { "Tool" } dd {
                    (config.tool.links) " links over " (number(config.well.length())) " m, bore of "
                    (number(1e3 * config.well.hole_diameter)) " mm, built up from "
                    (number(config.well.start_inclination_deg)) "° to " (number(config.well.end_inclination_deg())) "°"
                }
            }
            dt { "Read" } dd { (summary.messages) " messages of " code { (summary.path.display()) } }
        }
    }
}

/// The most important numbers.
fn tiles(summary: &Summary) -> Markup {
    let worst = summary.incidents.worst();
    let end = summary.seconds();
    // Both inputs end together with the log, so one tile covers them.
    let silent = summary
        .incidents
        .inputs_at_the_end()
        .min_by_key(|incident| incident.begin);
    let drive = &summary.drive;
    let locations = &summary.locations;
    let peak = |layer: usize| {
        let station = locations.worst_stations(layer).first().copied()?;
        Some((locations.peak[layer].at(station)?.max, locations.station_depth[station]))
    };
    html! {
        // Alarms first, then what may explain their absence, then forces, torque and trust.
        div.tiles {
            @if let Some(group) = &worst {
                div.tile.(priority_class(group.priority)) {
                    b { (words::alarm_priority(group.priority).to_uppercase()) } (capital(&group.worst.name))
                    small { (times(group.times)) ", " (duration(seconds(group.duration))) " in all" }
                }
                // A question mark and not "none": nothing is known without messages.
            } @else if !summary.has_alarms() {
                div.tile.unknown { b { "?" } "no alarms in the bag" }
            } @else {
                div.tile.good { b { "none" } "alarms while the rig sent its inputs" }
            }
            @if let Some(incident) = silent {
                div.tile.unknown {
                    b { (duration((end - seconds(incident.begin)).max(0.0))) } "without inputs at the end"
                    small { "the log or the rig had ended; the model held its inputs, then ramped them to the safe values" }
                }
            }
            @for (layer, name) in ["pipe on guide", "guide on wall"].into_iter().enumerate() {
                @if let Some((force, depth)) = peak(layer) {
                    div.tile {
                        b { (number(force / 1e3)) " kN" } "largest force, " (name)
                        small { "at " (format!("{depth:.2}")) " m" }
                    }
                }
            }
            // Both means are over the same time, or their ratio could exceed one.
            @if let Some([top, bit]) = drive.transfer.means() {
                div.tile {
                    b { (percent(bit / top)) } "of the torque at the uppermost joint reaches the bit"
                    small { (number(bit)) " of " (number(top)) " N m, mean" }
                }
            }
            @if let Some(index) = drive.stick_slip.range() {
                div.tile { b { (number(index.max)) } "largest stick-slip index" small { "1: the bit stands" } }
            }
            // The share of good quality comes last, as it qualifies all the tiles before.
            @match summary.trust() {
                Some((share, class)) => div.tile.(class) {
                    b { (percent(share)) } "of the time the model is good" small { "see Health" }
                },
                None => div.tile.unknown { b { "?" } "health of the model" small { "no status in the bag" } },
            }
        }
    }
}

fn missing(summary: &Summary) -> Markup {
    html! {
        @if !summary.missing.is_empty() {
            section.missing {
                h2 { "What is missing" }
                ul { @for line in &summary.missing { li { (line) } } }
            }
        }
    }
}

/// Notes on the meaning of the numbers.
fn limits() -> Markup {
    html! {
        section {
            h2 { "How to read it" }
            ul {
                li { "Forces, orbits and torque are computed by the model, not measured; the rig supplied rotary speed and weight on bit." }
                li { "Times count from the first message. Curves show the mean, pale bands the range from least to largest." }
                li { "Measured depth counts along the bore from the kick-off; joint 01 is the uppermost." }
                li { "The model does not include fluid, cuttings, thread play and wear, among others; the manual's page "
                     "Limits of the model states how much each may matter." }
            }
        }
    }
}

fn configuration(summary: &Summary) -> Markup {
    html! {
        section.configuration {
            h2 { "Configuration" }
            @if let Some(session) = &summary.session {
                dl.facts {
                    dt { "Hash" } dd { code { (session.config_hash) } }
                    dt { "Model step" } dd { (number(1e3 * session.time_step)) " ms" }
                    dt { "Resets" } dd { (summary.drive.resets) }
                }
                @if !summary.drive.changes.is_empty() {
                    h3 { "Parameter changes during the run" }
                    table {
                        thead { tr { th.n { "at (s)" } th { "parameter" } th.n { "new value" } } }
                        tbody { @for change in &summary.drive.changes {
                            tr { td.n { (format!("{:.1}", change.time)) } td { code { (change.name) } } td.n { (number(change.value)) } }
                        } }
                    }
                    @if summary.drive.more_changes > 0 { p { "And " (summary.drive.more_changes) " more." } }
                }
                @if let Some(problem) = &summary.config_problem {
                    p.warning { "This version of flexdrill cannot read this configuration: " (problem) }
                }
                pre { (session.configuration) }
            } @else {
                p { "Not in the bag." }
            }
        }
    }
}

/// A figure with its caption; empty when there is nothing to draw.
pub(crate) fn drawn(figure: Option<Figure>, caption: &str) -> Result<Markup, ReportError> {
    let Some(figure) = figure else {
        return Ok(html! {});
    };
    let drawing = svg(&figure)?;
    Ok(html! {
        figure id=(figure.name) {
            (PreEscaped(drawing))
            figcaption { (caption) }
        }
    })
}

fn priority_class(priority: u8) -> &'static str {
    match priority {
        Alarm::HIGH => "high",
        Alarm::MEDIUM => "medium",
        Alarm::LOW => "low",
        _ => "none",
    }
}

impl Summary {
    /// Length of the recording in the model's time (s).
    pub(crate) fn seconds(&self) -> f64 {
        self.end.saturating_sub(self.start) as f64 * 1e-9
    }

    /// Whether the bag has messages about alarms.
    pub(crate) fn has_alarms(&self) -> bool {
        self.incidents.newest.is_some() || self.incidents.groups().next().is_some()
    }

    /// Share of the time in which the model's quality is good, and the style for it.
    fn trust(&self) -> Option<(f64, &'static str)> {
        let quality = &self.health.quality;
        let class = if quality.has(TwinStatus::QUALITY_POOR) {
            "high"
        } else if quality.has(TwinStatus::QUALITY_DEGRADED) {
            "medium"
        } else {
            "good"
        };
        (!quality.is_empty()).then(|| (quality.of(TwinStatus::QUALITY_GOOD), class))
    }
}
