//! Where the tool drilled next, and the plan of the hole.

use maud::{Markup, html};

use super::drawn;
use super::text::{duration, number, percent};
use crate::ReportError;
use crate::hole::{HoleHistory, Instant};
use crate::plots;
use crate::reading::Summary;
use flexdrill_text::counted;

/// A radius (m); a hole without one is straight or bends the other way.
fn radius(radius: f64) -> String {
    if radius.is_finite() {
        format!("{} m", number(radius))
    } else {
        "straight or dropping".to_owned()
    }
}

/// The radius at an instant with its range.
fn at(name: &str, instant: Option<Instant>) -> Markup {
    html! {
        @if let Some(Instant { time, radius: [value, low, high] }) = instant {
            tr {
                td { (name) " (" (duration(time)) ")" }
                @for radius in [value, low, high].map(radius) { td.n { (radius) } }
            }
        }
    }
}

/// The plan in sentences.
fn plan(hole: &HoleHistory) -> Markup {
    html! {
        @if let Some(distance) = hole.distance.range().filter(|_| hole.compared > 0) {
            p {
                "At " (number(hole.ahead)) " m ahead the bit was " (number(distance.min)) " to " (number(distance.max))
                " m from the plan. In " b { (percent(hole.off as f64 / hole.compared as f64)) }
                " of " (counted(hole.compared, "comparison")) " the plan was outside the range of the plausible tools: the hole \
                 left its plan. The alarm has its own row above."
            }
        } @else if !hole.plan_because.is_empty() {
            p { "The plan was not compared: " (hole.plan_because) "." }
        }
    }
}

/// Nothing for a bag without `twin/hole_ahead`.
pub(super) fn section(summary: &Summary) -> Result<Markup, ReportError> {
    let hole = &summary.hole;
    if hole.messages == 0 {
        return Ok(html! {});
    }
    let figure = drawn(
        plots::hole(summary),
        "Build rate of the next metre, with the range of 90 % of the plausible tools, and that of the plan; distance to the \
         plan at the last depth that is compared.",
    )?;
    Ok(html! {
        section {
            h2 { "The hole ahead" }
            @if hole.known == 0 {
                p { "Where the tool drills was not known: " (hole.because) "." }
            } @else {
                p {
                    "Known in " (percent(hole.known as f64 / hole.messages as f64)) " of "
                    (counted(hole.messages, "message")) ". Radii are of the next metre, by statics; low and high are 5 and \
                     95 % of the plausible tools."
                }
                table {
                    thead { tr { th { "at" } th.n { "radius" } th.n { "low" } th.n { "high" } } }
                    tbody { (at("first", hole.first)) (at("last", hole.last)) }
                }
                (plan(hole))
                (figure)
            }
        }
    })
}
