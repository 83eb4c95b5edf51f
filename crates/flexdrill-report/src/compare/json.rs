//! The comparison for scripts.

use serde_json::{Value, json};

use super::{AlarmPair, Along, ComparedQuantity, Comparison, Figures, Pair, Stood};
use crate::reading::Summary;
use flexdrill_outputs::words;

/// Version of the document.
const VERSION: u32 = 1;

pub(super) fn of(comparison: &Comparison<'_>, tolerance: Option<f64>) -> Value {
    let beyond = tolerance.map(|tolerance| comparison.beyond(tolerance));
    json!({
        "version": VERSION,
        "a": run(comparison.a),
        "b": run(comparison.b),
        "same": comparison.beyond(0.0).is_empty(),
        "tolerance": tolerance,
        "beyond_tolerance": beyond,
        "quantities": comparison.quantities.iter().map(quantity).collect::<Vec<_>>(),
        "along_the_tool": comparison.along.iter().map(along).collect::<Vec<_>>(),
        "alarms": comparison.alarms.iter().map(alarm).collect::<Vec<_>>(),
    })
}

fn run(summary: &Summary) -> Value {
    let session = summary.session.as_ref();
    json!({
        "path": summary.path.to_string_lossy(),
        "namespace": summary.namespace,
        "start_ns": summary.start,
        "duration_s": summary.seconds(),
        "messages": summary.messages,
        "version": session.map(|session| &session.version),
        "config_hash": session.map(|session| &session.config_hash),
        "missing": summary.missing,
    })
}

/// Values of the table are in the unit that is shown there; here everything is SI.
fn quantity(quantity: &ComparedQuantity) -> Value {
    let figures = |figures: &Option<Figures>| {
        figures
            .as_ref()
            .map(|figures| json!({"min": figures.min, "mean": figures.mean, "max": figures.max}))
    };
    json!({
        "name": quantity.name,
        "unit": si(quantity.unit.shown),
        "a": figures(&quantity.runs.a),
        "b": figures(&quantity.runs.b),
        "relative_difference": quantity.difference(),
    })
}

fn along(along: &Along) -> Value {
    let Pair { a, b } = &along.curves;
    json!({
        "name": along.name,
        "unit": si(along.unit.0),
        "measured_depth_and_value": {"a": a, "b": b},
        "relative_difference": along.worst.map(|worst| worst.relative),
        "largest_difference": along.worst.map(|worst| json!({
            "measured_depth": worst.measured_depth,
            "a": worst.values[0],
            "b": worst.values[1],
        })),
    })
}

fn alarm(alarm: &AlarmPair) -> Value {
    let stood = |stood: &Stood| {
        json!({
            "times": stood.times,
            "duration_s": stood.duration,
            "priority": if stood.times > 0 { Some(words::alarm_priority(stood.priority)) } else { None },
        })
    };
    json!({
        "id": alarm.id,
        "name": alarm.name,
        "a": stood(&alarm.runs.a),
        "b": stood(&alarm.runs.b),
    })
}

/// The SI unit of a quantity that is shown in another one.
fn si(shown: &str) -> &'static str {
    match shown {
        "r/min" => "rad/s",
        "kN" => "N",
        "N m" => "N m",
        "W" => "W",
        "m/h" => "m/s",
        "MPa" => "Pa",
        "mm per turn" => "m",
        "m/s²" => "m/s2",
        "deg" => "rad",
        _ => "1",
    }
}
