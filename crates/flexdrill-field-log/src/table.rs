//! The rows of the CSV file, as numbers.

use crate::mapping::{Mapping, WeightOnBitColumn};
use crate::measured::{self, Shared, Source};
use crate::parts::{TimeAxis, Timed, order};
use crate::report::{IssueKind, Issues};
use crate::{Condition, FieldLogError};
use flexdrill_core::inputs::{InputKind, MeasuredKind};

/// One row with a readable, advancing time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// As an editor numbers it.
    pub(crate) number: u64,
    /// Since the log's first row (s).
    pub(crate) time: f64,
    /// As the log gives it: since the epoch of its format (s).
    pub(crate) own_time: f64,
    /// By [`InputKind::index`]: speed (r/min); weight on bit or hookload (kN); rate (m/h); pressure (MPa).
    pub(crate) values: [Option<f64>; InputKind::COUNT],
    /// Whether the bit drills; `None` when the log does not say.
    pub(crate) drilling: Option<bool>,
    /// Whether the bit is off bottom; `None` when the log does not say.
    pub(crate) off_bottom: Option<bool>,
    /// Torque of the drive (kN m).
    pub(crate) torque: Option<f64>,
    /// Index of the row's measured values in [`Table::measured`].
    pub(crate) measured: usize,
}

/// Largest value accepted (in the log's unit): far above any measurement, and finite after any unit and scale.
const LARGEST: f64 = 1e15;

/// Indices of the mapped columns in the header.
struct ColumnIndices {
    width: usize,
    time: usize,
    speed: usize,
    weight: usize,
    drilling: Option<usize>,
    off_bottom: Option<usize>,
    torque: Option<usize>,
    rate: Option<usize>,
    pressure: Option<usize>,
    measured: Vec<(MeasuredKind, Source)>,
}

/// The rows of a log.
pub(crate) struct Table {
    /// At least one, in the order of time.
    pub(crate) rows: Vec<Row>,
    /// First rows of the parts between which the clock restarts.
    pub(crate) parts: Vec<u64>,
    /// Every row of the file with anything in it, as an editor numbers them.
    pub(crate) written: Vec<u64>,
    /// The measured quantities of the mapping.
    pub(crate) measured_kinds: Vec<MeasuredKind>,
    /// One per row and measured quantity (SI), NaN where the row has none.
    pub(crate) measured: Vec<f64>,
}

impl Table {
    pub(crate) fn measured_of(&self, row: &Row) -> &[f64] {
        let count = self.measured_kinds.len();
        self.measured
            .get(row.measured * count..(row.measured + 1) * count)
            .unwrap_or_default()
    }
}

/// Reads all rows and adds the problems of single rows to `issues`. Each line is parsed alone, so that a stray quote
/// spoils its own row only.
pub(crate) fn read_table(
    file: &str,
    content: &[u8],
    mapping: &Mapping,
    issues: &mut Issues,
) -> Result<Table, FieldLogError> {
    // An encoding other than UTF-8 would make every row unreadable; one error explains them all.
    if let Some(encoding) = foreign_encoding(content) {
        return Err(FieldLogError::Encoding {
            file: file.to_owned(),
            encoding,
        });
    }
    let mut reader = LineReader::new(mapping);
    let mut lines = lines(content);
    let first = lines.next().map_or(&b""[..], |(_, line)| line);
    // A file without line ends would be read into memory as one header.
    if first.len() > LONGEST_LINE {
        return Err(FieldLogError::LongHeader {
            file: file.to_owned(),
            bytes: first.len(),
            most: LONGEST_LINE,
        });
    }
    let header = reader.read(first);
    let columns = ColumnIndices::find(file, &header, mapping)?;
    let time_column = &mapping.columns.time;
    // Two passes: the order of the times must be known before values
    // are read, and the rows of a long log are not copied.
    let mut readable: Vec<(Timed, &[u8])> = Vec::new();
    let mut written = Vec::new();
    // The first unreadable time, for the error when no row has a readable one.
    let mut unreadable = String::new();
    for (number, line) in lines {
        // Every row of the file is noted here, so that the report can say how many were left out.
        written.push(number);
        if line.len() > LONGEST_LINE {
            let found = format!("{} bytes, at most {LONGEST_LINE} are read", line.len());
            issues.add(IssueKind::Unreadable, "", number, || found);
            continue;
        }
        let record = reader.read(line);
        // A wrong number of fields shifts all columns, so the row says nothing, whatever its values look like.
        if record.len() != columns.width {
            let found = format!(
                "{} fields instead of {}{}",
                record.len(),
                columns.width,
                too_many(&record, columns.width, mapping)
            );
            issues.add(IssueKind::Unreadable, "", number, || found);
            continue;
        }
        let parsed = text(&record, columns.time).and_then(|text| time_column.format.parse(text, mapping.decimal));
        let Some(time) = parsed else {
            let found = text(&record, columns.time).unwrap_or("not text");
            let wrong = format!("{} is not a time{}", quoted(found), mapping.decimal.hint(found));
            // The first example is enough for the error: where no row has a readable time all have the same reason.
            if unreadable.is_empty() {
                unreadable = format!("; row {number}: {wrong}");
            }
            issues.add(IssueKind::Unreadable, &time_column.column, number, || wrong);
            continue;
        };
        readable.push((Timed { number, time }, line));
    }
    let axis = TimeAxis {
        format: time_column.format,
        column: &time_column.column,
        max_gap: mapping.quality.max_gap,
    };
    let mut timed: Vec<Timed> = readable.iter().map(|(timed, _)| *timed).collect();
    let parts = order(&mut timed, &axis, issues);
    let mut rows = Vec::with_capacity(timed.len());
    let mut of_file = readable.iter();
    let mut measured = Vec::new();
    for Timed { number, time } in timed {
        // Both lists are in the order of the file, so one pass over it suffices.
        let Some((own, line)) = of_file.find(|(row, _)| row.number == number) else {
            continue;
        };
        let record = reader.read(line);
        let timed = Timed { number, time };
        let row = columns.row(&record, timed, rows.len(), mapping, issues, &mut measured);
        rows.push(Row {
            // The time that the log itself gives is kept next to the ordered one, because texts quote it.
            own_time: own.time,
            ..row
        });
    }
    if rows.is_empty() {
        return Err(FieldLogError::NoRows {
            file: file.to_string(),
            column: time_column.column.clone(),
            format: time_column.format.name(),
            hint: unreadable,
        });
    }
    Ok(Table {
        rows,
        parts,
        written,
        measured_kinds: columns.measured.iter().map(|(kind, _)| *kind).collect(),
        measured,
    })
}

