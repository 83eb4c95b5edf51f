//! The page of two recordings next to each other.

use maud::{Markup, html};

use super::text::{capital, duration, number, percent, times};
use super::{document, drawn, facts, priority_class};
use crate::ReportError;
use crate::compare::{AlarmPair, Along, ComparedQuantity, Comparison, Figures, Stood, figures};
use crate::incidents::{Incident, seconds};
use crate::plots;
use crate::reading::Summary;
use flexdrill_outputs::words;

/// Width of a time line in its own units.
const WIDTH: f64 = 1000.0;
/// Least width of an incident on it: an incident of a moment is to be seen.
const LEAST: f64 = 3.0;
/// Largest number of differing lines of the configurations that are listed.
const LINES: usize = 200;

/// The page of two recordings.
///
/// # Errors
/// When a figure cannot be drawn.
pub fn html(comparison: &Comparison<'_>, tolerance: Option<f64>) -> Result<String, ReportError> {
    let (a, b) = (comparison.a, comparison.b);
    let (of_a, of_b) = (name(a), name(b));
    let time = "A is blue, B orange, each from its own beginning. Curves show the mean, pale bands the range from least to \
                largest.";
    let body = html! {
        header {
            h1 { "Two runs next to each other" }
            p.of { b { "A " } (of_a) b { " B " } (of_b) }
            div.pair {
                div { h3 { "A" } (facts(a)) }
                div { h3 { "B" } (facts(b)) }
            }
        }
        (verdict(comparison, tolerance))
        (missing(comparison))
        (over_time(comparison, tolerance))
        (drawn(figures::inputs(comparison), time)?)
        (drawn(figures::torque(comparison), time)?)
        (alarms(comparison, tolerance))
        (along_the_tool(comparison, tolerance))
        (drawn(figures::along(comparison), "Statistics over each whole run. A is blue, B orange; dashed green: B less A.")?)
        section {
            h2 { "Orbits at the worst locations" }
            (drawn(plots::named_orbits(a, "orbits_a"), "Run A, four seconds around the worst moment of each location.")?)
            (drawn(plots::named_orbits(b, "orbits_b"), "Run B, four seconds around the worst moment of each location.")?)
        }
        (configurations(comparison))
    };
    Ok(document(&format!("Two runs: {of_a} and {of_b}"), &body))
}

fn name(summary: &Summary) -> String {
    let path = &summary.path;
    path.file_name()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}

fn verdict(comparison: &Comparison<'_>, tolerance: Option<f64>) -> Markup {
    let same = comparison.beyond(0.0).is_empty();
    let beyond = tolerance.map(|tolerance| comparison.beyond(tolerance));
    html! {
        div.tiles {
            @if same {
                div.tile.good { b { "the same" } "every figure of both runs" }
            } @else if let (Some(tolerance), Some(beyond)) = (tolerance, &beyond) {
                @if beyond.is_empty() {
                    div.tile.good { b { "within " (percent(tolerance)) } "all means, and the alarms" }
                } @else {
                    div.tile.medium { b { (beyond.len()) } "beyond the tolerance of " (percent(tolerance)) }
                }
            } @else {
                div.tile { b { "different" } small { "no tolerance was given" } }
            }
            @for alarm in raised_otherwise(&comparison.alarms) {
                div.tile.(priority_class(alarm.runs.a.priority.max(alarm.runs.b.priority))) {
                    b { (stood(&alarm.runs.a)) " and " (stood(&alarm.runs.b)) }
                    (capital(&alarm.name))
                    small { "highest priority in A and in B; " (times(alarm.runs.a.times)) " and " (times(alarm.runs.b.times)) }
                }
            }
            @for quantity in largest(&comparison.quantities) {
                div.tile {
                    b { (percent(quantity.difference().unwrap_or(f64::NAN))) }
                    (capital(&quantity.name))
                    small { (of_run(&quantity.runs.a, quantity)) " and " (of_run(&quantity.runs.b, quantity)) " " (quantity.unit.shown) ", mean" }
                }
            }
        }
        @if let Some(beyond) = beyond.filter(|beyond| !beyond.is_empty()) {
            section.missing {
                h2 { "Beyond the tolerance" }
                ul { @for line in &beyond { li { (capital(line)) } } }
            }
        }
    }
}

