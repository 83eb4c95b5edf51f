//! Reads a log into timed inputs and a report.

use std::io::Read as _;
use std::path::Path;

use crate::compressed::unpacked;
use crate::hookload::weigh;
use crate::mapping::{Mapping, WeightOnBitColumn};
use crate::report::{Issues, Report, Summary, TorqueSummary};
use crate::spikes::{remove_spikes, report_frozen};
use crate::surveys::without_repetitions;
use crate::table::{Numbering, Row, read_table};
use crate::{FieldLogError, InputSequence, MeasuredSequence, Range, RowTime, Tare, TimedInput};
use flexdrill_core::inputs::InputKind;

/// Reads a whole log.
///
/// # Errors
/// When the file cannot be read, lacks a column of the mapping, or has no readable row.
pub fn read(path: impl AsRef<Path>, mapping: &Mapping) -> Result<(InputSequence, Report), FieldLogError> {
    read_range(path, mapping, &Range::ALL)
}

/// Reads a range of a log. Rows before the range also contribute to the hookload's tare. Times begin at 0 with the
/// first row of the range. The report covers the range only, with the rows at its ends that have no usable time. Where
/// the log's clock restarts, the parts follow each other with a gap between them.
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
    read_bytes(name, &content, mapping, range)
}

/// As [`read_range`], of the bytes of a log; errors name it `name`.
///
/// # Errors
/// As [`read_range`].
pub fn read_bytes(
    name: String,
    content: &[u8],
    mapping: &Mapping,
    range: &Range,
) -> Result<(InputSequence, Report), FieldLogError> {
    let mut issues = Issues::default();
    let content = unpacked(&name, content, LARGEST)?;
    let mut table = read_table(&name, &content, mapping, &mut issues)?;
    let numbering = table.numbering;
    // Tares are found before the range is cut, from all rows: the log may be weighed off bottom far from the range.
    let tares = clean_and_weigh(&mut table.rows, mapping, numbering, &mut issues);
    every_input_has_a_value(&name, &table.rows, mapping, &issues)?;

    let rows = &table.rows;
    // `read_table` has refused a table without rows.
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    let within = |row: &Row| range.contains(numbering.swap(row.number), row.time);
    // Row numbers and times rise together, so the rows of a range are contiguous.
    let from = rows.iter().position(within);
    // An empty range is an error with the extent of the log, since it is mostly a mistake in its ends.
    let (Some(from), Some(to)) = (from, rows.iter().rposition(within)) else {
        return Err(FieldLogError::EmptyRange {
            file: name,
            from: range
                .from
                .map_or_else(|| "the log's begin".to_string(), |from| from.to_string()),
            to: range
                .to
                .map_or_else(|| "the log's end".to_string(), |to| to.to_string()),
            first_row: numbering.swap(first.number).min(numbering.swap(last.number)),
            last_row: numbering.swap(last.number).max(numbering.swap(first.number)),
            length: last.time,
        });
    };
    let part = &rows[from..=to];
    // Rows without a usable time belong to the part around or before them, so that one report names each of them.
    let before = from.checked_sub(1).map_or(0, |index| rows[index].number);
    let after = rows.get(to + 1).map_or(u64::MAX, |row| row.number);
    let span = [before + 1, after - 1].map(|row| numbering.swap(range.nearest_row(numbering.swap(row))));
    let source = ReportSource {
        file: &name,
        mapping,
        tares: &tares,
        issues: &issues,
        written: &table.written,
    };
    // The report is on the range alone, as the rows outside play no part in the run.
    let mut report = source.report(part, span);
    let begins: Vec<usize> = table
        .parts
        .iter()
        .filter_map(|number| part.binary_search_by_key(number, |row| row.number).ok())
        .filter(|index| *index > 0)
        .collect();
    // A clock that restarted inside the range has a report for each part: rates and gaps across the seam mean nothing.
    if !begins.is_empty() {
        let ends = begins.iter().copied().chain([part.len()]);
        let mut begin = 0;
        for end in ends {
            let first = if begin == 0 { span[0] } else { part[begin].number };
            let last = part.get(end).map_or(span[1], |row| row.number - 1);
            report.parts.push(source.report(&part[begin..end], [first, last]));
            begin = end;
        }
    }
    // Times begin at 0 with the range, as every run does.
    let report = Report {
        notes: table.notes.clone(),
        ..report.numbered(numbering)
    };
    let mut sequence = sequence(part, mapping, numbering);
    sequence.measured = MeasuredSequence::new(table.measured_kinds.clone());
    for row in part {
        let time = row.time - part[0].time;
        sequence
            .measured
            .push(time, numbering.swap(row.number), table.measured_of(row));
    }
    let surveys = part.iter().filter_map(|row| {
        let values = *table.surveys.get(&row.number)?;
        Some((row.time - part[0].time, numbering.swap(row.number), values))
    });
    sequence.surveys = without_repetitions(surveys);
    Ok((sequence, report))
}

/// Largest log that is read (bytes): two months at 1 Hz with thirty columns. It is held in memory.
pub(crate) const LARGEST: u64 = 1 << 30;

