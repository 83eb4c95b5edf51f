//! Figures over intervals: step times and the real-time factor.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use hdrhistogram::Histogram;

/// Longest step time told apart (ns); longer ones count as this.
const LONGEST_STEP: u64 = 60_000_000_000;
/// Span of the real-time factor.
const FACTOR_SPAN: Duration = Duration::from_secs(1);

/// Computing times of steps since the last reading.
pub struct StepTimes {
    histogram: Histogram<u64>,
}

/// Percentiles of step times (s); zero when there was no step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct StepTimeFigures {
    /// Median.
    pub p50: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Longest.
    pub max: f64,
}

impl StepTimes {
    /// An empty meter, 1 ns to 60 s with three digits.
    ///
    /// # Errors
    /// None with these bounds; the histogram's own error otherwise.
    pub fn new() -> Result<Self, hdrhistogram::CreationError> {
        Ok(Self {
            histogram: Histogram::new_with_bounds(1, LONGEST_STEP, 3)?,
        })
    }

    /// Counts a step (ns).
    pub fn add(&mut self, nanoseconds: u32) {
        self.histogram.saturating_record(u64::from(nanoseconds).max(1));
    }

    /// The figures since the last call.
    pub fn take(&mut self) -> StepTimeFigures {
        if self.histogram.is_empty() {
            return StepTimeFigures::default();
        }
        let seconds = |nanoseconds: u64| nanoseconds as f64 * 1e-9;
        let figures = StepTimeFigures {
            p50: seconds(self.histogram.value_at_quantile(0.5)),
            p99: seconds(self.histogram.value_at_quantile(0.99)),
            max: seconds(self.histogram.max()),
        };
        self.histogram.reset();
        figures
    }
}

/// Model time gained per second of wall time, over the last second.
#[derive(Debug, Default)]
pub struct RealTimeFactor {
    samples: VecDeque<(Instant, f64)>,
}

impl RealTimeFactor {
    /// Takes the model time (s) gained since the start, over all resets; gives the factor, 0 before there is a span.
    pub fn update(&mut self, now: Instant, gained: f64) -> f64 {
        self.samples.push_back((now, gained));
        while self.samples.len() > 2 && self.samples.get(1).is_some_and(|(at, _)| now - *at >= FACTOR_SPAN) {
            self.samples.pop_front();
        }
        match self.samples.front() {
            Some((at, then)) if now > *at => (gained - then) / (now - *at).as_secs_f64(),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_of_the_interval() {
        let mut times = StepTimes::new().unwrap();
        for time in 1..=1000 {
            times.add(time * 1000);
        }
        let figures = times.take();
        // Three digits: within a thousandth.
        assert!((figures.p50 / 500e-6 - 1.0).abs() < 1e-3, "{figures:?}");
        assert!((figures.p99 / 990e-6 - 1.0).abs() < 1e-3, "{figures:?}");
        assert!((figures.max / 1e-3 - 1.0).abs() < 1e-3, "{figures:?}");
        assert_eq!(times.take(), StepTimeFigures::default());
    }

    #[test]
    fn the_factor_looks_back_one_second() {
        let start = Instant::now();
        let mut factor = RealTimeFactor::default();
        assert_eq!(factor.update(start, 0.0), 0.0);
        for tenth in 1..=20 {
            let gained = if tenth <= 10 {
                0.1 * f64::from(tenth)
            } else {
                1.0 + 0.05 * f64::from(tenth - 10)
            };
            let value = factor.update(start + Duration::from_millis(100 * tenth as u64), gained);
            if tenth == 10 {
                assert!((value - 1.0).abs() < 1e-9);
            }
            if tenth == 20 {
                assert!((value - 0.5).abs() < 1e-9, "{value}");
            }
        }
    }
}
