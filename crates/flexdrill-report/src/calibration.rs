//! The page of a calibration: what was found, how it explains the log, and what was left out.

use maud::{Markup, html};

use crate::ReportError;
use crate::page::{document, drawn, text};
use flexdrill_calibration::BAND;
use flexdrill_calibration::fit::{Outcome, Problem};
use flexdrill_calibration::identify::{Estimate, Verdict};
use flexdrill_calibration::windows::{Activity, Channel, Windows};
use flexdrill_core::units::{m_per_s_to_m_per_h, n_to_kn, pa_to_mpa, rad_per_s_to_rpm};
use flexdrill_plot::{Figure, Line, Panel};

/// Largest number of windows in the table; the figures have all.
const ROWS: usize = 200;
/// Height of a row of panels, for a width of 1080.
const HEIGHT: u32 = 330;

/// What the page says besides the numbers.
#[derive(Debug, Clone, Default)]
pub struct About {
    /// Name of the log.
    pub log: String,
    /// Lines on log, rows, hash, version.
    pub lines: Vec<String>,
    /// Unknowns that the configuration does not have, with the reason.
    pub left_out: Vec<(&'static str, &'static str)>,
    /// Channels that are not used, with the reason.
    pub refused: Vec<(&'static str, &'static str)>,
    /// Full runs of the twin with what was found.
    pub checked: Vec<Checked>,
    /// Why runs of the twin gave no figure.
    pub failed: Vec<String>,
    /// Why the values are not to be used; empty where they may be.
    pub objections: Vec<String>,
}

/// A full run of the twin with what was found. SI.
#[derive(Debug, Clone)]
pub struct Checked {
    /// Window of the log.
    pub window: usize,
    /// Quantity.
    pub channel: Channel,
    /// With which unknowns, in words.
    pub at: String,
    /// Mean of the log.
    pub measured: f64,
    /// The twin's figure, or why there is none.
    pub run: Result<f64, String>,
    /// The surrogate's.
    pub surrogate: f64,
    /// Half of the 90 % band of the run less the surrogate.
    pub surrogate_band: f64,
    /// Half of the 90 % band of the measurement.
    pub band: f64,
}

/// The page of a calibration.
///
/// # Errors
/// When a figure cannot be drawn.
pub fn html(about: &About, windows: &Windows, problem: &Problem, outcome: &Outcome) -> Result<String, ReportError> {
    let body = html! {
        header {
            h1 { "Calibration" }
            p.of { (about.log) }
            @for line in &about.lines { p.note { (line) } }
        }
        (tiles(about, problem, outcome))
        @if !about.objections.is_empty() {
            section.missing {
                h2 { "Not to be used" }
                p { "The values below are not to be used:" }
                ul { @for objection in &about.objections { li { (text::capital(objection)) "." } } }
            }
        }
        @if !about.refused.is_empty() {
            section.missing {
                h2 { "Not used" }
                ul { @for (channel, why) in &about.refused { li { b { (text::capital(channel)) } ": " (why) "." } } }
            }
        }
        (parameters(about, problem, outcome))
        (drawn(bands(problem, outcome), "Standardised unknowns: 0 is the middle of what was expected, grey the 90 % of it. \
            Blue: the 90 % band with the log.")?)
        (fit(windows, problem, outcome)?)
        (checked(about, windows))
        (quantities(windows, problem, outcome))
        (surrogates(problem, about))
        (left_out(windows))
        (window_table(windows, problem, outcome))
    };
    Ok(document(&format!("Calibration: {}", about.log), &body))
}

fn tiles(about: &About, problem: &Problem, outcome: &Outcome) -> Markup {
    let count = |verdict: Verdict| {
        outcome
            .estimates
            .iter()
            .filter(|estimate| estimate.verdict == verdict)
            .count()
    };
    html! {
        div.tiles {
            div.tile.(if about.objections.is_empty() { "good" } else { "high" }) {
                b { (text::number(outcome.misfit.sqrt())) } "residual over its stated error" small { "root mean square; near or below 1 explains the log" }
            }
            div.tile { b { (count(Verdict::Identified)) " of " (problem.unknowns.len()) } "unknowns identified" small { "to 5 %" } }
            div.tile { b { (count(Verdict::Bounded)) } "bounded" small { "known better than before, not to 5 %" } }
            div.tile { b { (count(Verdict::InCombination)) } "known in combination only" }
            div.tile.unknown { b { (count(Verdict::NotIdentifiable)) } "hardly moved" small { "left as they are" } }
            div.tile { b { (problem.observations.len()) } "means of steady windows" }
        }
    }
}