/// Longest line that is read (bytes): a thousand columns of a thousand characters. Reading a line takes 18 times its
/// length in memory.
const LONGEST_LINE: usize = 1 << 20;

/// The encoding of a text other than UTF-8, recognised by its byte order mark or by the zero bytes between the letters
/// of its header.
fn foreign_encoding(content: &[u8]) -> Option<&'static str> {
    match content {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Some("UTF-32"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("UTF-16"),
        [first, 0, second, 0, ..] if *first > 0 && *second > 0 => Some("UTF-16LE"),
        [0, first, 0, second, ..] if *first > 0 && *second > 0 => Some("UTF-16BE"),
        _ => None,
    }
}

/// A likely cause of too many fields in a row: decimal commas in a log separated by commas.
fn too_many(record: &csv::ByteRecord, width: usize, mapping: &Mapping) -> &'static str {
    let whole = |field: &[u8]| {
        let digits = field.strip_prefix(b"-").unwrap_or(field);
        digits.iter().all(u8::is_ascii_digit)
    };
    if mapping.separator == ',' && record.len() > width && record.iter().all(whole) {
        "; decimal commas cannot be distinguished from separators: export the log with `;` between fields, and set `separator: \";\"` \
         and `decimal: comma` in the mapping"
    } else {
        ""
    }
}

/// The separator that the header seems to use, when it differs from the mapping's.
fn other_separator(header: &csv::ByteRecord, mapping: &Mapping) -> String {
    let Some(only) = header.get(0).filter(|_| header.len() == 1) else {
        return String::new();
    };
    let found = [';', '\t', ',', '|'].into_iter().find(|separator| {
        *separator != mapping.separator && only.contains(&u8::try_from(*separator).unwrap_or_default())
    });
    found.map_or_else(String::new, |separator| {
        let written = separator.escape_default();
        format!("; the fields seem to have another separator: set `separator: \"{written}\"` in the mapping")
    })
}

/// Non-blank lines with the numbers that an editor shows; a line ends with CR, LF or both.
fn lines(content: &[u8]) -> impl Iterator<Item = (u64, &[u8])> {
    let content = content.strip_prefix(b"\xef\xbb\xbf").unwrap_or(content);
    let mut rest = content;
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        number += 1;
        let end = rest
            .iter()
            .position(|byte| matches!(byte, b'\n' | b'\r'))
            .unwrap_or(rest.len());
        let line = &rest[..end];
        let ending = if rest[end..].starts_with(b"\r\n") { 2 } else { 1 };
        rest = rest.get(end + ending..).unwrap_or_default();
        Some((number, line))
    })
    .filter(|(_, line)| !line.trim_ascii().is_empty())
}

