//! Notations of time in a log.

use std::borrow::Cow;

use jiff::civil::{Date, Time};
use jiff::fmt::strtime::BrokenDownTime;
use jiff::tz::Offset;
use serde::de::value::StrDeserializer;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Decimal;

/// Notation of time in a log. Only differences matter to the model; the dates are kept for the way back to the log.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
#[serde(remote = "Self", rename_all = "snake_case")]
pub enum TimeFormat {
    /// A number of seconds.
    #[default]
    Seconds,
    /// A number of milliseconds.
    Milliseconds,
    /// A number of microseconds.
    Microseconds,
    /// A number of nanoseconds.
    Nanoseconds,
    /// A number of minutes.
    Minutes,
    /// A number of hours.
    Hours,
    /// A number of days since 1899-12-30, as spreadsheets store date and time.
    ExcelDays,
    /// `2024-05-01T12:30:05.25Z`; also with a blank for the T, without `-` and `:`, with or without the Z or an offset
    /// such as +02:00.
    Iso8601,
    /// `23:59:58.5`, `23:59`, `11:59:58 PM`, or a number of seconds since midnight. It restarts at midnight.
    TimeOfDay,
    /// A pattern of strftime, such as `%d/%m/%Y %H:%M:%S%.f`.
    #[serde(skip)]
    Pattern(String),
}

impl<'de> Deserialize<'de> for TimeFormat {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        if text.contains('%') {
            return Ok(Self::Pattern(text));
        }
        // The derived function knows the words of the other formats.
        Self::deserialize(StrDeserializer::<D::Error>::new(&text))
    }
}

impl Serialize for TimeFormat {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// Latest time accepted (s): beyond any time in milliseconds read as seconds, and the sum of two is finite.
const LATEST: f64 = 1e15;
/// A day (s).
pub(crate) const DAY: f64 = 86_400.0;
/// Days from 1899-12-30, the epoch of spreadsheets, to 1970-01-01.
const EXCEL_EPOCH: f64 = 25_569.0;
/// Earliest year of a pattern's dates: an earlier one is a year of two digits read as four.
const EARLIEST_YEAR: i16 = 1900;

impl TimeFormat {
    /// The formats that are a number of something.
    pub(crate) const NUMBERS: [Self; 7] = [
        Self::Seconds,
        Self::Milliseconds,
        Self::Microseconds,
        Self::Nanoseconds,
        Self::Minutes,
        Self::Hours,
        Self::ExcelDays,
    ];

    /// The name in a mapping file.
    pub fn name(&self) -> &str {
        match self {
            Self::Seconds => "seconds",
            Self::Milliseconds => "milliseconds",
            Self::Microseconds => "microseconds",
            Self::Nanoseconds => "nanoseconds",
            Self::Minutes => "minutes",
            Self::Hours => "hours",
            Self::ExcelDays => "excel_days",
            Self::Iso8601 => "iso8601",
            Self::TimeOfDay => "time_of_day",
            Self::Pattern(pattern) => pattern,
        }
    }

    /// The format in a line of a mapping: in quotes where it is a pattern, which YAML reads otherwise.
    pub(crate) fn in_mapping(&self) -> String {
        match self {
            Self::Pattern(pattern) => format!("format: \"{pattern}\""),
            word => format!("format: {}", word.name()),
        }
    }

    /// Seconds in one of what it counts; `None` where it is not a number.
    pub(crate) const fn seconds_in_one(&self) -> Option<f64> {
        Some(match self {
            Self::Seconds => 1.0,
            Self::Milliseconds => 1e-3,
            Self::Microseconds => 1e-6,
            Self::Nanoseconds => 1e-9,
            Self::Minutes => 60.0,
            Self::Hours => 3600.0,
            Self::ExcelDays => DAY,
            Self::Iso8601 | Self::TimeOfDay | Self::Pattern(_) => return None,
        })
    }

    /// Whether its times are instants, and not only differences.
    pub fn has_dates(&self) -> bool {
        match self {
            Self::Iso8601 | Self::ExcelDays => true,
            // Every directive of a date, and the number of seconds since 1970.
            Self::Pattern(pattern) => directives(pattern).any(|directive| "dejDFs".contains(directive)),
            _ => false,
        }
    }