/// A value of an unknown whose unit is `unit` (SI, empty for a number alone), as page and command show it: newtons as kN,
/// pascals as MPa.
pub fn shown(unit: &str, value: f64) -> String {
    match unit {
        "N" => format!("{} kN", text::number(n_to_kn(value))),
        "Pa" => format!("{} MPa", text::number(pa_to_mpa(value))),
        "" => text::number(value),
        unit => format!("{} {unit}", text::number(value)),
    }
}

fn verdict(estimate: &Estimate) -> Markup {
    match estimate.verdict {
        Verdict::Identified => html! { "identified" },
        Verdict::Bounded => html! { "bounded" },
        Verdict::InCombination => html! { "only in combination" },
        Verdict::NotIdentifiable => html! { b.warning { "hardly moved" } " by this log, left as it is" },
    }
}

fn parameters(about: &About, problem: &Problem, outcome: &Outcome) -> Markup {
    html! {
        section {
            h2 { "What was found" }
            table {
                thead { tr { th { "unknown" } th { "expected, 90 %" } th { "found" } th { "90 % band" } th.n { "posterior over prior width" } th {} } }
                tbody {
                    @for (unknown, estimate) in problem.unknowns.iter().zip(&outcome.estimates) {
                        @let [low, high] = unknown.prior();
                        tr {
                            td { (text::capital(&unknown.name)) }
                            td { (shown(unknown.unit, low)) " to " (shown(unknown.unit, high)) }
                            td { @if estimate.verdict != Verdict::NotIdentifiable { b { (shown(unknown.unit, estimate.value)) } } @else { "–" } }
                            td { @if estimate.verdict != Verdict::NotIdentifiable {
                                (shown(unknown.unit, estimate.band[0])) " to " (shown(unknown.unit, estimate.band[1]))
                            } }
                            td.n { (text::number(estimate.width_ratio())) }
                            td { (verdict(estimate)) }
                        }
                    }
                    @for (name, why) in &about.left_out {
                        tr { td { (text::capital(name)) } td {} td { "–" } td {} td {} td { "not fitted: " (why) } }
                    }
                }
            }
            p.note { "This log can hardly move an unknown whose posterior is above 0.9 of its prior's width: it keeps its prior. Factors and \
                tares of the weight indicator are those of plausible tools; the twin itself takes the weight as the rig shows it." }
            @for pair in &outcome.pairs {
                @let [a, b] = pair.unknowns.map(|index| problem.unknowns[index].name.as_str());
                p {
                    "The log shows only the " (if pair.correlation < 0.0 { "sum" } else { "difference" }) " of " b { (a) } " and " b { (b) }
                    ": their correlation is " (text::number(pair.correlation)) ". The combination with the weights "
                    (text::number(pair.weights[0])) " and " (text::number(pair.weights[1])) " of the standardised unknowns is known to "
                    (text::number(pair.variance_ratio.sqrt())) " of what was expected."
                }
            }
        }
    }
}

/// Prior and posterior of all unknowns, standardised.
fn bands(problem: &Problem, outcome: &Outcome) -> Option<Figure> {
    let names = problem.unknowns.iter().map(|unknown| {
        unknown
            .name
            .replace("friction of ", "")
            .replace("tare of the ", "tare: ")
    });
    let mut panel = Panel::new("Expected and found", "", "standardised").named(names.collect());
    for (index, (unknown, estimate)) in problem.unknowns.iter().zip(&outcome.estimates).enumerate() {
        let x = index as f64;
        let [low, high] = estimate.band.map(|end| unknown.standard(end));
        let middle = unknown.standard(estimate.value);
        panel = panel
            .line(Line::new("", vec![(x - 0.12, -BAND), (x - 0.12, BAND)]).wide().color(6))
            .line(Line::new("", vec![(x + 0.12, low), (x + 0.12, high)]).wide().color(0))
            .line(Line::new("", vec![(x + 0.12, middle)]).dots().color(0));
    }
    Some(Figure {
        name: "bands",
        title: String::new(),
        caption: String::new(),
        columns: 1,
        height: HEIGHT,
        panels: vec![panel],
    })
}

fn unit(channel: Channel) -> (&'static str, f64) {
    match channel {
        Channel::SurfaceTorque | Channel::BitTorque => ("N m", 1.0),
        Channel::HookLoad | Channel::BitWeight => ("kN", n_to_kn(1.0)),
        Channel::RateOfPenetration => ("m/h", m_per_s_to_m_per_h(1.0)),
    }
}

