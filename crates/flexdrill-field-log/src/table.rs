//! The rows of the CSV file, as numbers.

use std::borrow::Cow;
use std::collections::BTreeMap;

use crate::judge::{Direction, Evidence, Wrong, judge};
use crate::layout::{LONGEST_LINE, Layout};
use crate::mapping::{Decimal, Mapping, Notation, WeightOnBitColumn};
use crate::measured::{self, Shared, Source};
use crate::parts::{TimeAxis, Timed, order};
use crate::report::{IssueKind, Issues};
use crate::surveys::{self, SurveyIndices};
use crate::time_suggestion::{fitting, is_clock, is_date};
use crate::{Condition, FieldLogError, TimeFormat};
use flexdrill_core::inputs::{InputKind, MeasuredKind, Unit};

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

/// Largest value accepted (in the log's unit): far above any measurement, and finite after any unit and scale.
const LARGEST: f64 = 1e15;

/// Indices of the mapped columns in the header.
struct ColumnIndices {
    /// Of time, or of the date alone.
    time: usize,
    /// Of the clock where it has its own column.
    clock: Option<usize>,
    speed: usize,
    weight: usize,
    drilling: Option<usize>,
    off_bottom: Option<usize>,
    torque: Option<usize>,
    rate: Option<usize>,
    pressure: Option<usize>,
    measured: Vec<(MeasuredKind, Source)>,
    surveys: Option<SurveyIndices>,
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

/// Texts by which a format is suggested.
const SUGGESTED_BY: usize = 50;

/// The times of a file.
#[derive(Default)]
struct Times<'a> {
    /// The rows with a readable time, and their lines.
    readable: Vec<(Timed, &'a [u8])>,
    /// Every row of the file with anything in it.
    written: Vec<u64>,
    /// The first row whose time or fields could not be read, for an error; empty without one.
    unreadable: String,
    /// The first texts that are no time in the mapping's format.
    texts: Vec<String>,
    /// Rows with such a text.
    wrong_texts: usize,
    /// The first row that has the fields of the header.
    first: csv::ByteRecord,
    /// A column of dates with several of them, where the time has none.
    other_dates: Option<String>,
}

impl<'a> Times<'a> {
    fn read(
        layout: &mut Layout<'a>,
        columns: &ColumnIndices,
        format: &TimeFormat,
        mapping: &Mapping,
        issues: &mut Issues,
    ) -> Self {
        let mut times = Self::default();
        let name = mapping.columns.time.name();
        // A date next to a clock alone, by its column and the first text.
        let mut dates: Option<(usize, String)> = None;
        for (number, line) in layout.rows.clone() {
            // Every row of the file is noted here, so that the report can say how many were left out.
            times.written.push(number);
            if line.len() > LONGEST_LINE {
                let found = format!("{} bytes, at most {LONGEST_LINE} are read", line.len());
                issues.add(IssueKind::Unreadable, "", number, || found);
                continue;
            }
            let record = layout.reader.read(line);
            // A wrong number of fields shifts all columns, so the row says nothing, whatever its values look like.
            if !layout.fits(&record) {
                let found = format!(
                    "{} fields instead of {}{}",
                    record.len(),
                    layout.width(),
                    too_many(&record, layout, mapping)
                );
                if times.unreadable.is_empty() {
                    times.unreadable = format!("; row {number}: {found}");
                }
                issues.add(IssueKind::Unreadable, "", number, || found);
                continue;
            }
            let found = columns.time_text(&record);
            let parsed = (found.as_deref()).and_then(|text| match mapping.thousands {
                Some(_) if format.seconds_in_one().is_some() => {
                    format.parse(&mapping.notation().parse(text)?.to_string(), Decimal::Point)
                }
                _ => format.parse(text, mapping.decimal),
            });
            if times.first.is_empty() && found.as_ref().is_some_and(|text| !text.trim().is_empty()) {
                times.first = record.clone();
                if format.restarts_daily() {
                    dates = date_column(&record, columns.time);
                }
            }
            let Some(time) = parsed else {
                let found = found.as_deref().unwrap_or("not text");
                let wrong = format!("{} is not a time{}", quoted(found), mapping.decimal.hint(found));
                // The first example is enough for the error: where no row has a readable time all have the same reason.
                if times.texts.is_empty() {
                    times.unreadable = format!("; row {number}: {wrong}");
                }
                // A line of units below the header, or one that is empty, says nothing about the format.
                if found.contains(|character: char| character.is_ascii_digit()) {
                    times.wrong_texts += 1;
                    if times.texts.len() < SUGGESTED_BY {
                        times.texts.push(found.to_owned());
                    }
                }
                issues.add(IssueKind::Unreadable, &name, number, || wrong);
                continue;
            };
            if let Some((index, first)) = &dates
                && times.other_dates.is_none()
                && text(&record, *index).is_some_and(|date| date != first && is_date(date))
            {
                times.other_dates = layout
                    .header
                    .get(*index)
                    .map(|name| String::from_utf8_lossy(name).into_owned());
            }
            times.readable.push((Timed { number, time }, line));
        }
        times
    }

