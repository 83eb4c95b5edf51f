//! All results as one table.

use serde_json::Value;

use flexdrill_alarms::Priority;

use crate::directory::{Directory, Found};
use crate::error::SweepError;
use crate::outcome::Outcome;
use crate::plan::{Plan, Point};
use flexdrill_text::table_cell;

impl Directory {
    /// The results as CSV, a row per point in the plan's order. The bytes depend on plan and results only. With `partial`,
    /// points without a result are rows of the state `missing`.
    ///
    /// # Errors
    /// When a point has no result and `partial` is not set, or a file is damaged or cannot be read.
    pub fn collect(&self, partial: bool) -> Result<Vec<u8>, SweepError> {
        // All points are looked at before any problem is reported, so that the error has their whole number.
        let mut missing = 0;
        let mut damaged = Vec::new();
        let mut writer = csv::Writer::from_writer(Vec::new());
        let failed = |reason: csv::Error| SweepError::Write {
            path: self.path().to_owned(),
            reason: std::io::Error::other(reason),
        };
        writer.write_record(header(self.plan())).map_err(failed)?;
        for point in self.points() {
            let outcome = match self.find(point)? {
                Found::Missing => {
                    missing += 1;
                    None
                    // A damaged point is no missing one: computing it again would
                    // overwrite what may be the trace of a fault.
                }
                Found::Done(outcome) => Some(outcome),
                Found::Damaged(damage) => {
                    damaged.push((self.file(point), damage));
                    None
                }
            };
            // Rows are in the plan's order, with or without a result, so
            // that the bytes do not depend on who computed what.
            writer
                .write_record(row(self.plan(), point, outcome.as_deref()))
                .map_err(failed)?;
        }
        // Damage outranks a missing result, also with `partial`.
        if let Some((path, damage)) = damaged.first() {
            return Err(SweepError::DamagedPoint {
                path: path.clone(),
                reason: damage.to_string(),
                damaged: damaged.len(),
            });
        }
        if missing > 0 && !partial {
            return Err(SweepError::Incomplete {
                path: self.path().to_owned(),
                missing,
                points: self.points().len(),
            });
        }
        writer.into_inner().map_err(|error| SweepError::Write {
            path: self.path().to_owned(),
            reason: std::io::Error::other(error.to_string()),
        })
    }
}

/// Columns that every table has, before those of alarms and figures.
const OWN: [&str; 11] = [
    "state",
    "members",
    "failed",
    "run_up_s",
    "good",
    "degraded",
    "poor",
    "failure",
    "any_alarm_low",
    "any_alarm_medium",
    "any_alarm_high",
];
/// Names of the quantiles.
const QUANTILES: [&str; 3] = ["p5", "p50", "p95"];

fn header(plan: &Plan) -> Vec<String> {
    let mut names: Vec<String> = vec!["point".to_owned()];
    names.extend(plan.keys.iter().map(|key| table_cell(key).into_owned()));
    names.extend(["start", "seed"].map(str::to_owned));
    names.extend(OWN.map(str::to_owned));
    for alarm in &plan.runs.alarms {
        let alarm = table_cell(alarm);
        names.extend(Priority::ALL.map(|priority| format!("{alarm}_{}", priority.name())));
    }
    for (figure, unit) in &plan.runs.figures {
        let (figure, unit) = (table_cell(figure), in_a_name(&table_cell(unit)));
        names.extend(QUANTILES.map(|quantile| format!("{figure}{unit}_{quantile}")));
    }
    names
}

/// A unit as the end of a column's name.
fn in_a_name(unit: &str) -> String {
    match unit {
        "" => String::new(),
        unit => format!(
            "_{}",
            unit.to_lowercase()
                .replace("1/", "per_")
                .replace('/', "_per_")
                .replace(' ', "")
        ),
    }
}

fn row(plan: &Plan, point: &Point, outcome: Option<&Outcome>) -> Vec<String> {
    let mut cells = vec![point.id.clone()];
    cells.extend(plan.values(point.row).map(|(_, value)| text(value)));
    cells.extend([point.start.name().to_owned(), point.seed.to_string()]);
    let Some(outcome) = outcome else {
        cells.push("missing".to_owned());
        let empty = OWN.len() - 1 + 3 * (plan.runs.alarms.len() + plan.runs.figures.len());
        cells.extend(vec![String::new(); empty]);
        return cells;
    };
    let state = if outcome.ended() > 0 { "known" } else { "unknown" };
    cells.extend([
        state.to_owned(),
        outcome.members.to_string(),
        outcome.failed.to_string(),
        outcome.run_up.map_or(String::new(), number),
    ]);
    cells.extend(outcome.quality.map(|count| count.to_string()));
    cells.push(table_cell(&outcome.failure).into_owned());
    cells.extend(outcome.any_alarm.map(|count| count.to_string()));
    for alarm in &plan.runs.alarms {
        for priority in Priority::ALL {
            let of = outcome
                .alarms
                .iter()
                .find(|count| count.alarm == *alarm && count.priority == priority);
            cells.push(of.map_or(0, |count| count.seen).to_string());
        }
    }
    for figure in &outcome.figures {
        match figure.quantiles {
            Some(quantiles) => cells.extend(quantiles.map(number)),
            None => cells.extend(vec![String::new(); 3]),
        }
    }
    cells
}

/// The shortest text that reads as the same number.
fn number(value: f64) -> String {
    value.to_string()
}

fn text(value: &Value) -> String {
    match value {
        Value::String(text) => table_cell(text).into_owned(),
        other => other.to_string(),
    }
}
