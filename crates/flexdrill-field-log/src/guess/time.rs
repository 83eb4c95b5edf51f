//! Which column is the time, and in which format.

use super::Sure;
use super::names::{Meaning, meaning};
use super::numbers::quantile;
use super::sheet::{Column, Sheet};
use crate::judge::{EXCEL_DAYS, Evidence, LIKELY, format_of_unit, is_depth, is_time, judge, shown};
use crate::mapping::TimeColumn;
use crate::parts::Timed;
use crate::time_suggestion::{fitting, is_date};
use crate::{Decimal, Quality, TimeFormat};

/// Seconds since 1970 from 1998 to 2039: no other column of a rig has such numbers.
const EPOCH: std::ops::Range<f64> = 9e8..2.2e9;
/// Steps that a log without a usual format may have in seconds, although it is not read (s).
const RARE: std::ops::RangeInclusive<f64> = 15.0..=3600.0;
/// Share of the steps that go one way in a column of time.
const ONE_WAY: f64 = 0.8;
/// Share of the steps near the usual one in equally spaced rows.
const EQUAL: f64 = 0.9;

/// A proposed time.
pub(crate) struct TimeProposal {
    pub(crate) column: TimeColumn,
    /// Indices of its columns.
    pub(crate) indices: Vec<usize>,
    /// The first text.
    pub(crate) first: String,
    pub(crate) evidence: Vec<String>,
    pub(crate) sure: Sure,
    /// One per row (s), NaN without one.
    pub(crate) seconds: Vec<f64>,
    /// The usual time between rows (s).
    pub(crate) step: f64,
}

/// The time, and why columns that may be one are not proposed, by their index.
#[derive(Default)]
pub(crate) struct Times {
    pub(crate) proposal: Option<TimeProposal>,
    pub(crate) left_out: Vec<(usize, String)>,
}

/// The time of a log. Texts with a date come first, then date and clock, a clock alone, and numbers.
pub(crate) fn find(sheet: &Sheet) -> Times {
    let texts = Texts::of(sheet);
    let mut times = Times::default();
    let mut candidates = Vec::new();
    for (index, formats) in &texts.instants {
        match &formats[..] {
            [only] => candidates.push(of_texts(sheet, &[*index], only.clone())),
            several => times.left_out.push((*index, fits_several(several))),
        }
    }
    if candidates.is_empty() {
        candidates.extend(texts.date_and_clock(sheet, &mut times.left_out));
    }
    candidates.extend(of_numbers(sheet, &mut times.left_out));
    let mut good: Vec<TimeProposal> = Vec::new();
    for candidate in candidates {
        match candidate.checked() {
            Ok(candidate) => good.push(candidate),
            Err((index, why)) => times.left_out.push((index, why)),
        }
    }
    // What is named or has a date comes before what only its numbers show.
    let best = good.iter().map(|candidate| candidate.sure).min();
    let (mut good, others): (Vec<_>, Vec<_>) = good.into_iter().partition(|candidate| Some(candidate.sure) == best);
    let agree = |a: &TimeProposal, b: &TimeProposal| {
        (a.step / b.step - 1.0).abs() < 0.05 && (a.length() / b.length() - 1.0).abs() < 0.01
    };
    let all_agree = good
        .split_first()
        .is_some_and(|(first, rest)| rest.iter().all(|other| agree(first, other)));
    if all_agree {
        // Two clocks that run alike give the same times, so that the first one is as good as any.
        let rest = good.split_off(1);
        let columns = rest.iter().chain(&others).flat_map(|other| &other.indices);
        times
            .left_out
            .extend(columns.map(|index| (*index, "another clock; one is enough".to_owned())));
        times.proposal = good.pop();
    } else {
        let names: Vec<String> = good
            .iter()
            .map(|candidate| format!("`{}`", candidate.column.name()))
            .collect();
        for index in good.iter().flat_map(|candidate| &candidate.indices) {
            let why = format!("{} fit a time equally and disagree", names.join(" and "));
            times.left_out.push((*index, why));
        }
    }
    times
}

