//! What a sequence of measurements says of one member.
//!
//! In window `k` a channel is measured as `y_k`, and the member gives `m_k` with its own sensor errors. The residual is
//!
//! ```text
//! r_k = y_k - m_k = b + e_k,   b ~ N(0, d^2),   e_k ~ N(0, s_k^2)
//! ```
//!
//! with the noise `s_k` of a window's mean and the discrepancy `b` of the model, which is the same in all windows for as long
//! as the kind of motion lasts. The windows' joint density has the covariance `s_k^2 delta_kl + d^2`. By the identity of
//! Sherman and Morrison it needs three sums alone:
//!
//! ```text
//! A = sum r^2 / s^2,   B = sum r / s^2,   C = sum 1 / s^2
//! log p = - 1/2 [ A - B^2 d^2 / (1 + C d^2) ] - 1/2 ln(1 + C d^2) - sum ln s + const
//! ```
//!
//! The last two terms are the same for all members, and are left out. However large `C` grows, `B / C` is known to `d` at
//! best: a long log does not average the discrepancy away.
//!
//! Of a member whose residuals are larger by the same `x` in all windows the log-likelihood is quadratic in `x`
//! ([`Quadratic`]). What a choice of members has used up is kept as such a quadratic, so that both are known of a member
//! near another one, too ([`Evidence::moved`]).

/// A channel's mean over a window, and what is known of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// The measured mean less the member's.
    pub residual: f64,
    /// Standard deviation of the mean by noise and drift of the sensor.
    pub noise: f64,
    /// Independent windows that this one counts for: its length over the correlation time of the residual, at most 1.
    pub independent: f64,
}

/// The sums of one channel.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Sums {
    squares: f64,
    firsts: f64,
    weights: f64,
}

/// A log-likelihood of one channel as a function of `x`, by which all residuals are larger: - 1/2 (constant + 2 slope x +
/// curvature x^2).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Quadratic {
    constant: f64,
    slope: f64,
    curvature: f64,
}

impl Quadratic {
    /// This and `share` of another.
    fn plus(self, share: f64, other: Self) -> Self {
        Self {
            constant: self.constant + share * other.constant,
            slope: self.slope + share * other.slope,
            curvature: self.curvature + share * other.curvature,
        }
    }

    /// The same function about residuals that are larger by `by`.
    fn moved(self, by: f64) -> Self {
        Self {
            constant: self.constant + by * (2.0 * self.slope + by * self.curvature),
            slope: self.slope + by * self.curvature,
            ..self
        }
    }
}

impl Sums {
    /// The log-likelihood with a discrepancy `d`.
    fn likelihood(&self, d: f64) -> Quadratic {
        // B moves by C x and A by 2 B x + C x^2, and the discrepancy takes the share C d^2 / (1 + C d^2) of both.
        let left = 1.0 / (1.0 + self.weights * d * d);
        Quadratic {
            constant: self.squares - self.firsts * self.firsts * d * d * left,
            slope: self.firsts * left,
            curvature: self.weights * left,
        }
    }

    /// The same of residuals that are larger by `by`.
    fn moved(self, by: f64) -> Self {
        Self {
            squares: self.squares + by * (2.0 * self.firsts + by * self.weights),
            firsts: self.firsts + by * self.weights,
            ..self
        }
    }
}

/// What measurements say of a member, over channels whose errors are independent.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    sums: Vec<Sums>,
    /// Standard deviation of the model's discrepancy per channel.
    discrepancy: Vec<f64>,
    /// The log-likelihood that choices of this member have used up, per channel.
    used: Vec<Quadratic>,
}

/// A part of a member's weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Part(Vec<Quadratic>);

impl Evidence {
    /// Nothing measured, of a model that is wrong by these amounts (standard deviations) per channel.
    pub fn new(discrepancy: &[f64]) -> Self {
        Self {
            sums: vec![Sums::default(); discrepancy.len()],
            discrepancy: discrepancy.to_vec(),
            used: vec![Quadratic::default(); discrepancy.len()],
        }
    }

    /// Takes a window's measurement of a channel. One that is not a number, or has no error, says nothing.
    pub fn add(&mut self, channel: usize, measurement: &Measurement) {
        let Measurement {
            residual,
            noise,
            independent,
        } = *measurement;
        let weight = independent.clamp(0.0, 1.0) / (noise * noise);
        let says = residual.is_finite() && weight.is_finite() && weight > 0.0;
        let Some(sums) = self.sums.get_mut(channel).filter(|_| says) else {
            return;
        };
        sums.squares += weight * residual * residual;
        sums.firsts += weight * residual;
        sums.weights += weight;
    }

    /// Lets what was measured lose its hold on the discrepancy, which changes with the motion: after `time` of a correlation
    /// time `lasting` (both s) a part exp(- time / lasting) is left.
    pub fn fade(&mut self, time: f64, lasting: f64) {
        let left = (-time / lasting).exp();
        for ((sums, used), d) in self.sums.iter_mut().zip(&mut self.used).zip(&self.discrepancy) {
            // What has faded has been used: the member keeps the weight that it earned.
            let before = sums.likelihood(*d);
            sums.squares *= left;
            sums.firsts *= left;
            sums.weights *= left;
            *used = used.plus(1.0, sums.likelihood(*d)).plus(-1.0, before);
        }
    }

