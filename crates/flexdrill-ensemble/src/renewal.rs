//! Renewal of an ensemble: others near the members of much weight replace those of little weight.
//!
//! Systematic resampling chooses parents; children are shrunk towards the mean and scattered again after Liu and West
//! (Sequential Monte Carlo Methods in Practice, Springer 2001, chapter 10),
//!
//! ```text
//! x' = a x + (1 - a) mean + h sum_i sqrt(w_i) (x_i - mean) xi_i,   a = sqrt(1 - h^2),
//! ```
//!
//! with independent standard normal `xi_i`, which keeps mean and covariance of the weighted members. A child is so a
//! combination of members whose shares sum to 1, and whatever is linear in the parameters is the same combination of what
//! the members have: a child's residuals are known before it has run. Parameters are given as standard normal coordinates,
//! those of their prior's quantiles, so that no child leaves the bounds of a key.

use statrs::distribution::{ContinuousCDF as _, Normal};

/// A member of the renewed ensemble.
#[derive(Debug, Clone, PartialEq)]
pub struct Renewal {
    /// The member that it is near.
    pub parent: usize,
    /// Its parameters, as standard normal coordinates.
    pub at: Vec<f64>,
    /// Shares of the members in it; their sum is 1.
    shares: Vec<f64>,
}

impl Renewal {
    /// What this member has of a quantity that is linear in the parameters, where the members have `values`; `None` where
    /// one that has a share in it has none.
    pub fn combined(&self, values: &[Option<f64>]) -> Option<f64> {
        let shares = self.shares.iter().zip(values).filter(|(share, _)| **share != 0.0);
        shares.map(|(share, value)| Some(share * (*value)?)).sum()
    }
}

