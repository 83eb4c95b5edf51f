//! Renewal of an ensemble: members of little weight give way to others near those of much weight.
//!
//! Systematic resampling chooses parents; children are shrunk towards the mean and scattered again after Liu and West
//! (Sequential Monte Carlo Methods in Practice, Springer 2001, chapter 10),
//!
//! ```text
//! x' = a x + (1 - a) mean + h L xi,   L L' = V,   a = sqrt(1 - h^2),
//! ```
//!
//! which keeps mean and covariance `V` of the weighted members. Parameters are given as standard normal coordinates, those of
//! their prior's quantiles, so that no child leaves the bounds of a key.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF as _, Normal};

/// A member of the renewed ensemble.
#[derive(Debug, Clone, PartialEq)]
pub struct Renewal {
    /// The member that it is near.
    pub parent: usize,
    /// Its parameters, as standard normal coordinates.
    pub at: Vec<f64>,
}

/// A renewed ensemble of the same size. `members` are parameters by member, `weights` their shares, and `scatter` the `h` of
/// Liu and West, 0.1 to 0.3. A member whose weight is nil has no child.
pub fn renewal(members: &[Vec<f64>], weights: &[f64], scatter: f64, seed: u64) -> Vec<Renewal> {
    let count = members.len().min(weights.len());
    let Some(size) = members.first().map(Vec::len) else {
        return Vec::new();
    };
    let mut random = fastrand::Rng::with_seed(seed);
    let (mean, root) = spread(members, weights, size);
    let (shrink, normal) = ((1.0 - scatter * scatter).sqrt(), Normal::standard());
    let parents = parents(&weights[..count], random.f64());
    parents
        .into_iter()
        .map(|parent| {
            let own = DVector::from_column_slice(&members[parent]);
            // Never 0, whose quantile is infinite.
            let draw = DVector::from_fn(size, |_, _| normal.inverse_cdf(random.f64().clamp(1e-12, 1.0 - 1e-12)));
            let at = own * shrink + &mean * (1.0 - shrink) + &root * draw * scatter;
            Renewal {
                parent,
                at: at.as_slice().to_vec(),
            }
        })
        .collect()
}

/// Systematic resampling: as many parents as weights, each as often as its share asks for, to within one.
fn parents(weights: &[f64], offset: f64) -> Vec<usize> {
    let count = weights.len();
    let sum: f64 = weights.iter().sum();
    let (mut chosen, mut cumulated, mut at) = (Vec::with_capacity(count), 0.0, 0);
    for k in 0..count {
        let wanted = (k as f64 + offset) / count as f64 * sum;
        while at + 1 < count && cumulated + weights[at] <= wanted {
            cumulated += weights[at];
            at += 1;
        }
        chosen.push(at);
    }
    chosen
}

