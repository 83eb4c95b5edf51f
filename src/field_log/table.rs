//! The rows of the CSV file, as numbers.

use super::mapping::{Mapping, WeightOnBitColumn};
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
}

/// Places of the columns in the header.
struct Places {
    width: usize,
    time: usize,
    speed: usize,
    weight: usize,
    drilling: Option<usize>,
    off_bottom: Option<usize>,
}

/// Reads all rows; what is wrong with single ones goes to `issues`.
pub(super) fn read_rows(
    file: &str,
    content: &[u8],
    mapping: &Mapping,
    issues: &mut Issues,
) -> Result<Vec<Row>, FieldLogError> {
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(u8::try_from(mapping.separator).unwrap_or(b','))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(content);
    let read_error = |error: csv::Error| FieldLogError::Read {
        path: file.into(),
        reason: error.to_string(),
    };
    let header = reader.byte_headers().map_err(read_error)?.clone();
    let places = Places::find(file, &header, mapping)?;
    let mut rows: Vec<Row> = Vec::new();
    let mut start = None;
    let mut record = csv::ByteRecord::new();
    let mut editor = EditorRows::new(content);
    while reader.read_byte_record(&mut record).map_err(read_error)? {
        let number = editor.row_at(record.position().map_or(0, csv::Position::byte));
        if record.len() != places.width {
            let found = format!("{} fields instead of {}", record.len(), places.width);
            issues.add(IssueKind::Unreadable, "", number, || found);
            continue;
        }
        let Some(time) = text(&record, places.time).and_then(|text| mapping.columns.time.format.parse(text)) else {
            issues.add(IssueKind::Unreadable, &mapping.columns.time.column, number, || {
                format!("{:?} is not a time", text(&record, places.time).unwrap_or("not text"))
            });
            continue;
        };
        let time = time - *start.get_or_insert(time);
        if let Some(last) = rows.last().map(|row| row.time) {
            if time <= last {
                let kind = if time < last {
                    IssueKind::TimeBackwards
                } else {
                    IssueKind::TimeStandsStill
                };
                issues.add(kind, &mapping.columns.time.column, number, || {
                    format!("by {:.2} s", last - time)
                });
                continue;
            }
            if time - last > mapping.quality.max_gap {
                issues.add(IssueKind::Gap, "", number, || {
                    format!("{:.1} s since the row before", time - last)
                });
            }
        }
        rows.push(places.row(&record, number, time, mapping, issues));
    }
    if rows.is_empty() {
        return Err(FieldLogError::NoRows {
            file: file.to_string(),
            column: mapping.columns.time.column.clone(),
            format: mapping.columns.time.format.name(),
        });
    }
    Ok(rows)
}

/// Numbers rows as an editor does. The reader's own line numbers are one too small with CR LF line ends.
struct EditorRows<'a> {
    content: &'a [u8],
    /// Counted up to here.
    at: usize,
    row: u64,
}

impl<'a> EditorRows<'a> {
    fn new(content: &'a [u8]) -> Self {
        Self { content, at: 0, row: 1 }
    }

    /// Row of the first text at or after a byte that is not before the last one asked for.
    fn row_at(&mut self, byte: u64) -> u64 {
        let byte = usize::try_from(byte).unwrap_or(usize::MAX);
        while let Some(&here) = self.content.get(self.at) {
            let line_end = here == b'\n' || here == b'\r';
            if self.at >= byte && !line_end {
                break;
            }
            let second_of_crlf = here == b'\n' && self.at > 0 && self.content[self.at - 1] == b'\r';
            self.row += u64::from(line_end && !second_of_crlf);
            self.at += 1;
        }
        self.row
    }
}

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
        Ok(Self {
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
                Ok(value) if value.is_finite() => Some(value),
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
        Row {
            number,
            time,
            values: [speed, weight],
            drilling,
            off_bottom,
        }
    }
}
