//! A log as columns of texts and numbers, read without a mapping: separator, row of the header and decimal separator are
//! found from the lines.

use crate::compressed::unpacked;
use crate::layout::{LONGEST_LINE, Layout, separator_line};
use crate::lines::{LineReader, Lines};
use crate::mapping::{Columns, Decimal, ScaledColumn, TimeColumn};
use crate::table::{MISSING_CODES, foreign_encoding};
use crate::{FieldLogError, Mapping, Quality, WeightOnBitColumn, las};
use flexdrill_core::inputs::Unit;
use flexdrill_text::counted;

/// Rows by which a log is judged: a day and more at 1 Hz.
const MOST_ROWS: usize = 100_000;
/// Columns that are judged: more are no log of a rig, and must not fill the memory.
const MOST_COLUMNS: usize = 300;
/// Lines in which the header and the first rows are.
const FIRST_LINES: usize = 400;
/// Lines in which a header is looked for.
const PREAMBLE: usize = 200;
/// Separators in the order in which they are tried; a blank is any blanks and tabs.
const SEPARATORS: [char; 5] = [',', ';', '\t', '|', ' '];
/// Texts of a column by which the notation of times is judged.
const TEXTS: usize = 50;
/// A column is one of numbers when at least this share of its fields are numbers.
const NUMBERS: f64 = 0.9;

/// The columns of a log.
pub(crate) struct Sheet {
    pub(crate) separator: char,
    pub(crate) decimal: Decimal,
    /// Row of the header where it is not the first one.
    pub(crate) header_row: Option<u64>,
    /// Numbers that stand for no value, which the log does not name itself.
    pub(crate) missing: Vec<f64>,
    pub(crate) columns: Vec<Column>,
    /// Numbers of the rows, as an editor shows them.
    pub(crate) rows: Vec<u64>,
    /// What was found besides the columns.
    pub(crate) notes: Vec<String>,
}

/// A column.
pub(crate) struct Column {
    /// As the header has it.
    pub(crate) name: String,
    /// The unit that the log gives: in brackets, in the line below the header or in LAS; empty without one.
    pub(crate) unit: String,
    /// The first text that is not empty.
    pub(crate) first: String,
    /// Texts from all over the column.
    pub(crate) texts: Vec<String>,
    /// All texts, where the column may hold dates or clock times; empty for a column of numbers.
    pub(crate) all_texts: Vec<String>,
    /// One number per row, NaN without one.
    pub(crate) values: Vec<f64>,
    /// Whether nearly all of its fields are numbers.
    pub(crate) is_number: bool,
    /// Whether the name is text, is not empty and stands once in the header.
    pub(crate) has_own_name: bool,
}

impl Column {
    /// Its numbers without the rows that have none.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        self.values.iter().copied().filter(|value| !value.is_nan())
    }
}

