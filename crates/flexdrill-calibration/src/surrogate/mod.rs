//! A Gaussian process through results of the twin.
//!
//! The mean torque and weight of steady drilling follow coefficients, speed and weight nearly along straight lines,
//! with a kink where the bit begins to cut: below the force of its wear flats it rubs only. The process has a linear
//! mean for the lines and a Matern 3/2 covariance, whose functions bend as sharply as that, with a length per input
//! (Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, section 2.7 and eq. 4.17). Lengths and the
//! share of noise are those of the largest restricted likelihood. Its error is known: each point is predicted without
//! itself.

use nalgebra::linalg::Cholesky;
use nalgebra::{DMatrix, DVector, Dyn};

use crate::CalibrationError;

/// Least number of points over the number of coefficients of the mean: with fewer, most of what is seen goes into the
/// mean, and nothing is left that shows the error.
const LEAST: usize = 2;
/// Points per input of a design. Loeppky, Sacks and Welch (Technometrics 51, 2009) recommend ten; with eight the error
/// of points left out is 2 % of the range of a rig's torque, below the noise of its sensor.
const PER_INPUT: usize = 8;
/// Eigenvalues of the mean's normal equations below this part of the largest count as zero.
const RANK: f64 = 1e-10;
/// Bounds of the logarithm of a length, in half ranges of the points: shorter ones than the distance of neighbours and
/// longer ones than a line have cannot be distinguished from their bounds.
const LENGTH: [f64; 2] = [-1.5, 4.0];
/// Expected logarithm of a length and its standard deviation, which decide where the likelihood is flat: a curve bends
/// once in the range of the points, give or take a factor of 4.5.
const USUAL_LENGTH: [f64; 2] = [0.7, 1.5];
/// Bounds of the logarithm of the share of noise: rounding of the factor, and all of the variance.
const NOISE: [f64; 2] = [-16.0, 0.0];
/// Logarithms of the lengths from which the search begins, and of the share of noise.
const STARTS: [f64; 2] = [0.0, 1.4];
const FIRST_NOISE: f64 = -9.0;
/// First and last step of the search.
const STEPS: [f64; 2] = [1.0, 0.1];
/// Standard deviation of results, over their largest size, that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// y = c0 + sum c_i x_i + f(x) + noise, with the inputs scaled to -1 to 1 over the range of the points, and f a
/// process.
#[derive(Debug, Clone, PartialEq)]
pub struct Surrogate {
    /// Middle and half width of each input.
    scale: Vec<[f64; 2]>,
    /// The points, scaled.
    seen: Vec<Vec<f64>>,
    fitted: Fitted,
    /// Root mean square of the errors with which each point is predicted without itself.
    pub error: f64,
    /// Each of these errors over the standard deviation that was stated for it, in the order of the points. Their root
    /// mean square is 1 where the process states its errors rightly.
    pub left_out: Vec<f64>,
    /// Range of the results.
    pub range: [f64; 2],
    /// Number of points.
    pub points: usize,
}

/// A process with given lengths and noise, fitted to points.
#[derive(Debug, Clone, PartialEq)]
struct Fitted {
    /// Inverses of the lengths.
    inverse: Vec<f64>,
    /// Variance of the noise over that of the process.
    noise: f64,
    /// Variance of the process.
    variance: f64,
    /// Coefficients of the mean.
    mean: DVector<f64>,
    /// Inverse covariance times what the mean leaves.
    weights: DVector<f64>,
    /// Lower factor of the covariance of the points, over the variance.
    factor: DMatrix<f64>,
    /// That factor's inverse times the terms of the mean.
    half: DMatrix<f64>,
    /// Lower factor of the matrix of the mean's normal equations.
    mean_factor: DMatrix<f64>,
}

/// The number of coefficients of the mean in `inputs` inputs.
pub fn coefficients(inputs: usize) -> usize {
    inputs + 1
}

