//! The times of all rows of a log, before their values are read.

use super::Numbering;
use super::columns::ColumnIndices;
use super::values::{quoted, text};
use crate::TimeFormat;
use crate::layout::{LONGEST_LINE, Layout};
use crate::mapping::{Decimal, Mapping};
use crate::parts::Timed;
use crate::report::{IssueKind, Issues};
use crate::time_suggestion::{fitting, is_clock, is_date};

/// Texts by which a format is suggested.
const SUGGESTED_BY: usize = 50;

/// The times of a file.
#[derive(Default)]
pub(super) struct Times<'a> {
    /// The rows with a readable time, and their lines.
    pub(super) readable: Vec<(Timed, &'a [u8])>,
    /// Every row of the file with anything in it.
    pub(super) written: Vec<u64>,
    /// The first row whose time or fields could not be read, for an error; empty without one.
    pub(super) unreadable: String,
    /// The first texts that are no time in the mapping's format.
    texts: Vec<String>,
    /// Rows with such a text.
    pub(super) wrong_texts: usize,
    /// The first row that has the fields of the header.
    first: csv::ByteRecord,
    /// A column of dates with several of them, where the time has none.
    pub(super) other_dates: Option<String>,
}

impl<'a> Times<'a> {
    pub(super) fn read(
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
    pub(super) fn suggestion(&self, layout: &Layout<'_>, mapping: &Mapping) -> String {
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
    pub(super) fn turn(&mut self, issues: &mut Issues) -> Numbering {
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
