//! The ensemble smoother with multiple data assimilation (Emerick and Reynolds 2013).
//!
//! The same observations are used in several steps. In each the covariance R of their errors is multiplied by alpha; the
//! inverses of all alphas add up to 1, so that a linear model with normal errors gets the exact posterior:
//!
//! X <- X + C_xy (C_yy + alpha R)^-1 (D - Y),    D = d + sqrt(alpha) L e
//!
//! with the members as columns of X, the predictions Y of each, the observations d, R = L L' and standard normal e.
//! Because the surrogate costs nothing, the ensemble is large enough to need no localisation.

use nalgebra::{DMatrix, DVector};

use crate::CalibrationError;
use crate::random::Random;

/// How the smoother runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmootherSettings {
    /// Members.
    pub members: usize,
    /// Steps, each with alpha = this number.
    pub steps: usize,
    /// Seed of the ensemble and of the perturbed observations.
    pub seed: u64,
}

impl Default for SmootherSettings {
    fn default() -> Self {
        Self {
            // The standard deviation of a posterior is then known to 2 % (1 / sqrt(2 N)).
            members: 1000,
            // As in the source; for a model that is nearly linear more steps change nothing.
            steps: 4,
            seed: 1,
        }
    }
}

/// A standard normal ensemble: one column per member.
pub(crate) fn standard_normal(rows: usize, members: usize, random: &mut Random) -> DMatrix<f64> {
    let mut all = DMatrix::from_fn(rows, members, |_, _| random.normal());
    // Mean and variance of each row are made exact, so that the ratio of variances begins at 1.
    for mut row in all.row_iter_mut() {
        let mean = row.sum() / members as f64;
        row.iter_mut().for_each(|x| *x -= mean);
        let deviation = (row.norm_squared() / (members.max(2) - 1) as f64).sqrt();
        if deviation > 0.0 {
            row.iter_mut().for_each(|x| *x /= deviation);
        }
    }
    all
}

/// One step: the members `x` (columns) after observations, given their predictions `y` (columns), the perturbed
/// observations `d` (columns) and alpha times the covariance of the errors.
///
/// # Errors
/// When that covariance is not positive definite.
pub fn update(
    x: &DMatrix<f64>,
    y: &DMatrix<f64>,
    d: &DMatrix<f64>,
    inflated: &DMatrix<f64>,
) -> Result<DMatrix<f64>, CalibrationError> {
    let divisor = (x.ncols().max(2) - 1) as f64;
    let (from_x, from_y) = (anomalies(x), anomalies(y));
    let cross = &from_x * from_y.transpose() / divisor;
    let within = &from_y * from_y.transpose() / divisor + inflated;
    let factor = within.cholesky().ok_or(CalibrationError::NoCovariance)?;
    Ok(x + cross * factor.solve(&(d - y)))
}

fn anomalies(members: &DMatrix<f64>) -> DMatrix<f64> {
    let mean: DVector<f64> = members.column_mean();
    let mut all = members.clone();
    for mut column in all.column_iter_mut() {
        column -= &mean;
    }
    all
}

/// The posterior ensemble of standardised unknowns, one column per member. `model` predicts the observations of a member.
///
/// # Errors
/// When the covariance of the observations is not positive definite, or a prediction is not finite.
pub fn smooth(
    unknowns: usize,
    observed: &[f64],
    covariance: &DMatrix<f64>,
    settings: &SmootherSettings,
    model: impl Fn(&[f64]) -> Vec<f64>,
) -> Result<DMatrix<f64>, CalibrationError> {
    let mut random = Random::new(settings.seed);
    let mut x = standard_normal(unknowns, settings.members, &mut random);
    let factor = covariance.clone().cholesky().ok_or(CalibrationError::NoCovariance)?.l();
    let alpha = settings.steps.max(1) as f64;
    let inflated = covariance * alpha;
    let centre = DVector::from_row_slice(observed);
    for _ in 0..settings.steps.max(1) {
        let y = predictions(&x, observed.len(), &model)?;
        let mut d = &factor * standard_normal(observed.len(), settings.members, &mut random) * alpha.sqrt();
        for mut column in d.column_iter_mut() {
            column += &centre;
        }
        x = update(&x, &y, &d, &inflated)?;
    }
    Ok(x)
}

fn predictions(
    x: &DMatrix<f64>,
    observations: usize,
    model: &impl Fn(&[f64]) -> Vec<f64>,
) -> Result<DMatrix<f64>, CalibrationError> {
    let mut y = DMatrix::zeros(observations, x.ncols());
    for (member, column) in x.column_iter().enumerate() {
        let z: Vec<f64> = column.iter().copied().collect();
        let predicted = model(&z);
        if let Some(value) = predicted.iter().copied().find(|value| !value.is_finite()) {
            return Err(CalibrationError::Number {
                what: "a prediction",
                value,
                bound: "finite",
            });
        }
        for (row, value) in predicted.into_iter().take(observations).enumerate() {
            y[(row, member)] = value;
        }
    }
    Ok(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear model with normal errors has a closed form: precision I + G' R^-1 G.
    #[test]
    fn a_linear_model_gets_the_exact_posterior() {
        let g = DMatrix::from_row_slice(3, 2, &[1.0, 1.0, 0.5, -0.2, 0.0, 2.0]);
        let r = DMatrix::from_row_slice(3, 3, &[0.2, 0.05, 0.0, 0.05, 0.1, 0.0, 0.0, 0.0, 1.5]);
        let d = DVector::from_row_slice(&[0.7, -0.4, 1.1]);
        let inverse = r.clone().try_inverse().unwrap();
        let covariance = (DMatrix::identity(2, 2) + g.transpose() * &inverse * &g)
            .try_inverse()
            .unwrap();
        let mean = &covariance * g.transpose() * &inverse * &d;
        let settings = SmootherSettings {
            members: 20_000,
            ..SmootherSettings::default()
        };
        let model = |z: &[f64]| (&g * DVector::from_row_slice(z)).iter().copied().collect();
        let x = smooth(2, d.as_slice(), &r, &settings, model).unwrap();
        let found = x.column_mean();
        let from = anomalies(&x);
        let spread = &from * from.transpose() / 19_999.0;
        // Sampling with 20,000 members: five standard errors of a mean of deviation below 0.7, and of a variance.
        assert!((found - mean).amax() < 5.0 * 0.7 / 20_000.0_f64.sqrt());
        assert!((spread - &covariance).amax() < 5.0 * covariance.amax() * 2.0_f64.sqrt() / 20_000.0_f64.sqrt());
    }

    #[test]
    fn the_same_seed_gives_the_same_bits() {
        let r = DMatrix::identity(1, 1);
        let run = |seed| {
            let settings = SmootherSettings {
                members: 50,
                steps: 3,
                seed,
            };
            smooth(2, &[0.5], &r, &settings, |z| vec![z[0] * z[1] + z[0]]).unwrap()
        };
        assert_eq!(run(3), run(3));
        assert_ne!(run(3), run(4));
    }

    #[test]
    fn what_cannot_be_is_an_error() {
        let settings = SmootherSettings {
            members: 10,
            ..SmootherSettings::default()
        };
        let none = smooth(1, &[0.0], &DMatrix::zeros(1, 1), &settings, |z| z.to_vec());
        assert_eq!(none.unwrap_err(), CalibrationError::NoCovariance);
        let wrong = smooth(1, &[0.0], &DMatrix::identity(1, 1), &settings, |_| vec![f64::NAN]);
        assert!(wrong.unwrap_err().to_string().contains("a prediction is NaN"));
    }
}