/// The least number of points for a process in `inputs` inputs.
pub fn least_points(inputs: usize) -> usize {
    LEAST * coefficients(inputs)
}

/// The number of points of a design for a process in `inputs` inputs.
pub fn usual_points(inputs: usize) -> usize {
    PER_INPUT * inputs
}

impl Surrogate {
    /// The process that fits the results best. `quantity` names it in errors.
    ///
    /// # Errors
    /// When there are too few points, or they do not differ in every input.
    pub fn new(quantity: &str, inputs: &[Vec<f64>], results: &[f64]) -> Result<Self, CalibrationError> {
        let dimensions = inputs.first().map_or(0, Vec::len);
        // Twice as many points as coefficients of the mean at least; with
        // fewer the error of points left out would mean nothing.
        let (count, least) = (coefficients(dimensions), least_points(dimensions));
        if inputs.len() < least || inputs.len() != results.len() {
            return Err(CalibrationError::FewPoints {
                quantity: quantity.to_owned(),
                points: inputs.len().min(results.len()),
                coefficients: count,
                least,
            });
        }
        let poor = || CalibrationError::PoorPoints {
            quantity: quantity.to_owned(),
        };
        // The inputs are scaled to -1 to 1 over the points, so that lengths of all inputs have the same bounds.
        let scale: Vec<[f64; 2]> = (0..dimensions)
            .map(|k| {
                let [low, high] = range(inputs.iter().map(|point| point[k]));
                [0.5 * (low + high), 0.5 * (high - low)]
            })
            .collect();
        // An input that does not vary has no length that could be found.
        if scale.iter().any(|[_, half]| !half.is_finite() || *half <= 0.0) {
            return Err(poor());
        }
        let seen: Vec<Vec<f64>> = inputs.iter().map(|point| scaled(&scale, point)).collect();
        // The mean is linear: a constant and a term for each input.
        let terms = DMatrix::from_fn(
            seen.len(),
            count,
            |k, term| if term == 0 { 1.0 } else { seen[k][term - 1] },
        );
        // Points along a line vary in every input, but do not determine the terms; only the rank shows that.
        let eigenvalues = (terms.transpose() * &terms).symmetric_eigenvalues();
        if eigenvalues.min() <= RANK * eigenvalues.max() {
            return Err(poor());
        }
        let y = DVector::from_row_slice(results);
        let search = Search { seen: &seen, terms, y };
        let fitted = search.best().ok_or_else(poor)?;
        // The error comes from points left out, because at its own points the process has none.
        let (errors, stated) = search.left_out(&fitted);
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        Ok(Self {
            scale,
            fitted,
            error: (squares / errors.len() as f64).sqrt(),
            left_out: errors
                .iter()
                .zip(&stated)
                .map(|(error, stated)| error / stated)
                .collect(),
            range: range(results.iter().copied()),
            points: seen.len(),
            seen,
        })
    }

    /// The prediction at a point. Outside of the points' range it returns to the line of the mean.
    pub fn predict(&self, inputs: &[f64]) -> f64 {
        let x = scaled(&self.scale, inputs);
        let mean = self.fitted.mean[0]
            + x.iter()
                .zip(self.fitted.mean.iter().skip(1))
                .map(|(x, c)| x * c)
                .sum::<f64>();
        let points = self.seen.iter().zip(self.fitted.weights.iter());
        mean + points
            .map(|(point, weight)| weight * correlation(point, &x, &self.fitted.inverse))
            .sum::<f64>()
    }