    /// Whether its times restart at midnight.
    pub(crate) fn restarts_daily(&self) -> bool {
        match self {
            Self::TimeOfDay => true,
            Self::Pattern(_) => !self.has_dates(),
            _ => false,
        }
    }

    /// Why a pattern cannot be used; `None` where it can, and for the other formats.
    pub(crate) fn fault(&self) -> Option<String> {
        let Self::Pattern(pattern) = self else { return None };
        // An afternoon shows whether the hour of twelve has its AM or PM.
        let sample = jiff::Timestamp::from_second(981_216_306)
            .ok()?
            .to_zoned(jiff::tz::TimeZone::UTC);
        let written = match jiff::fmt::strtime::format(pattern, &sample) {
            Ok(written) => written,
            Err(error) => return Some(error.to_string()),
        };
        let wanted = f64::from(sample.hour()) * 3600.0 + f64::from(sample.minute()) * 60.0;
        match self.parse(&written, Decimal::Point) {
            Some(seconds) if (seconds.rem_euclid(DAY) - wanted).abs() < 60.0 => None,
            Some(_) => Some("it does not give hour and minute".to_owned()),
            None => Some(format!("it does not read {written:?}, which it writes")),
        }
    }

    /// What a time of [`TimeFormat::parse`] is in the column of this name, such as `time_s 62.35`; empty where it has a date.
    pub fn own_text(&self, column: &str, seconds: f64) -> String {
        if self.has_dates() {
            return String::new();
        }
        match self.seconds_in_one() {
            Some(one) if one < 1.0 => format!("{column} {}", (seconds / one).round()),
            Some(one) => format!("{column} {}", rounded(seconds / one)),
            None => {
                let (hours, minutes) = ((seconds / 3600.0) as u64, (seconds % 3600.0 / 60.0) as u64);
                let seconds = rounded(seconds % 60.0);
                let zero = if seconds < 10.0 { "0" } else { "" };
                format!("{column} {hours:02}:{minutes:02}:{zero}{seconds}")
            }
        }
    }

    /// Time since the format's epoch (s); `None` when the text is not of this format.
    pub fn parse(&self, text: &str, decimal: Decimal) -> Option<f64> {
        // A comma in a clock cannot separate anything but a fraction (ISO 8601, 4.2.2.4).
        let clock = || match text.contains(',') {
            true => Cow::Owned(text.replacen(',', ".", 1)),
            false => Cow::Borrowed(text),
        };
        let seconds = match self {
            Self::ExcelDays => (decimal.parse(text)? - EXCEL_EPOCH) * DAY,
            Self::Iso8601 => iso8601(&clock())?,
            Self::TimeOfDay if text.contains(':') => clock_time(&clock())?,
            Self::TimeOfDay => since_midnight(decimal.parse(text)?)?,
            Self::Pattern(pattern) if pattern.contains(',') => of_pattern(pattern, text)?,
            Self::Pattern(pattern) => of_pattern(pattern, &clock())?,
            number => decimal.parse(text)? * number.seconds_in_one()?,
        };
        (seconds.abs() <= LATEST).then_some(seconds)
    }
}

/// The letters of a pattern's directives, without flags and widths.
fn directives(pattern: &str) -> impl Iterator<Item = char> + '_ {
    let mut characters = pattern.chars();
    std::iter::from_fn(move || {
        characters.find(|character| *character == '%')?;
        characters
            .find(|character| !matches!(character, '-' | '_' | '^' | '#' | '.' | ':') && !character.is_ascii_digit())
    })
}