fn state(motion: Activity) -> &'static str {
    match motion {
        Activity::OffBottom => "off bottom",
        Activity::Drilling => "drilling",
    }
}

/// Measured against predicted, and the residuals over the time of the log.
fn fit(windows: &Windows, problem: &Problem, outcome: &Outcome) -> Result<Markup, ReportError> {
    // Minutes for a short log, hours for a long one, so that the axis has readable numbers.
    let end = windows.steady.iter().map(|window| window.span[1]).fold(1.0, f64::max);
    let (time, per) = if end < 10_800.0 {
        ("time (min)", 60.0)
    } else {
        ("time (h)", 3600.0)
    };
    let mut panels = Vec::new();
    for channel in Channel::ALL {
        let (unit, factor) = unit(channel);
        // Off bottom and drilling have different surrogates and are shown apart.
        let of = |motion: Activity| {
            let all = problem.observations.iter().zip(&outcome.explained);
            all.filter(move |(observation, _)| {
                let quantity = &problem.quantities[observation.quantity];
                quantity.channel == channel && quantity.motion == motion
            })
        };
        let (mut against, mut over) = (
            Panel::new(
                text::capital(channel.name_and_unit().0),
                &format!("measured ({unit})"),
                &format!("{unit}, predicted"),
            ),
            Panel::new("Measured less predicted", time, unit),
        );
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut any = false;
        // Both states share one panel of a channel, because one coefficient explains both.
        for (motion, color) in [(Activity::Drilling, 0), (Activity::OffBottom, 1)] {
            let points: Vec<(f64, f64)> = of(motion)
                .map(|(o, e)| (factor * o.value, factor * e.predicted))
                .collect();
            let prior: Vec<(f64, f64)> = of(motion).map(|(o, e)| (factor * o.value, factor * e.prior)).collect();
            if points.is_empty() {
                continue;
            }
            any = true;
            // The expected values before the fit belong to the range too, or the improvement would be cut off.
            for (x, y) in points.iter().chain(&prior) {
                low = low.min(*x).min(*y);
                high = high.max(*x).max(*y);
            }
            if motion == Activity::Drilling {
                against = against.line(Line::new("as configured before", prior).dots().color(6));
            }
            against = against.line(Line::new(state(motion), points).dots().color(color));
            // A vertical line for each band, through zero: a residual within it is explained.
            for (observation, explained) in of(motion) {
                let (x, band) = (observation.time / per, factor * explained.band);
                over = over.line(Line::new("", vec![(x, -band), (x, band)]).thin().color(6));
            }
            let residuals = of(motion).map(|(o, e)| (o.time / per, factor * (o.value - e.predicted)));
            over = over.line(Line::new(state(motion), residuals.collect()).dots().color(color));
        }
        if any {
            // The diagonal comes last, when the range of all points is known.
            panels.push(against.line(Line::new("", vec![(low, low), (high, high)]).dashed().color(6)));
            panels.push(over);
        }
    }
    let figure = (!panels.is_empty()).then(|| Figure {
        name: "fit",
        title: String::new(),
        caption: String::new(),
        columns: 2,
        height: HEIGHT,
        panels,
    });
    Ok(html! {
        section {
            h2 { "How it explains the log" }
            (drawn(figure, "Left: a point on the dashed line is predicted exactly; grey as it was expected beforehand. Right: residuals \
                with the 90 % band of each window, which holds scatter, drift and the error of the surrogate.")?)
        }
    })
}

fn checked(about: &About, windows: &Windows) -> Markup {
    html! {
        @if !about.checked.is_empty() {
            section {
                h2 { "Checked by full runs" }
                p { "Full runs of the twin at the loads of some windows, with what was found and with members of the ensemble. \
                     A run must agree with the surrogate within the surrogate's band, and with the log within the log's." }
                table {
                    thead { tr { th { "quantity" } th { "rows" } th { "run with" } th.n { "r/min" } th.n { "kN" } th.n { "measured" } th.n { "90 % band" } th.n { "full run" } th.n { "surrogate" } th.n { "90 % band" } th { "unit" } } }
                    tbody { @for checked in &about.checked {
                        @let (unit, factor) = unit(checked.channel);
                        @let window = &windows.steady[checked.window];
                        tr {
                            td { (checked.channel.name_and_unit().0) ", " (state(window.motion)) }
                            td { (window.rows[0]) " to " (window.rows[1]) }
                            td { (checked.at) }
                            td.n { (text::number(rad_per_s_to_rpm(window.rotary_speed))) }
                            td.n { (text::number(n_to_kn(window.weight))) }
                            td.n { (text::number(factor * checked.measured)) }
                            td.n { "± " (text::number(factor * checked.band)) }
                            @match &checked.run {
                                Ok(value) => td.n { (text::number(factor * value)) },
                                Err(problem) => td { (problem) },
                            }
                            td.n { (text::number(factor * checked.surrogate)) }
                            td.n { "± " (text::number(factor * checked.surrogate_band)) }
                            td { (unit) }
                        }
                    } }
                }
            }
        }
    }
}

