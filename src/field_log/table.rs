//! The rows of the CSV file, as numbers.

use super::mapping::{Mapping, WeightOnBitColumn};
use super::parts::{Clock, Timed, order};
use super::report::{IssueKind, Issues};
use super::{Condition, FieldLogError};
#[cfg(doc)]
use flexdrill_core::inputs::InputKind;

/// One row with a readable, advancing time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    /// As an editor numbers it.
    pub(super) number: u64,
    /// Since the log's first row (s).
    pub(super) time: f64,
    /// By [`InputKind::index`]: speed (r/min); weight on bit or hookload (kN).
    pub(super) values: [Option<f64>; 2],
    /// Whether the bit drills, and whether it is off bottom; `None` when the log does not say.
    pub(super) drilling: Option<bool>,
    pub(super) off_bottom: Option<bool>,
    /// Of the drive (kN m).
    pub(super) torque: Option<f64>,
}

/// Largest value (in the log's unit): none is nearly so large, and units and scales keep it a number.
const LARGEST: f64 = 1e15;

/// Places of the columns in the header.
struct Places {
    width: usize,
    time: usize,
    speed: usize,
    weight: usize,
    drilling: Option<usize>,
    off_bottom: Option<usize>,
    torque: Option<usize>,
}

/// The rows of a log.
pub(super) struct Table {
    /// At least one, in the order of time.
    pub(super) rows: Vec<Row>,
    /// First rows of the parts between which the time starts anew.
    pub(super) parts: Vec<u64>,
    /// Every row of the file with anything in it, as an editor numbers them.
    pub(super) written: Vec<u64>,
}

/// Reads all rows; what is wrong with single ones goes to `issues`. Each line is read by itself, so that a stray quote
/// costs the row that it is in.
pub(super) fn read_table(
    file: &str,
    content: &[u8],
    mapping: &Mapping,
    issues: &mut Issues,
) -> Result<Table, FieldLogError> {
    if let Some(encoding) = foreign_encoding(content) {
        return Err(FieldLogError::Encoding {
            file: file.to_owned(),
            encoding,
        });
    }
    let mut reader = LineReader::new(mapping);
    let mut lines = lines(content);
    let first = lines.next().map_or(&b""[..], |(_, line)| line);
    if first.len() > LONGEST_LINE {
        return Err(FieldLogError::LongHeader {
            file: file.to_owned(),
            bytes: first.len(),
            most: LONGEST_LINE,
        });
    }
    let header = reader.read(first);
    let places = Places::find(file, &header, mapping)?;
    let time_column = &mapping.columns.time;
    let mut readable: Vec<(Timed, &[u8])> = Vec::new();
    let mut written = Vec::new();
    // The first time that could not be read, for the error if none could.
    let mut unreadable = String::new();
    for (number, line) in lines {
        written.push(number);
        if line.len() > LONGEST_LINE {
            let found = format!("{} bytes, at most {LONGEST_LINE} are read", line.len());
            issues.add(IssueKind::Unreadable, "", number, || found);
            continue;
        }
        let record = reader.read(line);
        if record.len() != places.width {
            let found = format!(
                "{} fields instead of {}{}",
                record.len(),
                places.width,
                too_many(&record, places.width, mapping)
            );
            issues.add(IssueKind::Unreadable, "", number, || found);
            continue;
        }
        let parsed = text(&record, places.time).and_then(|text| time_column.format.parse(text, mapping.decimal));
        let Some(time) = parsed else {
            let found = text(&record, places.time).unwrap_or("not text");
            let wrong = format!("{} is not a time{}", quoted(found), mapping.decimal.hint(found));
            if unreadable.is_empty() {
                unreadable = format!("; row {number}: {wrong}");
            }
            issues.add(IssueKind::Unreadable, &time_column.column, number, || wrong);
            continue;
        };
        readable.push((Timed { number, time }, line));
    }
    let clock = Clock {
        format: time_column.format,
        column: &time_column.column,
        max_gap: mapping.quality.max_gap,
    };
    let mut timed: Vec<Timed> = readable.iter().map(|(timed, _)| *timed).collect();
    let parts = order(&mut timed, &clock, issues);
    let mut rows = Vec::with_capacity(timed.len());
    let mut of_file = readable.iter();
    for Timed { number, time } in timed {
        let Some((_, line)) = of_file.find(|(row, _)| row.number == number) else {
            continue;
        };
        rows.push(places.row(&reader.read(line), number, time, mapping, issues));
    }
    if rows.is_empty() {
        return Err(FieldLogError::NoRows {
            file: file.to_string(),
            column: time_column.column.clone(),
            format: time_column.format.name(),
            hint: unreadable,
        });
    }
    Ok(Table { rows, parts, written })
}

/// Longest line that is read (bytes): a thousand columns of a thousand characters. What reads a line needs 18 times its
/// length.
const LONGEST_LINE: usize = 1 << 20;

