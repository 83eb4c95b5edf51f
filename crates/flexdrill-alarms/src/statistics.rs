//! The figures by which ISA-18.2 and EEMUA 191 judge an alarm system.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::{Priority, Time, span};

/// Span of a flood (s).
const FLOOD_SPAN: f64 = 600.0;
/// More annunciations than this within the span are a flood.
const FLOOD: usize = 10;
/// Span in which the repetitions of an alarm count as chattering (s).
const CHATTER_SPAN: f64 = 60.0;

/// Observed time from which on a mean per hour is given (s), so that it never extrapolates.
const RATE_SPAN: f64 = 3600.0;

/// Longest interval between two observations that counts as observed (s): in a longer one the program did not run.
const WATCHED_GAP: f64 = 60.0;

/// Counts of annunciations.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Statistics {
    /// Per alarm.
    counts: Vec<u64>,
    /// Per highest priority of an annunciation, in rising order.
    of_priority: [u64; 3],
    /// Per alarm the priority under which its last annunciation is counted.
    called: Vec<Option<Priority>>,
    /// Those of the last ten minutes.
    recent: VecDeque<Time>,
    /// Per alarm those of the last minute.
    repeats: Vec<VecDeque<Time>>,
    /// Per alarm the most in any minute.
    most_repeats: Vec<usize>,
    /// The most in any ten minutes.
    most_recent: usize,
    /// Observed time so far, and its part in flood.
    watched: Time,
    flooded: Time,
    last: Option<Time>,
}

/// The figures so far.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Figures {
    /// Observed time (s).
    pub watched: f64,
    /// The number of annunciations.
    pub annunciations: u64,
    /// The number with low, medium and high priority, by the highest that each annunciation reached.
    pub of_priority: [u64; 3],
    /// Mean annunciations per observed hour; none before the first full hour.
    pub per_hour: Option<f64>,
    /// In the last ten minutes.
    pub last_ten_minutes: usize,
    /// The most in any ten minutes.
    pub most_in_ten_minutes: usize,
    /// More than ten in the last ten minutes.
    pub flood: bool,
    /// Part of the observed time in flood, 0 to 1; none before the first full ten minutes.
    pub flood_share: Option<f64>,
    /// The most annunciations of one alarm within any minute.
    pub most_repeats: usize,
}

impl Statistics {
    /// Statistics of a number of alarms.
    pub(crate) fn new(alarms: usize) -> Self {
        Self {
            counts: vec![0; alarms],
            called: vec![None; alarms],
            repeats: vec![VecDeque::new(); alarms],
            most_repeats: vec![0; alarms],
            ..Self::default()
        }
    }

    /// Whether they belong to this number of alarms, which a changed file may violate.
    pub(crate) fn is_of(&self, alarms: usize) -> bool {
        [
            self.counts.len(),
            self.called.len(),
            self.repeats.len(),
            self.most_repeats.len(),
        ] == [alarms; 4]
    }

    /// Advances the time. The time of a restart does not count as observed, nor does a step back of the clock.
    pub(crate) fn advance(&mut self, time: Time) {
        if let Some(last) = self.last {
            let passed = match time - last {
                gap if (0..=span(WATCHED_GAP)).contains(&gap) => gap,
                _ => 0,
            };
            self.watched += passed;
            if self.recent.len() > FLOOD {
                self.flooded += passed;
            }
        }
        self.last = Some(time);
        forget(&mut self.recent, time, FLOOD_SPAN);
        for repeats in &mut self.repeats {
            forget(repeats, time, CHATTER_SPAN);
        }
    }

    /// The present time: that of the last [`Statistics::advance`].
    pub(crate) fn last(&self) -> Option<Time> {
        self.last
    }

    /// Counts an annunciation at the present time, because an event may carry the time of another clock.
    pub(crate) fn count(&mut self, alarm: usize, priority: Option<Priority>) {
        let time = self.last.unwrap_or_default();
        self.recent.push_back(time);
        self.most_recent = self.most_recent.max(self.recent.len());
        if let Some(priority) = priority {
            self.of_priority[priority as usize] += 1;
        }
        if let Some(count) = self.counts.get_mut(alarm) {
            *count += 1;
            self.called[alarm] = priority;
            self.repeats[alarm].push_back(time);
            self.most_repeats[alarm] = self.most_repeats[alarm].max(self.repeats[alarm].len());
        }
    }