    /// The covariance of the errors of the predictions at some points. Its variances are at least what the points that
    /// were left out show: the square of [`Self::error`].
    pub fn error_covariance(&self, inputs: &[Vec<f64>]) -> DMatrix<f64> {
        let fitted = &self.fitted;
        let at: Vec<Vec<f64>> = inputs.iter().map(|point| scaled(&self.scale, point)).collect();
        let mut known = DMatrix::from_fn(self.points, at.len(), |k, j| {
            correlation(&self.seen[k], &at[j], &fitted.inverse)
        });
        // The factor's diagonal is positive, so that neither of the two solutions fails.
        fitted.factor.solve_lower_triangular_mut(&mut known);
        let terms = DMatrix::from_fn(coefficients(self.scale.len()), at.len(), |term, j| {
            if term == 0 { 1.0 } else { at[j][term - 1] }
        });
        let mut of_mean = terms - fitted.half.transpose() * &known;
        fitted.mean_factor.solve_lower_triangular_mut(&mut of_mean);
        let mut all = DMatrix::from_fn(at.len(), at.len(), |i, j| {
            correlation(&at[i], &at[j], &fitted.inverse) + if i == j { fitted.noise } else { 0.0 }
        });
        all += of_mean.transpose() * &of_mean - known.transpose() * &known;
        // What the points that were left out show of the stated errors, where these are too small.
        all *= fitted.variance * self.over_stated().max(1.0).powi(2);
        let least = self.error * self.error;
        let raised: Vec<f64> = all
            .diagonal()
            .iter()
            .map(|variance| (least / variance.max(f64::MIN_POSITIVE)).max(1.0).sqrt())
            .collect();
        DMatrix::from_fn(at.len(), at.len(), |i, j| raised[i] * raised[j] * all[(i, j)])
    }

    /// The errors of the points that were left out over those that the process states (root mean square).
    pub fn over_stated(&self) -> f64 {
        (self.left_out.iter().map(|error| error * error).sum::<f64>() / self.points as f64).sqrt()
    }

    /// The standard deviation of the error of the prediction at a point, at least [`Self::error`].
    pub fn deviation(&self, inputs: &[f64]) -> f64 {
        self.error_covariance(&[inputs.to_vec()])[(0, 0)].sqrt()
    }
}

/// The points from which lengths and noise are found.
struct Search<'a> {
    seen: &'a [Vec<f64>],
    /// Terms of the mean, a row per point.
    terms: DMatrix<f64>,
    y: DVector<f64>,
}

