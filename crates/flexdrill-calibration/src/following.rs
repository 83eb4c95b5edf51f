//! The twin's parameters on their way to the estimate of [`crate::follow`]: within limits, no faster than a rate, and only
//! while the estimate is certain enough.
//!
//! Factor and tare move together along the straight line to the estimate. The torque of off-bottom rotation and of drilling
//! sees one combination of both, so that one of them alone would first move away from what is measured.

use crate::BAND;
use crate::follow::{Follow, Frozen};

/// What is known of factor and tare (N m): arrays of both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    /// The estimates.
    pub values: [f64; 2],
    /// Halves of their 90 % bands.
    pub halves: [f64; 2],
}

impl From<&Follow> for Estimated {
    fn from(follow: &Follow) -> Self {
        Self {
            values: [follow.factor(), follow.tare()],
            halves: follow.deviations().map(|deviation| BAND * deviation),
        }
    }
}

/// Share of the half band within which parameters stay: the estimate wanders within its band without a reason.
const CALM: f64 = 0.25;

/// How parameters follow. Arrays are of factor and tare (N m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowingSettings {
    /// Largest change per minute.
    pub rates: [f64; 2],
    /// Half of the estimate's 90 % band above which nothing moves.
    pub bands: [f64; 2],
    /// Limits of each.
    pub limits: [[f64; 2]; 2],
}

/// Why parameters did not move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Held {
    /// The newest sample did not count.
    Frozen(Frozen),
    /// The band of the factor is too wide: half of it, and the most that is allowed.
    FactorUncertain(f64, f64),
    /// The same of the tare (N m).
    TareUncertain(f64, f64),
    /// The factor is at a limit.
    FactorAtLimit(f64),
    /// The tare is at a limit (N m).
    TareAtLimit(f64),
}

/// What a comparison means for the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// New factor and tare, where they move.
    pub to: Option<[f64; 2]>,
    /// Why they do not, or not further.
    pub held: Option<Held>,
}

/// The parameters on their way. It is a function of its calls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Following {
    settings: FollowingSettings,
    /// Under way to the estimate, until it is reached.
    moving: bool,
}

impl Following {
    /// Parameters at rest.
    pub fn new(settings: FollowingSettings) -> Self {
        Self {
            settings,
            moving: false,
        }
    }

    /// Replaces the limits of factor and tare.
    pub fn set_limits(&mut self, limits: [[f64; 2]; 2]) {
        self.settings.limits = limits;
    }

