//! The cycles that a recording has counted, from its messages.

use flexdrill_messages::Ageing;

const SECONDS_PER_HOUR: f64 = 3600.0;
/// Time (s) by which a count may be older than its session: the first second of a run, and the rounding of stamps.
const OLDER: f64 = 2.0;

/// Sums over the model time, since the start or a reset.
#[derive(Debug, Clone, Default, PartialEq)]
struct Sums {
    /// Model time (s).
    duration: f64,
    stop: Vec<f64>,
    link: Vec<f64>,
}

impl Sums {
    /// The sums of a message, or `None` where they are none.
    fn of(message: &Ageing) -> Option<Self> {
        let hours = message.duration / SECONDS_PER_HOUR;
        let sums = |rates: &[f64]| -> Vec<f64> { rates.iter().map(|rate| rate * hours).collect() };
        let of = Self {
            duration: message.duration,
            stop: sums(&message.stop_damage_rate),
            link: sums(&message.bending_damage_rate),
        };
        let good = |value: &f64| value.is_finite() && *value >= 0.0;
        let mut all = of.stop.iter().chain(&of.link);
        (good(&of.duration) && of.stop.len() == of.link.len() && all.all(good)).then_some(of)
    }

    fn add(&mut self, factor: f64, other: &Self) {
        self.duration += factor * other.duration;
        for (sums, others) in [(&mut self.stop, &other.stop), (&mut self.link, &other.link)] {
            for (sum, other) in sums.iter_mut().zip(others) {
                // A count that is subtracted again rounds.
                *sum = (*sum + factor * other).max(0.0);
            }
        }
    }
}

/// Counted cycles of a run, from the messages of `twin/ageing` in the order of their time.
///
/// A message has the sums since the start or the last reset. A sum that falls has been reset: what was counted before is
/// kept. A run that continues an older one begins with what that one has counted, which is taken off.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Counted {
    /// Of finished counts, less what was counted before the run.
    before: Sums,
    newest: Option<Sums>,
    /// Slope of the count, and the moment it refers to (N m).
    slope: f64,
    rated_moment: f64,
    /// Stamp of the newest message (ns).
    end: i64,
}

impl Counted {
    /// Takes a message of a run that began at `start` (ns of the stamps' clock); false if its numbers are none, or of another
    /// tool than the messages before.
    pub fn push(&mut self, message: &Ageing, start: i64) -> bool {
        let Some(sums) = Sums::of(message) else {
            return false;
        };
        let good = |value: f64| value.is_finite() && value > 0.0;
        if !good(message.woehler_slope) || !good(message.rated_moment) {
            return false;
        }
        let stamp = message.header.stamp.to_nanoseconds();
        match &self.newest {
            None => {
                // The first message says how many joints there are, and what a count refers to.
                self.before = Sums {
                    duration: 0.0,
                    stop: vec![0.0; sums.stop.len()],
                    link: vec![0.0; sums.link.len()],
                };
                (self.slope, self.rated_moment) = (message.woehler_slope, message.rated_moment);
                let since = stamp.saturating_sub(start) as f64 * 1e-9;
                // More time than since the begin was counted by an earlier run, whose sums are in the table already.
                if sums.duration > since + OLDER {
                    let older = sums.clone();
                    self.before.duration = -older.duration;
                    self.before.stop = older.stop.iter().map(|sum| -sum).collect();
                    self.before.link = older.link.iter().map(|sum| -sum).collect();
                }
            }
            Some(newest) => {
                let same = newest.stop.len() == sums.stop.len()
                    && (self.slope, self.rated_moment) == (message.woehler_slope, message.rated_moment);
                if !same {
                    return false;
                }
                // Time that falls has been reset, and the sums with it.
                if sums.duration < newest.duration {
                    let finished = newest.clone();
                    self.before.add(1.0, &finished);
                }
            }
        }
        self.end = self.end.max(stamp);
        self.newest = Some(sums);
        true
    }

    /// Sums over the whole run.
    fn sums(&self) -> Sums {
        let mut sums = self.before.clone();
        if let Some(newest) = &self.newest {
            sums.add(1.0, newest);
        }
        sums
    }

    /// Model time (s).
    pub fn duration(&self) -> f64 {
        self.sums().duration.max(0.0)
    }

