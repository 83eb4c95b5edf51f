//! Rate limits for log lines.

use std::borrow::Cow;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{LazyLock, Mutex, PoisonError};
use std::time::Instant;

/// Least time between two log lines of one cause (s).
pub const LOG_INTERVAL: f64 = 10.0;
/// Most causes of a process that have separate lines; all others share one.
const MOST_CAUSES: usize = 1024;

/// Causes of a process and when it began.
static LINES: LazyLock<(Instant, Mutex<Throttles<Cow<'static, str>>>)> =
    LazyLock::new(|| (Instant::now(), Mutex::new(Throttles::new(LOG_INTERVAL))));

/// The limit of every log line that a peer can cause: one line per cause and [`LOG_INTERVAL`] in this process. Returns
/// the ending of the line as [`Throttle::ending`] does, or none when the line is left out and counted. `cause` names the
/// line and never repeats what a peer sent, so that there are few.
pub fn log_ending(cause: impl Into<Cow<'static, str>>) -> Option<String> {
    let (began, lines) = &*LINES;
    let now = began.elapsed().as_secs_f64();
    let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
    lines.ending_among(cause.into(), now, MOST_CAUSES, Cow::Borrowed("other causes"))
}

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

    /// As [`Throttles::ending`]; a cause beyond the first `most` counts as `other`.
    fn ending_among(&mut self, cause: K, now: f64, most: usize, other: K) -> Option<String> {
        let is_further = self.each.len() >= most && !self.each.contains_key(&cause);
        self.ending(if is_further { other } else { cause }, now)
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

    /// 3,000 connections in a second, for example.
    #[test]
    fn one_cause_has_one_line_in_a_process_and_the_causes_are_bounded() {
        let passed = (0..3000).filter_map(|_| log_ending("a test's cause")).count();
        // The test ends within the interval, except on a machine that stands still for ten seconds.
        assert!((1..=2).contains(&passed), "{passed}");
        let mut throttles = Throttles::new(10.0);
        let passed = (0..100).filter(|cause| throttles.ending_among(*cause, 0.0, 4, -1).is_some());
        assert_eq!(passed.count(), 5);
        assert_eq!(throttles.each.len(), 5);
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
