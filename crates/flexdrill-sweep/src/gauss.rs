//! A Gaussian process over a grid that says which class a run would show, and how sure that is.
//!
//! Every class has a separate process against the others: +1 where a run showed the class, -1 where it showed another one
//! (least-squares classification: Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, section 6.5). All
//! have the same covariance and so share one factorisation: Matern 5/2 with a length per axis (eq. 4.17). Lengths and scatter
//! are chosen from a few by the marginal likelihood (eq. 2.30) of all classes together.

use nalgebra::linalg::Cholesky;
use nalgebra::{DMatrix, DVector, Dyn};

/// Classes that the process distinguishes.
pub const CLASSES: usize = 3;
/// Lengths that are tried, as shares of an axis.
const LENGTHS: [f64; 4] = [0.2, 0.5, 1.0, 2.0];
/// Variances of the classes around the surface that are tried. Members are few, so that a cell near the boundary may show
/// either class; where single runs contradict all those around them, the larger ones are more likely, and nothing is sure.
const SCATTERS: [f64; 3] = [0.01, 0.1, 0.8];
/// What is chosen by the likelihood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Length of the covariance along each axis, as shares of the axis.
    pub lengths: [f64; 2],
    /// Variance of the classes of single runs around the surface.
    pub scatter: f64,
}

/// What the processes say at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Mean of each class, -1 to +1 or so.
    pub means: [f64; CLASSES],
    /// Standard deviation of every class's surface.
    pub deviation: f64,
    /// Variance of a single run around the surface.
    pub scatter: f64,
}

impl Surface {
    /// What is said where nothing was seen.
    pub const NOTHING: Self = Self {
        means: [0.0; CLASSES],
        deviation: 1.0,
        scatter: SCATTERS[0],
    };

    /// Probability that a run here shows a class and none of the others: that surface plus scatter is above zero.
    pub fn probability(&self, class: usize) -> f64 {
        normal(self.means[class] / (self.deviation * self.deviation + self.scatter).sqrt())
    }

    /// How much a run here shows of the boundary of a class: positive where the surface may cross zero within its 95 % band
    /// (Bryan et al., Active learning for identifying function threshold boundaries, NIPS 2005).
    pub fn straddle(&self, class: usize) -> f64 {
        1.96 * self.deviation - self.means[class].abs()
    }
}

/// Distribution function of the standard normal distribution.
fn normal(z: f64) -> f64 {
    0.5 * libm::erfc(-z / std::f64::consts::SQRT_2)
}

/// Processes that have seen some points.
pub struct Process {
    shape: Shape,
    points: Vec<[f64; 2]>,
    factor: Cholesky<f64, Dyn>,
    /// Inverse covariance times +1 and -1, by class.
    weights: [DVector<f64>; CLASSES],
}

impl Process {
    /// From the numbers of the classes at points of the unit square, with the shape that is most likely. Nothing without
    /// points.
    pub fn new(points: &[[f64; 2]], classes: &[usize]) -> Option<Self> {
        let mut best: Option<(Self, f64)> = None;
        for x in LENGTHS {
            for y in LENGTHS {
                let covariance = covariance(points, [x, y]);
                for scatter in SCATTERS {
                    let shape = Shape {
                        lengths: [x, y],
                        scatter,
                    };
                    if let Some((process, likelihood)) = Self::of(points, classes, shape, covariance.clone())
                        && best.as_ref().is_none_or(|(_, most)| likelihood > *most)
                    {
                        best = Some((process, likelihood));
                    }
                }
            }
        }
        best.map(|(process, _)| process)
    }

    /// With a shape that was chosen before.
    pub fn with(points: &[[f64; 2]], classes: &[usize], shape: Shape) -> Option<Self> {
        Self::of(points, classes, shape, covariance(points, shape.lengths)).map(|(process, _)| process)
    }

    /// With its log marginal likelihood over the classes that occur, up to a constant.
    fn of(points: &[[f64; 2]], classes: &[usize], shape: Shape, mut covariance: DMatrix<f64>) -> Option<(Self, f64)> {
        let count = points.len();
        if count == 0 {
            return None;
        }
        for at in 0..count {
            covariance[(at, at)] += shape.scatter;
        }
        let factor = covariance.cholesky()?;
        let determinant: f64 = factor.l_dirty().diagonal().iter().map(|value| value.ln()).sum();
        let mut likelihood = 0.0;
        let weights = std::array::from_fn(|class| {
            let seen = classes.iter().map(|of| if *of == class { 1.0 } else { -1.0 });
            let seen = DVector::from_iterator(count, seen);
            let weights = factor.solve(&seen);
            if classes.contains(&class) {
                likelihood += -0.5 * seen.dot(&weights) - determinant;
            }
            weights
        });
        let process = Self {
            shape,
            points: points.to_vec(),
            factor,
            weights,
        };
        Some((process, likelihood))
    }

    /// The shape that was chosen.
    pub const fn shape(&self) -> Shape {
        self.shape
    }

