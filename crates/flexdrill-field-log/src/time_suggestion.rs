//! Formats of time that fit the texts of a log, for errors that say which one to set.

use jiff::fmt::strtime::BrokenDownTime;

use crate::{Decimal, TimeFormat};

/// Dates as recorders, spreadsheets and reports write them.
const DATES: [&str; 17] = [
    "%d/%m/%Y", "%m/%d/%Y", "%Y/%m/%d", "%d-%m-%Y", "%m-%d-%Y", "%Y-%m-%d", "%d.%m.%Y", "%d-%b-%Y", "%d-%b-%y",
    "%d %b %Y", "%b %d %Y", "%d/%m/%y", "%m/%d/%y", "%y/%m/%d", "%d.%m.%y", "%Y%m%d", "%y%m%d",
];
/// What stands between date and clock.
const BETWEEN: [&str; 4] = [" ", "T", "-", ":"];
const CLOCKS: [&str; 5] = ["%H:%M:%S", "%I:%M:%S %p", "%H:%M", "%I:%M %p", "%H%M%S"];
/// What may stand behind the clock.
const BEHIND: [&str; 2] = ["", " %:z"];
/// Earliest year that is no year of two digits.
const EARLIEST_YEAR: i16 = 1900;

/// The formats that read all of the texts: ISO 8601 and time of day where they do, and otherwise the patterns of a list.
pub(crate) fn fitting(texts: &[String]) -> Vec<TimeFormat> {
    let reads_all = |format: &TimeFormat| {
        !texts.is_empty() && texts.iter().all(|text| format.parse(text, Decimal::Point).is_some())
    };
    for format in [TimeFormat::Iso8601, TimeFormat::TimeOfDay] {
        // A number of seconds is a time of day too, and says nothing.
        if reads_all(&format) && texts.iter().all(|text| text.contains([':', 'T'])) {
            return vec![format];
        }
    }
    let mut fitting = Vec::new();
    for date in DATES {
        for between in BETWEEN {
            for clock in CLOCKS {
                for behind in BEHIND {
                    let (head, tail) = clock.split_once(" %p").map_or((clock, ""), |(head, _)| (head, " %p"));
                    // The fraction is in the suggestion only where the log has one.
                    let formats = ["", "%.f"]
                        .map(|fraction| TimeFormat::Pattern(format!("{date}{between}{head}{fraction}{tail}{behind}")));
                    fitting.extend(formats.into_iter().find(reads_all));
                }
            }
        }
    }
    fitting
}

/// Whether a text is a date without a clock. Digits alone are a number.
pub(crate) fn is_date(text: &str) -> bool {
    let date = |pattern: &str| {
        let parsed = BrokenDownTime::parse(pattern, text).and_then(|parsed| parsed.to_date());
        parsed.is_ok_and(|date| date.year() >= EARLIEST_YEAR)
    };
    text.contains(|character: char| !character.is_ascii_digit()) && DATES.into_iter().any(date)
}

/// Whether a text is a clock time without a date.
pub(crate) fn is_clock(text: &str) -> bool {
    text.contains(':') && TimeFormat::TimeOfDay.parse(text, Decimal::Point).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(texts: &[&str]) -> Vec<String> {
        let texts: Vec<String> = texts.iter().map(|text| (*text).to_owned()).collect();
        fitting(&texts).iter().map(|format| format.name().to_owned()).collect()
    }

    #[test]
    fn one_pattern_is_found_where_the_texts_allow_one() {
        for (text, pattern) in [
            ("29/01/2026-11:59:20", "%d/%m/%Y-%H:%M:%S"),
            ("29-Jan-2026 11:59:20", "%d-%b-%Y %H:%M:%S"),
            ("29-Jan-26 11:59:20", "%d-%b-%y %H:%M:%S"),
            ("1/29/2026 11:59:20 AM", "%m/%d/%Y %I:%M:%S %p"),
            ("29.01.2026 11:59:20,250", "%d.%m.%Y %H:%M:%S%.f"),
            ("2026/01/29 11:59", "%Y/%m/%d %H:%M"),
            ("29.01.2026 11:59:20 +02:00", "%d.%m.%Y %H:%M:%S %:z"),
            ("2026-01-29 11:59:20", "iso8601"),
            ("20260129T115920Z", "iso8601"),
            ("11:59:20 AM", "time_of_day"),
        ] {
            assert_eq!(names(&[text]), [pattern], "{text}");
        }
        // A day beyond twelve separates day from month.
        assert_eq!(names(&["01/02/2026 11:59:20"]).len(), 2);
        assert_eq!(names(&["01/02/2026 11:59:20", "13/02/2026 00:00:00"]).len(), 1);
        assert!(names(&["lunch"]).is_empty() && names(&["12.5"]).is_empty() && names(&[]).is_empty());
    }

    #[test]
    fn dates_and_clocks_alone_are_recognised() {
        for text in ["2026-01-29", "29/01/2026", "29-Jan-26", "29.01.2026"] {
            assert!(is_date(text) && !is_clock(text), "{text}");
        }
        for text in ["11:59:20", "11:59", "1:05:00 PM"] {
            assert!(is_clock(text) && !is_date(text), "{text}");
        }
        for text in ["", "12.5", "20260129", "x", "1/2"] {
            assert!(!is_clock(text) && !is_date(text), "{text}");
        }
    }
}
