//! Notations of time in a log.

use jiff::civil::{Date, Time};
use jiff::tz::Offset;
use serde::{Deserialize, Serialize};

use crate::Decimal;

/// Notation of time in a log. Only differences matter to the model; the dates are kept for the way back to the log.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimeFormat {
    /// A number of seconds.
    #[default]
    Seconds,
    /// A number of milliseconds.
    Milliseconds,
    /// `2024-05-01T12:30:05.25Z`; also with a blank for the T, with or without the Z or an offset such as +02:00.
    Iso8601,
    /// `23:59:58.5`, `23:59`, or a number of seconds since midnight. It restarts at midnight.
    TimeOfDay,
}

/// Latest time accepted (s): beyond any time in milliseconds read as seconds, and the sum of two is finite.
const LATEST: f64 = 1e15;
/// A day (s).
pub(crate) const DAY: f64 = 86_400.0;

impl TimeFormat {
    /// The name in a mapping file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Seconds => "seconds",
            Self::Milliseconds => "milliseconds",
            Self::Iso8601 => "iso8601",
            Self::TimeOfDay => "time_of_day",
        }
    }

    /// Whether its times are instants, and not only differences.
    pub const fn has_dates(self) -> bool {
        matches!(self, Self::Iso8601)
    }

    /// What a time of [`TimeFormat::parse`] is in the column of this name, such as `time_s 62.35`; empty where it has a date.
    pub fn own_text(self, column: &str, seconds: f64) -> String {
        match self {
            Self::Seconds => format!("{column} {}", rounded(seconds)),
            Self::Milliseconds => format!("{column} {}", (seconds * 1e3).round()),
            Self::Iso8601 => String::new(),
            Self::TimeOfDay => {
                let (hours, minutes) = ((seconds / 3600.0) as u64, (seconds % 3600.0 / 60.0) as u64);
                let seconds = rounded(seconds % 60.0);
                let zero = if seconds < 10.0 { "0" } else { "" };
                format!("{column} {hours:02}:{minutes:02}:{zero}{seconds}")
            }
        }
    }

    /// Time since the format's epoch (s); `None` when the text is not of this format.
    pub fn parse(self, text: &str, decimal: Decimal) -> Option<f64> {
        let clock = || match decimal {
            Decimal::Point => text.to_owned(),
            Decimal::Comma => text.replacen(',', ".", 1),
        };
        let seconds = match self {
            Self::Seconds => decimal.parse(text)?,
            Self::Milliseconds => decimal.parse(text)? * 1e-3,
            Self::Iso8601 => iso8601(&clock())?,
            Self::TimeOfDay => time_of_day(&clock())?,
        };
        (seconds.abs() <= LATEST).then_some(seconds)
    }
}

/// Without digits that only the arithmetic has: to a microsecond.
fn rounded(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e6
}

/// Seconds since 1970-01-01, UTC.
fn iso8601(text: &str) -> Option<f64> {
    let (date, time) = text.split_once(['T', ' '])?;
    let mut parts = date.split('-');
    let year = i16::try_from(whole(parts.next()?, 4)?).ok()?;
    let month = i8::try_from(whole(parts.next()?, 2)?).ok()?;
    let day = i8::try_from(whole(parts.next()?, 2)?).ok()?;
    if parts.next().is_some() {
        return None;
    }
    let midnight = Date::new(year, month, day).ok()?.to_datetime(Time::midnight());
    let midnight = Offset::UTC.to_timestamp(midnight).ok()?.as_second();
    let (clock, offset) = split_offset(time)?;
    // jiff does not parse the clock: it would clamp a leap second to 59 and cut fractions to nanoseconds.
    Some((midnight - offset) as f64 + clock_time(clock)?)
}

/// Time since midnight (s) of `HH:MM` or `HH:MM:SS.s`.
fn clock_time(clock: &str) -> Option<f64> {
    let mut parts = clock.split(':');
    let hour = whole(parts.next()?, 2).filter(|hour| *hour < 24)?;
    let minute = whole(parts.next()?, 2).filter(|minute| *minute < 60)?;
    let second_text = parts.next().unwrap_or("0");
    if parts.next().is_some() || !second_text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.') {
        return None;
    }
    let second = second_text.parse::<f64>().ok().filter(|second| *second < 61.0)?;
    Some((hour * 3600 + minute * 60) as f64 + second)
}

/// Seconds since midnight.
fn time_of_day(text: &str) -> Option<f64> {
    if text.contains(':') {
        return clock_time(text);
    }
    let seconds = text.parse::<f64>().ok()?;
    // The end of the day is included: loggers write it for midnight.
    (0.0..=DAY).contains(&seconds).then_some(seconds)
}

/// The clock and the offset from UTC (s).
fn split_offset(time: &str) -> Option<(&str, i64)> {
    if let Some(clock) = time.strip_suffix(['Z', 'z']) {
        return Some((clock, 0));
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
    Some((&time[..at], sign * (hours * 3600 + minutes * 60)))
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
    fn decimal_commas_are_read_only_where_the_mapping_says_so() {
        for (format, text, seconds) in [
            (TimeFormat::Seconds, "0,5", 0.5),
            (TimeFormat::TimeOfDay, "23:59:58,5", DAY - 1.5),
            (TimeFormat::Iso8601, "1970-01-01T00:00:01,25Z", 1.25),
        ] {
            assert_eq!(format.parse(text, Decimal::Comma), Some(seconds), "{text}");
            assert_eq!(format.parse(text, Decimal::Point), None, "{text}");
        }
        // A point may stand between thousands then.
        assert_eq!(TimeFormat::Seconds.parse("1.234", Decimal::Comma), None);
    }
}
