//! A Gaussian process over a grid that says where the boundary between two classes runs, and how sure that is.
//!
//! The classes are -1 and +1. Covariance: Matern 5/2 with a length per axis (Rasmussen and Williams, Gaussian Processes for
//! Machine Learning, 2006, eq. 4.17), chosen from a few by the marginal likelihood (eq. 2.30).

use nalgebra::linalg::Cholesky;
use nalgebra::{DMatrix, DVector, Dyn};

/// Lengths that are tried, as shares of an axis.
const LENGTHS: [f64; 4] = [0.12, 0.25, 0.5, 1.0];
/// Variance of the classes around the surface. Members are few, and a cell near the boundary may show either class.
const NOISE: f64 = 0.05;
/// Points from which on lengths that were chosen before are kept: choosing costs sixteen factorisations.
const ENOUGH_FOR_LENGTHS: usize = 250;

/// Mean and standard deviation at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Mean, -1 to +1 or so.
    pub mean: f64,
    /// Standard deviation of the surface.
    pub deviation: f64,
}

impl Surface {
    /// Probability that the surface is on the side of its mean.
    pub fn confidence(&self) -> f64 {
        normal(self.mean.abs() / self.deviation)
    }

    /// How much a run here tells of the boundary: positive where the surface may cross zero within its 95 % band (Bryan et
    /// al., Active learning for identifying function threshold boundaries, NIPS 2005).
    pub fn straddle(&self) -> f64 {
        1.96 * self.deviation - self.mean.abs()
    }
}

/// Distribution function of the standard normal distribution.
fn normal(z: f64) -> f64 {
    0.5 * libm::erfc(-z / std::f64::consts::SQRT_2)
}

/// A process that has seen some points.
pub struct Process {
    lengths: [f64; 2],
    points: Vec<[f64; 2]>,
    factor: Cholesky<f64, Dyn>,
    /// Inverse covariance times the classes.
    weights: DVector<f64>,
}

impl Process {
    /// From classes at points of the unit square. `lengths` are those of the process before; nothing without points.
    pub fn new(points: &[[f64; 2]], classes: &[f64], lengths: Option<[f64; 2]>) -> Option<Self> {
        if let Some(lengths) = lengths
            && points.len() >= ENOUGH_FOR_LENGTHS
        {
            return Self::with(points, classes, lengths).map(|(process, _)| process);
        }
        let mut best: Option<(Self, f64)> = None;
        for x in LENGTHS {
            for y in LENGTHS {
                if let Some((process, likelihood)) = Self::with(points, classes, [x, y])
                    && best.as_ref().is_none_or(|(_, most)| likelihood > *most)
                {
                    best = Some((process, likelihood));
                }
            }
        }
        best.map(|(process, _)| process)
    }

    /// With its log marginal likelihood, up to a constant.
    fn with(points: &[[f64; 2]], classes: &[f64], lengths: [f64; 2]) -> Option<(Self, f64)> {
        let count = points.len();
        if count == 0 {
            return None;
        }
        let covariance = DMatrix::from_fn(count, count, |a, b| {
            matern(points[a], points[b], lengths) + if a == b { NOISE } else { 0.0 }
        });
        let factor = covariance.cholesky()?;
        let classes = DVector::from_column_slice(classes);
        let weights = factor.solve(&classes);
        let determinant: f64 = factor.l_dirty().diagonal().iter().map(|value| value.ln()).sum();
        let likelihood = -0.5 * classes.dot(&weights) - determinant;
        let process = Self {
            lengths,
            points: points.to_vec(),
            factor,
            weights,
        };
        Some((process, likelihood))
    }

    /// The lengths that were chosen.
    pub const fn lengths(&self) -> [f64; 2] {
        self.lengths
    }

    /// What it says at a place.
    pub fn at(&self, place: [f64; 2]) -> Surface {
        let seen = DVector::from_iterator(
            self.points.len(),
            self.points.iter().map(|point| matern(*point, place, self.lengths)),
        );
        let mean = seen.dot(&self.weights);
        let mut half = seen;
        // The lower triangle alone; the factor has a positive diagonal, so that this succeeds.
        self.factor.l_dirty().solve_lower_triangular_mut(&mut half);
        let variance = (1.0 - half.norm_squared()).max(1e-12);
        Surface {
            mean,
            deviation: variance.sqrt(),
        }
    }
}

fn matern(a: [f64; 2], b: [f64; 2], lengths: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|k| (a[k] - b[k]) / lengths[k]);
    let distance = 5f64.sqrt() * (x * x + y * y).sqrt();
    (1.0 + distance + distance * distance / 3.0) * libm::exp(-distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_sure_where_it_has_seen_and_not_where_it_has_not() {
        let points = [[0.0, 0.0], [0.0, 1.0], [0.25, 0.5]];
        let process = Process::new(&points, &[1.0, 1.0, 1.0], Some([0.25, 0.25])).unwrap();
        assert!(process.at([0.0, 0.0]).confidence() > 0.99);
        let far = process.at([1.0, 0.5]);
        assert!(far.straddle() > 0.0 && far.deviation > 0.3, "{far:?}");
    }

    #[test]
    fn the_mean_solves_the_normal_equations() {
        // With one point the mean is c k / (1 + noise), the variance 1 - k^2 / (1 + noise).
        let (process, _) = Process::with(&[[0.5, 0.5]], &[-1.0], [0.5, 0.5]).unwrap();
        let k = matern([0.5, 0.5], [0.7, 0.5], [0.5, 0.5]);
        let found = process.at([0.7, 0.5]);
        assert!((found.mean + k / (1.0 + NOISE)).abs() < 1e-14, "{found:?}");
        let variance = 1.0 - k * k / (1.0 + NOISE);
        assert!((found.deviation - variance.sqrt()).abs() < 1e-14, "{found:?}");
    }

    #[test]
    fn the_covariance_is_the_printed_one() {
        // r = l: (1 + sqrt 5 + 5/3) exp(-sqrt 5).
        let expected = (1.0 + 5f64.sqrt() + 5.0 / 3.0) * (-(5f64.sqrt())).exp();
        assert!((matern([0.0, 0.0], [0.3, 0.0], [0.3, 1.0]) - expected).abs() < 1e-15);
    }
}