/// A renewed ensemble of the same size. `members` are parameters by member, `weights` their shares, and `scatter` the `h` of
/// Liu and West, 0.1 to 0.3. A member whose weight is nil has no child.
pub fn renewal(members: &[Vec<f64>], weights: &[f64], scatter: f64, seed: u64) -> Vec<Renewal> {
    let count = members.len().min(weights.len());
    let Some(size) = members.first().map(Vec::len) else {
        return Vec::new();
    };
    let mut random = fastrand::Rng::with_seed(seed);
    let (shrink, normal) = ((1.0 - scatter * scatter).sqrt(), Normal::standard());
    let sum: f64 = weights[..count].iter().sum();
    let weights: Vec<f64> = weights[..count].iter().map(|weight| weight / sum).collect();
    let parents = parents(&weights, random.f64());
    parents
        .into_iter()
        .map(|parent| {
            // Never 0, whose quantile is infinite.
            let draws: Vec<f64> = weights
                .iter()
                .map(|weight| weight.sqrt() * normal.inverse_cdf(random.f64().clamp(1e-12, 1.0 - 1e-12)))
                .collect();
            let all: f64 = draws.iter().sum();
            let mut shares: Vec<f64> = (weights.iter().zip(&draws))
                .map(|(weight, draw)| (1.0 - shrink) * weight + scatter * (draw - weight * all))
                .collect();
            shares[parent] += shrink;
            let mut at = vec![0.0; size];
            for (share, member) in shares.iter().zip(members) {
                for (at, of) in at.iter_mut().zip(member) {
                    *at += share * of;
                }
            }
            Renewal { parent, at, shares }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Evidence, Measurement, effective_number, tempering, weights};

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

    /// An ensemble that is weighed by what is measured and renewed as the twin's is, with its evidence.
    struct Renewed {
        members: Vec<Vec<f64>>,
        evidence: Vec<Evidence>,
        renewals: u64,
        seed: u64,
    }

    impl Renewed {
        fn new(count: usize, size: usize, discrepancy: f64, seed: u64) -> Self {
            let mut random = fastrand::Rng::with_seed(seed);
            Self {
                members: (0..count).map(|_| normals(&mut random, size)).collect(),
                evidence: vec![Evidence::new(&[discrepancy]); count],
                renewals: 0,
                seed,
            }
        }

        fn logs(&self) -> Vec<f64> {
            self.evidence.iter().map(Evidence::log_weight).collect()
        }

        /// Weights by the power that leaves at least `least` members alike.
        fn tempered(&self, least: f64) -> (f64, Vec<f64>) {
            let logs = self.logs();
            let power = tempering(&logs, least);
            (
                power,
                weights(&logs.iter().map(|log| power * log).collect::<Vec<f64>>()),
            )
        }

        /// Takes a window in which `y` is measured where a member shows `figure`, and is renewed once.
        fn window(&mut self, y: f64, noise: f64, figure: impl Fn(&[f64]) -> f64) {
            for (member, evidence) in self.members.iter().zip(&mut self.evidence) {
                let measurement = Measurement {
                    residual: y - figure(member),
                    noise,
                    independent: 1.0,
                };
                evidence.add(0, &measurement);
            }
            self.renew();
        }

        fn renew(&mut self) {
            let half = 0.5 * self.members.len() as f64;
            if effective_number(&weights(&self.logs())) >= half {
                return;
            }
            let (power, shares) = self.tempered(half);
            assert!(effective_number(&shares) >= half - 1e-9);
            self.renewals += 1;
            let children = renewal(&self.members, &shares, 0.2, self.seed ^ self.renewals);
            let residuals: Vec<Option<f64>> = (self.evidence.iter())
                .map(|evidence| evidence.mean_residuals().next().flatten())
                .collect();
            self.evidence = (children.iter())
                .map(|child| {
                    let parent = &self.evidence[child.parent];
                    parent.chosen(&parent.part(power)).moved(&[child.combined(&residuals)])
                })
                .collect();
            self.members = children.into_iter().map(|child| child.at).collect();
        }

        /// Mean and variance of a direction.
        fn moments(&self, direction: &[f64]) -> [f64; 2] {
            let along = |member: &Vec<f64>| member.iter().zip(direction).map(|(x, d)| x * d).sum();
            let xs: Vec<f64> = self.members.iter().map(along).collect();
            moments(&xs, &weights(&self.logs()))
        }
    }

    /// A tool of two parameters x and z, independent and standard normal, whose figure is 9 x + 3 z: it is measured as y
    /// with a noise of 2 per window and a discrepancy of 1.5, so that the first window leaves 1 member of 6 alike and twelve
    /// of them 1 of 9. Bayes's rule has the closed form: of u = (9 x + 3 z) / sqrt(90) the precision is 1 + 90 / v,
    /// v = 1.5^2 + 2^2 / K, and the mean sqrt(90) mean(y) / v over it; the direction across u keeps its prior.
    #[test]
    fn a_tempered_and_renewed_ensemble_comes_to_the_posterior_of_bayes() {
        let (noise, discrepancy, truth, windows, slope) = (2.0, 1.5, 1.2, 12, 90.0_f64.sqrt());
        let count = 400;
        let figure = |member: &[f64]| 9.0 * member[0] + 3.0 * member[1];
        let (mut off, mut ratios, mut across) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 0..12 {
            let mut ensemble = Renewed::new(count, 2, discrepancy, seed);
            let errors = normals(&mut fastrand::Rng::with_seed(100 + seed), windows);
            let measured: Vec<f64> = errors.iter().map(|e| slope * truth + 0.7 + noise * e).collect();
            for y in &measured {
                ensemble.window(*y, noise, figure);
            }
            // What a window had too much of is used up by renewals after it.
            for _ in 0..20 {
                ensemble.renew();
            }
            assert_eq!(ensemble.tempered(0.5 * count as f64).0, 1.0, "nothing is left over");
            assert!(ensemble.renewals > 1, "{}", ensemble.renewals);
            let mean_y = measured.iter().sum::<f64>() / windows as f64;
            let v = discrepancy * discrepancy + noise * noise / windows as f64;
            let exact = [
                slope * mean_y / v / (1.0 + slope * slope / v),
                1.0 / (1.0 + slope * slope / v),
            ];
            let [mean, variance] = ensemble.moments(&[9.0 / slope, 3.0 / slope]);
            off.push((mean - exact[0]) / exact[1].sqrt());
            ratios.push(variance / exact[1]);
            across.push(ensemble.moments(&[3.0 / slope, -9.0 / slope])[1]);
        }
        // Of n members alike a mean scatters by 1 / sqrt(n) of its deviation and a variance by sqrt(2 / n): 0.07 and 0.1 of
        // the 200 that each of a few renewals leaves at the least, twice as much with what they add up to. Twelve seeds
        // scatter by sqrt(12) less, and four standard deviations are allowed.
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let allowed = |each: f64| 4.0 * 2.0 * each / 12.0_f64.sqrt();
        assert!(mean(&off).abs() < allowed(0.07), "{off:?}");
        assert!((mean(&ratios) - 1.0).abs() < allowed(0.1), "{ratios:?}");
        assert!((mean(&across) - 1.0).abs() < allowed(0.1), "{across:?}");
    }

    /// One window that a single member of twelve explains: eight remain alike, and the mean comes to it in a few renewals.
    #[test]
    fn one_window_takes_no_more_members_than_allowed_and_is_not_lost() {
        let mut ensemble = Renewed::new(12, 1, 0.01, 3);
        let figure = |member: &[f64]| member[0];
        let [before, _] = ensemble.moments(&[1.0]);
        for (member, evidence) in ensemble.members.iter().zip(&mut ensemble.evidence) {
            let measurement = Measurement {
                residual: 1.0 - figure(member),
                noise: 0.1,
                independent: 1.0,
            };
            evidence.add(0, &measurement);
        }
        assert!(effective_number(&weights(&ensemble.logs())) < 3.0);
        let (power, shares) = ensemble.tempered(8.0);
        assert!(
            effective_number(&shares) >= 8.0 && power > 0.0 && power < 1.0,
            "{power}"
        );
        for _ in 0..30 {
            ensemble.renew();
        }
        let [mean, variance] = ensemble.moments(&[1.0]);
        // Precisions 1 and 1 / (0.1^2 + 0.01^2): mean 0.99, deviation 0.1. Twelve members know neither better than by half.
        assert!(
            (mean - 0.99).abs() < 0.15 && (before - 0.99).abs() > 0.5,
            "{before} {mean}"
        );
        assert!((0.03..0.2).contains(&variance.sqrt()), "{variance}");
    }

    #[test]
    fn what_is_linear_is_combined_as_the_parameters_are() {
        let mut random = fastrand::Rng::with_seed(4);
        let members: Vec<Vec<f64>> = (0..9).map(|_| normals(&mut random, 20)).collect();
        let figure = |at: &[f64]| 2.0 + at.iter().enumerate().map(|(k, x)| k as f64 * x).sum::<f64>();
        let mut values: Vec<Option<f64>> = members.iter().map(|member| Some(figure(member))).collect();
        let shares = [0.0, 0.2, 0.1, 0.1, 0.1, 0.1, 0.1, 0.2, 0.1];
        let children = renewal(&members, &shares, 0.2, 1);
        for child in &children {
            assert!((child.combined(&values).unwrap() - figure(&child.at)).abs() < 1e-9);
        }
        values[0] = None;
        assert!(
            children[0].combined(&values).is_some(),
            "a member without weight has no share"
        );
        values[1] = None;
        assert_eq!(children[0].combined(&values), None);
    }

    #[test]
    fn renewal_keeps_mean_and_covariance_and_repeats_by_its_seed() {
        let mut random = fastrand::Rng::with_seed(2);
        let [x, y] = [0, 1].map(|_| normals(&mut random, 1500));
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
            // The scatter of 1500 children moves their mean by 0.3 / sqrt(1500) deviations and their variance by twice that
            // share; four standard deviations, and the parents' rounding to whole numbers.
            assert!(
                (m0 - m1).abs() < 0.05 && (v1 / v0 - 1.0).abs() < 0.08,
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
