//! What the data determine.

use nalgebra::{DMatrix, DVector};

use crate::BAND;
use crate::unknown::{Shape, Unknown};

/// Half width of a 90 % band up to which an unknown counts as identified.
const PRECISE: f64 = 0.05;
/// Posterior over prior variance above which the data do not determine an unknown.
pub const NOT_IDENTIFIABLE: f64 = 0.8;
/// Posterior over prior variance below which an unknown is determined by itself, whatever it is correlated with: its band
/// is a third of the prior's.
const ALONE: f64 = 0.1;
/// A pair shows one combination only where that has at most this part of the smaller variance of the two.
const COMBINED: f64 = 0.25;

/// How far the data determine an unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// By itself, with a 90 % band of at most 5 % to each side: of the value, of an offset of the range expected.
    Identified,
    /// By itself, with a wider band that is narrower than the one expected.
    Bounded,
    /// Only together with another one.
    InCombination,
    /// Hardly at all: it is left at its prior.
    NotIdentifiable,
}

/// What was found of an unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Median, given that the unknowns that are not identifiable have the medians of their priors; of one of these, that of
    /// its prior.
    pub value: f64,
    /// Ends of the 90 % band.
    pub band: [f64; 2],
    /// Posterior over prior variance of the standardised unknown.
    pub variance_ratio: f64,
    /// How far the data determine it.
    pub verdict: Verdict,
}

impl Estimate {
    /// Width of the posterior over that of the prior. Near 1 the data can hardly move the prior.
    pub fn width_ratio(&self) -> f64 {
        self.variance_ratio.sqrt()
    }
}

/// Two unknowns of which the data show one combination only.
#[derive(Debug, Clone, PartialEq)]
pub struct CombinedPair {
    /// The unknowns.
    pub unknowns: [usize; 2],
    /// Correlation of their posterior: near -1 both act on the data in the same direction, so that their sum is known.
    pub correlation: f64,
    /// Weights of the standardised unknowns in the combination that is known; their squares add up to 1.
    pub weights: [f64; 2],
    /// Posterior over prior variance of that combination.
    pub variance_ratio: f64,
}

/// Estimates and pairs from a posterior ensemble of standardised unknowns, one column per member.
pub fn identify(unknowns: &[Unknown], posterior: &DMatrix<f64>) -> (Vec<Estimate>, Vec<CombinedPair>) {
    // The unknowns are standardised: their prior has mean 0 and variance 1.
    let mean = posterior.column_mean();
    // At least one as the divisor, so that an ensemble of one member has no spread instead of NaN.
    let divisor = (posterior.ncols().max(2) - 1) as f64;
    let covariance = DMatrix::from_fn(unknowns.len(), unknowns.len(), |i, j| {
        let products = posterior
            .column_iter()
            .map(|member| (member[i] - mean[i]) * (member[j] - mean[j]));
        products.sum::<f64>() / divisor
    });
    let pairs = pairs(&covariance);
    let medians = medians(&covariance, &mean);
    let estimates = unknowns
        .iter()
        .enumerate()
        .map(|(index, unknown)| {
            // The prior variance is 1, so the posterior variance is the ratio of both.
            let ratio = covariance[(index, index)];
            let paired = pairs.iter().any(|pair| pair.unknowns.contains(&index));
            let value = unknown.value(medians[index]);
            // Without information of the data the ensemble's own mean and
            // deviation are noise; the prior is the honest answer.
            let (middle, deviation) = if ratio > NOT_IDENTIFIABLE {
                (0.0, 1.0)
            } else {
                (mean[index], ratio.sqrt())
            };
            // The ends are transformed and not the deviation: the band of a logarithmic normal is not symmetrical.
            let band = [-BAND, BAND].map(|z| unknown.value(middle + deviation * z));
            let [low, high] = unknown.prior();
            // A relative precision has no meaning for an unknown that may be zero,
            // such as a tare; its prior's width is the measure there.
            let size = match unknown.shape() {
                Shape::Normal => high - low,
                Shape::LogNormal => value,
            };
            // From the worst verdict to the best: a narrow band says little
            // about an unknown that is only known in combination.
            let verdict = if ratio > NOT_IDENTIFIABLE {
                Verdict::NotIdentifiable
            } else if paired && ratio > ALONE {
                Verdict::InCombination
            } else if 0.5 * (band[1] - band[0]) <= PRECISE * size {
                Verdict::Identified
            } else {
                Verdict::Bounded
            };
            Estimate {
                value,
                band,
                variance_ratio: ratio,
                verdict,
            }
        })
        .collect();
    (estimates, pairs)
}