/// Seconds since 1970-01-01, UTC, or since midnight where the pattern has no date.
fn of_pattern(pattern: &str, text: &str) -> Option<f64> {
    let parsed = BrokenDownTime::parse(pattern, text.trim()).ok()?;
    let fraction = f64::from(parsed.subsec_nanosecond().unwrap_or(0)) * 1e-9;
    if let Some(instant) = parsed.timestamp() {
        return Some(instant.as_second() as f64 + fraction);
    }
    let time = parsed.to_time().ok()?;
    let clock =
        f64::from(i32::from(time.hour()) * 3600 + i32::from(time.minute()) * 60 + i32::from(time.second())) + fraction;
    if parsed.day().is_none() && parsed.day_of_year().is_none() {
        return Some(clock);
    }
    let date = parsed.to_date().ok().filter(|date| date.year() >= EARLIEST_YEAR)?;
    let midnight = Offset::UTC
        .to_timestamp(date.to_datetime(Time::midnight()))
        .ok()?
        .as_second();
    let offset = parsed.offset().map_or(0, Offset::seconds);
    Some((midnight - i64::from(offset)) as f64 + clock)
}

/// Without digits that only the arithmetic has: to a microsecond.
fn rounded(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e6
}

/// Seconds since 1970-01-01, UTC.
fn iso8601(text: &str) -> Option<f64> {
    let (date, time) = text.split_once(['T', ' '])?;
    let (year, month, day) = match date.len() {
        8 if date.is_ascii() => (&date[..4], &date[4..6], &date[6..]),
        _ => {
            let (year, rest) = date.split_once('-')?;
            let (month, day) = rest.split_once('-')?;
            (year, month, day)
        }
    };
    let year = i16::try_from(whole(year, 4)?).ok()?;
    let month = i8::try_from(whole(month, 2)?).ok()?;
    let day = i8::try_from(whole(day, 2)?).ok()?;
    let midnight = Date::new(year, month, day).ok()?.to_datetime(Time::midnight());
    let midnight = Offset::UTC.to_timestamp(midnight).ok()?.as_second();
    let (clock, offset) = split_offset(time.trim_start())?;
    // jiff does not parse the clock: it would clamp a leap second to 59 and cut fractions to nanoseconds.
    let clock = if clock.contains(':') {
        clock_time(clock)?
    } else {
        compact_clock(clock)?
    };
    Some((midnight - offset) as f64 + clock)
}

/// Time since midnight (s) of `HHMMSS`, `HHMMSS.s` or `HHMM`.
fn compact_clock(clock: &str) -> Option<f64> {
    let digits = clock.split_once('.').map_or(clock, |(digits, _)| digits);
    let seconds = match (digits.len(), clock.is_ascii()) {
        (4, true) if digits == clock => "0",
        (6, true) => &clock[4..],
        _ => return None,
    };
    clock_time(&format!("{}:{}:{seconds}", &clock[..2], &clock[2..4]))
}

/// Time since midnight (s) of `HH:MM`, `HH:MM:SS.s`, or one of them with AM or PM behind it.
fn clock_time(clock: &str) -> Option<f64> {
    let (clock, half_day) = split_half_day(clock);
    let mut parts = clock.split(':');
    let hour_text = parts.next()?;
    // A clock of twelve hours has mostly one digit before ten, a clock of a day has two.
    let hour = match half_day {
        None => whole(hour_text, 2).filter(|hour| *hour < 24)?,
        Some(afternoon) => {
            let hour = whole(hour_text, hour_text.len().min(2)).filter(|hour| (1..=12).contains(hour))?;
            hour % 12 + if afternoon { 12 } else { 0 }
        }
    };
    let minute = whole(parts.next()?, 2).filter(|minute| *minute < 60)?;
    let second_text = parts.next().unwrap_or("0");
    if parts.next().is_some() || !second_text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.') {
        return None;
    }
    let second = second_text.parse::<f64>().ok().filter(|second| *second < 61.0)?;
    Some((hour * 3600 + minute * 60) as f64 + second)
}

/// The clock without AM or PM, and whether it is the afternoon.
fn split_half_day(clock: &str) -> (&str, Option<bool>) {
    for (mark, afternoon) in [("AM", false), ("PM", true), ("am", false), ("pm", true)] {
        if let Some(rest) = clock.strip_suffix(mark) {
            return (rest.trim_end(), Some(afternoon));
        }
    }
    (clock, None)
}

/// Seconds since midnight, from a number of them.
fn since_midnight(seconds: f64) -> Option<f64> {
    // The end of the day is included: loggers write it for midnight.
    (0.0..=DAY).contains(&seconds).then_some(seconds)
}

