//! A quantity over time in bounded memory.

use crate::is_quantity;

/// Largest number of buckets: about as many as a figure can show.
const MOST: usize = 600;
/// Initial width of a bucket (s): outputs have up to 50 Hz.
const FINEST: f64 = 0.02;
/// Number of empty buckets that do not interrupt the line.
const GAP: usize = 3;
/// Time without a value that does not interrupt the line (s): some topics have one message per second.
const GAP_TIME: f64 = 2.5;

/// Longest time for which a value holds when no other follows (s): as for the line.
pub(crate) const HELD: f64 = GAP_TIME;

#[derive(Debug, Clone, Copy)]
struct Bucket {
    min: f64,
    max: f64,
    sum: f64,
    count: u64,
    /// Integral of the values over time, each of which holds until the next one (value times s).
    area: f64,
    /// Part of the bucket in which a value held (s).
    covered: f64,
}

const EMPTY: Bucket = Bucket {
    min: f64::INFINITY,
    max: f64::NEG_INFINITY,
    sum: 0.0,
    count: 0,
    area: 0.0,
    covered: 0.0,
};

impl Bucket {
    fn join(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            sum: self.sum + other.sum,
            count: self.count + other.count,
            area: self.area + other.area,
            covered: self.covered + other.covered,
        }
    }
}

/// Least, mean and largest value per bucket of time. Buckets become twice as wide when there are too many.
#[derive(Debug, Clone)]
pub(crate) struct History {
    width: f64,
    buckets: Vec<Bucket>,
    /// Times of the first and the last value (s), and the last value.
    span: Option<([f64; 2], f64)>,
}

impl Default for History {
    fn default() -> Self {
        Self {
            width: FINEST,
            buckets: Vec::new(),
            span: None,
        }
    }
}

/// Extremes and mean of all values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub min: f64,
    /// Mean over time; each value holds until the next one.
    pub mean: f64,
    pub max: f64,
}

/// A part of the curve without long interruptions.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Segment {
    /// Time (s) and mean.
    pub mean: Vec<(f64, f64)>,
    /// Outline of the band between least and largest value.
    pub outline: Vec<(f64, f64)>,
}

impl History {
    /// Adds a value at a time (s from the beginning). Values that are not finite or before the beginning are left out.
    pub(crate) fn push(&mut self, time: f64, value: f64) {
        if !(time >= 0.0 && is_quantity(time) && is_quantity(value)) {
            return;
        }
        while time / self.width >= MOST as f64 {
            self.widen();
        }
        let index = (time / self.width) as usize;
        if self.buckets.len() <= index {
            self.buckets.resize(index + 1, EMPTY);
        }
        if let Some(bucket) = self.buckets.get_mut(index) {
            *bucket = bucket.join(Bucket {
                min: value,
                max: value,
                sum: value,
                count: 1,
                ..EMPTY
            });
        }
        let first = match self.span {
            Some(([first, last], before)) => {
                self.hold(before, last, time.min(last + HELD));
                first.min(time)
            }
            None => time,
        };
        self.span = Some(([first, time], value));
    }

    /// Adds the time from `from` to `to` (s), in which `value` held, to the buckets.
    fn hold(&mut self, value: f64, from: f64, to: f64) {
        let mut begin = from;
        let first = (from / self.width) as usize;
        for (index, bucket) in self.buckets.iter_mut().enumerate().skip(first) {
            let end = ((index + 1) as f64 * self.width).min(to);
            if end > begin {
                bucket.area += value * (end - begin);
                bucket.covered += end - begin;
                begin = end;
            }
            if begin >= to {
                break;
            }
        }
    }

    /// Times of the first and the last value (s); `None` without values.
    pub(crate) fn span(&self) -> Option<[f64; 2]> {
        self.span.map(|(span, _)| span)
    }

    /// Mean over time from `from` to `to` (s), to the width of a bucket; `None` if no value held in it.
    pub(crate) fn mean_between(&self, from: f64, to: f64) -> Option<f64> {
        let (mut area, mut covered) = (0.0, 0.0);
        for (index, bucket) in self.buckets.iter().enumerate() {
            let begin = index as f64 * self.width;
            let inside = ((begin + self.width).min(to) - begin.max(from)).max(0.0) / self.width;
            area += bucket.area * inside;
            covered += bucket.covered * inside;
        }
        (covered > 0.0).then(|| area / covered)
    }

    fn widen(&mut self) {
        self.width *= 2.0;
        self.buckets = self
            .buckets
            .chunks(2)
            .map(|pair| pair.iter().copied().fold(EMPTY, Bucket::join))
            .collect();
    }

