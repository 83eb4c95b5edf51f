//! The rows of the CSV file, as numbers.

mod columns;
mod times;
mod values;

use std::collections::BTreeMap;

use self::columns::ColumnIndices;
use self::times::Times;
use self::values::Values;
use crate::FieldLogError;
use crate::judge::{Direction, Evidence, Wrong, judge};
use crate::layout::Layout;
use crate::mapping::Mapping;
use crate::parts::{TimeAxis, Timed, order};
use crate::report::Issues;
use crate::surveys;
use flexdrill_core::inputs::{InputKind, MeasuredKind, Unit};

pub(crate) use values::MISSING_CODES;

/// One row with a readable, advancing time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// As an editor numbers it, or mirrored: see [`Numbering`].
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
    /// Surveys by the number of their row.
    pub(crate) surveys: BTreeMap<u64, surveys::Values>,
    /// How the numbers of the rows are those of an editor.
    pub(crate) numbering: Numbering,
    /// What was found in the log and not in the mapping, for the report.
    pub(crate) notes: Vec<String>,
}

impl Table {
    pub(crate) fn measured_of(&self, row: &Row) -> &[f64] {
        let count = self.measured_kinds.len();
        self.measured
            .get(row.measured * count..(row.measured + 1) * count)
            .unwrap_or_default()
    }
}

/// Numbers of rows: inside the crate they rise with time, and where the file has its newest row first they are mirrored.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Numbering {
    /// First and last row of the file, added; `None` where the oldest row is first.
    mirror: Option<u64>,
}

impl Numbering {
    /// As an editor numbers the row, from the number inside the crate, and back.
    pub(crate) fn swap(self, row: u64) -> u64 {
        self.mirror.map_or(row, |mirror| mirror.saturating_sub(row))
    }

    pub(crate) const fn is_mirrored(self) -> bool {
        self.mirror.is_some()
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
    let mut layout = Layout::of(file, content, mapping)?;
    let columns = ColumnIndices::find(file, &layout, mapping)?;
    let name = mapping.columns.time.name();
    let format = mapping.columns.time.format();
    // Two passes: the order of the times must be known before values
    // are read, and the rows of a long log are not copied.
    let mut times = Times::read(&mut layout, &columns, &format, mapping, issues);
    if times.readable.is_empty() {
        return Err(FieldLogError::NoRows {
            file: file.to_string(),
            column: name,
            format: format.name().to_owned(),
            hint: format!("{}{}", times.unreadable, times.suggestion(&layout, mapping)),
        });
    }
    let wrong = |Wrong { found, cure }| FieldLogError::Times {
        file: file.to_owned(),
        column: name.clone(),
        found,
        cure,
    };
    // Where another format fits the rows that this one does not read, and these are most, the mapping has the wrong one.
    if times.wrong_texts > times.readable.len() {
        let cure = times.suggestion(&layout, mapping);
        if let Some(cure) = cure.strip_prefix("; ") {
            return Err(wrong(Wrong {
                found: format!("{} of its rows are no time{}", times.wrong_texts, times.unreadable),
                cure: cure.to_owned(),
            }));
        }
    }
    let evidence = Evidence {
        format: &format,
        is_named: mapping.columns.time.format.is_some(),
        column: &name,
        unit: layout.units.get(columns.time).map_or("", String::as_str),
        max_gap: mapping.quality.max_gap,
        names: layout
            .header
            .iter()
            .map(|name| String::from_utf8_lossy(name).into_owned())
            .collect(),
        other_dates: times.other_dates.take(),
    };
    let timed: Vec<Timed> = times.readable.iter().map(|(timed, _)| *timed).collect();
    let direction = judge(&timed, &evidence).map_err(wrong)?;
    let mut notes = std::mem::take(&mut layout.notes);
    notes.extend(other_units(&layout, mapping));
    let mut numbering = Numbering::default();
    if direction == Direction::NewestFirst {
        numbering = times.turn(issues);
        notes.push("THE NEWEST ROW IS FIRST in the log: it is read from its last row to its first".to_owned());
    }
    let axis = TimeAxis {
        format: &format,
        column: &name,
        max_gap: mapping.quality.max_gap,
    };
    let mut timed: Vec<Timed> = times.readable.iter().map(|(timed, _)| *timed).collect();
    let parts = order(&mut timed, &axis, issues);
    let missing: Vec<f64> = mapping.missing.iter().copied().chain(layout.missing).collect();
    let mut rows = Vec::with_capacity(timed.len());
    let mut of_file = times.readable.iter();
    let (mut measured, mut surveys) = (Vec::new(), BTreeMap::new());
    for Timed { number, time } in timed {
        // Both lists are in the same order, so one pass over it suffices.
        let Some((own, line)) = of_file.find(|(row, _)| row.number == number) else {
            continue;
        };
        let record = layout.reader.read(line);
        let timed = Timed { number, time };
        let values = Values {
            record: &record,
            number,
            notation: mapping.notation(),
            missing: &missing,
        };
        let survey = columns.surveys.and_then(|of| of.values(|index| values.rare(index)));
        surveys.extend(survey.map(|survey| (number, survey)));
        let row = columns.row(&values, timed, rows.len(), mapping, issues, &mut measured);
        rows.push(Row {
            // The time that the log itself gives is kept next to the ordered one, because texts quote it.
            own_time: own.time,
            ..row
        });
    }
    Ok(Table {
        rows,
        parts,
        written: times.written,
        measured_kinds: columns.measured.iter().map(|(kind, _)| *kind).collect(),
        measured,
        surveys,
        numbering,
        notes,
    })
}

/// The columns whose unit in the log is another than that of the mapping, in words.
fn other_units(layout: &Layout<'_>, mapping: &Mapping) -> Vec<String> {
    let differing = mapping.columns.units().into_iter().filter_map(|(name, unit)| {
        let written = layout.units.get(layout.column(name)?)?;
        let found = Unit::of_spelling(written)?;
        (found != unit && found.dimension() == unit.dimension()).then(|| {
            format!("CHECK THE UNIT of column `{name}`: the log gives it as {written}, the mapping reads it in {unit}")
        })
    });
    differing.collect()
}

/// The encoding of a text other than UTF-8, recognised by its byte order mark or by the zero bytes between the letters
/// of its header.
pub(crate) fn foreign_encoding(content: &[u8]) -> Option<&'static str> {
    match content {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Some("UTF-32"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("UTF-16"),
        [first, 0, second, 0, ..] if *first > 0 && *second > 0 => Some("UTF-16LE"),
        [0, first, 0, second, ..] if *first > 0 && *second > 0 => Some("UTF-16BE"),
        _ => None,
    }
}