    /// The next move of `applied` (factor and tare in force), `step` seconds after the comparison before. `frozen` is what
    /// the estimate has said of the newest sample.
    pub fn step(&mut self, step: f64, applied: [f64; 2], estimate: Estimated, frozen: Option<Frozen>) -> Moved {
        let held = |held| Moved {
            to: None,
            held: Some(held),
        };
        // A sample that did not count brings no new estimate, so there is nothing to move to.
        if let Some(frozen) = frozen {
            return held(Held::Frozen(frozen));
        }
        let s = &self.settings;
        // Half of the 90 % band. Moving to an uncertain estimate would carry its scatter into every force of the twin.
        let Estimated {
            values: wanted,
            halves: half,
        } = estimate;
        if half[0] > s.bands[0] {
            return held(Held::FactorUncertain(half[0], s.bands[0]));
        }
        if half[1] > s.bands[1] {
            return held(Held::TareUncertain(half[1], s.bands[1]));
        }
        // The limits bound the target and not the step, so that the reason can say which parameter has no more room.
        let target = [0, 1].map(|k| wanted[k].clamp(s.limits[k][0], s.limits[k][1]));
        let ahead = [0, 1].map(|k| target[k] - applied[k]);
        // Clamping returns the limit itself, so equality with it is exact.
        let at_limit = |k: usize| s.limits[k].contains(&target[k]);
        let stopped = if at_limit(0) {
            Some(Held::FactorAtLimit(target[0]))
        } else {
            at_limit(1).then_some(Held::TareAtLimit(target[1]))
        };
        // With hysteresis: the way begins beyond a quarter of the half band,
        // and then continues until the estimate is reached.
        self.moving |= (0..2).any(|k| ahead[k].abs() > CALM * half[k]);
        if !self.moving {
            return Moved {
                to: None,
                held: stopped,
            };
        }
        // The share of the way that both rates allow. A step beyond a minute counts as one: the clock may have jumped.
        let minutes = (step / 60.0).min(1.0);
        let share = (0..2).fold(1.0_f64, |share, k| share.min(s.rates[k] * minutes / ahead[k].abs()));
        // A share of one arrives at the target exactly; rounding on the way
        // would leave a rest that is moved again and again.
        self.moving = share < 1.0;
        let to = if self.moving {
            [0, 1].map(|k| (applied[k] + share * ahead[k]).clamp(s.limits[k][0], s.limits[k][1]))
        } else {
            target
        };
        Moved {
            to: (to != applied).then_some(to),
            held: stopped,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::{FollowSettings, Instant};
    use crate::random::Random;

    const SETTINGS: FollowingSettings = FollowingSettings {
        rates: [0.02, 5.0],
        bands: [0.15, 15.0],
        limits: [[0.5, 2.0], [-200.0, 200.0]],
    };

    /// A rig and a twin whose friction differ by a factor, with an offset of the torque sensor (N m).
    struct Bench {
        truth: [f64; 2],
        follow: Follow,
        following: Following,
        applied: [f64; 2],
        random: Random,
        second: u32,
    }

    impl Bench {
        fn new(truth: [f64; 2], settings: FollowingSettings, seed: u64) -> Self {
            let limits = FollowSettings {
                factor_limits: settings.limits[0],
                tare_limits: settings.limits[1],
                ..FollowSettings::default()
            };
            Self {
                truth,
                follow: Follow::new(limits, [1.0, 0.0]),
                following: Following::new(settings),
                applied: [1.0, 0.0],
                random: Random::new(seed),
                second: 0,
            }
        }

        /// A second: a minute off bottom every ten, drilling otherwise.
        fn next(&mut self, change: impl FnOnce(&mut Instant)) -> Moved {
            let off_bottom = self.second % 600 < 60;
            self.second += 1;
            let (friction, bit) = if off_bottom { (40.0, 0.0) } else { (80.0, 220.0) };
            let mut instant = Instant {
                step: 1.0,
                measured: self.truth[1] + bit + self.truth[0] * friction + 15.0 * self.random.normal(),
                predicted: bit + self.applied[0] * friction,
                friction: self.applied[0] * friction,
                applied: self.applied[0],
                good: true,
                steady: true,
            };
            change(&mut instant);
            let frozen = self.follow.push(&instant);
            let moved = self
                .following
                .step(instant.step, self.applied, Estimated::from(&self.follow), frozen);
            if let Some(to) = moved.to {
                for (k, rate) in SETTINGS.rates.into_iter().enumerate() {
                    // A billionth is more than rounding.
                    let most = rate / 60.0 * instant.step.min(60.0) + 1e-9;
                    assert!(
                        (to[k] - self.applied[k]).abs() <= most,
                        "{moved:?} from {:?}",
                        self.applied
                    );
                }
                self.applied = to;
            }
            moved
        }
    }

    #[test]
    fn parameters_come_to_the_truth_and_rest_there() {
        for seed in 1..=20 {
            let mut bench = Bench::new([1.3, 12.0], SETTINGS, seed);
            let mut moves = 0;
            for second in 0..5400 {
                let moved = bench.next(|_| {});
                // Without a minute off bottom and one of drilling the estimate is not certain.
                assert!(second > 60 || moved.to.is_none(), "{second}: {moved:?}");
                moves += u32::from(second >= 3600 && moved.to.is_some());
            }
            let [factor, tare] = bench.follow.deviations();
            // Four standard deviations of the estimate and the share of the band that does not count.
            assert!(
                (bench.applied[0] - 1.3).abs() < 4.5 * factor,
                "{seed}: {:?}",
                bench.applied
            );
            assert!(
                (bench.applied[1] - 12.0).abs() < 4.5 * tare,
                "{seed}: {:?}",
                bench.applied
            );
            // From an hour on the parameters rest for most of the time: 1800 comparisons.
            assert!(moves < 900, "{seed}: {moves}");
        }
    }

    #[test]
    fn without_a_time_off_bottom_nothing_moves() {
        let mut bench = Bench::new([1.3, 0.0], SETTINGS, 1);
        for _ in 0..3600 {
            bench.second = 300;
            let moved = bench.next(|_| {});
            assert_eq!(moved.to, None);
            assert!(
                matches!(moved.held, Some(Held::FactorUncertain(half, 0.15)) if half > 0.15),
                "{moved:?}"
            );
        }
        assert_eq!(bench.applied, [1.0, 0.0]);
    }

    #[test]
    fn a_limit_stops_and_says_so() {
        let limited = FollowingSettings {
            limits: [[0.5, 1.1], [-200.0, 200.0]],
            ..SETTINGS
        };
        let mut bench = Bench::new([1.5, 0.0], limited, 1);
        let mut said = None;
        for _ in 0..3600 {
            said = bench.next(|_| {}).held;
        }
        assert_eq!(said, Some(Held::FactorAtLimit(1.1)));
        // It stands still within a quarter of the half band.
        let [factor, _] = bench.follow.deviations();
        let short = 1.1 - bench.applied[0];
        assert!((0.0..=CALM * BAND * factor).contains(&short), "{:?}", bench.applied);
    }

    /// Whatever comes: limits and rates hold (checked in `Bench::next`), a sample that does not count moves nothing, and
    /// everything stays finite.
    #[test]
    fn any_sequence_of_bad_input_stays_within_limits_and_moves_nothing_itself() {
        const WRONG: [f64; 8] = [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            0.0,
            -1.0,
            1e300,
            -1e9,
            1e-300,
        ];
        // The twin's own figures are computed: they are wrong only where they are not numbers.
        const NO_NUMBER: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        for seed in 0..200 {
            let mut random = Random::new(1000 + seed);
            let truth = [1.0 + 0.3 * random.normal(), 20.0 * random.normal()];
            let mut bench = Bench::new(truth, SETTINGS, seed);
            let mut below = move |most: usize| (random.uniform() * most as f64) as usize;
            for _ in 0..1500 {
                let (kind, value, none) = (below(24), WRONG[below(WRONG.len())], NO_NUMBER[below(NO_NUMBER.len())]);
                let before = (bench.applied, bench.follow);
                let moved = bench.next(|instant| match kind {
                    0 => instant.measured = value,
                    1 => instant.predicted = none,
                    2 => instant.friction = none,
                    3 => instant.step = value,
                    4 => instant.applied = none,
                    5 => instant.good = false,
                    6 => instant.steady = false,
                    _ => {}
                });
                if let Some(Held::Frozen(why)) = moved.held {
                    assert_eq!((moved.to, bench.applied), (None, before.0), "{why:?}");
                    // An outlier widens the band only.
                    let same = (bench.follow.factor(), bench.follow.tare()) == (before.1.factor(), before.1.tare());
                    assert!(same, "{why:?}");
                }
                if (5..7).contains(&kind) {
                    assert!(matches!(moved.held, Some(Held::Frozen(_))));
                }
                let state = [bench.follow.factor(), bench.follow.tare()];
                for (k, [low, high]) in SETTINGS.limits.into_iter().enumerate() {
                    for value in [state[k], bench.applied[k]] {
                        assert!((low..=high).contains(&value), "{seed}: {state:?} {:?}", bench.applied);
                    }
                }
                assert!(bench.follow.deviations().iter().all(|deviation| deviation.is_finite()));
            }
        }
    }
}