impl Sheet {
    /// # Errors
    /// When the file is no text, has no header of column names, or LAS that is not read.
    pub(crate) fn of(file: &str, content: &[u8], largest: u64) -> Result<Self, FieldLogError> {
        let content = unpacked(file, content, largest)?;
        if let Some(encoding) = foreign_encoding(&content) {
            return Err(FieldLogError::Encoding {
                file: file.to_owned(),
                encoding,
            });
        }
        // The layout of a LAS file is in the file; of another the separator and the header are found first, and the
        // reader of logs does the rest, so that both agree.
        let begin = if las::is_las(&content) {
            None
        } else {
            Some(begin(&content).ok_or_else(|| FieldLogError::NoColumns { file: file.to_owned() })?)
        };
        let draft = draft(begin);
        let mut layout = Layout::of(file, &content, &draft)?;
        let mut notes = std::mem::take(&mut layout.notes);
        let rows = layout.rows.clone();
        let mut numbers = Vec::new();
        let mut fields: Vec<Vec<String>> = vec![Vec::new(); layout.header.len().min(MOST_COLUMNS)];
        let mut units = layout.units.clone();
        let mut unread = 0_u64;
        for (number, line) in rows {
            let record = (line.len() <= LONGEST_LINE).then(|| layout.reader.read(line));
            let Some(record) = record.filter(|record| layout.fits(record)) else {
                unread += 1;
                continue;
            };
            // A line of units stands directly below the header.
            if numbers.is_empty()
                && unread == 0
                && let Some(below) = units_below(&record)
            {
                for (unit, found) in units.iter_mut().zip(below) {
                    if unit.is_empty() {
                        *unit = found;
                    }
                }
                continue;
            }
            if numbers.len() >= MOST_ROWS {
                notes.push(format!("the columns are judged by the first {MOST_ROWS} rows"));
                break;
            }
            numbers.push(number);
            for (column, field) in fields.iter_mut().zip(&record) {
                column.push(String::from_utf8_lossy(field).into_owned());
            }
        }
        if unread > 0 {
            notes.push(format!("{} cannot be read", counted(unread, "row")));
        }
        if layout.header.len() > MOST_COLUMNS {
            notes.push(format!("the first {MOST_COLUMNS} columns are judged"));
        }
        let decimal = if layout.separator == ',' {
            Decimal::Point
        } else {
            decimal_of(&fields)
        };
        let mut missing = Vec::new();
        let names: Vec<String> = layout
            .header
            .iter()
            .map(|name| String::from_utf8_lossy(name).into_owned())
            .collect();
        let columns = fields.into_iter().enumerate().map(|(index, texts)| {
            let name = names.get(index).cloned().unwrap_or_default();
            // A name that is not UTF-8 would not be found again by its mapping.
            let is_text = layout.header.get(index).is_some_and(|own| own == name.as_bytes());
            Column {
                has_own_name: is_text && !name.is_empty() && names.iter().filter(|other| **other == name).count() == 1,
                unit: units.get(index).cloned().unwrap_or_default(),
                ..Column::of(name, texts, decimal, layout.missing, &mut missing)
            }
        });
        Ok(Self {
            columns: columns.collect(),
            separator: layout.separator,
            decimal,
            header_row: begin.and_then(|begin| begin.row_in_mapping),
            missing,
            rows: numbers,
            notes,
        })
    }
}

impl Column {
    /// The numbers of the texts. What stands for no value is none, and is added to `codes` where the log does not name it.
    fn of(name: String, texts: Vec<String>, decimal: Decimal, null: Option<f64>, codes: &mut Vec<f64>) -> Self {
        let mut values = Vec::with_capacity(texts.len());
        let (mut given, mut read) = (0_usize, 0_usize);
        for text in &texts {
            let value = decimal.parse(text).filter(|value| value.is_finite());
            given += usize::from(!text.is_empty());
            read += usize::from(value.is_some());
            let stands_for_none = value.is_some_and(|value| MISSING_CODES.contains(&value));
            if let Some(code) = value.filter(|value| stands_for_none && Some(*value) != null && !codes.contains(value))
            {
                codes.push(code);
            }
            let value = value.filter(|value| !stands_for_none && Some(*value) != null);
            values.push(value.unwrap_or(f64::NAN));
        }
        let is_number = read > 0 && read as f64 >= NUMBERS * given as f64;
        let filled: Vec<&String> = texts.iter().filter(|text| !text.is_empty()).collect();
        let step = (filled.len() / TEXTS).max(1);
        Self {
            name,
            unit: String::new(),
            first: filled.first().map_or_else(String::new, |text| (*text).clone()),
            texts: filled
                .iter()
                .step_by(step)
                .take(TEXTS)
                .map(|text| (*text).clone())
                .collect(),
            all_texts: if is_number { Vec::new() } else { texts },
            values,
            is_number,
            has_own_name: false,
        }
    }
}

/// Where the columns begin.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Begin {
    separator: char,
    row: u64,
    /// The row, where a mapping has to name it.
    row_in_mapping: Option<u64>,
}

/// A mapping with the layout alone, for the reader of layouts.
fn draft(begin: Option<Begin>) -> Mapping {
    let column = String::new;
    Mapping {
        title: String::new(),
        separator: begin.map_or(',', |begin| begin.separator),
        decimal: Decimal::Point,
        thousands: None,
        header_row: begin.map(|begin| begin.row),
        missing: Vec::new(),
        columns: Columns {
            time: TimeColumn {
                column: column(),
                date: None,
                clock: None,
                format: None,
            },
            rotary_speed: ScaledColumn {
                column: column(),
                unit: Unit::TurnPerMinute,
                scale: 1.0,
            },
            weight_on_bit: WeightOnBitColumn::Direct(ScaledColumn {
                column: column(),
                unit: Unit::Kilonewton,
                scale: 1.0,
            }),
            torque: None,
            rate_of_penetration: None,
            standpipe_pressure: None,
            measured: std::collections::BTreeMap::new(),
            surveys: None,
        },
        quality: Quality::default(),
    }
}

