//! Errors of a calibration.

/// Why nothing was fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CalibrationError {
    /// Too few points for the coefficients of the surrogate's mean.
    #[error(
        "the surrogate of {quantity} has {points} points for {coefficients} coefficients: at least {least} are needed; run \
         more points of the design"
    )]
    FewPoints {
        /// What it is a surrogate of.
        quantity: String,
        /// Points with a result.
        points: usize,
        /// Coefficients of the surrogate's mean.
        coefficients: usize,
        /// Least number of points.
        least: usize,
    },
    /// The points do not determine the surrogate's coefficients.
    #[error(
        "the points of the surrogate of {quantity} do not determine its coefficients: they do not differ in every input"
    )]
    PoorPoints {
        /// What it is a surrogate of.
        quantity: String,
    },
    /// A covariance is not positive definite.
    #[error("the covariance of the observations is not positive definite: a window has no scatter and no error")]
    NoCovariance,
    /// A number that cannot be.
    #[error("{what} is {value}: must be {bound}")]
    Number {
        /// What it is.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// Nothing was observed.
    #[error("there is nothing to fit: no steady window has a measured quantity that the twin predicts")]
    NothingObserved,
}