    /// The line of the mapping that would make the texts times, after `; `; empty where none is known.
    fn suggestion(&self, layout: &Layout<'_>, mapping: &Mapping) -> String {
        let formats = fitting(&self.texts);
        match &formats[..] {
            [] => {}
            [only] => return format!("; set `{}` in `columns.time` of the mapping", only.in_mapping()),
            several => {
                let names: Vec<String> = several
                    .iter()
                    .take(4)
                    .map(|format| format!("`{}`", format.in_mapping()))
                    .collect();
                return format!(
                    "; several formats fit, set the one that the recorder writes in `columns.time` of the mapping: {}",
                    names.join(" or ")
                );
            }
        }
        let time = &mapping.columns.time.column;
        let clock = (0..self.first.len()).find(|index| text(&self.first, *index).is_some_and(is_clock));
        let clock = clock.and_then(|index| text(&layout.header, index));
        match clock {
            Some(clock)
                if !time.is_empty() && self.texts.iter().all(|text| is_date(text)) && !self.texts.is_empty() =>
            {
                format!("; it is a date alone: set `time: {{date: \"{time}\", clock: \"{clock}\"}}` in the mapping")
            }
            _ => String::new(),
        }
    }

    /// Mirrors the rows of a file that has its newest row first.
    fn turn(&mut self, issues: &mut Issues) -> Numbering {
        let ends = self.written.first().zip(self.written.last());
        let numbering = Numbering {
            mirror: ends.map(|(first, last)| first + last),
        };
        self.readable.reverse();
        for (timed, _) in &mut self.readable {
            timed.number = numbering.swap(timed.number);
        }
        self.written.reverse();
        for row in &mut self.written {
            *row = numbering.swap(*row);
        }
        issues.swap(numbering);
        numbering
    }
}

/// A column other than that of time which has a date in this row, and the date.
fn date_column(record: &csv::ByteRecord, time: usize) -> Option<(usize, String)> {
    let mut others = (0..record.len()).filter(|index| *index != time);
    others.find_map(|index| {
        text(record, index)
            .filter(|text| is_date(text))
            .map(|text| (index, text.to_owned()))
    })
}

/// The columns whose unit in the log is another than that of the mapping, in words.
fn other_units(layout: &Layout<'_>, mapping: &Mapping) -> Vec<String> {
    let differing = mapping.column_units().into_iter().filter_map(|(name, unit)| {
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

/// A likely cause of too many fields in a row: decimal commas in a log separated by commas.
fn too_many(record: &csv::ByteRecord, layout: &Layout<'_>, mapping: &Mapping) -> &'static str {
    let whole = |field: &[u8]| {
        let digits = field.strip_prefix(b"-").unwrap_or(field);
        digits.iter().all(u8::is_ascii_digit)
    };
    if layout.separator == ','
        && record.len() > layout.width()
        && mapping.decimal == Decimal::Point
        && record.iter().all(whole)
    {
        "; decimal commas cannot be distinguished from separators: export the log with `;` between fields, and set `separator: \";\"` \
         and `decimal: comma` in the mapping"
    } else {
        ""
    }
}

/// The separator that the header seems to use, when it differs from the mapping's.
fn other_separator(layout: &Layout<'_>) -> String {
    let Some(only) = layout.header.get(0).filter(|_| layout.header.len() == 1) else {
        return String::new();
    };
    let found = [';', '\t', ',', '|'].into_iter().find(|separator| {
        *separator != layout.separator && only.contains(&u8::try_from(*separator).unwrap_or_default())
    });
    found.map_or_else(String::new, |separator| {
        let written = separator.escape_default();
        format!("; the fields seem to have another separator: set `separator: \"{written}\"` in the mapping")
    })
}

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
    fn find(file: &str, layout: &Layout<'_>, mapping: &Mapping) -> Result<Self, FieldLogError> {
        let header = &layout.header;
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
                    hint: other_separator(layout),
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
        let (time, clock) = match (&columns.time.date, &columns.time.clock) {
            (Some(date), Some(clock)) => {
                let date = find(date, "columns.time.date")?;
                (date, Some(find(clock, "columns.time.clock")?))
            }
            _ => (find(&columns.time.column, "columns.time.column")?, None),
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
            time,
            clock,
            speed: find(&columns.rotary_speed.column, "columns.rotary_speed.column")?,
            weight,
            drilling,
            off_bottom,
            measured: measured::sources(mapping, find)?,
            surveys: SurveyIndices::find(mapping, find)?,
        })
    }

    /// The text of a row's time; `None` where it is not text.
    fn time_text<'r>(&self, record: &'r csv::ByteRecord) -> Option<Cow<'r, str>> {
        let time = text(record, self.time)?;
        match self.clock {
            None => Some(Cow::Borrowed(time)),
            Some(clock) => Some(Cow::Owned(format!("{time} {}", text(record, clock)?))),
        }
    }

    /// The row of that `index`; its measured values are added to `measured`.
    fn row(
        &self,
        values: &Values<'_>,
        Timed { number, time }: Timed,
        index: usize,
        mapping: &Mapping,
        issues: &mut Issues,
        measured: &mut Vec<f64>,
    ) -> Row {
        let mut value = |index: usize, column: &str| values.value(index, column, issues);
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

/// Numbers that recorders write for no value: -999.25 of LAS and its relatives, those of WITS, and the smallest whole
/// number of 16 bits. No input of a rig has them.
pub(crate) const MISSING_CODES: [f64; 9] = [
    -999.25, -999.0, -9999.0, -9999.25, -99_999.0, -999_999.0, -8888.0, -32_768.0, -999.99,
];

/// The fields of a row as numbers.
struct Values<'a> {
    record: &'a csv::ByteRecord,
    number: u64,
    notation: Notation,
    missing: &'a [f64],
}

impl Values<'_> {
    /// The number of a field that most rows do not have: any other text is none.
    fn rare(&self, index: usize) -> Option<f64> {
        let value = self.notation.parse(text(self.record, index)?)?;
        let is_missing = self.missing.contains(&value) || MISSING_CODES.contains(&value);
        (!is_missing && value.abs() <= LARGEST).then_some(value)
    }

    /// The number of a field. Each problem is reported by its kind, with the column and the row.
    fn value(&self, index: usize, column: &str, issues: &mut Issues) -> Option<f64> {
        let number = self.number;
        let Some(text) = text(self.record, index) else {
            issues.add(IssueKind::Unreadable, column, number, || "not text".to_string());
            return None;
        };
        // Empty is missing and not zero.
        if text.is_empty() {
            issues.add(IssueKind::Missing, column, number, || "empty".to_string());
            return None;
        }
        match self.notation.parse(text) {
            // Rigs write numbers such as -999.25 for a missing value; the mapping lists them.
            Some(value) if self.missing.contains(&value) => {
                issues.add(IssueKind::Missing, column, number, || text.to_string());
                None
            }
            Some(value) if MISSING_CODES.contains(&value) => {
                issues.add(IssueKind::MissingCode, column, number, || {
                    format!("{text} stands for no value in many recorders: add `missing: [{value}]` to the mapping")
                });
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
                    format!("{} is not a number{}", quoted(text), self.notation.decimal.hint(text))
                });
                None
            }
        }
    }
}