    /// Forgets what a channel was measured to be, and what it has been used for.
    pub fn forget(&mut self, channel: usize) {
        if let (Some(sums), Some(used)) = (self.sums.get_mut(channel), self.used.get_mut(channel)) {
            (*sums, *used) = Default::default();
        }
    }

    fn likelihoods(&self) -> impl Iterator<Item = Quadratic> {
        let channels = self.sums.iter().zip(&self.discrepancy);
        channels.map(|(sums, d)| sums.likelihood(*d))
    }

    /// Logarithm of the likelihood of all that was measured, but for a term that all members share.
    pub fn log_likelihood(&self) -> f64 {
        self.likelihoods().map(|of| -0.5 * of.constant).sum()
    }

    /// The logarithm of the member's weight: what was measured and has not been used by a choice of members.
    pub fn log_weight(&self) -> f64 {
        let left = self.likelihoods().zip(&self.used);
        left.map(|(of, used)| -0.5 * (of.constant - used.constant)).sum()
    }

    /// What a choice of this member by the power `exponent` of its weight uses up.
    pub fn part(&self, exponent: f64) -> Part {
        let left = self.likelihoods().zip(&self.used);
        Part(
            left.map(|(of, used)| Quadratic::default().plus(exponent, of.plus(-1.0, *used)))
                .collect(),
        )
    }

    /// The evidence of a member that was chosen by a part of it: all of it is kept, so that the discrepancy is not taken for
    /// new in every window. The rest of the weight, and what was measured since the choice, counts from here on.
    #[must_use]
    pub fn chosen(&self, part: &Part) -> Self {
        let used = self.used.iter().zip(&part.0);
        Self {
            used: used.map(|(used, part)| used.plus(1.0, *part)).collect(),
            ..self.clone()
        }
    }

    /// Mean residual per channel; `None` where nothing was measured.
    pub fn mean_residuals(&self) -> impl Iterator<Item = Option<f64>> {
        let of = |sums: &Sums| (sums.weights > 0.0).then(|| sums.firsts / sums.weights);
        self.sums.iter().map(of)
    }