impl Search<'_> {
    /// The process of the largest restricted likelihood: a search along the logarithms of the lengths and of the noise,
    /// one after the other, with steps that become shorter.
    fn best(&self) -> Option<Fitted> {
        let dimensions = self.terms.ncols() - 1;
        let mut best: Option<(f64, Fitted)> = None;
        for start in STARTS {
            let mut at = vec![start; dimensions];
            at.push(FIRST_NOISE);
            let Some(mut here) = self.fit(&at) else { continue };
            let mut step = STEPS[0];
            while step >= STEPS[1] {
                let mut better = false;
                for k in 0..at.len() {
                    let [low, high] = if k < dimensions { LENGTH } else { NOISE };
                    for change in [step, -step] {
                        let mut next = at.clone();
                        next[k] = (next[k] + change).clamp(low, high);
                        if next[k] != at[k]
                            && let Some(there) = self.fit(&next)
                            && there.0 < here.0
                        {
                            (at, here, better) = (next, there, true);
                            break;
                        }
                    }
                }
                if !better {
                    step *= 0.5;
                }
            }
            if best.as_ref().is_none_or(|best| here.0 < best.0) {
                best = Some(here);
            }
        }
        best.map(|(_, fitted)| fitted)
    }

    /// The process with these logarithms of lengths and noise, with the negative logarithm of its restricted likelihood
    /// (Rasmussen and Williams, eq. 2.45, with the variance at its best value) and of the density of the lengths.
    fn fit(&self, logarithms: &[f64]) -> Option<(f64, Fitted)> {
        let (noise, lengths) = logarithms.split_last()?;
        // The search is in logarithms, which keeps lengths and noise positive.
        let inverse: Vec<f64> = lengths.iter().map(|length| libm::exp(-length)).collect();
        let noise = libm::exp(*noise);
        let count = self.seen.len();
        // In units of the process's variance, which has a closed form below and needs no search.
        let mut covariance = DMatrix::from_diagonal_element(count, count, 1.0 + noise);
        for i in 0..count {
            for j in 0..i {
                // The factorisation reads the lower triangle alone.
                covariance[(i, j)] = correlation(&self.seen[i], &self.seen[j], &inverse);
            }
        }
        // With the Cholesky factor the correlated residuals become independent ones of equal variance.
        let factor = Cholesky::<f64, Dyn>::new(covariance)?.l();
        let half = factor.solve_lower_triangular(&self.terms)?;
        let half_y = factor.solve_lower_triangular(&self.y)?;
        // Generalised least squares for the coefficients of the mean.
        let mean_factor = (half.transpose() * &half).cholesky()?;
        let mean = mean_factor.solve(&(half.transpose() * &half_y));
        let left = half_y - &half * &mean;
        // Restricted likelihood: the fitted coefficients of the mean reduce the
        // degrees of freedom, or the variance would be too small.
        let freedom = (count - self.terms.ncols()) as f64;
        // Results along a line leave nothing but rounding; without a floor the logarithm below would be infinite.
        let variance = (left.norm_squared() / freedom).max((ROUNDING * self.y.amax()).powi(2));
        let mean_factor = mean_factor.l();
        let determinant = |factor: &DMatrix<f64>| factor.diagonal().iter().map(|value| libm::log(*value)).sum::<f64>();
        // The likelihood is flat where few points show a length; the density decides there.
        let unusual = lengths.iter().map(|length| {
            let [usual, deviation] = USUAL_LENGTH;
            0.5 * ((length - usual) / deviation).powi(2)
        });
        let value = 0.5 * freedom * libm::log(variance.max(f64::MIN_POSITIVE))
            + determinant(&factor)
            + determinant(&mean_factor)
            + unusual.sum::<f64>();
        // A prediction then costs one product with these weights.
        let weights = factor.transpose().solve_upper_triangular(&left)?;
        let fitted = Fitted {
            inverse,
            noise,
            variance,
            mean,
            weights,
            factor,
            half,
            mean_factor,
        };
        value.is_finite().then_some((value, fitted))
    }

    /// The error of each point that is predicted from the others, and the standard deviation stated for it, with the
    /// same lengths (Dubrule, Math. Geol. 15, 1983): from the inverse covariance less what the mean takes of it.
    fn left_out(&self, fitted: &Fitted) -> (Vec<f64>, Vec<f64>) {
        let count = self.seen.len();
        let mut inverse = DMatrix::identity(count, count);
        fitted.factor.solve_lower_triangular_mut(&mut inverse);
        let mut of_mean = fitted.half.transpose() * &inverse;
        fitted.mean_factor.solve_lower_triangular_mut(&mut of_mean);
        (0..count)
            .map(|k| {
                let own = (inverse.column(k).norm_squared() - of_mean.column(k).norm_squared()).max(f64::MIN_POSITIVE);
                (
                    fitted.weights[k] / own,
                    (fitted.variance / own).sqrt().max(f64::MIN_POSITIVE),
                )
            })
            .unzip()
    }
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

fn scaled(scale: &[[f64; 2]], inputs: &[f64]) -> Vec<f64> {
    inputs
        .iter()
        .zip(scale)
        .map(|(x, [middle, half])| (x - middle) / half)
        .collect()
}

/// Matern 3/2.
fn correlation(a: &[f64], b: &[f64], inverse: &[f64]) -> f64 {
    let square: f64 = a
        .iter()
        .zip(b)
        .zip(inverse)
        .map(|((a, b), inverse)| ((a - b) * inverse).powi(2))
        .sum();
    let distance = (3.0 * square).sqrt();
    (1.0 + distance) * libm::exp(-distance)
}

#[cfg(test)]
mod tests;
