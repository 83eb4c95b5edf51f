//! A map as tables and in words.

use flexdrill_alarms::Priority;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_sweep::SweepError;
use flexdrill_sweep::envelope::Envelope;
use flexdrill_sweep::map::{Axis, Map, Origin, ROTARY_SPEED, Verdict, WEIGHT_ON_BIT};
use flexdrill_text::{counted, table_cell};

/// Whose bounds a table of an envelope has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// The first axis, for every value of the second.
    X,
    /// The second axis, for every value of the first.
    Y,
}

fn failed(error: impl std::error::Error + Send + Sync + 'static) -> SweepError {
    SweepError::Write {
        path: "map.csv".into(),
        reason: std::io::Error::other(error),
    }
}

fn written(rows: Vec<Vec<String>>) -> Result<Vec<u8>, SweepError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row).map_err(failed)?;
    }
    writer.into_inner().map_err(|error| failed(error.into_error()))
}

/// The map as CSV, a row per cell and start.
///
/// # Errors
/// When the table cannot be built, which does not occur in memory.
pub fn csv(map: &Map) -> Result<Vec<u8>, SweepError> {
    let alarms = alarms(map);
    // Figures have the same names in all runs, so the first that has any gives the columns.
    let figures: Vec<(String, String)> = map
        .cells
        .iter()
        .flat_map(|cell| &cell.starts)
        .find(|start| !start.figures.is_empty())
        .map(|start| {
            start
                .figures
                .iter()
                .map(|figure| (figure.name.clone(), figure.unit.clone()))
                .collect()
        })
        .unwrap_or_default();
    let mut header = [&map.x.key, &map.y.key]
        .map(|key| table_cell(key).into_owned())
        .to_vec();
    let own = [
        "verdict",
        "start",
        "state",
        "expected",
        "confidence",
        "chance",
        "chance_low",
        "chance_high",
        "alarm",
        "members",
        "failed",
        "failure",
    ];
    header.extend(own.map(str::to_owned));
    // Ids, figures and failures come from files, and a spreadsheet would run a cell that begins like a formula:
    // `table_cell` prevents that.
    for alarm in &alarms {
        let alarm = table_cell(alarm);
        header.extend(Priority::ALL.map(|priority| format!("{alarm}_{}", priority.name())));
    }
    for (name, unit) in &figures {
        let unit = if unit.is_empty() {
            String::new()
        } else {
            format!(" ({unit})")
        };
        let (name, unit) = (table_cell(name), table_cell(&unit));
        header.extend(["p5", "p50", "p95"].map(|quantile| format!("{name}_{quantile}{unit}")));
    }
    let mut rows = vec![header];
    for cell in &map.cells {
        for (start, of) in map.starts.iter().zip(&cell.starts) {
            let mut row = vec![
                cell.x.to_string(),
                cell.y.to_string(),
                cell.verdict.name().to_owned(),
                start.name().to_owned(),
                of.state.name().to_owned(),
                of.expected.to_string(),
                format!("{:.4}", of.confidence),
                of.chance.map_or(String::new(), |chance| format!("{chance:.4}")),
            ];
            // Four digits: a chance from at most some hundred members has no more.
            row.extend(of.interval.map(|end| format!("{end:.4}")));
            row.extend([
                table_cell(&of.alarm).into_owned(),
                of.members.to_string(),
                of.failed.to_string(),
                table_cell(&of.failure).into_owned(),
            ]);
            for alarm in &alarms {
                for priority in Priority::ALL {
                    let count = of
                        .alarms
                        .iter()
                        .find(|count| count.alarm == *alarm && count.priority == priority);
                    // An inferred start has no counts. Zero would claim that its members were run without an alarm.
                    row.push(match of.state {
                        Origin::Known => count.map_or(0, |count| count.seen).to_string(),
                        _ => String::new(),
                    });
                }
            }
            for (name, _) in &figures {
                let figure = of.figures.iter().find(|figure| figure.name == *name);
                // Empty cells keep the columns in place.
                match figure.and_then(|figure| figure.quantiles) {
                    Some(quantiles) => row.extend(quantiles.map(|value| value.to_string())),
                    None => row.extend(vec![String::new(); 3]),
                }
            }
            rows.push(row);
        }
    }
    written(rows)
}

