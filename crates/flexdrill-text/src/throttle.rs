//! Rate limits for log lines.

use std::collections::HashMap;
use std::hash::Hash;

/// Passes one line per interval and counts the lines that it held back.
#[derive(Debug, Clone)]
pub struct Throttle {
    interval: f64,
    last: Option<f64>,
    skipped: u64,
}

impl Throttle {
    /// At most one line per `interval` (s).
    pub fn new(interval: f64) -> Self {
        Self {
            interval,
            last: None,
            skipped: 0,
        }
    }

    /// How many lines were held back since the last one, if a line may be logged at `now` (s, any steady clock).
    pub fn pass(&mut self, now: f64) -> Option<u64> {
        if self.last.is_some_and(|last| now - last < self.interval) {
            self.skipped += 1;
            return None;
        }
        self.last = Some(now);
        Some(std::mem::take(&mut self.skipped))
    }

    /// As [`Throttle::pass`], as an ending for the line: empty, or ` (3 more since the last line)`.
    pub fn ending(&mut self, now: f64) -> Option<String> {
        self.pass(now).map(|skipped| match skipped {
            0 => String::new(),
            more => format!(" ({more} more since the last line)"),
        })
    }
}

/// One [`Throttle`] per cause.
#[derive(Debug, Clone)]
pub struct Throttles<K> {
    interval: f64,
    each: HashMap<K, Throttle>,
}

impl<K: Eq + Hash> Throttles<K> {
    /// At most one line per cause and `interval` (s).
    pub fn new(interval: f64) -> Self {
        Self {
            interval,
            each: HashMap::new(),
        }
    }

    /// As [`Throttle::ending`], for one cause.
    pub fn ending(&mut self, cause: K, now: f64) -> Option<String> {
        let interval = self.interval;
        self.each
            .entry(cause)
            .or_insert_with(|| Throttle::new(interval))
            .ending(now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_per_interval_with_the_number_left_out() {
        let mut throttle = Throttle::new(1.0);
        assert_eq!(throttle.pass(10.0), Some(0));
        let passed: Vec<u64> = (1..=2000)
            .filter_map(|ms| throttle.pass(10.0 + f64::from(ms) * 1e-3))
            .collect();
        assert_eq!(passed, [999, 999]);
        assert_eq!(throttle.ending(12.5), None);
        assert_eq!(throttle.ending(13.0).unwrap(), " (1 more since the last line)");
    }

    #[test]
    fn causes_do_not_hide_each_other() {
        let mut throttles = Throttles::new(1.0);
        assert_eq!(throttles.ending("diverged", 0.0).as_deref(), Some(""));
        assert_eq!(throttles.ending("diverged", 0.5), None);
        assert_eq!(throttles.ending("not finite", 0.5).as_deref(), Some(""));
        assert_eq!(
            throttles.ending("diverged", 1.0).as_deref(),
            Some(" (1 more since the last line)")
        );
    }
}
