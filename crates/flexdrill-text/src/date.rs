//! Instants as dates and times of day in UTC.

use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::Offset;

/// A year (s). A model whose clock begins at zero counts its own time: earlier instants are no dates.
const FIRST_DATE: i64 = 31_536_000;

/// Date and time of an instant (ns since 1970), such as `2026-11-22 01:10:19 UTC`, or `model time 61 s` where the clock
/// began at zero.
pub fn date_time(nanoseconds: i64) -> String {
    model_time(nanoseconds).unwrap_or_else(|| format!("{} UTC", utc(nanoseconds).strftime("%Y-%m-%d %H:%M:%S")))
}

/// Time of day of an instant (ns since 1970), such as `01:10:19 UTC`, or `model time 61 s` as [`date_time`] has it.
pub fn time_of_day(nanoseconds: i64) -> String {
    model_time(nanoseconds).unwrap_or_else(|| format!("{} UTC", utc(nanoseconds).strftime("%H:%M:%S")))
}

/// Date and time of an instant (ns since 1970) for a file name, such as `20261122T011019Z`; such names sort by time.
pub fn compact_date_time(nanoseconds: i64) -> String {
    utc(nanoseconds).strftime("%Y%m%dT%H%M%SZ").to_string()
}

fn model_time(nanoseconds: i64) -> Option<String> {
    let seconds = nanoseconds.div_euclid(1_000_000_000);
    (0..FIRST_DATE)
        .contains(&seconds)
        .then(|| format!("model time {seconds} s"))
}

/// The calendar has every instant that 64 bits of nanoseconds can hold (years 1677 to 2262).
fn utc(nanoseconds: i64) -> DateTime {
    let instant = Timestamp::from_nanosecond(nanoseconds.into()).unwrap_or_default();
    Offset::UTC.to_datetime(instant)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected texts are those of `date -u -d @SECONDS`.
    #[test]
    fn dates_agree_with_the_calendar() {
        let cases = [
            (951_782_400, "2000-02-29 00:00:00 UTC"),
            (1_700_000_000, "2023-11-14 22:13:20 UTC"),
            (4_107_542_399, "2100-02-28 23:59:59 UTC"),
            (4_107_542_400, "2100-03-01 00:00:00 UTC"),
            (-1, "1969-12-31 23:59:59 UTC"),
            (i64::MAX / 1_000_000_000, "2262-04-11 23:47:16 UTC"),
            (i64::MIN / 1_000_000_000, "1677-09-21 00:12:44 UTC"),
        ];
        for (seconds, text) in cases {
            assert_eq!(date_time(seconds * 1_000_000_000), text);
        }
        assert_eq!(time_of_day(1_700_000_000_900_000_000), "22:13:20 UTC");
        assert_eq!(compact_date_time(1_700_000_000_900_000_000), "20231114T221320Z");
    }

    #[test]
    fn a_clock_that_began_at_zero_shows_model_time() {
        assert_eq!(date_time(61_500_000_000), "model time 61 s");
        assert_eq!(time_of_day(61_500_000_000), "model time 61 s");
        assert_eq!(date_time(31_536_000_000_000_000), "1971-01-01 00:00:00 UTC");
    }
}