fn fits_several(formats: &[TimeFormat]) -> String {
    let names: Vec<String> = formats
        .iter()
        .take(4)
        .map(|format| format!("`{}`", format.in_mapping()))
        .collect();
    format!("a time whose texts fit several formats equally: {}", names.join(" or "))
}

/// The columns whose texts are times.
struct Texts {
    /// With a date and a clock, and the formats that fit.
    instants: Vec<(usize, Vec<TimeFormat>)>,
    dates: Vec<usize>,
    clocks: Vec<usize>,
}

impl Texts {
    fn of(sheet: &Sheet) -> Self {
        let mut texts = Self {
            instants: Vec::new(),
            dates: Vec::new(),
            clocks: Vec::new(),
        };
        let columns = sheet.columns.iter().enumerate();
        for (index, column) in
            columns.filter(|(_, column)| !column.is_number && column.has_own_name && !column.texts.is_empty())
        {
            let formats = fitting(&column.texts);
            if formats.iter().any(TimeFormat::has_dates) {
                texts.instants.push((index, formats));
            } else if formats.first() == Some(&TimeFormat::TimeOfDay) {
                texts.clocks.push(index);
            } else if column.texts.iter().all(|text| is_date(text)) {
                texts.dates.push(index);
            }
        }
        texts
    }

    /// The time of one column of dates and one of clock times, or of the clock alone.
    fn date_and_clock(&self, sheet: &Sheet, left_out: &mut Vec<(usize, String)>) -> Option<TimeProposal> {
        let [clock] = self.clocks[..] else {
            let why = "several columns of clock times fit equally";
            left_out.extend(self.clocks.iter().map(|index| (*index, why.to_owned())));
            return None;
        };
        let alone = || Some(of_texts(sheet, &[clock], TimeFormat::TimeOfDay));
        let date = match self.dates[..] {
            [] => return alone(),
            [date] => date,
            _ => {
                let why = "several columns of dates fit equally";
                left_out.extend(self.dates.iter().map(|index| (*index, why.to_owned())));
                return None;
            }
        };
        let joined = joined(sheet, &[date, clock]);
        let given: Vec<String> = joined.into_iter().flatten().collect();
        let few: Vec<String> = given.iter().step_by((given.len() / 50).max(1)).cloned().collect();
        let formats = fitting(&few);
        match &formats[..] {
            [only] => Some(of_texts(sheet, &[date, clock], only.clone())),
            several => {
                left_out.push((date, fits_several(several)));
                // On one day the clock gives the same differences, whatever the day is.
                let texts = &sheet.columns.get(date)?.all_texts;
                texts.windows(2).all(|pair| pair[0] == pair[1]).then(alone).flatten()
            }
        }
    }
}

/// The texts of the rows, of two columns with a blank between; `None` where one is empty.
fn joined(sheet: &Sheet, indices: &[usize]) -> Vec<Option<String>> {
    let columns: Vec<&Column> = indices.iter().filter_map(|index| sheet.columns.get(*index)).collect();
    let row = |row: usize| {
        let texts: Option<Vec<&str>> = columns
            .iter()
            .map(|column| {
                column
                    .all_texts
                    .get(row)
                    .map(String::as_str)
                    .filter(|text| !text.is_empty())
            })
            .collect();
        texts.map(|texts| texts.join(" "))
    };
    (0..sheet.rows.len()).map(row).collect()
}

fn of_texts(sheet: &Sheet, indices: &[usize], format: TimeFormat) -> TimeProposal {
    let texts = joined(sheet, indices);
    let first = texts.iter().flatten().next().cloned().unwrap_or_default();
    let seconds = texts
        .iter()
        .map(|text| text.as_ref().and_then(|text| format.parse(text, sheet.decimal)));
    let names: Vec<String> = indices
        .iter()
        .filter_map(|index| Some(sheet.columns.get(*index)?.name.clone()))
        .collect();
    let seconds: Vec<f64> = seconds.map(|seconds| seconds.unwrap_or(f64::NAN)).collect();
    let column = match &names[..] {
        [date, clock] => TimeColumn {
            column: String::new(),
            date: Some(date.clone()),
            clock: Some(clock.clone()),
            format: Some(format),
        },
        _ => TimeColumn {
            column: names.concat(),
            date: None,
            clock: None,
            format: Some(format),
        },
    };
    TimeProposal {
        column,
        indices: indices.to_vec(),
        first,
        evidence: vec!["its texts are times".to_owned()],
        sure: Sure::Sure,
        seconds,
        step: f64::NAN,
    }
}

