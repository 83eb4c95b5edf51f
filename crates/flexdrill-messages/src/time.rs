//! Times of messages and nanoseconds since the epoch.

use super::builtin_interfaces::Time;

const NANOSECONDS_PER_SECOND: i64 = 1_000_000_000;

impl Time {
    /// From nanoseconds since the clock's epoch; held at the ends of what 32-bit seconds can say.
    pub fn from_nanoseconds(nanoseconds: i64) -> Self {
        let seconds = nanoseconds.div_euclid(NANOSECONDS_PER_SECOND);
        match i32::try_from(seconds) {
            Ok(sec) => Self {
                sec,
                nanosec: nanoseconds.rem_euclid(NANOSECONDS_PER_SECOND) as u32,
            },
            Err(_) if seconds < 0 => Self {
                sec: i32::MIN,
                nanosec: 0,
            },
            Err(_) => Self {
                sec: i32::MAX,
                nanosec: 999_999_999,
            },
        }
    }

    /// Nanoseconds since the clock's epoch.
    pub fn to_nanoseconds(&self) -> i64 {
        i64::from(self.sec) * NANOSECONDS_PER_SECOND + i64::from(self.nanosec)
    }

    /// This time moved by `seconds`, to the nearest nanosecond.
    pub fn plus_seconds(&self, seconds: f64) -> Self {
        let shift = (seconds * NANOSECONDS_PER_SECOND as f64).round() as i64;
        Self::from_nanoseconds(self.to_nanoseconds().saturating_add(shift))
    }
}