    /// Extremes and mean of all values; `None` without values.
    pub(crate) fn range(&self) -> Option<Range> {
        let all = self.buckets.iter().copied().fold(EMPTY, Bucket::join);
        (all.count > 0).then(|| Range {
            min: all.min,
            mean: if all.covered > 0.0 {
                all.area / all.covered
            } else {
                all.sum / all.count as f64
            },
            max: all.max,
        })
    }

    /// The curve, interrupted where nothing was said for long. Times in s, values times `factor`.
    pub(crate) fn segments(&self, factor: f64) -> Vec<Segment> {
        let gap = GAP.max((GAP_TIME / self.width) as usize);
        let mut all: Vec<(Segment, Vec<(f64, f64)>)> = Vec::new();
        let mut last = None;
        for (index, bucket) in self.buckets.iter().enumerate().filter(|(_, bucket)| bucket.count > 0) {
            if last.is_none_or(|last| index - last > gap) {
                all.push(Default::default());
            }
            last = Some(index);
            let time = (index as f64 + 0.5) * self.width;
            if let Some((segment, lower)) = all.last_mut() {
                segment.mean.push((time, factor * bucket.sum / bucket.count as f64));
                segment.outline.push((time, factor * bucket.max));
                lower.push((time, factor * bucket.min));
            }
        }
        all.into_iter()
            .map(|(mut segment, lower)| {
                segment.outline.extend(lower.into_iter().rev());
                segment
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_bounded_and_extremes_survive() {
        let mut history = History::default();
        // A day at 50 Hz with one blow in it.
        for step in 0..4_320_000_u32 {
            let blow = if step == 1_234_567 { 99.0 } else { 0.0 };
            history.push(f64::from(step) * 0.02, blow + f64::from(step % 2));
        }
        assert!(history.buckets.len() <= MOST, "{}", history.buckets.len());
        let range = history.range().unwrap();
        // The blow fell on an odd step.
        assert_eq!((range.min, range.max), (0.0, 100.0));
        assert!((range.mean - 0.5).abs() < 1e-4, "{}", range.mean);
        assert_eq!(history.segments(1.0).len(), 1);
    }

    /// Samples on change and every second, as the applied inputs have: a hundred in one second do not outweigh a
    /// minute.
    #[test]
    fn a_mean_is_over_time_and_not_over_messages() {
        let mut history = History::default();
        for step in 0..100 {
            history.push(f64::from(step) * 0.01, 8.0);
        }
        for second in 1..=60 {
            history.push(f64::from(second), 2.0);
        }
        // 8 for a second, 2 for 59 seconds.
        assert!((history.range().unwrap().mean - 126.0 / 60.0).abs() < 1e-9);
        assert_eq!(history.span(), Some([0.0, 60.0]));
        assert!((history.mean_between(0.0, 2.0).unwrap() - 5.0).abs() < 1e-3);
        assert!((history.mean_between(10.0, 20.0).unwrap() - 2.0).abs() < 1e-9);
        assert_eq!(history.mean_between(100.0, 200.0), None);
        // Nothing is known of a long silence, and a single value has no time.
        history.push(3600.0, 9.0);
        let known = 60.0 + HELD;
        let mean = history.range().unwrap().mean;
        assert!((mean - (126.0 + 2.0 * HELD) / known).abs() < 1e-9, "{mean}");
        let mut single = History::default();
        single.push(1.0, 3.0);
        assert_eq!(single.range().unwrap().mean, 3.0);
    }

    #[test]
    fn silence_interrupts_the_curve_and_implausible_values_are_left_out() {
        let mut history = History::default();
        for time in [0.0, 1.0, 2.0, 60.0, 61.0] {
            history.push(time, 1.0);
        }
        for (time, value) in [
            (f64::NAN, 1.0),
            (-1.0, 7.0),
            (3.0, f64::NAN),
            (3.0, f64::INFINITY),
            (3.0, 1e300),
        ] {
            history.push(time, value);
        }
        let segments = history.segments(2.0);
        assert_eq!(segments.iter().map(|s| s.mean.len()).collect::<Vec<_>>(), [3, 2]);
        assert!(segments.iter().all(|s| s.mean.iter().all(|(_, value)| *value == 2.0)));
        assert_eq!(history.range().unwrap().max, 1.0);
        // A stamp of another century does not take memory or time.
        history.push(4e9, 5.0);
        assert!(history.buckets.len() <= MOST);
        assert_eq!(history.range().unwrap().max, 5.0);
    }
}