/// The columns of numbers that may be times.
fn of_numbers(sheet: &Sheet, left_out: &mut Vec<(usize, String)>) -> Vec<TimeProposal> {
    let mut found = Vec::new();
    for (index, column) in sheet.columns.iter().enumerate() {
        let named = is_time(&column.name);
        // A unit of time behind the name, such as `min`, has another meaning in names of limits.
        let unit = unit_of(column);
        let bare = unit
            .and_then(|unit| column.name.strip_suffix(unit))
            .unwrap_or(&column.name);
        let says = meaning(bare, "").0;
        let may_be = says == Meaning::Nothing || named && says == Meaning::Unknown;
        if !column.is_number || !column.has_own_name || !may_be || is_depth(&column.name) {
            continue;
        }
        let by_unit = unit.and_then(format_of_unit);
        let steps: Vec<f64> = steps(&column.values);
        let rising = steps
            .iter()
            .filter(|step| **step > 0.0)
            .count()
            .max(steps.iter().filter(|step| **step < 0.0).count());
        // A time that stands or turns, such as that on bottom, is none of the rows.
        if steps.is_empty() || (rising as f64) < ONE_WAY * steps.len() as f64 {
            if named {
                left_out.push((
                    index,
                    "named as a time, and its numbers do not rise from row to row".to_owned(),
                ));
            }
            continue;
        }
        let step = quantile(steps.iter().map(|step| step.abs()).filter(|step| *step > 0.0), 0.5);
        let value = quantile(column.numbers(), 0.5);
        let format = match by_unit {
            Some(format) => Ok((format, Sure::Sure, format!("unit {}", unit.unwrap_or_default()))),
            None if unit.is_some_and(|unit| !unit.is_empty()) && !named => continue,
            None => by_numbers(value, step, named, &column.values),
        };
        match format {
            Ok((format, sure, why)) => {
                let mut evidence = Vec::new();
                if named {
                    evidence.push("named as a time".to_owned());
                }
                evidence.push(why);
                let one = format.clone();
                let seconds = column
                    .values
                    .iter()
                    .map(|value| one.parse(&value.to_string(), Decimal::Point).unwrap_or(f64::NAN));
                found.push(TimeProposal {
                    seconds: seconds.collect(),
                    column: TimeColumn {
                        column: column.name.clone(),
                        date: None,
                        clock: None,
                        format: Some(format),
                    },
                    indices: vec![index],
                    first: column.first.clone(),
                    evidence,
                    // A unit of time alone is less than a name with it.
                    sure: if named { sure } else { sure.max(Sure::Likely) },
                    step: f64::NAN,
                });
            }
            Err(why) => left_out.push((index, why)),
        }
    }
    found
}

/// The unit of a column as written: apart from the name, or as its last word.
fn unit_of(column: &Column) -> Option<&str> {
    if !column.unit.is_empty() {
        return Some(&column.unit);
    }
    let last = column
        .name
        .rsplit(|character: char| !character.is_alphanumeric())
        .next();
    last.filter(|last| last.len() < column.name.len() && format_of_unit(last).is_some())
}

fn steps(values: &[f64]) -> Vec<f64> {
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    steps.filter(|step| step.is_finite()).collect()
}