pub(crate) fn content_of(path: &Path, name: &str) -> Result<Vec<u8>, FieldLogError> {
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
    // The same bound holds for a file that grows while it is read.
    file.take(LARGEST).read_to_end(&mut content).map_err(failed)?;
    Ok(content)
}

struct ReportSource<'a> {
    file: &'a str,
    mapping: &'a Mapping,
    tares: &'a [Tare],
    issues: &'a Issues,
    /// Numbers of all rows of the file.
    written: &'a [u64],
}

impl ReportSource<'_> {
    /// The report of the rows used (`part`, at least one) and of the rows left out between `from` and `to`.
    fn report(&self, part: &[Row], [from, to]: [u64; 2]) -> Report {
        let (begin, end) = (part[0], part[part.len() - 1]);
        // The tares that apply within the part begin with the last one before it.
        let acting = self
            .tares
            .partition_point(|tare| tare.last_row < begin.number)
            .saturating_sub(1);
        let tares = self.tares[acting..].iter().filter(|tare| tare.last_row <= end.number);
        let written = self.written.partition_point(|row| *row <= to) - self.written.partition_point(|row| *row < from);
        let sequence = sequence(part, self.mapping, Numbering::default());
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
            newest_first: false,
            notes: Vec::new(),
            parts: Vec::new(),
        }
    }
}

/// Removes implausible samples and converts hookloads to weights on bit.
fn clean_and_weigh(rows: &mut [Row], mapping: &Mapping, numbering: Numbering, issues: &mut Issues) -> Vec<Tare> {
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
        remove_spikes(rows, kind, spike, quality.max_gap, column, issues);
    }
    match &columns.weight_on_bit {
        WeightOnBitColumn::Direct(_) => Vec::new(),
        WeightOnBitColumn::Hookload(hookload) => weigh(rows, hookload, quality.max_gap, numbering, issues),
    }
}

/// Refuses a log in which a mapped input has no value in any row: the twin would run without it.
fn every_input_has_a_value(file: &str, rows: &[Row], mapping: &Mapping, issues: &Issues) -> Result<(), FieldLogError> {
    let columns = &mapping.columns;
    let (weight, weight_key) = match &columns.weight_on_bit {
        WeightOnBitColumn::Direct(direct) => (&direct.column, "weight_on_bit: {direct: {column: ...}}"),
        WeightOnBitColumn::Hookload(hookload) => (
            &hookload.column,
            "weight_on_bit: {hookload: {column: ..., drilling: ..., off_bottom: ...}}",
        ),
    };
    let rate = columns.rate_of_penetration.as_ref().map(|rate| &rate.column);
    let pressure = columns.standpipe_pressure.as_ref().map(|pressure| &pressure.column);
    // The model assumes a configured value of what the mapping does not name, so such a column may be left out of it.
    let required = |key: &str| format!("name the column that has it: `{key}` in the mapping");
    let optional = |key: &str| format!("name the column that has it, or remove `{key}` from the mapping");
    for (kind, column, cure) in [
        (
            InputKind::RotarySpeed,
            Some(&columns.rotary_speed.column),
            required("rotary_speed: {column: ...}"),
        ),
        (InputKind::WeightOnBit, Some(weight), required(weight_key)),
        (InputKind::RateOfPenetration, rate, optional("rate_of_penetration")),
        (InputKind::StandpipePressure, pressure, optional("standpipe_pressure")),
    ] {
        let Some(column) = column else { continue };
        if rows.iter().any(|row| row.values[kind.index()].is_some()) {
            continue;
        }
        // The first problem mostly shows the cause: a missing code, a unit in the field, no tare.
        let first = issues.first_of(column);
        let first = first.map_or_else(String::new, |issue| {
            format!(": {}: {}", issue.kind.name(), issue.detail)
        });
        return Err(FieldLogError::NoValue {
            file: file.to_owned(),
            column: column.clone(),
            input: kind.name(),
            found: format!("{} rows{first}", rows.len()),
            cure,
        });
    }
    Ok(())
}

fn sequence(rows: &[Row], mapping: &Mapping, numbering: Numbering) -> InputSequence {
    let begin = rows.first().map_or(0.0, |row| row.time);
    let scales = [mapping.columns.rotary_speed.scale, mapping.weight_scale(), 1.0, 1.0];
    let mut inputs = Vec::with_capacity(2 * rows.len());
    for row in rows {
        for ((kind, value), scale) in InputKind::ALL.into_iter().zip(row.values).zip(scales) {
            if let Some(value) = value {
                inputs.push(TimedInput {
                    time: row.time - begin,
                    kind,
                    value: value * scale,
                    row: numbering.swap(row.number),
                });
            }
        }
    }
    let (column, format) = (mapping.columns.time.name(), mapping.columns.time.format());
    InputSequence {
        inputs,
        rows: rows
            .iter()
            .map(|row| RowTime {
                row: numbering.swap(row.number),
                time: row.time - begin,
                own_time: format.own_text(&column, row.own_time),
            })
            .collect(),
        start: rows
            .first()
            .map(|row| row.own_time)
            .filter(|start| format.has_dates() && *start >= 0.0),
        measured: MeasuredSequence::default(),
        surveys: Vec::new(),
        duration: rows.last().map_or(0.0, |row| row.time - begin),
    }
}
