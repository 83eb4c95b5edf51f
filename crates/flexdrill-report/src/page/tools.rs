//! What plausible tools did under the same inputs.

use maud::{Markup, html};

use super::text::{duration, number, percent};
use super::{drawn, priority_class};
use crate::ReportError;
use crate::plots;
use crate::reading::Summary;
use crate::tools::{BandHistory, PlausibleTools};
use flexdrill_outputs::words;
use flexdrill_text::counted;

/// A row: means of the twin and of the quantiles over the time in which both are known.
fn row(summary: &Summary, band: &BandHistory) -> Markup {
    let (unit, factor) = band.kind.unit();
    let [p5, p50, p95] = band.quantiles.each_ref();
    let span = p50.span();
    let mean = |history: &crate::history::History| {
        span.and_then(|[from, to]| history.mean_between(from, to))
            .unwrap_or(f64::NAN)
    };
    let of_twin = band.transfer.and_then(|field| summary.transfer.figures.field(field));
    let all_zero =
        |history: &crate::history::History| history.range().is_none_or(|range| range.min == 0.0 && range.max == 0.0);
    html! {
        @if !all_zero(p5) || !all_zero(p95) {
            tr {
                td { (band.label) }
                td.n { (number(factor * of_twin.map_or(f64::NAN, |quantity| mean(&quantity.history)))) }
                @for history in [p5, p50, p95] { td.n { (number(factor * mean(history))) } }
                td { (unit) }
            }
        }
    }
}

/// Members and what they amount to, as sentences.
fn members(tools: &PlausibleTools) -> Markup {
    let [least, most] = tools.effective;
    html! {
        p {
            (counted(u64::from(tools.members), "plausible tool")) " ran with the twin, under its inputs. "
            @if least <= most {
                "By what the rig measured they amounted to " (number(least))
                @if most - least >= 0.05 { " to " (number(most)) }
                " alike"
                @if tools.renewals > 0 {
                    ", and " (counted(u64::from(tools.renewals), "time")) " those of little weight were replaced"
                }
                ". "
            }
            @if tools.failed > 0 {
                "Up to " (tools.failed) " could not be computed: what they do is unknown, not safe. "
            }
            @if tools.without > 0 {
                "In " (counted(tools.without, "message")) " of " (tools.seconds) " there are no bands"
                @if !tools.why.is_empty() { ": " (tools.why) } "."
            }
        }
    }
}

/// Alarms of plausible tools, the likeliest first; none where the bag has no bands.
fn alarms(tools: &PlausibleTools) -> Markup {
    let mut list: Vec<_> = tools.alarms.iter().collect();
    list.sort_by(|a, b| {
        (b.priority, b.most)
            .partial_cmp(&(a.priority, a.most))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    html! {
        @if list.is_empty() {
            @if tools.seconds > tools.without { p { "No alarm stood in any of them." } }
        } @else {
            table {
                thead { tr {
                    th { "priority, or a higher one" } th { "alarm" } th.n { "share of the tools, mean over time" }
                    th.n { "at most" } th.n { "at" }
                } }
                tbody {
                    @for alarm in list {
                        tr {
                            td { span.priority.(priority_class(alarm.priority)) {
                                (words::alarm_priority(alarm.priority).to_uppercase())
                            } }
                            td { (alarm.name) }
                            td.n { (percent(tools.mean_chance(alarm))) }
                            td.n { (percent(alarm.most)) " (" (alarm.seen) " of " (alarm.members) ")" }
                            td.n { (duration(alarm.at)) }
                        }
                    }
                }
            }
        }
    }
}

/// The section; nothing where no plausible tools ran.
pub(super) fn section(summary: &Summary) -> Result<Markup, ReportError> {
    let tools = &summary.tools;
    if tools.seconds == 0 {
        return Ok(html! {});
    }
    let figure = drawn(
        plots::tools(summary),
        "Band: 5 to 95 % of the plausible tools by their weights, wider by the figure's factor in ensemble.band_factors, with \
         their median. Line: the twin.",
    )?;
    Ok(html! {
        section {
            h2 { "Plausible tools" }
            (members(tools))
            @if tools.has_bands() {
                table {
                    thead { tr {
                        th { "mean over time" } th.n { "the twin" } th.n { "5 %" } th.n { "median" } th.n { "95 %" }
                        th { "unit" }
                    } }
                    tbody { @for band in &tools.bands { (row(summary, band)) } }
                }
            }
            (alarms(tools))
            (figure)
            p.note {
                "The tools differ by what is not known of tool and rig (section uncertainty of the configuration); their \
                 model is the twin's, with what it leaves out."
            }
        }
    })
}