/// The format by the size of the numbers and their usual step, with how sure it is and why; or why it is not clear.
fn by_numbers(value: f64, step: f64, named: bool, values: &[f64]) -> Result<(TimeFormat, Sure, String), String> {
    for (format, one) in [
        (TimeFormat::Seconds, 1.0),
        (TimeFormat::Milliseconds, 1e3),
        (TimeFormat::Microseconds, 1e6),
        (TimeFormat::Nanoseconds, 1e9),
    ] {
        if EPOCH.contains(&(value / one)) {
            let why = format!("its numbers are {} since 1970", format.name());
            return Ok((format, Sure::Likely, why));
        }
    }
    if EXCEL_DAYS.contains(&value) && step < 8e-3 {
        return Ok((
            TimeFormat::ExcelDays,
            Sure::Likely,
            "its numbers are days of a spreadsheet".to_owned(),
        ));
    }
    let likely: Vec<&TimeFormat> = TimeFormat::NUMBERS
        .iter()
        .filter(|format| {
            let step = format.seconds_in_one().map_or(f64::NAN, |one| step * one);
            // Rows a minute apart are seconds too, although such a log is refused.
            **format != TimeFormat::ExcelDays && LIKELY.contains(&step)
                || **format == TimeFormat::Seconds && RARE.contains(&step)
        })
        .collect();
    let names: Vec<&str> = likely.iter().map(|format| format.name()).collect();
    match &likely[..] {
        [only] if named => Ok((
            (*only).clone(),
            Sure::Likely,
            format!("its step of {} fits only {}", shown(step), only.name()),
        )),
        [TimeFormat::Seconds] => {
            // A count of the rows and steps of depth are whole or equal; the clock of a recorder is a little late or early.
            let all = steps(values);
            let near = all.iter().filter(|other| (*other / step - 1.0).abs() < 1e-6).count();
            let whole = values.iter().filter(|value| value.fract() == 0.0).count();
            if near * 2 < all.len() && whole * 2 < values.len() && (0.5..2.0).contains(&step) {
                Ok((
                    TimeFormat::Seconds,
                    Sure::Weak,
                    "rises by about a second from row to row, as a clock".to_owned(),
                ))
            } else {
                Err("rises evenly: a time, a depth and a count of rows fit equally".to_owned())
            }
        }
        _ if named && likely.is_empty() => Err(format!(
            "named as a time, and no format gives its step of {} a usual size",
            shown(step)
        )),
        _ if named => Err(format!(
            "named as a time, and its step of {} fits {} equally",
            shown(step),
            names.join(" and ")
        )),
        _ => Err("rises evenly: a time, a depth and a count of rows fit equally".to_owned()),
    }
}

impl TimeProposal {
    /// From the first time to the last (s).
    fn length(&self) -> f64 {
        let mut given = self.seconds.iter().filter(|seconds| !seconds.is_nan());
        let first = given.next().copied().unwrap_or(0.0);
        (given.next_back().copied().unwrap_or(first) - first).abs()
    }

    /// With the evidence of its steps.
    ///
    /// # Errors
    /// When the times cannot be right, or a row in ten has none.
    fn checked(mut self) -> Result<Self, (usize, String)> {
        let index = self.indices.first().copied().unwrap_or(0);
        let given: Vec<Timed> = self
            .seconds
            .iter()
            .zip(1..)
            .filter(|(time, _)| !time.is_nan())
            .map(|(time, number)| Timed { number, time: *time })
            .collect();
        if given.len() * 10 < self.seconds.len() * 9 {
            return Err((index, "a time that many of its rows do not have".to_owned()));
        }
        // The reader of logs judges the times by the same function before a run.
        let evidence = Evidence {
            format: &self.column.format(),
            is_named: true,
            column: &self.column.name(),
            unit: "",
            max_gap: Quality::default().max_gap,
            names: Vec::new(),
            other_dates: None,
        };
        judge(&given, &evidence).map_err(|wrong| (index, format!("as a time, {}", wrong.found)))?;
        let steps: Vec<f64> = given
            .windows(2)
            .map(|pair| (pair[1].time - pair[0].time).abs())
            .collect();
        self.step = quantile(steps.iter().copied().filter(|step| *step > 0.0), 0.5);
        if self.step.is_nan() {
            return Err((index, "as a time, it stands in all rows".to_owned()));
        }
        let near = steps
            .iter()
            .filter(|step| (*step / self.step - 1.0).abs() <= 0.5)
            .count();
        if near as f64 >= EQUAL * steps.len() as f64 {
            self.evidence
                .push(format!("rows equally spaced, {} s apart", shown(self.step)));
        } else {
            self.evidence.push(format!("the usual step is {} s", shown(self.step)));
            self.sure = self.sure.max(Sure::Likely);
        }
        Ok(self)
    }
}
