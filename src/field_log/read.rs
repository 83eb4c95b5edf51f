//! From a file to timed inputs and a report.

use std::path::Path;

use super::hookload::weigh;
use super::mapping::{Mapping, WeightOnBitColumn};
use super::report::{Issues, Report, Summary};
use super::spikes::{report_frozen, take_out_spikes};
use super::table::{Row, read_rows};
use super::{FieldLogError, InputSequence, Range, TimedInput};
use flexdrill_core::inputs::InputKind;

/// Reads a whole log.
///
/// # Errors
/// When the file cannot be read, lacks a column of the mapping, or has no readable row.
pub fn read(path: impl AsRef<Path>, mapping: &Mapping) -> Result<(InputSequence, Report), FieldLogError> {
    read_range(path, mapping, &Range::ALL)
}

/// Reads a part of a log. Rows before it still count for the hookload's tare; times begin at 0 with its first row; the
/// report is of the part only.
///
/// # Errors
/// As [`read`], and when the part is empty.
pub fn read_range(
    path: impl AsRef<Path>,
    mapping: &Mapping,
    range: &Range,
) -> Result<(InputSequence, Report), FieldLogError> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let content = std::fs::read(path).map_err(|reason| FieldLogError::Read {
        path: path.to_path_buf(),
        reason: reason.to_string(),
    })?;
    let mut issues = Issues::default();
    let mut rows = read_rows(&name, &content, mapping, &mut issues)?;
    let mut tares = clean_and_weigh(&mut rows, mapping, &mut issues);

    let (first, last) = (rows[0], rows[rows.len() - 1]);
    let part: Vec<Row> = rows
        .into_iter()
        .filter(|row| range.contains(row.number, row.time))
        .collect();
    let (Some(begin), Some(end)) = (part.first(), part.last()) else {
        return Err(FieldLogError::EmptyRange {
            file: name,
            from: range
                .from
                .map_or_else(|| "its begin".to_string(), |from| from.to_string()),
            to: range.to.map_or_else(|| "its end".to_string(), |to| to.to_string()),
            first_row: first.number,
            last_row: last.number,
            length: last.time,
        });
    };
    // Only tares that act within the part: from the last one before it on.
    let acting = tares
        .partition_point(|tare| tare.last_row < begin.number)
        .saturating_sub(1);
    tares.drain(..acting);
    tares.retain(|tare| tare.last_row <= end.number);

    let sequence = sequence(&part, mapping);
    let report = Report {
        file: name,
        first_row: begin.number,
        last_row: end.number,
        rows: part.len() as u64,
        duration: end.time - begin.time,
        inputs: InputKind::ALL.map(|kind| Summary::of(&sequence, kind)),
        weight_from_hookload: matches!(mapping.columns.weight_on_bit, WeightOnBitColumn::Hookload(_)),
        speed_scale: mapping.columns.rotary_speed.scale,
        weight_scale: mapping.weight_scale(),
        tares,
        issues: issues.between(begin.number, end.number),
    };
    Ok((sequence, report))
}

/// Takes out what cannot be and turns hookloads into weights.
fn clean_and_weigh(rows: &mut [Row], mapping: &Mapping, issues: &mut Issues) -> Vec<super::Tare> {
    let (columns, quality) = (&mapping.columns, &mapping.quality);
    let weight_column = match &columns.weight_on_bit {
        WeightOnBitColumn::Direct(direct) => &direct.column,
        WeightOnBitColumn::Hookload(hookload) => &hookload.column,
    };
    for (kind, column, spike) in [
        (InputKind::RotarySpeed, &columns.rotary_speed.column, quality.spike_rpm),
        (InputKind::WeightOnBit, weight_column, quality.spike_kn),
    ] {
        report_frozen(rows, kind, quality.frozen_after, column, issues);
        take_out_spikes(rows, kind, spike, quality.max_gap, column, issues);
    }
    match &columns.weight_on_bit {
        WeightOnBitColumn::Direct(_) => Vec::new(),
        WeightOnBitColumn::Hookload(hookload) => weigh(rows, hookload, quality.max_gap, issues),
    }
}

fn sequence(rows: &[Row], mapping: &Mapping) -> InputSequence {
    let begin = rows.first().map_or(0.0, |row| row.time);
    let scales = [mapping.columns.rotary_speed.scale, mapping.weight_scale()];
    let mut inputs = Vec::with_capacity(2 * rows.len());
    for row in rows {
        for ((kind, value), scale) in InputKind::ALL.into_iter().zip(row.values).zip(scales) {
            if let Some(value) = value {
                inputs.push(TimedInput {
                    time: row.time - begin,
                    kind,
                    value: value * scale,
                    row: row.number,
                });
            }
        }
    }
    InputSequence {
        inputs,
        duration: rows.last().map_or(0.0, |row| row.time - begin),
    }
}