    /// The evidence of a member near this one, whose mean residuals are `residuals` per channel, and whose residuals are
    /// larger by the same in all windows. A channel without one keeps those of this member.
    #[must_use]
    pub fn moved(&self, residuals: &[Option<f64>]) -> Self {
        let by = (self.mean_residuals().zip(residuals))
            .map(|(own, other)| own.zip(*other).map_or(0.0, |(own, other)| other - own));
        let mut near = self.clone();
        for ((sums, used), by) in near.sums.iter_mut().zip(&mut near.used).zip(by) {
            (*sums, *used) = (sums.moved(by), used.moved(by));
        }
        near
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// Truth by the density of the joint normal distribution with its full covariance.
    #[test]
    fn the_sums_give_the_joint_density_of_all_windows() {
        let mut random = fastrand::Rng::with_seed(3);
        for windows in [1, 2, 7, 30] {
            let d = 4.0 * random.f64();
            let noise: Vec<f64> = (0..windows).map(|_| 0.2 + random.f64()).collect();
            let covariance = DMatrix::from_fn(windows, windows, |k, l| {
                d * d + if k == l { noise[k] * noise[k] } else { 0.0 }
            });
            let inverse = covariance.try_inverse().unwrap();
            let mut of = |offset: f64| {
                let residuals: Vec<f64> = (0..windows).map(|_| offset + random.f64()).collect();
                let mut evidence = Evidence::new(&[d]);
                for (residual, noise) in residuals.iter().zip(&noise) {
                    evidence.add(
                        0,
                        &Measurement {
                            residual: *residual,
                            noise: *noise,
                            independent: 1.0,
                        },
                    );
                }
                let r = DVector::from_vec(residuals);
                let exact = -0.5 * (r.transpose() * &inverse * r)[(0, 0)];
                assert!((evidence.log_likelihood() - exact).abs() < 1e-9 * exact.abs().max(1.0));
            };
            of(0.0);
            of(-3.0);
        }
    }

    /// A long log knows an offset to the discrepancy, and no better: the closed form of a normal mean with a common error.
    #[test]
    fn a_long_log_does_not_average_the_discrepancy_away() {
        let (d, noise) = (2.0, 1.0);
        for windows in [1_u32, 10, 10_000] {
            // The curvature of the log-likelihood in the member's figure is what is known of it.
            let at = |shift: f64| {
                let mut evidence = Evidence::new(&[d]);
                for _ in 0..windows {
                    evidence.add(
                        0,
                        &Measurement {
                            residual: shift,
                            noise,
                            independent: 1.0,
                        },
                    );
                }
                evidence.log_likelihood()
            };
            let variance = -1.0 / (at(1.0) - 2.0 * at(0.0) + at(-1.0));
            let exact = d * d + noise * noise / f64::from(windows);
            assert!(
                (variance - exact).abs() < 1e-6 * exact,
                "{windows}: {variance}, {exact}"
            );
        }
    }

    #[test]
    fn what_is_no_measurement_says_nothing_and_renewal_starts_from_zero() {
        let mut evidence = Evidence::new(&[1.0, 1.0]);
        let good = Measurement {
            residual: 2.0,
            noise: 0.5,
            independent: 1.0,
        };
        evidence.add(1, &good);
        let known = evidence.clone();
        for bad in [
            Measurement {
                residual: f64::NAN,
                ..good
            },
            Measurement { noise: 0.0, ..good },
            Measurement {
                noise: f64::INFINITY,
                ..good
            },
            Measurement {
                independent: f64::NAN,
                ..good
            },
        ] {
            evidence.add(0, &bad);
        }
        evidence.add(7, &good);
        assert_eq!(evidence, known);
        let mut renewed = evidence.chosen(&evidence.part(1.0));
        assert!(evidence.log_weight() < 0.0 && renewed.log_weight() == 0.0);
        // A second look at the same offset tells less than the first: the discrepancy was met before.
        renewed.add(1, &good);
        assert!(renewed.log_weight() > evidence.log_weight());
        let before = renewed.log_weight();
        renewed.fade(3600.0, 7200.0);
        assert!((renewed.log_weight() - before).abs() < 1e-12, "fading moves no weight");
    }

    fn random_evidence(random: &mut fastrand::Rng, residuals: &[f64], noise: &[f64]) -> Evidence {
        let mut evidence = Evidence::new(&[1.5, 0.5]);
        for (window, (residual, noise)) in residuals.iter().zip(noise).enumerate() {
            evidence.add(
                window % 2,
                &Measurement {
                    residual: *residual,
                    noise: *noise,
                    independent: 0.3,
                },
            );
            if window % 3 == 0 {
                evidence.fade(20.0 + random.f64(), 600.0);
            }
            if window % 4 == 1 {
                evidence = evidence.chosen(&evidence.part(0.4));
            }
        }
        evidence
    }

    /// Truth is the member whose residuals were the larger ones from the beginning.
    #[test]
    fn moved_evidence_is_that_of_the_moved_member() {
        for seed in 0..5 {
            let mut random = fastrand::Rng::with_seed(seed);
            let residuals: Vec<f64> = (0..12).map(|_| random.f64() - 0.5).collect();
            let noise: Vec<f64> = (0..12).map(|_| 0.2 + random.f64()).collect();
            let by = [0.7, -1.3];
            let moved: Vec<f64> = residuals.iter().enumerate().map(|(k, r)| r + by[k % 2]).collect();
            let [own, other] =
                [&residuals, &moved].map(|of| random_evidence(&mut fastrand::Rng::with_seed(9), of, &noise));
            let near = own.moved(&other.mean_residuals().collect::<Vec<_>>());
            // Sums of some hundred, to rounding.
            let close = |a: f64, b: f64| (a - b).abs() < 1e-9;
            assert!(close(near.log_likelihood(), other.log_likelihood()), "{seed}");
            assert!(close(near.log_weight(), other.log_weight()), "{seed}");
            assert!((near.log_weight() - own.log_weight()).abs() > 0.1, "{seed}");
            assert_eq!(own.moved(&[None, None]), own);
        }
    }

    /// The powers by which a member was chosen leave what is missing to the whole.
    #[test]
    fn a_choice_by_a_part_of_the_weight_leaves_the_rest() {
        let mut random = fastrand::Rng::with_seed(1);
        let evidence = random_evidence(&mut random, &[1.0, -2.0, 0.5, 3.0], &[0.5, 0.7, 0.6, 0.8]);
        let whole = evidence.log_weight();
        let after = evidence.chosen(&evidence.part(0.25));
        let rest = after.chosen(&after.part(0.5));
        assert!(whole.abs() > 1.0 && (rest.log_weight() - 0.375 * whole).abs() < 1e-12 * whole.abs());
        assert!((rest.log_likelihood() - evidence.log_likelihood()).abs() < 1e-12);
    }

    #[test]
    fn a_forgotten_channel_says_nothing_and_leaves_the_others() {
        let add = |evidence: &mut Evidence, channel| {
            let measurement = Measurement {
                residual: 2.0,
                noise: 0.5,
                independent: 1.0,
            };
            evidence.add(channel, &measurement);
        };
        let (mut both, mut one) = (Evidence::new(&[1.0, 1.0]), Evidence::new(&[1.0, 1.0]));
        add(&mut both, 0);
        add(&mut both, 1);
        add(&mut one, 1);
        let mut chosen = both.chosen(&both.part(0.5));
        both.forget(0);
        assert_eq!(both, one);
        chosen.forget(0);
        assert!((chosen.log_weight() - 0.5 * one.log_weight()).abs() < 1e-12);
        both.forget(7);
        assert_eq!(both, one);
    }
}