/// Alarms that some member of the map saw, in the order of their names.
fn alarms(map: &Map) -> Vec<String> {
    let starts = map.cells.iter().flat_map(|cell| &cell.starts);
    let mut names: Vec<String> = starts
        .flat_map(|start| &start.alarms)
        .map(|count| count.alarm.clone())
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Name of a column in SI, and the conversion from the axis's unit.
type Converted = (&'static str, fn(f64) -> f64);

/// A quantity in SI: its column's name, and the factor from the axis's unit.
fn in_si(axis: &Axis) -> Option<Converted> {
    match axis.key.as_str() {
        ROTARY_SPEED => Some(("rotary_speed_rad_per_s", rpm_to_rad_per_s)),
        WEIGHT_ON_BIT => Some(("weight_on_bit_n", kn_to_n)),
        _ => None,
    }
}

/// One table of the envelope: for every value of the one quantity the least and the most of the other, in the units of the
/// axes and, for speed and weight, in SI. Where no value is clear, the bounds are empty.
///
/// # Errors
/// As [`csv()`].
pub fn bounds(map: &Map, envelope: &Envelope, of: Of) -> Result<Vec<u8>, SweepError> {
    let (of, at, bounds) = match of {
        Of::X => (&map.x, &map.y, &envelope.of_x),
        Of::Y => (&map.y, &map.x, &envelope.of_y),
    };
    let named = |axis: &Axis| {
        let unit = if axis.unit.is_empty() {
            String::new()
        } else {
            format!(" ({})", axis.unit)
        };
        (axis.key.clone(), unit)
    };
    let ((at_name, at_unit), (name, unit)) = (named(at), named(of));
    let mut header = vec![
        format!("{at_name}{at_unit}"),
        format!("least {name}{unit}"),
        format!("most {name}{unit}"),
    ];
    let si = in_si(at).zip(in_si(of));
    if let Some(((at, _), (of, _))) = si {
        header.extend([at.to_owned(), format!("least_{of}"), format!("most_{of}")]);
    }
    let mut rows = vec![header];
    for (value, bounds) in bounds.at.iter().zip(&bounds.bounds) {
        let mut row = vec![value.to_string()];
        let both = |convert: fn(f64) -> f64| match bounds {
            Some(ends) => ends.map(|end| convert(end).to_string()).to_vec(),
            None => vec![String::new(); 2],
        };
        row.extend(both(|value| value));
        if let Some(((_, at), (_, of))) = si {
            row.push(at(*value).to_string());
            row.extend(both(of));
        }
        rows.push(row);
    }
    written(rows)
}

/// The map in words, a line each.
pub fn words(map: &Map) -> Vec<String> {
    let cells = map.cells.len();
    let count = |verdict| map.cells.iter().filter(|cell| cell.verdict == verdict).count();
    let all = cells * map.starts.len();
    let mut lines = vec![format!(
        "{} from {}: {} of {} made ({:.0} %).",
        counted(cells as u64, "cell"),
        counted(map.starts.len() as u64, "start"),
        map.runs,
        counted(all as u64, "run"),
        100.0 * f64::from(map.runs) / all as f64
    )];
    lines.push(format!(
        "{} clear, {} with an alarm, {} that depend on the start, {} in which a run failed, {} not known.",
        count(Verdict::Clear),
        count(Verdict::Alarm),
        count(Verdict::DependsOnStart),
        count(Verdict::Unknown),
        count(Verdict::NotKnown)
    ));
    // Each inferred start is wrong with its remaining doubt; the sum is the number to be expected.
    let starts = map.cells.iter().flat_map(|cell| &cell.starts);
    let inferred = starts.filter(|start| start.state == Origin::Inferred);
    let (of, doubtful) = inferred.fold((0, 0.0), |(of, doubtful), start| {
        (of + 1, doubtful + 1.0 - start.confidence)
    });
    if of > 0 {
        lines.push(format!(
            "{of} of the {all} are inferred from the runs around them with at least 95 %: {doubtful:.1} of these are \
             expected to be wrong."
        ));
    }
    lines.push(map.members_in_words());
    lines.push(map.tools_in_words());
    if map.first_looks > 0 {
        lines.push(format!(
            "{} of the runs have one member, since no neighbour is of another class.",
            map.first_looks
        ));
    }
    lines.push(format!(
        "{:.0} s of model time: members with their ways to the values, and each state that they began from once.",
        map.model_time
    ));
    let mut leading: Vec<(usize, String)> = alarms(map)
        .into_iter()
        .map(|alarm| {
            let starts = map.cells.iter().flat_map(|cell| &cell.starts);
            (starts.filter(|start| start.alarm == alarm).count(), alarm)
        })
        .filter(|(count, _)| *count > 0)
        .collect();
    // Equal counts are ordered by name, so that the same map always has the same words.
    leading.sort_by(|a, b| b.0.cmp(&a.0).then_with(|| a.1.cmp(&b.1)));
    if !leading.is_empty() {
        let named: Vec<String> = leading
            .iter()
            .map(|(count, alarm)| format!("{alarm} in {}", counted(*count as u64, "run")))
            .collect();
        lines.push(format!("Most likely alarms: {}.", named.join(", ")));
    }
    lines
}