/// Mean of weighted members, and a root of their covariance.
fn spread(members: &[Vec<f64>], weights: &[f64], size: usize) -> (DVector<f64>, DMatrix<f64>) {
    let sum: f64 = weights.iter().sum();
    let weighted = || members.iter().zip(weights.iter().map(|weight| weight / sum));
    let mut mean = DVector::zeros(size);
    for (member, weight) in weighted() {
        mean += DVector::from_column_slice(member) * weight;
    }
    let mut covariance = DMatrix::zeros(size, size);
    for (member, weight) in weighted() {
        let from = DVector::from_column_slice(member) - &mean;
        covariance += &from * from.transpose() * weight;
    }
    // Fewer members than parameters leave directions without variance, which Cholesky's root does not have.
    let eigen = covariance.symmetric_eigen();
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    (mean, eigen.eigenvectors * DMatrix::from_diagonal(&roots))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Evidence, Measurement, effective_number, weights};

    #[test]
    fn parents_are_as_frequent_as_their_weights() {
        for offset in [0.0, 0.3, 0.999] {
            let chosen = parents(&[0.5, 0.0, 0.25, 0.25], offset);
            let of = |index| chosen.iter().filter(|parent| **parent == index).count();
            assert_eq!([of(0), of(1), of(2), of(3)], [2, 0, 1, 1], "{offset}");
        }
    }

    fn normals(random: &mut fastrand::Rng, count: usize) -> Vec<f64> {
        let normal = Normal::standard();
        (0..count)
            .map(|_| normal.inverse_cdf(random.f64().clamp(1e-12, 1.0 - 1e-12)))
            .collect()
    }

    /// Mean and variance of weighted values.
    fn moments(values: &[f64], weights: &[f64]) -> [f64; 2] {
        let mean = values.iter().zip(weights).map(|(x, w)| w * x).sum::<f64>();
        let square = values.iter().zip(weights).map(|(x, w)| w * (x - mean).powi(2));
        [mean, square.sum()]
    }

    /// A tool with one parameter x, standard normal, whose figure is 3 x: the measured figure is y, with a noise of 2 per
    /// window and a discrepancy of 1.5. Bayes's rule has the closed form: precision 1 + 9 / (1.5^2 + 2^2 / K), mean
    /// (3 y / (...)) over it. The ensemble is renewed after each window, and must come to the same.
    #[test]
    fn a_renewed_ensemble_has_the_posterior_of_bayes() {
        let (slope, noise, discrepancy, truth, windows) = (3.0, 2.0, 1.5, 1.2, 12);
        let mut random = fastrand::Rng::with_seed(11);
        let count = 6000;
        let mut members: Vec<Vec<f64>> = normals(&mut random, count).into_iter().map(|x| vec![x]).collect();
        let mut evidence = vec![Evidence::new(&[discrepancy]); count];
        let errors = normals(&mut random, windows);
        let measured: Vec<f64> = errors.iter().map(|e| slope * truth + 0.7 + noise * e).collect();
        let mut renewals = 0;
        for (window, y) in measured.iter().enumerate() {
            for (member, evidence) in members.iter().zip(&mut evidence) {
                evidence.add(
                    0,
                    &Measurement {
                        residual: y - slope * member[0],
                        noise,
                        independent: 1.0,
                    },
                );
            }
            let logs: Vec<f64> = evidence.iter().map(Evidence::log_weight).collect();
            let shares = weights(&logs);
            if effective_number(&shares) < 0.5 * count as f64 {
                renewals += 1;
                let renewed = renewal(&members, &shares, 0.1, window as u64);
                evidence = renewed.iter().map(|child| evidence[child.parent].renewed()).collect();
                members = renewed.into_iter().map(|child| child.at).collect();
            }
        }
        let logs: Vec<f64> = evidence.iter().map(Evidence::log_weight).collect();
        let xs: Vec<f64> = members.iter().map(|member| member[0]).collect();
        let [mean, variance] = moments(&xs, &weights(&logs));
        let mean_y = measured.iter().sum::<f64>() / windows as f64;
        let known = slope * slope / (discrepancy * discrepancy + noise * noise / windows as f64);
        let exact = [known * mean_y / slope / (1.0 + known), 1.0 / (1.0 + known)];
        assert!(renewals > 0, "nothing was renewed");
        // Six thousand members know a mean to a hundredth of its deviation; the scatter moves a member's figure against the
        // evidence that it inherits by a tenth of a deviation, which widens the variance by about so much.
        assert!((mean - exact[0]).abs() < 0.1 * exact[1].sqrt(), "{mean}, {exact:?}");
        assert!((variance / exact[1] - 1.0).abs() < 0.15, "{variance}, {exact:?}");
    }

    #[test]
    fn renewal_keeps_mean_and_covariance_and_repeats_by_its_seed() {
        let mut random = fastrand::Rng::with_seed(2);
        let [x, y] = [0, 1].map(|_| normals(&mut random, 20_000));
        let members: Vec<Vec<f64>> = x.iter().zip(&y).map(|(x, y)| vec![*x, 0.8 * x + 0.6 * y]).collect();
        let shares = weights(&x.iter().map(|x| 0.4 * x).collect::<Vec<f64>>());
        let renewed = renewal(&members, &shares, 0.3, 9);
        assert_eq!(renewed, renewal(&members, &shares, 0.3, 9));
        assert_ne!(renewed, renewal(&members, &shares, 0.3, 10));
        let equal = vec![1.0 / renewed.len() as f64; renewed.len()];
        for direction in [[1.0, 0.0], [0.0, 1.0], [0.7, -0.7]] {
            let along = |at: &[f64]| direction[0] * at[0] + direction[1] * at[1];
            let before: Vec<f64> = members.iter().map(|at| along(at)).collect();
            let after: Vec<f64> = renewed.iter().map(|child| along(&child.at)).collect();
            let ([m0, v0], [m1, v1]) = (moments(&before, &shares), moments(&after, &equal));
            assert!(
                (m0 - m1).abs() < 0.03 && (v1 / v0 - 1.0).abs() < 0.05,
                "{m0} {m1} {v0} {v1}"
            );
        }
    }

    #[test]
    fn one_member_or_none_renews_without_a_root() {
        assert!(renewal(&[], &[], 0.2, 1).is_empty());
        let alone = renewal(&[vec![0.5, 1.0]], &[1.0], 0.2, 1);
        assert!((alone[0].at[0] - 0.5).abs() < 1e-12 && (alone[0].at[1] - 1.0).abs() < 1e-12);
    }
}
