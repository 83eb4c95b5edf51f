//! The recursive estimate of friction and tare while drilling.
//!
//! A Kalman filter with two states: the factor s by which friction differs from the twin's, and the tare of the torque
//! sensor. To first order the torque that friction takes is proportional to its coefficient, so that
//!
//! measured = tare + predicted + (s - a) friction + noise,
//!
//! where a is the factor with which friction acts in the twin, and friction is the torque that it takes at the factor 1.
//! Off bottom the tare is seen best, with weight the factor. Both move as slow random walks between limits. A sample that
//! is far from what is expected, or not from steady motion, changes nothing: a fault is to be seen in the residual and is
//! not to be learned. [`crate::following`] lets the twin's parameters follow the estimate.

/// How the estimate follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowSettings {
    /// Standard deviation of a sample of the torque (N m).
    pub noise: f64,
    /// Error of the twin's torque as a share of it.
    pub model: f64,
    /// Drift of the factor after an hour (standard deviation).
    pub factor_drift: f64,
    /// Drift of the tare after an hour (N m, standard deviation).
    pub tare_drift: f64,
    /// Uncertainty of the factor at the beginning (standard deviation).
    pub factor_prior: f64,
    /// Uncertainty of the tare at the beginning (N m, standard deviation).
    pub tare_prior: f64,
    /// Limits of the factor.
    pub factor_limits: [f64; 2],
    /// Limits of the tare (N m).
    pub tare_limits: [f64; 2],
    /// Deviations of the innovation beyond which a sample changes nothing.
    pub outlier: f64,
}

impl Default for FollowSettings {
    fn default() -> Self {
        Self {
            noise: 15.0,
            model: 0.05,
            factor_drift: 0.1,
            tare_drift: 5.0,
            factor_prior: 0.2,
            tare_prior: 20.0,
            factor_limits: [0.5, 2.0],
            tare_limits: [-200.0, 200.0],
            outlier: 4.0,
        }
    }
}

/// What is known at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Time since the last instant (s).
    pub step: f64,
    /// Measured torque (N m).
    pub measured: f64,
    /// Torque that the twin predicts with the friction that acts in it (N m).
    pub predicted: f64,
    /// The part of it that friction takes (N m).
    pub friction: f64,
    /// Factor with which friction acts in the twin.
    pub applied: f64,
    /// Whether the inputs of the twin are fresh and good.
    pub good: bool,
    /// Whether speed and weight are steady.
    pub steady: bool,
}

impl Instant {
    /// Why nothing can be learned from this instant, whatever is estimated; `None` where something can.
    pub fn unusable(&self) -> Option<Frozen> {
        if !self.good {
            return Some(Frozen::BadInput);
        }
        if !self.steady {
            return Some(Frozen::NotSteady);
        }
        let all = [self.step, self.measured, self.predicted, self.friction, self.applied];
        let missing = all.iter().any(|value| !value.is_finite()) || self.step <= 0.0 || self.applied <= 0.0;
        missing.then_some(Frozen::Missing)
    }
}

/// Why a sample changed nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frozen {
    /// A number is missing.
    Missing,
    /// An input of the twin is not good.
    BadInput,
    /// Speed or weight changes, or has changed a moment ago.
    NotSteady,
    /// The sample is far from what is expected.
    Outlier,
}

/// The estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Follow {
    settings: FollowSettings,
    /// Factor and tare.
    state: [f64; 2],
    /// Covariance of factor and tare: it grows with time and shrinks with each sample that counts.
    covariance: [[f64; 2]; 2],
}

impl Follow {
    /// An estimate that begins with a factor and a tare (N m), within the limits.
    pub fn new(settings: FollowSettings, [factor, tare]: [f64; 2]) -> Self {
        Self {
            state: [
                within(factor, settings.factor_limits),
                within(tare, settings.tare_limits),
            ],
            covariance: [[settings.factor_prior.powi(2), 0.0], [0.0, settings.tare_prior.powi(2)]],
            settings,
        }
    }

    /// Factor of friction.
    pub fn factor(&self) -> f64 {
        self.state[0]
    }

    /// Tare of the torque sensor (N m).
    pub fn tare(&self) -> f64 {
        self.state[1]
    }

    /// Standard deviations of factor and tare.
    pub fn deviations(&self) -> [f64; 2] {
        [self.covariance[0][0].sqrt(), self.covariance[1][1].sqrt()]
    }

    /// The torque that is expected (N m).
    pub fn expected(&self, instant: &Instant) -> f64 {
        let friction = instant.friction / instant.applied;
        self.state[1] + instant.predicted + (self.state[0] - instant.applied) * friction
    }