    /// What it says at a place.
    pub fn at(&self, place: [f64; 2]) -> Surface {
        let seen = DVector::from_iterator(
            self.points.len(),
            self.points
                .iter()
                .map(|point| matern(*point, place, self.shape.lengths)),
        );
        let means = self.weights.each_ref().map(|weights| seen.dot(weights));
        let mut half = seen;
        // The lower triangle alone; the factor has a positive diagonal, so that this succeeds.
        self.factor.l_dirty().solve_lower_triangular_mut(&mut half);
        let variance = (1.0 - half.norm_squared()).max(1e-12);
        Surface {
            means,
            deviation: variance.sqrt(),
            scatter: self.shape.scatter,
        }
    }
}

/// Covariance of the surface at points; the factorisation reads the lower triangle alone.
fn covariance(points: &[[f64; 2]], lengths: [f64; 2]) -> DMatrix<f64> {
    let of = |a: usize, b: usize| {
        if a < b {
            0.0
        } else {
            matern(points[a], points[b], lengths)
        }
    };
    DMatrix::from_fn(points.len(), points.len(), of)
}

fn matern(a: [f64; 2], b: [f64; 2], lengths: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|k| (a[k] - b[k]) / lengths[k]);
    let distance = 5f64.sqrt() * (x * x + y * y).sqrt();
    (1.0 + distance + distance * distance / 3.0) * libm::exp(-distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPE: Shape = Shape {
        lengths: [0.25, 0.25],
        scatter: SCATTERS[0],
    };

    #[test]
    fn it_is_sure_where_it_has_seen_and_not_where_it_has_not() {
        let points = [[0.0, 0.0], [0.0, 1.0], [0.25, 0.5]];
        let process = Process::with(&points, &[1, 1, 1], SHAPE).unwrap();
        let seen = process.at([0.0, 0.0]);
        assert!(seen.probability(1) > 0.99 && seen.probability(0) < 0.01, "{seen:?}");
        let far = process.at([1.0, 0.5]);
        assert!(far.straddle(1) > 0.0 && far.deviation > 0.3, "{far:?}");
        // No knowledge is no class.
        assert_eq!(
            [0, 1, 2].map(|class| Surface::NOTHING.probability(class)),
            [0.5; CLASSES]
        );
    }

    #[test]
    fn the_mean_solves_the_normal_equations() {
        // With one point the mean is c k / (1 + scatter), the variance 1 - k^2 / (1 + scatter).
        let shape = Shape {
            lengths: [0.5, 0.5],
            ..SHAPE
        };
        let process = Process::with(&[[0.5, 0.5]], &[1], shape).unwrap();
        let k = matern([0.5, 0.5], [0.7, 0.5], [0.5, 0.5]);
        let found = process.at([0.7, 0.5]);
        for (mean, sign) in found.means.into_iter().zip([-1.0, 1.0, -1.0]) {
            assert!((mean - sign * k / (1.0 + SHAPE.scatter)).abs() < 1e-14, "{found:?}");
        }
        let variance = 1.0 - k * k / (1.0 + SHAPE.scatter);
        assert!((found.deviation - variance.sqrt()).abs() < 1e-14, "{found:?}");
        // A standard normal variable is below 1.6449 with 95 %.
        let at = Surface {
            means: [1.644_853_6 * (0.16f64 + 0.2).sqrt(); CLASSES],
            deviation: 0.4,
            scatter: 0.2,
        };
        assert!((at.probability(2) - 0.95).abs() < 1e-8, "{at:?}");
    }

    #[test]
    fn runs_that_contradict_their_neighbours_leave_nothing_sure() {
        let points: Vec<[f64; 2]> = (0..49)
            .map(|at| [f64::from(at % 7) / 6.0, f64::from(at / 7) / 6.0])
            .collect();
        // Classes without any order: digits of the square root of 2.
        let digits = "1414213562373095048801688724209698078569671875376";
        let mixed: Vec<usize> = digits.bytes().map(|digit| usize::from(digit % 2)).collect();
        let process = Process::new(&points, &mixed).unwrap();
        let halves: Vec<usize> = points.iter().map(|[x, _]| usize::from(*x > 0.45)).collect();
        let sure = Process::new(&points, &halves).unwrap();
        let place = [0.75, 0.75];
        assert!(sure.at(place).probability(1) > 0.95, "{:?}", sure.at(place));
        let [no, yes] = [0, 1].map(|class| process.at(place).probability(class));
        assert!(no < 0.95 && yes < 0.95, "{no} {yes} {:?}", process.shape());
    }

    #[test]
    fn the_covariance_is_the_printed_one() {
        // r = l: (1 + sqrt 5 + 5/3) exp(-sqrt 5).
        let expected = (1.0 + 5f64.sqrt() + 5.0 / 3.0) * (-(5f64.sqrt())).exp();
        assert!((matern([0.0, 0.0], [0.3, 0.0], [0.3, 1.0]) - expected).abs() < 1e-15);
    }
}
