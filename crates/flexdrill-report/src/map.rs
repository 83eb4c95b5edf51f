//! A safe window as one HTML page.

use maud::{Markup, PreEscaped, html};

use flexdrill_map::{Axis, Map, OfStart, Start, Verdict};
use flexdrill_text::counted;

use crate::page::document_by;

/// The page of a map with its picture (SVG).
pub fn page(map: &Map, svg: &str) -> String {
    let title = if map.title.is_empty() {
        "Safe window"
    } else {
        &map.title
    };
    let body = html! {
        header {
            h1 { "Safe window" }
            p.of { (title) }
            (facts(map))
        }
        (tiles(map))
        figure {
            (PreEscaped(svg))
            figcaption {
                "Every rectangle is a cell. Dots are runs; cells without a dot are inferred where the runs around "
                "them say with at least 95 % what they are. Elsewhere they are not known: pale and crossed out. The "
                "line is the boundary of the clear cells."
            }
        }
        (reading(map))
        (table(map))
    };
    document_by(&map.program, &format!("Safe window: {title}"), &body)
}

fn named(axis: &Axis) -> String {
    if axis.unit.is_empty() {
        axis.name.clone()
    } else {
        format!("{} ({})", axis.name, axis.unit)
    }
}

fn facts(map: &Map) -> Markup {
    let span = |axis: &Axis| {
        let (first, last) = (axis.values.first(), axis.values.last());
        let ends = first
            .zip(last)
            .map(|(first, last)| format!("{} to {}", number(*first), number(*last)));
        format!(
            "{} {}, {}",
            ends.unwrap_or_default(),
            axis.unit,
            counted(axis.values.len() as u64, "value")
        )
    };
    html! {
        dl.facts {
            dt { (map.x.name) } dd { (span(&map.x)) }
            dt { (map.y.name) } dd { (span(&map.y)) }
            dt { "Runs" } dd {
                (map.runs) " of " (map.cells.len() * map.starts.len()) ", each judged over " (number(map.horizon))
                " s, at most " (counted(map.members.into(), if map.plausible { "plausible tool" } else { "member" })) @if map.run_all { ", all of them run" } ", seed " (map.seed)
            }
            dt { "Alarms" } dd {
                "of " (map.priority.name()) " priority or higher, expected where their chance is above "
                (percent(map.limit))
            }
            dt { "Tools" } dd { (map.tools_in_words()) }
            @if map.model_time > 0.0 { dt { "Model time" } dd { (number(map.model_time)) " s" } }
            dt { "Computed by" } dd { (map.program) ", configuration " code { (map.configuration.get(..12).unwrap_or("")) } }
        }
    }
}

fn tiles(map: &Map) -> Markup {
    let count = |verdict| map.cells.iter().filter(|cell| cell.verdict == verdict).count();
    html! {
        div.tiles {
            div.tile.good { b { (count(Verdict::Clear)) } "cells are clear" small { "from every start" } }
            div.tile.medium { b { (count(Verdict::Alarm)) } "cells have an alarm" small { "from every start" } }
            div.tile.low {
                b { (count(Verdict::DependsOnStart)) } "cells depend on the start"
                small { "clear on one way to the values, an alarm on the other" }
            }
            div.tile.unknown { b { (count(Verdict::Unknown)) } "cells failed" small { "a run failed: not safe" } }
            div.tile.unknown {
                b { (count(Verdict::NotKnown)) } "cells are not known"
                small { "not run, and the runs around them do not say: not safe" }
            }
        }
    }
}

/// How to read the map.
fn reading(map: &Map) -> Markup {
    html! {
        h2 { "How to read it" }
        p {
            b { "From rest" } ": the tool stands, then speed and weight rise to the values. " b { "From running" }
            ": the tool runs fast under the weight, then the speed falls to the value. Where the two differ, the way to a "
            "speed decides whether the tool is in trouble there."
        }
        p {
            "A chance is the share of the members that saw any alarm, with its 95 % interval. " (map.members_in_words())
            " A member that failed is unknown, and a cell with one is never clear."
        }
    }
}

fn table(map: &Map) -> Markup {
    html! {
        h2 { "Runs" }
        table {
            thead {
                tr {
                    th.n { (named(&map.x)) } th.n { (named(&map.y)) }
                    th { "Start" } th { "Likeliest alarm" } th.n { "Chance of any" } th.n { "95 % interval" } th.n { "Members" }
                }
            }
            tbody {
                @for cell in &map.cells {
                    @for (start, of) in map.starts.iter().zip(&cell.starts) {
                        @if of.state.was_run() {
                            tr {
                                td.n { (number(cell.x)) } td.n { (number(cell.y)) }
                                td { (way(*start)) }
                                td { (alarm(of)) }
                                td.n { @if let Some(chance) = of.chance { (percent(chance)) } @else { "unknown" } }
                                td.n { (percent(of.interval[0])) " to " (percent(of.interval[1])) }
                                td.n {
                                    (of.members)
                                    @if of.failed > 0 { ", " (of.failed) " failed" }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

const fn way(start: Start) -> &'static str {
    match start {
        Start::Rest => "rest",
        Start::Running => "running",
    }
}

fn alarm(of: &OfStart) -> Markup {
    html! {
        @if of.alarm.is_empty() { "none" } @else { (of.alarm.replace('_', " ")) }
        @if !of.failure.is_empty() { br; small { (of.failure) } }
    }
}

/// A number with four digits.
fn number(value: f64) -> String {
    let digits = (3.0 - value.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A share; never 0 or 100 % where it is neither.
fn percent(share: f64) -> String {
    let whole = (100.0 * share).round();
    if (whole == 0.0) != (share == 0.0) || (whole == 100.0) != (share == 1.0) {
        format!("{:.1} %", 100.0 * share)
    } else {
        format!("{whole} %")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_shares_are_not_rounded_to_certainty() {
        assert_eq!(
            [20.0, 29.090_909, 0.1, 1234.5].map(number),
            ["20", "29.09", "0.1", "1234"]
        );
        assert_eq!(
            [0.0, 1.0, 0.001, 0.999, 0.5].map(percent),
            ["0 %", "100 %", "0.1 %", "99.9 %", "50 %"]
        );
    }
}
