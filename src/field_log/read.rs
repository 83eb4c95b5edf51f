//! From a file to timed inputs and a report.

use std::io::Read as _;
use std::path::Path;

use super::hookload::weigh;
use super::mapping::{Mapping, WeightOnBitColumn};
use super::report::{Issues, Report, Summary, TorqueSummary};
use super::spikes::{report_frozen, take_out_spikes};
use super::table::{Row, read_table};
use super::{FieldLogError, InputSequence, Range, Tare, TimedInput};
use flexdrill_core::inputs::InputKind;

/// Reads a whole log.
///
/// # Errors
/// When the file cannot be read, lacks a column of the mapping, or has no readable row.
pub fn read(path: impl AsRef<Path>, mapping: &Mapping) -> Result<(InputSequence, Report), FieldLogError> {
    read_range(path, mapping, &Range::ALL)
}

/// Reads a range of a log. Rows before it still count for the hookload's tare; times begin at 0 with its first row; the
/// report is of the range only, with the rows at its ends that have no usable time. Where the time of the log starts
/// anew, the parts follow each other with a gap between them.
///
/// # Errors
/// As [`read`], and when the range is empty.
pub fn read_range(
    path: impl AsRef<Path>,
    mapping: &Mapping,
    range: &Range,
) -> Result<(InputSequence, Report), FieldLogError> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let content = content_of(path, &name)?;
    let mut issues = Issues::default();
    let mut table = read_table(&name, &content, mapping, &mut issues)?;
    let tares = clean_and_weigh(&mut table.rows, mapping, &mut issues);

    let rows = &table.rows;
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    let within = |row: &Row| range.contains(row.number, row.time);
    // Rows and their times rise together, so those of a range lie side by side.
    let from = rows.iter().position(within);
    let (Some(from), Some(to)) = (from, rows.iter().rposition(within)) else {
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
    let part = &rows[from..=to];
    // Rows without a usable time belong to the part that they stand in or beside, so that none is in no report.
    let before = from.checked_sub(1).map_or(0, |index| rows[index].number);
    let after = rows.get(to + 1).map_or(u64::MAX, |row| row.number);
    let span = [before + 1, after - 1].map(|row| range.nearest_row(row));
    let about = About {
        file: &name,
        mapping,
        tares: &tares,
        issues: &issues,
        written: &table.written,
    };
    let mut report = about.report(part, span);
    let begins: Vec<usize> = table
        .parts
        .iter()
        .filter_map(|number| part.binary_search_by_key(number, |row| row.number).ok())
        .filter(|index| *index > 0)
        .collect();
    if !begins.is_empty() {
        let ends = begins.iter().copied().chain([part.len()]);
        let mut begin = 0;
        for end in ends {
            let first = if begin == 0 { span[0] } else { part[begin].number };
            let last = part.get(end).map_or(span[1], |row| row.number - 1);
            report.parts.push(about.report(&part[begin..end], [first, last]));
            begin = end;
        }
    }
    Ok((sequence(part, mapping), report))
}

/// Largest log that is read (bytes): two months at 1 Hz with thirty columns. It is held in memory.
const LARGEST: u64 = 1 << 30;

/// The bytes of a log.
fn content_of(path: &Path, name: &str) -> Result<Vec<u8>, FieldLogError> {
    let failed = |reason: std::io::Error| FieldLogError::Read {
        path: path.to_path_buf(),
        reason: reason.to_string(),
    };
    let file = std::fs::File::open(path).map_err(failed)?;
    let bytes = file.metadata().map_err(failed)?.len();
    if bytes > LARGEST {
        return Err(FieldLogError::TooLarge {
            file: name.to_owned(),
            bytes,
            most: LARGEST,
        });
    }
    let mut content = Vec::new();
    // A file that grows while it is read ends at the same bound.
    file.take(LARGEST).read_to_end(&mut content).map_err(failed)?;
    Ok(content)
}

/// What reports are made from.
struct About<'a> {
    file: &'a str,
    mapping: &'a Mapping,
    tares: &'a [Tare],
    issues: &'a Issues,
    /// Rows of the file.
    written: &'a [u64],
}

impl About<'_> {
    /// The report of rows that are used, at least one, and of those from row to row that are not.
    fn report(&self, part: &[Row], [from, to]: [u64; 2]) -> Report {
        let (begin, end) = (part[0], part[part.len() - 1]);
        // Only tares that act within the part: from the last one before it on.
        let acting = self
            .tares
            .partition_point(|tare| tare.last_row < begin.number)
            .saturating_sub(1);
        let tares = self.tares[acting..].iter().filter(|tare| tare.last_row <= end.number);
        let written = self.written.partition_point(|row| *row <= to) - self.written.partition_point(|row| *row < from);
        let sequence = sequence(part, self.mapping);
        Report {
            file: self.file.to_owned(),
            first_row: begin.number,
            last_row: end.number,
            rows: part.len() as u64,
            left_out: (written as u64).saturating_sub(part.len() as u64),
            duration: end.time - begin.time,
            inputs: InputKind::ALL.map(|kind| Summary::of(&sequence, kind)),
            torque: TorqueSummary::of(part.iter().filter_map(|row| row.torque)),
            max_gap: self.mapping.quality.max_gap,
            weight_from_hookload: matches!(self.mapping.columns.weight_on_bit, WeightOnBitColumn::Hookload(_)),
            speed_scale: self.mapping.columns.rotary_speed.scale,
            weight_scale: self.mapping.weight_scale(),
            tares: tares.copied().collect(),
            issues: self.issues.between(from, to),
            parts: Vec::new(),
        }
    }
}

/// Takes out what cannot be and turns hookloads into weights.
fn clean_and_weigh(rows: &mut [Row], mapping: &Mapping, issues: &mut Issues) -> Vec<Tare> {
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
