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

/// What measurements say of a member, over channels whose errors are independent.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    sums: Vec<Sums>,
    /// Standard deviation of the model's discrepancy per channel.
    discrepancy: Vec<f64>,
    /// The log-likelihood at the last renewal, which the choice of this member has used up.
    used: f64,
}

impl Evidence {
    /// Nothing measured, of a model that is wrong by these amounts (standard deviations) per channel.
    pub fn new(discrepancy: &[f64]) -> Self {
        Self {
            sums: vec![Sums::default(); discrepancy.len()],
            discrepancy: discrepancy.to_vec(),
            used: 0.0,
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
        // What has faded has been used: the member keeps the weight that it earned.
        let before = self.log_likelihood();
        for sums in &mut self.sums {
            sums.squares *= left;
            sums.firsts *= left;
            sums.weights *= left;
        }
        self.used += self.log_likelihood() - before;
    }

    /// Logarithm of the likelihood of all that was measured, but for a term that all members share.
    pub fn log_likelihood(&self) -> f64 {
        let channels = self.sums.iter().zip(&self.discrepancy);
        channels
            .map(|(sums, d)| {
                let explained = sums.firsts * sums.firsts * d * d / (1.0 + sums.weights * d * d);
                -0.5 * (sums.squares - explained)
            })
            .sum()
    }

    /// The same since the last renewal: the logarithm of the member's weight.
    pub fn log_weight(&self) -> f64 {
        self.log_likelihood() - self.used
    }

    /// The evidence of a member that was chosen by it: it is kept, so that the discrepancy is not taken for new in every
    /// window, and counts from here on.
    #[must_use]
    pub fn renewed(&self) -> Self {
        self.chosen(self.log_weight())
    }

    /// The same of a member that was chosen when its [`Evidence::log_weight`] was this: what was measured since then counts.
    #[must_use]
    pub fn chosen(&self, log_weight: f64) -> Self {
        Self {
            used: self.used + log_weight,
            ..self.clone()
        }
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
        let mut renewed = evidence.renewed();
        assert!(evidence.log_weight() < 0.0 && renewed.log_weight() == 0.0);
        // A second look at the same offset tells less than the first: the discrepancy was met before.
        renewed.add(1, &good);
        assert!(renewed.log_weight() > evidence.log_weight());
        let before = renewed.log_weight();
        renewed.fade(3600.0, 7200.0);
        assert!((renewed.log_weight() - before).abs() < 1e-12, "fading moves no weight");
    }
}
