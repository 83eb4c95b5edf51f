//! Instants as date and time, UTC.

/// Before this an instant is a model's own time and no date (s): a year.
const DATES_FROM: i64 = 31_536_000;

/// Date and time of an instant in ns since 1970, such as `2026-11-22 01:10:19 UTC`; a model that began at time 0 has
/// no date.
pub fn instant(nanoseconds: i64) -> String {
    let seconds = nanoseconds.div_euclid(1_000_000_000);
    if (0..DATES_FROM).contains(&seconds) {
        return format!("model time {seconds} s");
    }
    let [year, month, day, hour, minute, second] = calendar(seconds);
    format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02} UTC")
}

/// Time of day of such an instant, such as `01:10:19 UTC`.
pub fn time_of_day(nanoseconds: i64) -> String {
    let seconds = nanoseconds.div_euclid(1_000_000_000);
    if (0..DATES_FROM).contains(&seconds) {
        return format!("model time {seconds} s");
    }
    let [_, _, _, hour, minute, second] = calendar(seconds);
    format!("{hour:02}:{minute:02}:{second:02} UTC")
}

/// Date and time as part of a file name, which sorts by time: `20261122T011019Z`.
pub fn instant_in_a_name(seconds: i64) -> String {
    let [year, month, day, hour, minute, second] = calendar(seconds);
    format!("{year:04}{month:02}{day:02}T{hour:02}{minute:02}{second:02}Z")
}

/// Year, month, day, hour, minute and second of s since 1970.
fn calendar(seconds: i64) -> [i64; 6] {
    let (days, of_day) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
    let [year, month, day] = civil(days);
    [year, month, day, of_day / 3600, of_day % 3600 / 60, of_day % 60]
}

/// Year, month and day of a day since 1970-01-01 in the Gregorian calendar (Hinnant, "chrono-compatible low-level date
/// algorithms").
fn civil(days: i64) -> [i64; 3] {
    let shifted = days + 719_468;
    let era = shifted.div_euclid(146_097);
    let day_of_era = shifted.rem_euclid(146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * march + 2) / 5 + 1;
    let month = if march < 10 { march + 3 } else { march - 9 };
    [year_of_era + era * 400 + i64::from(month <= 2), month, day]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_those_of_the_calendar() {
        // date -u -d @N
        let cases = [
            (951_782_400, "2000-02-29 00:00:00 UTC"),
            (1_700_000_000, "2023-11-14 22:13:20 UTC"),
            (4_107_542_399, "2100-02-28 23:59:59 UTC"),
            (4_107_542_400, "2100-03-01 00:00:00 UTC"),
            (-1, "1969-12-31 23:59:59 UTC"),
        ];
        for (seconds, text) in cases {
            assert_eq!(instant(seconds * 1_000_000_000), text);
        }
        assert_eq!(instant(61_500_000_000), "model time 61 s");
        assert_eq!(time_of_day(61_500_000_000), "model time 61 s");
        assert_eq!(time_of_day(1_700_000_000_900_000_000), "22:13:20 UTC");
        assert_eq!(instant_in_a_name(1_700_000_000), "20231114T221320Z");
    }
}