/// Whether the twin explains each quantity.
fn quantities(windows: &Windows, problem: &Problem, outcome: &Outcome) -> Markup {
    html! {
        section {
            h2 { "What the twin explains" }
            table {
                thead { tr { th { "quantity" } th.n { "windows" } th.n { "residuals over their stated errors" } th.n { "at most" } th { "largest in rows" } th {} } }
                tbody { @for check in &outcome.checks {
                    @let quantity = &problem.quantities[check.quantity];
                    @let window = &windows.steady[problem.observations[check.worst].window];
                    tr {
                        td { (quantity.channel.name_and_unit().0) ", " (state(quantity.motion)) }
                        td.n { (check.windows) }
                        td.n { (text::number(check.times)) }
                        td.n { (text::number(check.most)) }
                        td { (window.rows[0]) " to " (window.rows[1]) }
                        td { @if check.is_explained() { "explained" } @else { b.warning { "not explained" } } }
                    }
                } }
            }
            p.note { "Root mean square, with the correlation of the errors. The bound is twice the stated error, and more for few windows: \
                what chance gives in one quantity of 10,000." }
        }
    }
}

fn surrogates(problem: &Problem, about: &About) -> Markup {
    html! {
        section {
            h2 { "Surrogates of the twin" }
            table {
                thead { tr { th { "quantity" } th.n { "runs" } th.n { "least" } th.n { "largest" } th.n { "error of a run left out" } th { "unit" } th.n { "over its stated error" } } }
                tbody { @for quantity in &problem.quantities {
                    @let (unit, factor) = unit(quantity.channel);
                    tr {
                        td { (quantity.channel.name_and_unit().0) ", " (state(quantity.motion)) }
                        td.n { (quantity.surrogate.points) }
                        @for end in quantity.surrogate.range { td.n { (text::number(factor * end)) } }
                        td.n { (text::number(factor * quantity.surrogate.error)) }
                        td { (unit) }
                        td.n { (text::number(quantity.surrogate.over_stated())) }
                    }
                } }
            }
            @if !about.failed.is_empty() {
                p { (about.failed.len()) " runs gave no figure; the first: " (about.failed[0]) "." }
            }
        }
    }
}

fn left_out(windows: &Windows) -> Markup {
    let used: usize = windows.steady.iter().map(|window| window.samples).sum();
    html! {
        section {
            h2 { "What was left out" }
            table {
                thead { tr { th { "reason" } th.n { "samples" } } }
                tbody {
                    tr { td { "in steady windows, used" } td.n { (used) } }
                    @for (reason, samples) in windows.left_out_by_reason() { tr { td { (reason) } td.n { (samples) } } }
                }
            }
        }
    }
}

fn window_table(windows: &Windows, problem: &Problem, outcome: &Outcome) -> Markup {
    let all: Vec<_> = problem.observations.iter().zip(&outcome.explained).collect();
    html! {
        section {
            h2 { "Windows" }
            table {
                thead { tr { th { "rows" } th { "motion" } th.n { "r/min" } th.n { "kN" } th { "quantity" } th.n { "measured" } th.n { "predicted" } th.n { "90 % band" } th { "unit" } th.n { "residual over its error" } } }
                tbody { @for (observation, explained) in all.iter().take(ROWS) {
                    @let window = &windows.steady[observation.window];
                    @let quantity = &problem.quantities[observation.quantity];
                    @let (unit, factor) = unit(quantity.channel);
                    tr {
                        td { (window.rows[0]) " to " (window.rows[1]) }
                        td { (state(window.motion)) }
                        td.n { (text::number(rad_per_s_to_rpm(window.rotary_speed))) }
                        td.n { (text::number(n_to_kn(window.weight))) }
                        td { (quantity.channel.name_and_unit().0) }
                        td.n { (text::number(factor * observation.value)) }
                        td.n { (text::number(factor * explained.predicted)) }
                        td.n { "± " (text::number(factor * explained.band)) }
                        td { (unit) }
                        td.n { (text::number(explained.standardised)) }
                    }
                } }
            }
            @if all.len() > ROWS { p { "And " (all.len() - ROWS) " more, in calibration.json." } }
        }
    }
}