/// The encoding of a text that is not UTF-8 and not read, by its byte order mark, or by the zero bytes that it has beside
/// the letters of a header.
fn foreign_encoding(content: &[u8]) -> Option<&'static str> {
    match content {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Some("UTF-32"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("UTF-16"),
        [first, 0, second, 0, ..] if *first > 0 && *second > 0 => Some("UTF-16LE"),
        [0, first, 0, second, ..] if *first > 0 && *second > 0 => Some("UTF-16BE"),
        _ => None,
    }
}

/// What may have made too many fields of a row: decimal commas between commas.
fn too_many(record: &csv::ByteRecord, width: usize, mapping: &Mapping) -> &'static str {
    let whole = |field: &[u8]| {
        let digits = field.strip_prefix(b"-").unwrap_or(field);
        digits.iter().all(u8::is_ascii_digit)
    };
    if mapping.separator == ',' && record.len() > width && record.iter().all(whole) {
        "; decimal commas cannot be told from separators: export the log with `;` between fields, and set `separator: \";\"` \
         and `decimal: comma` in the mapping"
    } else {
        ""
    }
}

/// The separator that a header seems to have, where it is not that of the mapping.
fn other_separator(header: &csv::ByteRecord, mapping: &Mapping) -> String {
    let Some(only) = header.get(0).filter(|_| header.len() == 1) else {
        return String::new();
    };
    let found = [';', '\t', ',', '|'].into_iter().find(|separator| {
        *separator != mapping.separator && only.contains(&u8::try_from(*separator).unwrap_or_default())
    });
    found.map_or_else(String::new, |separator| {
        let written = separator.escape_default();
        format!("; its fields seem to be separated otherwise: set `separator: \"{written}\"` in the mapping")
    })
}

/// Lines with anything in them, as an editor numbers them; they end with CR, LF or both.
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

/// Reads single lines. To build a parser takes as long as to read hundreds of lines, so that all share one.
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

    /// The fields of a line.
    fn read(&mut self, line: &[u8]) -> csv::ByteRecord {
        self.parser.reset();
        // Neither is ever longer than the line, its end included.
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
            // An empty input tells the parser that the line has ended.
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

/// Room for a line at first (bytes).
const LINE: usize = 1024;
/// Room for its fields at first.
const FIELDS: usize = 64;

/// Longest text of a field that is shown (characters).
const SHOWN: usize = 60;

/// A field for a message, without what is beyond [`SHOWN`].
fn quoted(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
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

fn text(record: &csv::ByteRecord, place: usize) -> Option<&str> {
    record.get(place).and_then(|bytes| std::str::from_utf8(bytes).ok())
}

impl Places {
    fn find(file: &str, header: &csv::ByteRecord, mapping: &Mapping) -> Result<Self, FieldLogError> {
        let find = |column: &str, key: &str| {
            let named = header.iter().enumerate();
            let mut places = named
                .filter(|(_, name)| *name == column.as_bytes())
                .map(|(place, _)| place);
            match (places.next(), places.next()) {
                (Some(place), None) => Ok(place),
                (Some(first), Some(second)) => Err(FieldLogError::DuplicateColumn {
                    file: file.to_string(),
                    column: column.to_string(),
                    key: key.to_string(),
                    first: first + 1,
                    second: second + 1,
                }),
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
        let torque = (columns.torque.as_ref()).map(|torque| find(&torque.column, "columns.torque.column"));
        Ok(Self {
            torque: torque.transpose()?,
            width: header.len(),
            time: find(&columns.time.column, "columns.time.column")?,
            speed: find(&columns.rotary_speed.column, "columns.rotary_speed.column")?,
            weight,
            drilling,
            off_bottom,
        })
    }

    fn row(&self, record: &csv::ByteRecord, number: u64, time: f64, mapping: &Mapping, issues: &mut Issues) -> Row {
        let mut value = |place: usize, column: &str| -> Option<f64> {
            let Some(text) = text(record, place) else {
                issues.add(IssueKind::Unreadable, column, number, || "not text".to_string());
                return None;
            };
            if text.is_empty() {
                issues.add(IssueKind::Missing, column, number, || "empty".to_string());
                return None;
            }
            match mapping.decimal.parse(text) {
                Some(value) if mapping.missing.contains(&value) => {
                    issues.add(IssueKind::Missing, column, number, || text.to_string());
                    None
                }
                Some(value) if value.abs() <= LARGEST => Some(value),
                Some(value) if value.is_finite() => {
                    issues.add(IssueKind::Unreadable, column, number, || {
                        format!("{} is beyond {LARGEST:e}, which no sensor measures", quoted(text))
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
        let mut condition = |place: Option<usize>, condition: &Condition| {
            place
                .and_then(|place| value(place, &condition.column))
                .map(|value| condition.holds(value))
        };
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
            torque.and_then(|(place, torque)| value(place, &torque.column).map(|value| torque.unit.to_kn_m(value)));
        Row {
            torque,
            number,
            time,
            values: [speed, weight],
            drilling,
            off_bottom,
        }
    }
}