    /// Per joint from the top: weights of the stop's cycles, and of the link's below it.
    pub fn weights(&self) -> Vec<[f64; 2]> {
        let sums = self.sums();
        sums.stop
            .into_iter()
            .zip(sums.link)
            .map(|(stop, link)| [stop, link])
            .collect()
    }

    /// Slope of the count.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Moment that the count refers to (N m).
    pub fn rated_moment(&self) -> f64 {
        self.rated_moment
    }

    /// Stamp of the newest message (ns).
    pub fn end(&self) -> i64 {
        self.end
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::builtin_interfaces::Time;

    const SECOND: i64 = 1_000_000_000;

    /// A message at `stamp` (s) whose count covers `duration` (s), with these sums of two joints.
    fn message(stamp: i64, duration: f64, stop: [f64; 2], link: [f64; 2]) -> Ageing {
        let rates = |sums: [f64; 2]| {
            sums.map(|sum| if duration > 0.0 { sum * 3600.0 / duration } else { 0.0 })
                .to_vec()
        };
        let mut message = Ageing {
            duration,
            woehler_slope: 3.0,
            rated_moment: 100.0,
            stop_damage_rate: rates(stop),
            bending_damage_rate: rates(link),
            ..Ageing::default()
        };
        message.header.stamp = Time::from_nanoseconds(stamp * SECOND);
        message
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * b.abs().max(1.0)
    }

    #[test]
    fn a_reset_keeps_what_was_counted() {
        let mut counted = Counted::default();
        assert!(counted.push(&message(100, 0.0, [0.0; 2], [0.0; 2]), 100 * SECOND));
        assert!(counted.push(&message(150, 50.0, [1.0, 2.0], [3.0, 4.0]), 100 * SECOND));
        // Reset at 160 s.
        assert!(counted.push(&message(170, 10.0, [0.5, 0.25], [0.0, 1.0]), 100 * SECOND));
        assert!(counted.push(&message(190, 30.0, [1.5, 0.5], [0.0, 2.0]), 100 * SECOND));
        assert!(close(counted.duration(), 80.0));
        let expected = [[2.5, 3.0], [2.5, 6.0]];
        for (found, expected) in counted.weights().into_iter().zip(expected) {
            assert!(
                close(found[0], expected[0]) && close(found[1], expected[1]),
                "{found:?}"
            );
        }
        assert_eq!(counted.end(), 190 * SECOND);
    }

    #[test]
    fn what_an_earlier_run_has_counted_is_no_part_of_this_one() {
        let mut counted = Counted::default();
        // The session began at 1000 s, and its first count covers 600 s.
        assert!(counted.push(&message(1001, 600.0, [6.0, 0.0], [3.0, 0.0]), 1000 * SECOND));
        assert_eq!(counted.duration(), 0.0);
        assert!(counted.push(&message(1061, 660.0, [7.0, 1.0], [3.5, 0.0]), 1000 * SECOND));
        assert!(close(counted.duration(), 60.0));
        let weights = counted.weights();
        assert!(close(weights[0][0], 1.0) && close(weights[0][1], 0.5) && close(weights[1][0], 1.0));
        // A recording that began late has all of its session.
        let mut late = Counted::default();
        assert!(late.push(&message(1600, 599.0, [6.0, 0.0], [3.0, 0.0]), 1000 * SECOND));
        assert!(close(late.duration(), 599.0) && close(late.weights()[0][0], 6.0));
    }

    #[test]
    fn numbers_that_are_none_and_another_tool_are_not_taken() {
        let mut counted = Counted::default();
        assert!(counted.push(&message(10, 5.0, [1.0, 0.0], [0.0; 2]), 5 * SECOND));
        let known = counted.clone();
        let mut wrong = message(20, 15.0, [2.0, 0.0], [0.0; 2]);
        wrong.stop_damage_rate[1] = f64::NAN;
        assert!(!counted.push(&wrong, 5 * SECOND));
        wrong.stop_damage_rate[1] = -1.0;
        assert!(!counted.push(&wrong, 5 * SECOND));
        wrong.stop_damage_rate = vec![0.0; 3];
        assert!(!counted.push(&wrong, 5 * SECOND));
        wrong.bending_damage_rate = vec![0.0; 3];
        assert!(!counted.push(&wrong, 5 * SECOND));
        let mut other = message(20, 15.0, [2.0, 0.0], [0.0; 2]);
        other.woehler_slope = 5.0;
        assert!(!counted.push(&other, 5 * SECOND));
        assert_eq!(counted, known);
    }
}
