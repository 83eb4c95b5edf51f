//! How what was found explains what was measured: every observation, and every quantity by itself.
//!
//! A posterior predictive check (Gelman, Meng and Stern, Statistica Sinica 6, 1996): where the structure of the twin is right
//! and the errors are as stated, residuals r of a quantity with the covariance R of its errors have r' R^-1 r of about their
//! number. R has scatter, drift and the surrogate's error with their correlations, so that a course of the residuals over
//! speed or weight counts although each of them is within its band. The sum over all quantities would not show one that is
//! not explained among five that are.

use nalgebra::{DMatrix, DVector};

/// Mean square of standardised residuals up to which the twin explains them: twice the stated error. Errors are stated to a
/// factor of two at best.
pub const EXPLAINS: f64 = 4.0;
/// Standard normal quantile of 1 - 1e-4. Few residuals exceed twice their error by chance: of three, one set in a hundred.
/// With this bound it is one quantity of 10,000, and from eight windows on [`EXPLAINS`] is the larger one.
const RARE: f64 = 3.719;

/// How an observation is explained.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Explained {
    /// Prediction with all unknowns at the medians of their priors.
    pub prior: f64,
    /// Mean prediction of the posterior.
    pub predicted: f64,
    /// Half of the width of the 90 % band of a measurement of this window.
    pub band: f64,
    /// Measured less predicted over its standard deviation.
    pub standardised: f64,
}

/// How a quantity is explained.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuantityCheck {
    /// Number of the quantity.
    pub quantity: usize,
    /// Windows in which it was measured.
    pub windows: usize,
    /// Residuals over their stated errors (root mean square), with the correlation of the errors.
    pub times: f64,
    /// Bound of it.
    pub most: f64,
    /// Observation with the largest residual over its error.
    pub worst: usize,
}

impl QuantityCheck {
    /// Whether the twin explains the quantity within the stated errors.
    pub fn is_explained(&self) -> bool {
        self.times <= self.most
    }
}

/// Checks the quantities, from residuals and the covariance of all errors; `quantity_of` has the quantity per observation.
pub(crate) fn check(
    quantity_of: &[usize],
    residuals: &[f64],
    covariance: &DMatrix<f64>,
    explained: &[Explained],
) -> Vec<QuantityCheck> {
    let mut numbers = quantity_of.to_vec();
    numbers.sort_unstable();
    numbers.dedup();
    let of_one = |number: usize| {
        let own: Vec<usize> = (0..quantity_of.len()).filter(|k| quantity_of[*k] == number).collect();
        let errors = DMatrix::from_fn(own.len(), own.len(), |i, j| covariance[(own[i], own[j])]);
        let left = DVector::from_iterator(own.len(), own.iter().map(|k| residuals[*k]));
        // A part of a positive definite matrix is one.
        let whitened = errors.cholesky()?.l().solve_lower_triangular(&left)?;
        let size = |k: &usize| explained[*k].standardised.abs();
        let worst = own.iter().copied().max_by(|a, b| size(a).total_cmp(&size(b)))?;
        Some(QuantityCheck {
            quantity: number,
            windows: own.len(),
            times: (whitened.norm_squared() / own.len() as f64).sqrt(),
            most: most(own.len()),
            worst,
        })
    };
    numbers.into_iter().filter_map(of_one).collect()
}

/// Largest root mean square of so many residuals: the larger one of twice their errors and of what chance gives once in
/// 10,000 (the quantile of chi square by Wilson and Hilferty, Proc. Natl. Acad. Sci. 17, 1931).
fn most(residuals: usize) -> f64 {
    let part = 2.0 / (9.0 * residuals as f64);
    let by_chance = (1.0 - part + RARE * part.sqrt()).powi(3);
    by_chance.max(EXPLAINS).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_residuals_may_be_larger() {
        // Quantiles of chi square at 1 - 1e-4 (Abramowitz and Stegun, table 26.8): 18.42 of two, 21.11 of three degrees of
        // freedom. The approximation is a few per cent above.
        for (count, quantile) in [(2, 18.42), (3, 21.11)] {
            let found = most(count).powi(2) * count as f64;
            assert!((0.0..0.06).contains(&(found / quantile - 1.0)), "{count}: {found}");
        }
        assert_eq!(most(9), 2.0);
    }

    #[test]
    fn a_course_within_the_bands_is_found_where_errors_are_shared() {
        // Windows whose errors are one, but for a tenth: a difference between them is no error.
        let covariance = DMatrix::from_fn(10, 10, |i, j| if i == j { 1.01 } else { 1.0 });
        let explained = [Explained {
            prior: 0.0,
            predicted: 0.0,
            band: 1.0,
            standardised: 0.0,
        }; 10];
        let course: Vec<f64> = (0..10).map(|k| if k < 5 { 0.6 } else { -0.6 }).collect();
        let alike = vec![1.2; 10];
        let of = |residuals: &[f64]| check(&[0; 10], residuals, &covariance, &explained)[0].times;
        // Closed forms: 0.6 / 0.1 for a course without a mean; 1.2 / sqrt(10.01) for the mean.
        assert!((of(&course) - 6.0).abs() < 1e-9 && (of(&alike) - 1.2 / 10.01_f64.sqrt()).abs() < 1e-9);
    }
}
