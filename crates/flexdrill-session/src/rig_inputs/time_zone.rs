//! A clock of the rig that shows another time zone.

use std::fmt;

/// A time zone that explains how far a stamp is ahead of the clock. `Display` is a sentence with the remedy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeZone {
    /// Offset of the zone (h).
    hours: f64,
}

impl TimeZone {
    /// Time zones are whole quarters of an hour (s).
    const QUARTER: f64 = 900.0;
    /// Quarters of the last zone, 14 h.
    const MOST: f64 = 56.0;
    /// Clocks that are set are within this of one another (s).
    const NEAR: f64 = 2.0;

    /// The zone of a clock that is ahead by so much (s); `None` where no time zone explains it.
    pub fn ahead(ahead: f64) -> Option<Self> {
        let quarters = (ahead / Self::QUARTER).round();
        let is_zone = (1.0..=Self::MOST).contains(&quarters) && (ahead - Self::QUARTER * quarters).abs() <= Self::NEAR;
        is_zone.then_some(Self { hours: quarters / 4.0 })
    }
}

impl fmt::Display for TimeZone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} h is a time zone: add it to `utc_offset_h` in the mapping of its bridge, or set its clock to UTC",
            self.hours
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_quarters_of_an_hour_within_two_seconds_are_time_zones() {
        for (ahead, hours) in [(7199.2, 2.0), (19_801.0, 5.5), (900.0, 0.25), (50_400.0, 14.0)] {
            assert_eq!(TimeZone::ahead(ahead), Some(TimeZone { hours }), "{ahead}");
        }
        for ahead in [1.0, 903.0, 7206.0, 54_000.0, -7200.0, f64::NAN] {
            assert_eq!(TimeZone::ahead(ahead), None, "{ahead}");
        }
    }
}
