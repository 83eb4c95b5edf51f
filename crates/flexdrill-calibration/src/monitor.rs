//! The comparison of rig and twin while drilling, once per second.
//!
//! Residuals are judged in steady motion only: after a change of speed or weight the string winds up and the auto-driller
//! settles, and a difference then says nothing.

use std::collections::VecDeque;

use crate::residual::{Cause, Expected, Residual, RigQuantity, Watch, causes};

/// Readings whose median is judged: a weight that is derived from a hook load scatters by kilonewtons.
const MEDIAN: usize = 5;

/// Levels of [`Residual::limit`] from which rig and twin disagree, a little and much. A twin whose error is as stated
/// reaches 1.5 at 1.4 % of all loads, and 3 at none.
pub const LEVELS: [f64; 2] = [1.5, 3.0];

/// How rig and twin are compared. Arrays are in the order of [`RigQuantity::ALL`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonitorSettings {
    /// What is expected of each residual.
    pub expected: [Expected; RigQuantity::COUNT],
    /// Offset of each sensor: what it shows where the quantity is 0.
    pub tare: [f64; RigQuantity::COUNT],
    /// Age of the newest sample (s) beyond which a quantity counts as not measured.
    pub longest_age: [f64; RigQuantity::COUNT],
    /// Time of the sliding means (s).
    pub mean: f64,
    /// Time after a change in which nothing is judged (s).
    pub settle: f64,
    /// Largest deviation of the speed from its sliding mean (rad/s).
    pub speed_band: f64,
    /// The same of the weight (N), and as a share of it; the larger one counts.
    pub weight_band: (f64, f64),
    /// Weight below which the bit counts as off bottom (N).
    pub off_bottom: f64,
    /// Speed below which nothing is judged (rad/s): friction may then point in any direction.
    pub standing: f64,
}

impl Default for MonitorSettings {
    /// Noise and drift as in the figures of `docs/calibration.md`. `least` is the ripple of a settled mean of the twin.
    fn default() -> Self {
        let expected = |noise, model, least, drift| Expected {
            noise,
            model,
            least,
            drift,
        };
        Self {
            expected: [
                expected(15.0, 0.05, 3.0, 5.0),
                expected(2e3, 0.02, 1e3, 1e3),
                expected(0.3, 0.01, 0.05, 0.0),
                expected(10.0, 0.05, 3.0, 0.0),
                expected(400.0, 0.05, 200.0, 0.0),
            ],
            tare: [0.0; RigQuantity::COUNT],
            // A tool in the hole sends a word every half minute, by pulses in the mud.
            longest_age: [5.0, 5.0, 60.0, 60.0, 60.0],
            mean: 20.0,
            settle: 15.0,
            speed_band: 0.21,
            weight_band: (1.0e3, 0.15),
            off_bottom: 1.0e3,
            standing: 0.52,
        }
    }
}

/// Errors of sensors and twin, as a configuration states them (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stated {
    /// Standard deviation of a sample, in the order of [`RigQuantity::ALL`].
    pub noise: [f64; RigQuantity::COUNT],
    /// Offset of each sensor.
    pub tare: [f64; RigQuantity::COUNT],
    /// Drift of that offset after an hour, standard deviation.
    pub drift: [f64; RigQuantity::COUNT],
    /// Error of the twin as a share.
    pub model: f64,
}

impl MonitorSettings {
    /// A comparison with stated errors.
    pub fn stated(stated: &Stated) -> Self {
        let mut settings = Self {
            tare: stated.tare,
            ..Self::default()
        };
        for quantity in RigQuantity::ALL {
            let expected = &mut settings.expected[quantity as usize];
            expected.noise = stated.noise[quantity as usize];
            expected.drift = stated.drift[quantity as usize];
            // In steady motion all of the tool turns at the speed of the drive, whatever the model.
            if quantity != RigQuantity::DownholeSpeed {
                expected.model = stated.model;
            }
        }
        settings
    }
}

