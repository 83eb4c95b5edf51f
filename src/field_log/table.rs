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
    let mut reader = LineReader::new(mapping);
    let mut lines = lines(content);
    let header = lines
        .next()
        .map_or_else(csv::ByteRecord::new, |(_, line)| reader.read(line));
    let places = Places::find(file, &header, mapping)?;
    let time_column = &mapping.columns.time;
    let mut readable: Vec<(Timed, &[u8])> = Vec::new();
    let mut written = Vec::new();
    for (number, line) in lines {
        written.push(number);
        let record = reader.read(line);
        if record.len() != places.width {
            let found = format!("{} fields instead of {}", record.len(), places.width);
            issues.add(IssueKind::Unreadable, "", number, || found);
            continue;
        }
        let Some(time) = text(&record, places.time).and_then(|text| time_column.format.parse(text)) else {
            issues.add(IssueKind::Unreadable, &time_column.column, number, || {
                format!("{:?} is not a time", text(&record, places.time).unwrap_or("not text"))
            });
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
        });
    }
    Ok(Table { rows, parts, written })
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

fn text(record: &csv::ByteRecord, place: usize) -> Option<&str> {
    record.get(place).and_then(|bytes| std::str::from_utf8(bytes).ok())
}

impl Places {
    fn find(file: &str, header: &csv::ByteRecord, mapping: &Mapping) -> Result<Self, FieldLogError> {
        let find = |column: &str, key: &str| {
            header
                .iter()
                .position(|name| name == column.as_bytes())
                .ok_or_else(|| FieldLogError::MissingColumn {
                    file: file.to_string(),
                    column: column.to_string(),
                    key: key.to_string(),
                    found: header
                        .iter()
                        .map(String::from_utf8_lossy)
                        .collect::<Vec<_>>()
                        .join(", "),
                })
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
            match text.parse::<f64>() {
                Ok(value) if mapping.missing.contains(&value) => {
                    issues.add(IssueKind::Missing, column, number, || text.to_string());
                    None
                }
                Ok(value) if value.abs() <= LARGEST => Some(value),
                Ok(value) if value.is_finite() => {
                    issues.add(IssueKind::Unreadable, column, number, || {
                        format!("{text:?} is beyond {LARGEST:e}, which no sensor measures")
                    });
                    None
                }
                _ => {
                    issues.add(IssueKind::Unreadable, column, number, || {
                        format!("{text:?} is not a number")
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