/// The standardised medians, given that unknowns which the data do not determine are at 0: their keys keep their values, and
/// those of the others must fit to that. With the covariance C and mean m of the ensemble, K of the kept ones:
/// m - C_.K C_KK^-1 m_K.
fn medians(covariance: &DMatrix<f64>, mean: &DVector<f64>) -> DVector<f64> {
    let kept: Vec<usize> = (0..mean.len())
        .filter(|k| covariance[(*k, *k)] > NOT_IDENTIFIABLE)
        .collect();
    let between = DMatrix::from_fn(kept.len(), kept.len(), |i, j| covariance[(kept[i], kept[j])]);
    let of_kept = DVector::from_iterator(kept.len(), kept.iter().map(|k| mean[*k]));
    let mut medians = mean.clone();
    // Without scatter in a direction the kept ones are as good as one of them.
    if let Some(factor) = between.cholesky() {
        let weights = factor.solve(&of_kept);
        for index in 0..mean.len() {
            let change = kept
                .iter()
                .zip(weights.iter())
                .map(|(k, w)| covariance[(index, *k)] * w);
            medians[index] -= change.sum::<f64>();
        }
    }
    for k in kept {
        medians[k] = 0.0;
    }
    medians
}

fn pairs(covariance: &DMatrix<f64>) -> Vec<CombinedPair> {
    let mut found = Vec::new();
    for i in 0..covariance.nrows() {
        for j in i + 1..covariance.nrows() {
            let (a, b, c) = (covariance[(i, i)], covariance[(j, j)], covariance[(i, j)]);
            if a.min(b) <= ALONE || c == 0.0 {
                continue;
            }
            // The smaller eigenvalue of the two-by-two covariance and its eigenvector.
            let half = 0.5 * (a - b);
            let smaller = 0.5 * (a + b) - half.hypot(c);
            if smaller > COMBINED * a.min(b) {
                continue;
            }
            let (x, y) = (c, smaller - a);
            let length = x.hypot(y);
            let sign = if x + y < 0.0 { -1.0 } else { 1.0 };
            found.push(CombinedPair {
                unknowns: [i, j],
                correlation: c / (a * b).sqrt(),
                weights: [sign * x / length, sign * y / length],
                variance_ratio: smaller,
            });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::smoother::{SmootherSettings, smooth};

    fn friction(name: &str) -> Unknown {
        Unknown::new(name, "", Shape::LogNormal, [0.25, 0.40]).unwrap()
    }

    /// The data show the sum of the first two, the third by itself, and nothing of the fourth.
    #[test]
    fn sums_are_named_and_what_acts_on_nothing_is_left_at_its_prior() {
        let unknowns = ["arc", "straight", "bit", "joints"].map(friction);
        let error = DMatrix::from_diagonal_element(2, 2, 1e-3);
        let model = |z: &[f64]| vec![z[0] + z[1] + 0.01 * z[3], z[2]];
        let posterior = smooth(4, &[0.8, -0.5], &error, &SmootherSettings::default(), model).unwrap();
        let (estimates, pairs) = identify(&unknowns, &posterior);
        let verdicts: Vec<Verdict> = estimates.iter().map(|estimate| estimate.verdict).collect();
        assert_eq!(
            verdicts,
            [
                Verdict::InCombination,
                Verdict::InCombination,
                Verdict::Identified,
                Verdict::NotIdentifiable
            ]
        );
        assert_eq!(pairs.len(), 1);
        let pair = &pairs[0];
        assert_eq!(pair.unknowns, [0, 1]);
        // A sum of two with error 1e-3: each keeps half of its variance, the correlation is -1 less 1e-3.
        assert!(pair.correlation < -0.99 && pair.variance_ratio < 0.01, "{pair:?}");
        assert!(
            pair.weights.iter().all(|weight| (weight - 0.5_f64.sqrt()).abs() < 0.05),
            "{pair:?}"
        );
        assert!((estimates[2].value - unknowns[2].value(-0.5)).abs() < 0.005);
        assert_eq!(estimates[3].value, unknowns[3].value(0.0));
        let band = estimates[3].band.iter().zip([0.25, 0.40]);
        assert!(band.into_iter().all(|(end, prior)| (end - prior).abs() < 1e-12));
    }
}