/// What is known at an instant. NaN where nothing is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Time since the reading before (s).
    pub step: f64,
    /// Applied speed of the drive (rad/s).
    pub rotary_speed: f64,
    /// Applied weight at the surface (N).
    pub weight: f64,
    /// Whether all inputs are fresh and good.
    pub good: bool,
    /// What was measured since the reading before.
    pub measured: [f64; RigQuantity::COUNT],
    /// What the twin computes.
    pub predicted: [f64; RigQuantity::COUNT],
}

/// What the comparison says.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Per quantity, in the order of [`RigQuantity::ALL`]; `None` while it cannot be judged.
    pub residuals: [Option<Residual>; RigQuantity::COUNT],
    /// Speed and weight have been steady for the settling time.
    pub steady: bool,
    /// Whether the bit drills.
    pub drilling: bool,
    /// Likely causes where a residual is surely beyond its band, the likeliest first.
    pub causes: Vec<Cause>,
}

impl Compared {
    /// The quantity that is farthest from what is expected, against its limit; `None` while none can be judged.
    pub fn worst(&self) -> Option<(RigQuantity, Residual)> {
        RigQuantity::ALL
            .into_iter()
            .filter_map(|quantity| Some((quantity, self.residuals[quantity as usize]?)))
            .max_by(|a, b| against_limit(&a.1).abs().total_cmp(&against_limit(&b.1).abs()))
    }
}

/// Difference over what is surely beyond the band of the twin's error.
fn against_limit(residual: &Residual) -> f64 {
    residual.difference() / residual.limit(1.0)
}

/// The comparison. It is a function of its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Monitor {
    settings: MonitorSettings,
    watches: [Watch; RigQuantity::COUNT],
    /// The newest speeds (rad/s) and weights (N), the newest last.
    newest: VecDeque<[f64; 2]>,
    /// Time of all readings (s).
    time: f64,
    /// Means of speed and weight since the last change, and the time since then (s).
    steady: Option<([f64; 2], f64)>,
}

impl Monitor {
    /// A comparison that knows nothing yet.
    pub fn new(settings: MonitorSettings) -> Self {
        Self {
            watches: [Watch::new(settings.mean); RigQuantity::COUNT],
            newest: VecDeque::with_capacity(MEDIAN),
            time: 0.0,
            steady: None,
            settings,
        }
    }

    /// Replaces the offsets of the sensors from the next reading on.
    pub fn set_tare(&mut self, tare: [f64; RigQuantity::COUNT]) {
        self.settings.tare = tare;
    }

    /// Takes a reading.
    pub fn push(&mut self, reading: &Reading) -> Compared {
        let steady = self.is_steady(reading);
        if reading.step > 0.0 {
            self.time += reading.step;
        }
        let hours = self.time / 3600.0;
        let s = &self.settings;
        for (index, watch) in self.watches.iter_mut().enumerate() {
            if steady {
                let expected = reading.predicted[index] + s.tare[index];
                watch.push(reading.step, reading.measured[index], expected);
            } else {
                watch.reset();
            }
        }
        let residual = |quantity: RigQuantity| {
            let index = quantity as usize;
            self.watches[index].residual(&s.expected[index], s.longest_age[index], hours)
        };
        let residuals = RigQuantity::ALL.map(residual);
        let drilling = reading.weight >= s.off_bottom;
        let ratios = residuals
            .each_ref()
            .map(|residual| residual.as_ref().map(against_limit));
        Compared {
            causes: causes(&ratios, drilling),
            residuals,
            steady,
            drilling,
        }
    }

