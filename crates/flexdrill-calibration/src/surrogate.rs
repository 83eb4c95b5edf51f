//! A quadratic through results of the twin.
//!
//! The mean torque and weight of steady drilling change smoothly with coefficients, speed and weight. A full quadratic
//! in all inputs has every product of a coefficient and a load, which is what Coulomb friction and the bit's law are
//! made of. Its error is known: each point is predicted without itself.

use nalgebra::{DMatrix, DVector};

use crate::CalibrationError;

/// Least number of points over the number of coefficients: with fewer, the error of a point left out is itself a guess.
const LEAST: f64 = 1.3;
/// Singular values below this part of the largest count as zero.
const RANK: f64 = 1e-10;

/// y = c0 + sum c_i x_i + sum c_ij x_i x_j (i <= j), with the inputs scaled to -1 to 1 over the range of the points.
#[derive(Debug, Clone, PartialEq)]
pub struct Surrogate {
    /// Middle and half width of each input.
    scale: Vec<[f64; 2]>,
    coefficients: Vec<f64>,
    /// Root mean square of the errors with which each point is predicted without itself.
    pub error: f64,
    /// Range of the results.
    pub range: [f64; 2],
    /// Number of points.
    pub points: usize,
}

/// The number of coefficients of a full quadratic in `inputs` inputs.
pub fn coefficients(inputs: usize) -> usize {
    (inputs + 1) * (inputs + 2) / 2
}

/// The least number of points for a full quadratic in `inputs` inputs.
pub fn least_points(inputs: usize) -> usize {
    (LEAST * coefficients(inputs) as f64).ceil() as usize
}

impl Surrogate {
    /// The quadratic that fits the results best. `quantity` names it in errors.
    ///
    /// # Errors
    /// When there are too few points, or they do not differ in every input.
    pub fn new(quantity: &str, inputs: &[Vec<f64>], results: &[f64]) -> Result<Self, CalibrationError> {
        let dimensions = inputs.first().map_or(0, Vec::len);
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
        let scale: Vec<[f64; 2]> = (0..dimensions)
            .map(|k| {
                let [low, high] = range(inputs.iter().map(|point| point[k]));
                [0.5 * (low + high), 0.5 * (high - low)]
            })
            .collect();
        if scale.iter().any(|[_, half]| !half.is_finite() || *half <= 0.0) {
            return Err(poor());
        }
        let rows: Vec<f64> = inputs.iter().flat_map(|point| terms(&scale, point)).collect();
        let matrix = DMatrix::from_row_slice(inputs.len(), count, &rows);
        let y = DVector::from_row_slice(results);
        let svd = matrix.svd(true, true);
        let largest = svd.singular_values.max();
        if !largest.is_finite() || svd.singular_values.min() <= RANK * largest {
            return Err(poor());
        }
        let solution = svd.solve(&y, 0.0).map_err(|_| poor())?;
        // The prediction of a point without itself: its residual over 1 - h, with h on the diagonal of the projection.
        let u = svd.u.as_ref().ok_or_else(poor)?;
        let fitted = u * (u.transpose() * &y);
        let squares: f64 = (0..y.len())
            .map(|k| {
                let leverage = u.row(k).norm_squared();
                ((y[k] - fitted[k]) / (1.0 - leverage).max(RANK)).powi(2)
            })
            .sum();
        Ok(Self {
            scale,
            coefficients: solution.iter().copied().collect(),
            error: (squares / y.len() as f64).sqrt(),
            range: range(results.iter().copied()),
            points: y.len(),
        })
    }

    /// The prediction at a point. Outside of the points' range the inputs are held at its ends, because a quadratic that
    /// leaves its points soon turns back.
    pub fn predict(&self, inputs: &[f64]) -> f64 {
        let held: Vec<f64> = inputs
            .iter()
            .zip(&self.scale)
            .map(|(x, [middle, half])| x.clamp(middle - half, middle + half))
            .collect();
        terms(&self.scale, &held)
            .zip(&self.coefficients)
            .map(|(term, c)| term * c)
            .sum()
    }
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// 1, all inputs, all products of two, scaled.
fn terms(scale: &[[f64; 2]], inputs: &[f64]) -> impl Iterator<Item = f64> + use<> {
    let x: Vec<f64> = inputs
        .iter()
        .zip(scale)
        .map(|(x, [middle, half])| (x - middle) / half)
        .collect();
    let mut all = vec![1.0];
    all.extend(&x);
    for (i, a) in x.iter().enumerate() {
        all.extend(x[i..].iter().map(|b| a * b));
    }
    all.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::latin_hypercube;

    fn quadratic(x: &[f64]) -> f64 {
        3.0 + 2.0 * x[0] - x[1] + 0.5 * x[0] * x[1] + 4.0 * x[2] * x[2]
    }

    #[test]
    fn a_quadratic_is_found_again_with_no_error() {
        let points = latin_hypercube(least_points(3), 3, 2);
        let results: Vec<f64> = points.iter().map(|x| quadratic(x)).collect();
        let surrogate = Surrogate::new("torque", &points, &results).unwrap();
        // Rounding of a least-squares problem of this condition.
        assert!(surrogate.error < 1e-11, "{}", surrogate.error);
        let x = [0.3, 0.6, 0.5];
        assert!((surrogate.predict(&x) - quadratic(&x)).abs() < 1e-12);
    }

    /// The error that is stated is that of new points: a cubic is not a quadratic.
    #[test]
    fn the_error_of_points_left_out_is_that_of_new_points() {
        let cubic = |x: &[f64]| quadratic(x) + 2.0 * x[0].powi(3);
        let points = latin_hypercube(40, 3, 3);
        let results: Vec<f64> = points.iter().map(|x| cubic(x)).collect();
        let surrogate = Surrogate::new("torque", &points, &results).unwrap();
        let fresh = latin_hypercube(400, 3, 4);
        let squares: f64 = fresh.iter().map(|x| (surrogate.predict(x) - cubic(x)).powi(2)).sum();
        let seen = (squares / 400.0).sqrt();
        assert!(
            (0.5..2.0).contains(&(surrogate.error / seen)),
            "{} {seen}",
            surrogate.error
        );
    }

    #[test]
    fn points_that_do_not_suffice_are_refused() {
        let points = latin_hypercube(9, 3, 2);
        let error = Surrogate::new("torque", &points, &[0.0; 9]).unwrap_err();
        assert!(
            error.to_string().contains("9 points for 10 coefficients: at least 13"),
            "{error}"
        );
        let mut flat = latin_hypercube(13, 3, 2);
        flat.iter_mut().for_each(|point| point[1] = 0.5);
        assert!(matches!(
            Surrogate::new("torque", &flat, &[0.0; 13]),
            Err(CalibrationError::PoorPoints { .. })
        ));
    }
}
