//! Computing times of steps over an interval.

use hdrhistogram::Histogram;

/// Longest step time resolved (ns); longer ones count as this.
const LONGEST_STEP: u64 = 60_000_000_000;

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
}