    /// Whether speed and weight have stayed within their bands for the settling time.
    fn is_steady(&mut self, reading: &Reading) -> bool {
        let s = &self.settings;
        let numbers = [reading.step, reading.rotary_speed, reading.weight];
        let turns = reading.rotary_speed.abs() >= s.standing;
        if !reading.good || !turns || reading.step <= 0.0 || numbers.iter().any(|value| !value.is_finite()) {
            self.steady = None;
            self.newest.clear();
            return false;
        }
        if self.newest.len() == MEDIAN {
            self.newest.pop_front();
        }
        self.newest.push_back([reading.rotary_speed, reading.weight]);
        let now = [0, 1].map(|which| median(self.newest.iter().map(|values| values[which])));
        let drills = |weight: f64| weight >= s.off_bottom;
        let (means, time) = match self.steady {
            Some((means, time))
                if (now[0] - means[0]).abs() <= s.speed_band
                    && (now[1] - means[1]).abs() <= s.weight_band.0.max(s.weight_band.1 * means[1].abs())
                    && drills(now[1]) == drills(means[1]) =>
            {
                // A mean over the sliding time, so that a slow change does not count from its beginning.
                let share = (reading.step / s.mean).min(1.0);
                let toward = |mean: f64, now: f64| mean + share * (now - mean);
                let means = [toward(means[0], now[0]), toward(means[1], now[1])];
                (means, time + reading.step)
            }
            _ => (now, 0.0),
        };
        self.steady = Some((means, time));
        time >= s.settle
    }
}

/// The median of some finite values; the lower one of two.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[(values.len() - 1) / 2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    const TORQUE: usize = RigQuantity::SurfaceTorque as usize;

    fn reading(torque: f64, predicted: f64) -> Reading {
        let mut measured = [f64::NAN; RigQuantity::COUNT];
        measured[TORQUE] = torque;
        Reading {
            step: 1.0,
            rotary_speed: 4.2,
            weight: 12e3,
            good: true,
            measured,
            predicted: [predicted, 160e3, 4.2, 200.0, 11e3],
        }
    }

    #[test]
    fn only_steady_motion_is_judged_and_a_change_begins_again() {
        let mut monitor = Monitor::new(MonitorSettings::default());
        for second in 0..200 {
            let mut now = reading(400.0, 300.0);
            if second >= 100 {
                now.weight = 18e3;
            }
            let compared = monitor.push(&now);
            // The median of five follows a step two readings later. From 15 s on samples count, and with 19 of them the
            // mean is filled to 0.6.
            let since = if second < 102 { second } else { second - 102 };
            assert_eq!(
                compared.residuals[TORQUE].is_some(),
                since >= 33,
                "{second}: {compared:?}"
            );
            assert_eq!(compared.steady, since >= 15, "{second}");
            assert_eq!(
                compared.worst().map(|(quantity, _)| quantity as usize),
                (since >= 33).then_some(TORQUE)
            );
            assert_eq!(compared.causes.is_empty(), since < 33);
        }
        for bad in [
            Reading {
                good: false,
                ..reading(400.0, 300.0)
            },
            Reading {
                rotary_speed: 0.0,
                ..reading(400.0, 300.0)
            },
            Reading {
                weight: f64::NAN,
                ..reading(400.0, 300.0)
            },
        ] {
            let mut monitor = monitor.clone();
            assert_eq!(monitor.push(&bad).worst(), None, "{bad:?}");
            assert_eq!(monitor.push(&reading(400.0, 300.0)).worst(), None, "it begins again");
        }
    }

    #[test]
    fn a_weight_that_scatters_is_steady_and_its_tare_is_expected() {
        let mut random = Random::new(2);
        let mut settings = MonitorSettings::default();
        settings.tare[TORQUE] = 20.0;
        let mut monitor = Monitor::new(settings);
        let mut judged = 0;
        for _ in 0..1000 {
            let mut now = reading(320.0, 300.0);
            // A twelfth of the weight: the median of five scatters by half of it, well within 15 %.
            now.weight = 12e3 + 1e3 * random.normal();
            if let Some((_, residual)) = monitor.push(&now).worst() {
                judged += 1;
                assert!(residual.difference().abs() < 1e-9, "{residual:?}");
            }
        }
        assert!(judged > 900, "{judged}");
    }
}