/// The clock and the offset from UTC (s).
fn split_offset(time: &str) -> Option<(&str, i64)> {
    for zone in ["Z", "z", "UTC", "GMT"] {
        if let Some(clock) = time.strip_suffix(zone) {
            return Some((clock.trim_end(), 0));
        }
    }
    let Some(at) = time.find(['+', '-']) else {
        return Some((time, 0));
    };
    let sign = if time[at..].starts_with('-') { -1 } else { 1 };
    let digits: String = time[at + 1..].chars().filter(|character| *character != ':').collect();
    let (hours, minutes) = match digits.len() {
        2 => (whole(&digits, 2)?, 0),
        4 if digits.is_ascii() => (whole(&digits[..2], 2)?, whole(&digits[2..], 2)?),
        _ => return None,
    };
    Some((time[..at].trim_end(), sign * (hours * 3600 + minutes * 60)))
}

fn whole(text: &str, digits: usize) -> Option<i64> {
    let fits = text.len() == digits && text.bytes().all(|byte| byte.is_ascii_digit());
    fits.then(|| text.parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_instants() {
        let parse = |text| TimeFormat::Iso8601.parse(text, Decimal::Point);
        assert_eq!(parse("1970-01-01T00:00:00Z"), Some(0.0));
        assert_eq!(parse("2000-02-29 12:00:00.5"), Some(951_825_600.5));
        assert_eq!(parse("2024-12-31T23:59:59+01:00"), Some(1_735_685_999.0));
        assert_eq!(parse("2024-12-31T17:59-0500"), Some(1_735_685_940.0));
        assert_eq!(parse("2016-12-31T23:59:60.5Z"), Some(1_483_228_800.5));
    }

    /// Two Gregorian cycles of 400 years. A day that a month does not have is no date.
    #[test]
    fn days_follow_one_another_over_every_leap_rule() {
        let mut expected = -62_135_596_800.0; // date -u -d 0001-01-01 +%s
        for year in 1..=801_u32 {
            let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
            let lengths = [31, 28 + u32::from(leap), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
            for (month, length) in (1..).zip(lengths) {
                for day in 1..=31 {
                    let text = format!("{year:04}-{month:02}-{day:02}T00:00:00Z");
                    let found = TimeFormat::Iso8601.parse(&text, Decimal::Point);
                    if day > length {
                        assert_eq!(found, None, "{text}");
                    } else {
                        assert_eq!(found, Some(expected), "{text}");
                        expected += DAY;
                    }
                }
            }
        }
    }

    #[test]
    fn nonsense_is_none() {
        for text in [
            "",
            "12:30",
            "2024-13-01T00:00:00",
            "2024-1-1T00:00:00",
            "2024-01-01T25:00:00",
            "2024-01-01Tx",
            "2024-01-01T00:00:00+é1",
        ] {
            assert_eq!(TimeFormat::Iso8601.parse(text, Decimal::Point), None, "{text}");
        }
        for text in ["24:00:00", "12", "12:61", "12:30:0x", "-1", "86401", "nan", "12:30:00Z"] {
            let parsed = TimeFormat::TimeOfDay.parse(text, Decimal::Point);
            assert_eq!(parsed, (text == "12").then_some(12.0), "{text}");
        }
        let point = Decimal::Point;
        assert_eq!(TimeFormat::TimeOfDay.parse("23:59:58.5", point), Some(DAY - 1.5));
        assert_eq!(TimeFormat::TimeOfDay.parse("86399.25", point), Some(DAY - 0.75));
        assert_eq!(TimeFormat::Seconds.parse("nan", point), None);
        assert_eq!(TimeFormat::Milliseconds.parse("1500", point), Some(1.5));
    }

    #[test]
    fn notations_of_recorders_are_the_same_instant() {
        let noon = 1_769_687_960.0; // date -u -d 2026-01-29T11:59:20 +%s
        for text in [
            "2026-01-29T11:59:20Z",
            "2026-01-29 11:59:20",
            "20260129T115920Z",
            "20260129 115920",
            "20260129T115920.000",
            "2026-01-29 13:59:20 +02:00",
            "2026-01-29 13:59:20+0200",
            "2026-01-29T11:59:20,000",
            "2026-01-29 11:59:20 UTC",
            "2026-01-29 11:59:20 AM",
        ] {
            assert_eq!(TimeFormat::Iso8601.parse(text, Decimal::Point), Some(noon), "{text}");
        }
        for (pattern, text) in [
            ("%d/%m/%Y-%H:%M:%S", "29/01/2026-11:59:20"),
            ("%d-%b-%Y %H:%M:%S", "29-Jan-2026 11:59:20"),
            ("%d-%b-%y %H:%M:%S", "29-JAN-26 11:59:20"),
            ("%m/%d/%Y %I:%M:%S %p", "1/29/2026 11:59:20 AM"),
            ("%d.%m.%Y %H:%M:%S%.f", "29.01.2026 11:59:20,000"),
            ("%d.%m.%Y %H:%M:%S%.f", "29.01.2026 11:59:20"),
            ("%d.%m.%Y %H:%M:%S %:z", "29.01.2026 13:59:20 +02:00"),
            ("%s", "1769687960"),
        ] {
            let format = TimeFormat::Pattern(pattern.to_owned());
            assert_eq!(format.fault(), None, "{pattern}");
            assert_eq!(format.parse(text, Decimal::Point), Some(noon), "{pattern} {text}");
            assert!(format.has_dates());
        }
        let excel = TimeFormat::ExcelDays.parse("46051.4995370370", Decimal::Point).unwrap();
        assert!((excel - noon).abs() < 1e-3, "{excel}");
        let clock = TimeFormat::Pattern("%I:%M:%S %p".to_owned());
        assert_eq!(clock.parse("1:05:00 PM", Decimal::Point), Some(47_100.0));
        assert!(clock.restarts_daily());
        assert_eq!(
            TimeFormat::TimeOfDay.parse("1:05:00 PM", Decimal::Point),
            Some(47_100.0)
        );
        assert_eq!(TimeFormat::TimeOfDay.parse("12:05:00 AM", Decimal::Point), Some(300.0));
        // A year of two digits is no year of four.
        let four = TimeFormat::Pattern("%d/%m/%Y %H:%M:%S".to_owned());
        assert_eq!(four.parse("29/01/26 11:59:20", Decimal::Point), None);
    }

    #[test]
    fn a_pattern_that_does_not_give_the_time_back_is_refused() {
        for pattern in ["%d/%m/%Y", "%I:%M:%S", "%Q!%", "%c", "%Y %j", "%"] {
            let format = TimeFormat::Pattern(pattern.to_owned());
            assert!(format.fault().is_some(), "{pattern}");
        }
    }

    #[test]
    fn a_time_without_a_date_is_written_as_the_log_has_it() {
        for (format, text, own) in [
            (TimeFormat::Seconds, "62.35", "t 62.35"),
            (TimeFormat::Milliseconds, "62350", "t 62350"),
            (TimeFormat::TimeOfDay, "09:05:02", "t 09:05:02"),
            (TimeFormat::TimeOfDay, "23:59:58.5", "t 23:59:58.5"),
            (TimeFormat::Iso8601, "2024-05-01T12:30:05Z", ""),
        ] {
            let seconds = format.parse(text, Decimal::Point).unwrap();
            assert_eq!(format.own_text("t", seconds), own, "{text}");
        }
    }

    #[test]
    fn decimal_commas_of_a_number_need_the_mapping_and_those_of_a_clock_do_not() {
        for (format, text, seconds) in [
            (TimeFormat::Seconds, "0,5", 0.5),
            (TimeFormat::TimeOfDay, "23:59:58,5", DAY - 1.5),
            (TimeFormat::Iso8601, "1970-01-01T00:00:01,25Z", 1.25),
        ] {
            assert_eq!(format.parse(text, Decimal::Comma), Some(seconds), "{text}");
            if format != TimeFormat::Seconds {
                assert_eq!(format.parse(text, Decimal::Point), Some(seconds), "{text}");
            }
        }
        assert_eq!(TimeFormat::Seconds.parse("0,5", Decimal::Point), None);
        // A point may stand between thousands then.
        assert_eq!(TimeFormat::Seconds.parse("1.234", Decimal::Comma), None);
    }
}