fn of_run(figures: &Option<Figures>, quantity: &ComparedQuantity) -> String {
    number(
        figures
            .as_ref()
            .map_or(f64::NAN, |figures| quantity.unit.factor * figures.mean),
    )
}

/// Cards of alarms, and of quantities.
const CARDS: usize = 4;

/// The priority that an alarm reached in a run, in words.
fn stood(run: &Stood) -> String {
    match run.priority {
        0 => "none".to_owned(),
        priority => words::alarm_priority(priority).to_uppercase(),
    }
}

/// The alarms that reached another priority, the highest first, and of the same one those that differ by more.
fn raised_otherwise(alarms: &[AlarmPair]) -> Vec<&AlarmPair> {
    let mut order: Vec<&AlarmPair> = alarms
        .iter()
        .filter(|alarm| alarm.runs.a.priority != alarm.runs.b.priority)
        .collect();
    order.sort_by_key(|alarm| {
        let (a, b) = (alarm.runs.a.priority, alarm.runs.b.priority);
        std::cmp::Reverse((a.max(b), a.abs_diff(b)))
    });
    order.truncate(CARDS);
    order
}

/// The quantities that differ, the most important first: a large difference of a small drag matters less than a small one
/// of the weight at the bit.
fn largest(quantities: &[ComparedQuantity]) -> Vec<&ComparedQuantity> {
    let mut order: Vec<&ComparedQuantity> = quantities
        .iter()
        .filter(|quantity| quantity.difference().is_some_and(|difference| difference > 0.0))
        .collect();
    order.sort_by(|a, b| {
        let by_size = || b.difference().unwrap_or(0.0).total_cmp(&a.difference().unwrap_or(0.0));
        a.importance().cmp(&b.importance()).then_with(by_size)
    });
    order.truncate(CARDS);
    order
}

fn missing(comparison: &Comparison<'_>) -> Markup {
    let all: Vec<(&str, &String)> = [("A", comparison.a), ("B", comparison.b)]
        .into_iter()
        .flat_map(|(run, summary)| summary.missing.iter().map(move |line| (run, line)))
        .collect();
    html! {
        @if !all.is_empty() {
            section.missing {
                h2 { "What is missing" }
                ul { @for (run, line) in &all { li { b { (run) } ": " (line) } } }
            }
        }
    }
}

/// A difference, marked where it is beyond the tolerance.
fn difference(difference: Option<f64>, agrees: bool) -> Markup {
    let text = difference.map_or_else(|| "only one run".to_owned(), percent);
    html! { @if agrees { (text) } @else { b.warning { (text) } } }
}

fn over_time(comparison: &Comparison<'_>, tolerance: Option<f64>) -> Markup {
    let shared = comparison.a.seconds().min(comparison.b.seconds());
    html! {
        section {
            h2 { "Quantities over time" }
            p { "Means are over the time that both runs cover, " (duration(shared)) ". Least and largest values are those of each whole run." }
            table {
                thead { tr {
                    th { "quantity" } th { "unit" } th.n { "A least" } th.n { "A mean" } th.n { "A largest" }
                    th.n { "B least" } th.n { "B mean" } th.n { "B largest" } th.n { "B less A" } th.n { "difference" }
                } }
                tbody { @for quantity in &comparison.quantities { (row(quantity, tolerance)) } }
            }
        }
    }
}

fn row(quantity: &ComparedQuantity, tolerance: Option<f64>) -> Markup {
    let factor = quantity.unit.factor;
    let values = |figures: &Option<Figures>| match figures {
        Some(figures) => [figures.min, figures.mean, figures.max].map(|value| number(factor * value)),
        None => [(); 3].map(|()| number(f64::NAN)),
    };
    let change = match (&quantity.runs.a, &quantity.runs.b) {
        (Some(a), Some(b)) => factor * (b.mean - a.mean),
        _ => f64::NAN,
    };
    html! {
        tr {
            td { (quantity.name) } td { (quantity.unit.shown) }
            @for value in values(&quantity.runs.a) { td.n { (value) } }
            @for value in values(&quantity.runs.b) { td.n { (value) } }
            td.n { (number(change)) }
            td.n { (difference(quantity.difference(), tolerance.is_none_or(|t| quantity.agrees(t)))) }
        }
    }
}

