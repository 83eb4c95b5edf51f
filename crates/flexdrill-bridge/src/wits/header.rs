//! The first seven items of every record: well, hole, record, sequence, date, time, activity.

use jiff::civil::{Date, DateTime, Time};
use jiff::tz::Offset;

use super::item::number;

/// Number of the last item of a header.
pub const LAST_HEADER_ITEM: u8 = 7;

/// Longest text of a header that is kept (bytes).
const LONGEST_TEXT: usize = 32;

/// The header of a record in a frame.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Header {
    /// Name of the well, as sent: for displays only, escaped.
    pub well: Vec<u8>,
    /// The number of the record that the header itself gives.
    pub record: Option<u64>,
    /// The sequence number.
    pub sequence: Option<u64>,
    /// Date and time as the source has them, in its time zone.
    pub date: Option<Date>,
    /// See [`Self::date`].
    pub time: Option<Time>,
    /// Code of the activity, as sent.
    pub activity: Option<u64>,
    /// Whether the sequence number is a date or a time of day.
    pub(crate) is_clock: bool,
    /// Items of the header that could not be read, by their number.
    pub unreadable: Vec<u8>,
}

impl Header {
    /// Adds an item of the header. Texts that are not needed are passed over.
    pub(crate) fn add(&mut self, item: u8, value: &[u8]) {
        let whole = || {
            let value = number(value)?;
            ((0.0..1e15).contains(&value) && value.fract() == 0.0).then_some(value as u64)
        };
        let mut read = true;
        match item {
            1 => self.well = value[..value.len().min(LONGEST_TEXT)].to_vec(),
            3 => {
                self.record = whole();
                read = self.record.is_some();
            }
            4 => {
                self.sequence = whole();
                read = self.sequence.is_some();
            }
            5 => {
                self.date = whole().and_then(date);
                read = self.date.is_some();
            }
            6 => {
                self.time = whole().and_then(time);
                read = self.time.is_some();
            }
            7 => {
                self.activity = whole();
                read = self.activity.is_some();
            }
            _ => {}
        }
        if !read {
            self.unreadable.push(item);
        }
    }

    /// Looks whether the sequence number is a clock: date with time, or what items 05 and 06 have.
    pub(crate) fn look_at_sequence(&mut self, items: [Option<&[u8]>; 2]) {
        let Some(sequence) = self.sequence else { return };
        let is_date_time = sequence >= 100_000_000_000
            && date(sequence / 1_000_000).is_some_and(|date| (2000..2100).contains(&date.year()))
            && time(sequence % 1_000_000).is_some();
        // Numbers below a thousand may be like a time shortly after midnight.
        let is_item = |text: &[u8]| number(text).is_some_and(|value| value == sequence as f64);
        self.is_clock = is_date_time || sequence >= 1000 && items.into_iter().flatten().any(is_item);
    }

    /// The instant of date and time (ns since 1970), if the header has both. `utc_offset` is that of the source's clock (s).
    pub fn instant(&self, utc_offset: i32) -> Option<i64> {
        let date_time = DateTime::from_parts(self.date?, self.time?);
        let offset = Offset::from_seconds(utc_offset).ok()?;
        let instant = offset.to_timestamp(date_time).ok()?;
        i64::try_from(instant.as_nanosecond()).ok()
    }
}

/// A date from YYMMDD, or YYYYMMDD as some sources send it. Years of two digits belong to this century.
fn date(value: u64) -> Option<Date> {
    let year = value / 10_000;
    let year = if year < 100 { 2000 + year } else { year };
    let part = |value: u64| i8::try_from(value % 100).ok();
    Date::new(i16::try_from(year).ok()?, part(value / 100)?, part(value)?).ok()
}

/// A time of day from HHMMSS.
fn time(value: u64) -> Option<Time> {
    let part = |value: u64| i8::try_from(value).ok();
    Time::new(part(value / 10_000)?, part(value / 100 % 100)?, part(value % 100)?, 0).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn date_and_time_are_an_instant_in_the_sources_zone() {
        let mut header = Header::default();
        header.add(5, b"231114");
        header.add(6, b"221320");
        assert_eq!(header.instant(0), Some(1_700_000_000_000_000_000));
        // A clock two hours ahead of UTC shows the same figures two hours earlier.
        assert_eq!(header.instant(7200), Some(1_699_992_800_000_000_000));
        header.add(5, b"20231114");
        assert_eq!(header.instant(0), Some(1_700_000_000_000_000_000));
        assert!(header.unreadable.is_empty());
    }

    #[test]
    fn a_sequence_number_that_is_a_clock_is_noticed() {
        let is_clock = |sequence: &str| {
            let mut header = Header::default();
            header.add(4, sequence.as_bytes());
            header.look_at_sequence([Some(b"260925"), Some(b"083724")]);
            header.is_clock
        };
        assert!(
            ["20260925083724", "260925083724", "83724", "260925"]
                .map(is_clock)
                .iter()
                .all(|is| *is)
        );
        assert!(
            !["1", "83725", "900000000000000", "99999999999"]
                .map(is_clock)
                .iter()
                .any(|is| *is)
        );
    }

    #[test]
    fn figures_that_are_no_date_are_reported() {
        let mut header = Header::default();
        for (item, value) in [(4, "x"), (5, "231399"), (6, "250000"), (7, "-3")] {
            header.add(item, value.as_bytes());
        }
        assert_eq!(header.unreadable, [4, 5, 6, 7]);
        assert_eq!(header.instant(0), None);
    }
}