    /// The last annunciation of an alarm rose in priority.
    pub(crate) fn raise(&mut self, alarm: usize, priority: Option<Priority>) {
        let Some(called) = self.called.get_mut(alarm) else {
            return;
        };
        if let (Some(before), Some(now)) = (*called, priority)
            && now > before
        {
            let counted = &mut self.of_priority[before as usize];
            *counted = counted.saturating_sub(1);
            self.of_priority[now as usize] += 1;
            *called = priority;
        }
    }

    /// Annunciations of an alarm.
    pub fn annunciations(&self, alarm: usize) -> u64 {
        self.counts.get(alarm).copied().unwrap_or_default()
    }

    /// Annunciations of an alarm in the last minute; three are a chattering alarm.
    pub fn last_minute(&self, alarm: usize) -> usize {
        self.repeats.get(alarm).map_or(0, VecDeque::len)
    }

    /// The most annunciations of an alarm within any minute.
    pub fn most_repeats(&self, alarm: usize) -> usize {
        self.most_repeats.get(alarm).copied().unwrap_or_default()
    }

    /// The figures so far.
    pub fn figures(&self) -> Figures {
        let annunciations = self.counts.iter().sum();
        let rate = |part: f64, window: f64| (self.watched >= span(window)).then(|| part / self.watched as f64);
        Figures {
            watched: self.watched as f64 * 1e-9,
            annunciations,
            of_priority: self.of_priority,
            per_hour: rate(annunciations as f64 * span(3600.0) as f64, RATE_SPAN),
            last_ten_minutes: self.recent.len(),
            most_in_ten_minutes: self.most_recent,
            flood: self.recent.len() > FLOOD,
            flood_share: rate(self.flooded as f64, FLOOD_SPAN),
            most_repeats: self.most_repeats.iter().copied().max().unwrap_or_default(),
        }
    }
}

/// Drops times that are older than a span, or later than the present after a step back of the clock.
fn forget(times: &mut VecDeque<Time>, now: Time, length: f64) {
    times.retain(|time| now - time < span(length) && *time <= now);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_more_than_ten_in_ten_minutes() {
        let mut statistics = Statistics::new(2);
        statistics.advance(0);
        for minute in 0..12 {
            statistics.advance(span(f64::from(minute) * 30.0));
            statistics.count(0, Some(Priority::Low));
        }
        // The eleventh comes at 300 s, the first is forgotten at 600 s, the second at 630 s: 330 s with eleven or more.
        for second in 331..1200 {
            statistics.advance(span(f64::from(second)));
        }
        let figures = statistics.figures();
        assert_eq!(
            (figures.annunciations, figures.most_in_ten_minutes, figures.flood),
            (12, 12, false)
        );
        let share = figures.flood_share.unwrap();
        assert!((share - 330.0 / 1199.0).abs() < 1e-9, "{figures:?}");
    }

    #[test]
    fn rates_are_given_over_a_full_window_only() {
        let mut statistics = Statistics::new(1);
        let mut rates = Vec::new();
        for second in 0..=7200_u32 {
            statistics.advance(span(f64::from(second)));
            if second == 1 || second == 60 {
                statistics.count(0, Some(Priority::Low));
            }
            let figures = statistics.figures();
            assert_eq!(figures.flood_share.is_some(), second >= 600, "at {second} s");
            assert_eq!(figures.per_hour.is_some(), second >= 3600, "at {second} s");
            rates.extend(figures.per_hour);
        }
        assert_eq!((rates.first(), rates.last()), (Some(&2.0), Some(&1.0)));
    }

    #[test]
    fn repeats_are_counted_within_a_minute() {
        let mut statistics = Statistics::new(2);
        for second in [0.0, 30.0, 59.0, 65.0, 200.0] {
            statistics.advance(span(second));
            statistics.count(1, Some(Priority::High));
        }
        assert_eq!((statistics.most_repeats(0), statistics.most_repeats(1)), (0, 3));
        assert_eq!((statistics.last_minute(1), statistics.annunciations(1)), (1, 5));
        assert_eq!(statistics.figures().of_priority, [0, 0, 5]);
    }
}