/// The separator and the row of the header: of the separators, the one by which most of the first rows have the fields of
/// a line of names above them. `None` where no line has names.
fn begin(content: &[u8]) -> Option<Begin> {
    let mut lines: Vec<(u64, &[u8])> = Lines::of(content)
        .filter(|(_, line)| line.len() <= LONGEST_LINE)
        .take(FIRST_LINES)
        .collect();
    let mut first_row = lines.first()?.0;
    let mut separators = SEPARATORS.to_vec();
    if let Some(named) = separator_line(lines.first()?.1) {
        separators = vec![named];
        lines.remove(0);
        first_row = lines.first()?.0;
    }
    let mut best: Option<(usize, usize, Begin)> = None;
    for separator in separators {
        let mut reader = LineReader::new(separator);
        let records: Vec<(u64, csv::ByteRecord)> = lines
            .iter()
            .map(|(number, line)| (*number, reader.read(line)))
            .collect();
        // Blanks separate the words of any text, so they count only where nothing else separates.
        if separator == ' ' && best.is_some() {
            continue;
        }
        for (index, (row, names)) in records.iter().enumerate().take(PREAMBLE) {
            let width = width(names);
            if width < 2 || !has_names(names) {
                continue;
            }
            let rows = records.get(index + 1..).unwrap_or_default();
            let fitting = rows
                .iter()
                .filter(|(_, row)| self::width(row) <= width && row.len() >= width);
            let fitting = fitting.filter(|(_, row)| !has_names(row)).count();
            // Most of what follows must have these fields: a line of a report with two words is no header.
            let is_better = best.is_none_or(|(most, columns, _)| (fitting, width) > (most, columns));
            if fitting * 2 > rows.len() && is_better {
                let begin = Begin {
                    separator,
                    row: *row,
                    row_in_mapping: (*row != first_row).then_some(*row),
                };
                best = Some((fitting, width, begin));
            }
        }
    }
    best.map(|(_, _, begin)| begin)
}

/// The number of fields without empty ones at the end.
fn width(record: &csv::ByteRecord) -> usize {
    record
        .iter()
        .rposition(|field| !field.is_empty())
        .map_or(0, |last| last + 1)
}

/// Whether all fields have letters and none is a number or a time.
fn has_names(record: &csv::ByteRecord) -> bool {
    let is_name = |field: &[u8]| {
        field.is_empty()
            || field
                .first()
                .is_some_and(|first| !first.is_ascii_digit() && !matches!(first, b'-' | b'+' | b'.'))
                && field.iter().any(|byte| byte.is_ascii_alphabetic() || *byte >= 0x80)
    };
    width(record) > 0 && record.iter().all(is_name)
}

/// The units of a line that has nothing but units; `None` where the line is another one.
fn units_below(record: &csv::ByteRecord) -> Option<Vec<String>> {
    let texts: Vec<String> = record
        .iter()
        .map(|field| {
            let text = String::from_utf8_lossy(field);
            text.trim_matches(['(', ')', '[', ']']).trim().to_owned()
        })
        .collect();
    let units = texts.iter().filter(|text| Unit::of_spelling(text).is_some()).count();
    (has_names(record) && units >= 2).then_some(texts)
}

/// The decimal separator by the fields: a comma needs a field in which it cannot separate thousands.
fn decimal_of(columns: &[Vec<String>]) -> Decimal {
    let mut commas = 0_u64;
    for text in columns.iter().flatten() {
        if !text.contains([',', '.']) {
            continue;
        }
        if Decimal::Point.parse(text).is_some() {
            return Decimal::Point;
        }
        let fraction = text.split_once(',').map_or(0, |(_, fraction)| fraction.len());
        commas += u64::from(fraction != 3 && Decimal::Comma.parse(text).is_some());
    }
    if commas > 0 { Decimal::Comma } else { Decimal::Point }
}