/// Parses single lines. Building a parser takes as long as parsing hundreds of lines, so all lines share one.
struct LineReader {
    parser: csv_core::Reader,
    fields: Vec<u8>,
    ends: Vec<usize>,
}

impl LineReader {
    fn new(mapping: &Mapping) -> Self {
        let delimiter = u8::try_from(mapping.separator).unwrap_or(b',');
        Self {
            parser: csv_core::ReaderBuilder::new().delimiter(delimiter).build(),
            fields: vec![0; LINE],
            ends: vec![0; FIELDS],
        }
    }

    fn read(&mut self, line: &[u8]) -> csv::ByteRecord {
        self.parser.reset();
        // Neither buffer needs more entries than the line has bytes, plus one for its end.
        if self.fields.len() <= line.len() {
            self.fields.resize(2 * line.len(), 0);
        }
        if self.ends.len() <= line.len() {
            self.ends.resize(2 * line.len(), 0);
        }
        let (mut input, mut written, mut ended) = (line, 0, 0);
        loop {
            let (result, read, more, ends) =
                self.parser
                    .read_record(input, &mut self.fields[written..], &mut self.ends[ended..]);
            input = &input[read..];
            (written, ended) = (written + more, ended + ends);
            // An empty input marks the end of the line for the parser.
            if result != csv_core::ReadRecordResult::InputEmpty {
                break;
            }
        }
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        let mut record: csv::ByteRecord = begins
            .zip(&self.ends[..ended])
            .map(|(begin, end)| &self.fields[begin..*end])
            .collect();
        record.trim();
        record
    }
}

/// Initial size of the line buffer (bytes).
const LINE: usize = 1024;
/// Initial number of fields.
const FIELDS: usize = 64;

/// Longest text of a field in a message (characters).
const LONGEST_QUOTE: usize = 60;

/// A field in quotes for a message, cut at [`LONGEST_QUOTE`].
fn quoted(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{:?}...", &text[..end]),
        None => format!("{text:?}"),
    }
}

/// Longest list of column names in an error (characters).
const NAMES: usize = 2000;

/// The names of a header, for an error.
fn names(header: &csv::ByteRecord) -> String {
    let all = header
        .iter()
        .map(String::from_utf8_lossy)
        .collect::<Vec<_>>()
        .join(", ");
    match all.char_indices().nth(NAMES) {
        Some((end, _)) => format!("{} ... ({} columns)", &all[..end], header.len()),
        None => all,
    }
}

fn text(record: &csv::ByteRecord, index: usize) -> Option<&str> {
    record.get(index).and_then(|bytes| std::str::from_utf8(bytes).ok())
}

