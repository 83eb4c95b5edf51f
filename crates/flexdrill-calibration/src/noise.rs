//! The covariance of the errors of what is measured.
//!
//! Two errors that are independent of each other: the scatter of a window's mean, of that window alone, and the drift
//! of the sensor, a random walk from the beginning of the log. Treating drift as independent from window to window
//! would make a long log look far more certain than it is. The error of the surrogate is added by [`crate::fit`].

use nalgebra::DMatrix;

use crate::CalibrationError;

/// What the covariance needs of an observation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSource {
    /// Sensor that it comes from.
    pub sensor: usize,
    /// Time from the beginning of the log (s).
    pub time: f64,
    /// Standard deviation of the window's mean.
    pub scatter: f64,
    /// Standard deviation of the sensor's drift after an hour; it grows with the root of time.
    pub drift_in_an_hour: f64,
}

/// The covariance of the errors of all observations.
///
/// # Errors
/// When a standard deviation is negative or not finite.
pub fn covariance(sources: &[ErrorSource]) -> Result<DMatrix<f64>, CalibrationError> {
    for source in sources {
        for (what, value) in [
            ("the scatter of a window", source.scatter),
            ("the drift of a sensor", source.drift_in_an_hour),
            ("the time of a window", source.time),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(CalibrationError::Number {
                    what,
                    value,
                    bound: "finite and not negative",
                });
            }
        }
    }
    let between = |i: usize, j: usize| {
        let (a, b) = (&sources[i], &sources[j]);
        let mut sum = if i == j { a.scatter * a.scatter } else { 0.0 };
        if a.sensor == b.sensor {
            sum += a.drift_in_an_hour * b.drift_in_an_hour * a.time.min(b.time) / 3600.0;
        }
        sum
    };
    Ok(DMatrix::from_fn(sources.len(), sources.len(), between))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_log_does_not_average_drift_away() {
        let source = |time: f64| ErrorSource {
            sensor: 0,
            time,
            scatter: 1.0,
            drift_in_an_hour: 3.0,
        };
        let all: Vec<ErrorSource> = (0..100).map(|k| source(f64::from(k) * 36.0)).collect();
        let c = covariance(&all).unwrap();
        assert_eq!(c[(0, 0)], 1.0);
        assert_eq!(c[(50, 50)], 1.0 + 9.0 * 0.5);
        assert_eq!(c[(10, 50)], 9.0 * 0.1);
        // The variance of the mean of all: scatter 0.01, and a third of the drift after the hour.
        let mean = c.sum() / 1e4;
        assert!((mean - (0.01 + 3.0)).abs() < 0.1, "{mean}");
        assert!(c.cholesky().is_some());
        let mut wrong = source(0.0);
        wrong.scatter = f64::NAN;
        assert!(covariance(&[wrong]).is_err());
    }
}