fn along_the_tool(comparison: &Comparison<'_>, tolerance: Option<f64>) -> Markup {
    let known: Vec<&Along> = comparison
        .along
        .iter()
        .filter(|along| !along.curves.a.is_empty() || !along.curves.b.is_empty())
        .collect();
    html! {
        @if !known.is_empty() {
            section {
                h2 { "Along the tool" }
                p { "The difference is the root mean square over depth, relative to that of the larger curve. Extremes of a chaotic \
                     motion differ between any two runs; a tolerance applies to means and root mean squares only." }
                table {
                    thead { tr {
                        th { "quantity" } th { "unit" } th.n { "difference" } th.n { "largest at (m)" } th.n { "A there" } th.n { "B there" }
                    } }
                    tbody { @for along in known {
                        tr {
                            td { (along.name) } td { (along.unit.0) }
                            td.n { (difference(along.worst.map(|worst| worst.relative), tolerance.is_none_or(|t| along.agrees(t)))) }
                            @match &along.worst {
                                Some(worst) => {
                                    td.n { (format!("{:.2}", worst.measured_depth)) }
                                    @for value in worst.values { td.n { (number(along.unit.1 * value)) } }
                                },
                                None => { td {} td {} td {} },
                            }
                        }
                    } }
                }
            }
        }
    }
}

fn alarms(comparison: &Comparison<'_>, tolerance: Option<f64>) -> Markup {
    let (a, b) = (comparison.a, comparison.b);
    let end = a.seconds().max(b.seconds()).max(1e-3);
    html! {
        section {
            h2 { "Alarms on one time line" }
            @if !a.has_alarms() && !b.has_alarms() {
                p { "Neither bag has messages about alarms." }
            } @else if comparison.alarms.is_empty() {
                p { "No alarm occurred in either run." }
            } @else {
                table.timeline {
                    thead { tr { th { "alarm" } th {} th { (ticks(end)) } th.n { "times" } th.n { "total time" } } }
                    tbody { @for alarm in &comparison.alarms {
                        @let differs = !tolerance.is_none_or(|t| alarm.agrees(t));
                        (line(alarm, true, a, end, differs))
                        (line(alarm, false, b, end, differs))
                    } }
                }
                p.note {
                    "Times count from the beginning of each run. "
                    @for (class, word) in [("high", "high"), ("medium", "medium"), ("low", "low")] {
                        span.priority.(class) { (word) } " "
                    }
                    "is the highest priority that an incident reached."
                }
            }
        }
    }
}

fn line(alarm: &AlarmPair, first: bool, summary: &Summary, end: f64, differs: bool) -> Markup {
    let stood: &Stood = if first { &alarm.runs.a } else { &alarm.runs.b };
    let list = summary.incidents.list();
    html! {
        tr.second[!first] {
            @if first { td rowspan="2" { (capital(&alarm.name)) @if differs { " " b.warning { "differs" } } } }
            td { (if first { "A" } else { "B" }) }
            td { svg viewBox={ "0 0 " (WIDTH) " 14" } preserveAspectRatio="none" {
                rect x="0" y="6.5" width={ (format!("{:.1}", WIDTH * summary.seconds() / end)) } height="1" fill="#d9dde0" {}
                @for incident in list.iter().filter(|incident| incident.alarm == alarm.id) { (bar(incident, summary, end)) }
            } }
            td.n { (if stood.times == 0 { "none".to_owned() } else { times(stood.times) }) }
            td.n { @if stood.times > 0 { (duration(stood.duration)) } }
        }
    }
}

