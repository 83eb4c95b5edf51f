//! Shares of time of the values of a code.

use std::collections::BTreeMap;

use crate::history::HELD;

/// The codes of successive messages. Each holds until the next message, at most for [`HELD`].
#[derive(Debug, Default)]
pub(crate) struct Shares {
    /// Time of each code (s).
    times: BTreeMap<u8, f64>,
    last: Option<(f64, u8)>,
}

impl Shares {
    /// Adds the code of a message at a time (s from the beginning).
    pub(crate) fn push(&mut self, time: f64, code: u8) {
        if let Some((before, last)) = self.last {
            let held = (time - before).clamp(0.0, HELD);
            *self.times.entry(last).or_default() += held;
        }
        self.times.entry(code).or_default();
        self.last = Some((time, code));
    }

    /// Whether there was no message.
    pub(crate) fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Whether a code has occurred.
    pub(crate) fn has(&self, code: u8) -> bool {
        self.times.contains_key(&code)
    }

    /// Codes and their shares of the time (0 to 1).
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u8, f64)> {
        let all: f64 = self.times.values().sum();
        // A single message holds for no time, yet it is all that is known.
        let equal = 1.0 / self.times.len().max(1) as f64;
        self.times
            .iter()
            .map(move |(code, time)| (*code, if all > 0.0 { time / all } else { equal }))
    }

    /// The share of a code (0 to 1).
    pub(crate) fn of(&self, code: u8) -> f64 {
        self.iter()
            .find(|(known, _)| *known == code)
            .map_or(0.0, |(_, share)| share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Messages come on change and every second: many in a short time are not a long time.
    #[test]
    fn shares_are_of_time_and_not_of_messages() {
        let mut shares = Shares::default();
        for step in 0..100 {
            shares.push(f64::from(step) * 0.01, 1);
        }
        for second in 1..=4 {
            shares.push(f64::from(second), 3);
        }
        assert!((shares.of(1) - 0.25).abs() < 1e-9, "{}", shares.of(1));
        assert!((shares.of(3) - 0.75).abs() < 1e-9, "{}", shares.of(3));
        // A silence of an hour belongs to no code.
        shares.push(3604.0, 1);
        assert!((shares.of(3) - 5.5 / 6.5).abs() < 1e-9, "{}", shares.of(3));
        let mut single = Shares::default();
        single.push(1.0, 2);
        assert_eq!(single.of(2), 1.0);
    }
}