impl ColumnIndices {
    fn find(file: &str, header: &csv::ByteRecord, mapping: &Mapping) -> Result<Self, FieldLogError> {
        // A name that occurs twice is refused: to take the first would be a guess.
        let find = |column: &str, key: &str| {
            let named = header.iter().enumerate();
            let mut indices = named
                .filter(|(_, name)| *name == column.as_bytes())
                .map(|(index, _)| index);
            match (indices.next(), indices.next()) {
                (Some(index), None) => Ok(index),
                (Some(first), Some(second)) => Err(FieldLogError::DuplicateColumn {
                    file: file.to_string(),
                    column: column.to_string(),
                    key: key.to_string(),
                    first: first + 1,
                    second: second + 1,
                }),
                // The text lists the columns that exist, and the separator that
                // the header seems to have: the two usual reasons.
                (None, _) => Err(FieldLogError::MissingColumn {
                    file: file.to_string(),
                    column: column.to_string(),
                    key: key.to_string(),
                    found: names(header),
                    hint: other_separator(header, mapping),
                }),
            }
        };
        let columns = &mapping.columns;
        // Weight comes directly or from the hook load, which needs to know when the bit is on bottom.
        let (weight, drilling, off_bottom) = match &columns.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => {
                (find(&direct.column, "columns.weight_on_bit.direct.column")?, None, None)
            }
            WeightOnBitColumn::Hookload(hookload) => {
                let key = "columns.weight_on_bit.hookload";
                (
                    find(&hookload.column, &format!("{key}.column"))?,
                    Some(find(&hookload.drilling.column, &format!("{key}.drilling.column"))?),
                    Some(find(&hookload.off_bottom.column, &format!("{key}.off_bottom.column"))?),
                )
            }
        };
        // An optional column that the mapping names must exist: its absence
        // is a mistake in the mapping, not a missing input.
        let torque = (columns.torque.as_ref()).map(|torque| find(&torque.column, "columns.torque.column"));
        let rate = columns.rate_of_penetration.as_ref();
        let rate = rate.map(|rate| find(&rate.column, "columns.rate_of_penetration.column"));
        let pressure = columns.standpipe_pressure.as_ref();
        let pressure = pressure.map(|pressure| find(&pressure.column, "columns.standpipe_pressure.column"));
        Ok(Self {
            torque: torque.transpose()?,
            rate: rate.transpose()?,
            pressure: pressure.transpose()?,
            // Every row must have as many fields as the header.
            width: header.len(),
            time: find(&columns.time.column, "columns.time.column")?,
            speed: find(&columns.rotary_speed.column, "columns.rotary_speed.column")?,
            weight,
            drilling,
            off_bottom,
            measured: measured::sources(mapping, find)?,
        })
    }

    /// The row of that `index`; its measured values are added to `measured`.
    fn row(
        &self,
        record: &csv::ByteRecord,
        Timed { number, time }: Timed,
        index: usize,
        mapping: &Mapping,
        issues: &mut Issues,
        measured: &mut Vec<f64>,
    ) -> Row {
        // One closure for all columns: each problem is reported by its kind, with the column and the row.
        let mut value = |index: usize, column: &str| -> Option<f64> {
            let Some(text) = text(record, index) else {
                issues.add(IssueKind::Unreadable, column, number, || "not text".to_string());
                return None;
            };
            // Empty is missing and not zero.
            if text.is_empty() {
                issues.add(IssueKind::Missing, column, number, || "empty".to_string());
                return None;
            }
            match mapping.decimal.parse(text) {
                // Rigs write numbers such as -999.25 for a missing value; the mapping lists them.
                Some(value) if mapping.missing.contains(&value) => {
                    issues.add(IssueKind::Missing, column, number, || text.to_string());
                    None
                }
                // Beyond any sensor is a fault of the log, and such a number would hide the rest in a chart.
                Some(value) if value.abs() <= LARGEST => Some(value),
                Some(value) if value.is_finite() => {
                    issues.add(IssueKind::Unreadable, column, number, || {
                        format!("{} is beyond {LARGEST:e}, more than any sensor measures", quoted(text))
                    });
                    None
                }
                _ => {
                    issues.add(IssueKind::Unreadable, column, number, || {
                        format!("{} is not a number{}", quoted(text), mapping.decimal.hint(text))
                    });
                    None
                }
            }
        };
        let columns = &mapping.columns;
        let speed =
            value(self.speed, &columns.rotary_speed.column).map(|speed| columns.rotary_speed.unit.to_rpm(speed));
        // A condition without a value is unknown, not false: on and off bottom then both stay open.
        let mut condition = |index: Option<usize>, condition: &Condition| {
            index
                .and_then(|index| value(index, &condition.column))
                .map(|value| condition.holds(value))
        };
        // A hook load is read like a weight here. It becomes one when the tare is known, which needs all rows.
        let (weight_column, weight_unit, drilling, off_bottom) = match &columns.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => (&direct.column, direct.unit, None, None),
            WeightOnBitColumn::Hookload(hookload) => (
                &hookload.column,
                hookload.unit,
                condition(self.drilling, &hookload.drilling),
                condition(self.off_bottom, &hookload.off_bottom),
            ),
        };
        let weight = value(self.weight, weight_column).map(|weight| weight_unit.to_kn(weight));
        let torque = self.torque.zip(columns.torque.as_ref());
        let torque =
            torque.and_then(|(index, torque)| value(index, &torque.column).map(|value| torque.unit.to_kn_m(value)));
        let rate = self.rate.zip(columns.rate_of_penetration.as_ref());
        let rate = rate.and_then(|(index, rate)| value(index, &rate.column).map(|value| rate.unit.to_m_per_h(value)));
        let pressure = self.pressure.zip(columns.standpipe_pressure.as_ref());
        let pressure = pressure
            .and_then(|(index, pressure)| value(index, &pressure.column).map(|value| pressure.unit.to_mpa(value)));
        // Measured quantities may come from a column that is an input too; it
        // is read once, or its faults would be reported twice.
        let shared = Shared {
            torque_kn_m: torque,
            rate_m_per_h: rate,
            pressure_mpa: pressure,
            hookload_kn: weight,
        };
        for (kind, source) in &self.measured {
            let found = match (*source, columns.measured.get(kind)) {
                (Source::Column(index, unit), Some(column)) => {
                    value(index, &column.column).map(|value| unit.to_si(value))
                }
                (source, _) => shared.value(source),
            };
            // NaN keeps the measured values of all rows in columns of equal length.
            measured.push(found.unwrap_or(f64::NAN));
        }
        Row {
            measured: index,
            torque,
            number,
            time,
            own_time: time,
            values: [speed, weight, rate, pressure],
            drilling,
            off_bottom,
        }
    }
}