    /// Takes a sample, or says why it changed nothing.
    pub fn push(&mut self, instant: &Instant) -> Option<Frozen> {
        let unusable = instant.unusable();
        if unusable.is_some() {
            return unusable;
        }
        let s = &self.settings;
        let hours = instant.step / 3600.0;
        self.covariance[0][0] = (self.covariance[0][0] + s.factor_drift.powi(2) * hours).min(s.factor_prior.powi(2));
        self.covariance[1][1] = (self.covariance[1][1] + s.tare_drift.powi(2) * hours).min(s.tare_prior.powi(2));
        let [[a, c], [_, b]] = self.covariance;
        let f = instant.friction / instant.applied;
        let (x, y) = (a * f + c, c * f + b);
        let noise = s.noise.powi(2) + (s.model * instant.predicted).powi(2);
        let variance = f * x + y + noise;
        let innovation = instant.measured - self.expected(instant);
        if innovation.abs() > s.outlier * variance.sqrt() {
            return Some(Frozen::Outlier);
        }
        let gain = [x / variance, y / variance];
        self.state = [
            within(self.state[0] + gain[0] * innovation, s.factor_limits),
            within(self.state[1] + gain[1] * innovation, s.tare_limits),
        ];
        let off = c - gain[0] * y;
        self.covariance = [[a - gain[0] * x, off], [off, b - gain[1] * y]];
        None
    }
}

fn within(value: f64, [low, high]: [f64; 2]) -> f64 {
    value.clamp(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// An hour of drilling with a minute off bottom every ten. The truth: friction 1.25 times the twin's, tare 12 N m.
    fn hour(seed: u64, mut change: impl FnMut(u32, &mut Instant)) -> Follow {
        let mut follow = Follow::new(FollowSettings::default(), [1.0, 0.0]);
        let mut random = Random::new(seed);
        for second in 0..3600_u32 {
            let off_bottom = second % 600 < 60;
            let (friction, bit) = if off_bottom { (40.0, 0.0) } else { (80.0, 220.0) };
            let mut instant = Instant {
                step: 1.0,
                measured: 12.0 + bit + 1.25 * friction + 15.0 * random.normal(),
                predicted: bit + friction,
                friction,
                applied: 1.0,
                good: true,
                steady: true,
            };
            change(second, &mut instant);
            follow.push(&instant);
        }
        follow
    }

    #[test]
    fn friction_and_tare_are_found() {
        for seed in 1..=20 {
            let follow = hour(seed, |_, _| {});
            let [factor, tare] = follow.deviations();
            // Four of the standard deviations that the filter states.
            assert!((follow.factor() - 1.25).abs() < 4.0 * factor, "{seed}: {follow:?}");
            assert!((follow.tare() - 12.0).abs() < 4.0 * tare, "{seed}: {follow:?}");
            assert!(factor < 0.1 && tare < 6.0, "{follow:?}");
        }
    }

    #[test]
    fn bad_samples_change_nothing_and_limits_hold() {
        let before = hour(1, |_, _| {});
        let mut follow = before;
        let good = Instant {
            step: 1.0,
            measured: 300.0,
            predicted: 300.0,
            friction: 80.0,
            applied: 1.0,
            good: true,
            steady: true,
        };
        for (wrong, frozen) in [
            (
                Instant {
                    measured: f64::NAN,
                    ..good
                },
                Frozen::Missing,
            ),
            (Instant { step: -1.0, ..good }, Frozen::Missing),
            (Instant { applied: 0.0, ..good }, Frozen::Missing),
            (Instant { good: false, ..good }, Frozen::BadInput),
            (Instant { steady: false, ..good }, Frozen::NotSteady),
        ] {
            assert_eq!(follow.push(&wrong), Some(frozen));
            assert_eq!(follow, before);
        }
        assert_eq!(
            follow.push(&Instant {
                measured: 3000.0,
                ..good
            }),
            Some(Frozen::Outlier)
        );
        assert_eq!((follow.factor(), follow.tare()), (before.factor(), before.tare()));
        // A torque that rises without end within what is plausible.
        for second in 0..20_000 {
            let measured = 300.0 + 0.05 * f64::from(second);
            follow.push(&Instant { measured, ..good });
            assert!((0.5..=2.0).contains(&follow.factor()) && follow.tare().abs() <= 200.0);
        }
        assert!(follow.factor() == 2.0 || follow.tare() == 200.0, "{follow:?}");
    }

    /// Friction that acts with the factor that was found gives the same estimate: what follows does not chase itself.
    #[test]
    fn a_twin_that_follows_is_seen_with_the_same_truth() {
        let apart = hour(3, |_, _| {});
        let together = hour(3, |second, instant| {
            // From half an hour on 1.2 of the friction acts in the twin.
            if second >= 1800 {
                instant.predicted += 0.2 * instant.friction;
                instant.friction *= 1.2;
                instant.applied = 1.2;
            }
        });
        // The twin's error is a share of its torque, so that a little more of it weighs a little less.
        assert!(
            (apart.factor() - together.factor()).abs() < 0.01,
            "{apart:?} {together:?}"
        );
        assert!((apart.tare() - together.tare()).abs() < 0.5, "{apart:?} {together:?}");
    }
}