fn bar(incident: &Incident, summary: &Summary, end: f64) -> Markup {
    let at = |time: f64| WIDTH * (time / end).clamp(0.0, 1.0);
    let begin = at(seconds(incident.begin));
    let until = at(incident.end.map_or(summary.seconds(), seconds));
    let width = (until - begin).max(LEAST);
    let color = match priority_class(incident.priority) {
        "high" => "#b3261e",
        "medium" => "#d55e00",
        "low" => "#e69f00",
        _ => "#999",
    };
    html! {
        rect x={ (format!("{:.1}", begin.min(WIDTH - width))) } y="1" width={ (format!("{width:.1}")) } height="12" fill=(color) {
            title { (words::alarm_priority(incident.priority)) ", " (incident.worst.evidence) }
        }
    }
}

/// The numbers above the time lines.
fn ticks(end: f64) -> Markup {
    let (unit, length) = match end {
        ..300.0 => ("s", 1.0),
        ..10_800.0 => ("min", 60.0),
        _ => ("h", 3600.0),
    };
    html! {
        span.ticks { @for part in 0..5 {
            span { (number(end / length * f64::from(part) / 4.0)) @if part == 4 { " " (unit) } }
        } }
    }
}

fn configurations(comparison: &Comparison<'_>) -> Markup {
    let (a, b) = (comparison.a.session.as_ref(), comparison.b.session.as_ref());
    html! {
        section {
            h2 { "Configurations" }
            @match (a, b) {
                (Some(a), Some(b)) => {
                    dl.facts {
                        dt { "A" } dd { "hash " code { (a.config_hash) } ", step " (number(1e3 * a.time_step)) " ms" }
                        dt { "B" } dd { "hash " code { (b.config_hash) } ", step " (number(1e3 * b.time_step)) " ms" }
                    }
                    @if a.configuration == b.configuration {
                        p { "Both runs have the same configuration." }
                    } @else {
                        @let lines = differing(&a.configuration, &b.configuration);
                        table {
                            thead { tr { th { "only in A" } th { "only in B" } } }
                            tbody { @for [a, b] in lines.iter().take(LINES) { tr { td { code { (a) } } td { code { (b) } } } } }
                        }
                        @if lines.len() > LINES { p { "And " (lines.len() - LINES) " more lines." } }
                    }
                },
                _ => p { "At least one bag does not have its configuration." },
            }
        }
    }
}

/// Keys with their values, each with its path, that only one of two configurations has or that differ.
fn differing(a: &str, b: &str) -> Vec<[String; 2]> {
    let (a, b) = (keys(a), keys(b));
    let mut all: Vec<&String> = a.iter().chain(&b).map(|(key, _)| key).collect();
    let mut seen = std::collections::BTreeSet::new();
    all.retain(|key| seen.insert(*key));
    let of = |of: &[(String, String)], key: &String| {
        let values: Vec<&str> = of
            .iter()
            .filter(|(known, _)| known == key)
            .map(|(_, value)| value.as_str())
            .collect();
        (!values.is_empty()).then(|| values.join(" "))
    };
    let shown = |key: &String, value: &Option<String>| {
        value
            .as_ref()
            .map_or_else(String::new, |value| format!("{key}: {value}"))
    };
    all.into_iter()
        .filter_map(|key| {
            let (x, y) = (of(&a, key), of(&b, key));
            (x != y).then(|| [shown(key, &x), shown(key, &y)])
        })
        .collect()
}

/// The keys of the recorded configuration with their whole path, from its indentation. The twin writes it in block style,
/// two blanks a level.
fn keys(text: &str) -> Vec<(String, String)> {
    let mut path: Vec<(usize, String)> = Vec::new();
    let mut found = Vec::new();
    for line in text.lines() {
        let line = line.split(" #").next().unwrap_or(line).trim_end();
        let content = line.trim_start();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let indent = line.len() - content.len();
        path.retain(|(known, _)| *known < indent);
        let (key, value) = match content.split_once(':') {
            Some((key, value)) if !content.starts_with('-') => (key, value.trim()),
            _ => ("", content),
        };
        let names: Vec<&str> = path
            .iter()
            .map(|(_, name)| name.as_str())
            .chain([key])
            .filter(|name| !name.is_empty())
            .collect();
        if value.is_empty() {
            path.push((indent, key.to_owned()));
        } else {
            found.push((names.join("."), value.to_owned()));
        }
    }
    found
}

#[cfg(test)]
mod tests;
