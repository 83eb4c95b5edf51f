//! The comparison of rig and twin while drilling, once per second.
//!
//! Residuals are judged in steady motion only: after a change of speed or weight the string winds up and the auto-driller
//! settles, and a difference then says nothing. The estimate of friction and tare ([`crate::follow`]) is kept all the
//! time and enters the prediction only where the configuration lets it follow.

use crate::follow::{Follow, FollowSettings, Frozen, Instant};
use crate::residual::{Cause, Expected, Residual, Watch, causes};

/// How rig and twin are compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonitorSettings {
    /// What is expected of the residual of the surface torque.
    pub torque: Expected,
    /// The same of the hook load.
    pub hook_load: Expected,
    /// Time of the sliding means (s).
    pub mean: f64,
    /// Time after a change in which nothing is judged (s).
    pub settle: f64,
    /// Largest deviation of the speed from its mean since the last change (rad/s).
    pub speed_band: f64,
    /// The same of the weight (N), and as a share of it; the larger one counts.
    pub weight_band: (f64, f64),
    /// Weight below which the bit counts as off bottom (N).
    pub off_bottom: f64,
    /// Speed below which nothing is judged (rad/s).
    pub standing: f64,
    /// The recursive estimate.
    pub follow: FollowSettings,
    /// Whether the prediction follows it.
    pub follows: bool,
    /// Tare of the torque's sensor at the beginning (N m).
    pub torque_tare: f64,
    /// Tare of the hook load's sensor (N).
    pub hook_load_tare: f64,
}

impl Default for MonitorSettings {
    fn default() -> Self {
        let follow = FollowSettings::default();
        Self {
            torque: Expected {
                noise: follow.noise,
                model: follow.model,
                // Ripple of a steady mean.
                least: 3.0,
            },
            hook_load: Expected {
                noise: 2e3,
                model: 0.02,
                least: 1e3,
            },
            mean: 20.0,
            settle: 15.0,
            speed_band: 0.21,
            weight_band: (1.0e3, 0.15),
            off_bottom: 1.0e3,
            standing: 0.52,
            follow,
            follows: false,
            torque_tare: 0.0,
            hook_load_tare: 0.0,
        }
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
    /// Measured surface torque (N m).
    pub torque: f64,
    /// Measured hook load (N).
    pub hook_load: f64,
    /// The twin's surface torque (N m).
    pub predicted_torque: f64,
    /// The part of it that friction takes (N m).
    pub friction_torque: f64,
    /// The twin's hook load (N).
    pub predicted_hook_load: f64,
}

/// What the comparison says.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Residual of the surface torque; `None` while nothing can be judged.
    pub torque: Option<Residual>,
    /// Residual of the hook load.
    pub hook_load: Option<Residual>,
    /// Whether the bit drills.
    pub drilling: bool,
    /// Why the estimate did not move; `None` where it did.
    pub frozen: Option<Frozen>,
    /// Likely causes where a residual is beyond its band.
    pub causes: Vec<Cause>,
}

impl Compared {
    /// The largest residual over its band.
    pub fn ratio(&self) -> f64 {
        [self.torque, self.hook_load]
            .into_iter()
            .flatten()
            .map(|residual| residual.ratio().abs())
            .fold(0.0, f64::max)
    }
}

/// The comparison. It is a function of its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Monitor {
    settings: MonitorSettings,
    follow: Follow,
    torque: Watch,
    hook_load: Watch,
    /// Means of speed and weight since the last change, and the time since then (s).
    steady: Option<([f64; 2], f64)>,
}

impl Monitor {
    /// A comparison that knows nothing yet.
    pub fn new(settings: MonitorSettings) -> Self {
        Self {
            follow: Follow::new(settings.follow, settings.torque_tare),
            torque: Watch::new(settings.mean),
            hook_load: Watch::new(settings.mean),
            steady: None,
            settings,
        }
    }

    /// The estimate of friction and tare.
    pub fn follow(&self) -> &Follow {
        &self.follow
    }

    /// Takes a reading.
    pub fn push(&mut self, reading: &Reading) -> Compared {
        let steady = self.is_steady(reading);
        let instant = Instant {
            step: reading.step,
            measured: reading.torque,
            predicted: reading.predicted_torque,
            friction: reading.friction_torque,
            steady,
        };
        // The prediction is made before the sample is learned.
        let expected = if self.settings.follows {
            self.follow.expected(&instant)
        } else {
            reading.predicted_torque + self.settings.torque_tare
        };
        let frozen = self.follow.push(&instant);
        if steady {
            self.torque.push(reading.step, reading.torque, expected);
            let hook_load = reading.predicted_hook_load + self.settings.hook_load_tare;
            self.hook_load.push(reading.step, reading.hook_load, hook_load);
        } else {
            self.torque.reset();
            self.hook_load.reset();
        }
        let torque = self.torque.residual(&self.settings.torque);
        let hook_load = self.hook_load.residual(&self.settings.hook_load);
        let drilling = reading.weight >= self.settings.off_bottom;
        Compared {
            causes: causes(torque.map(|r| r.ratio()), hook_load.map(|r| r.ratio()), drilling),
            torque,
            hook_load,
            drilling,
            frozen,
        }
    }

    /// Whether speed and weight have stayed within their bands for the settling time.
    fn is_steady(&mut self, reading: &Reading) -> bool {
        let s = &self.settings;
        let numbers = [reading.step, reading.rotary_speed, reading.weight];
        let turns = reading.rotary_speed.abs() >= s.standing;
        if !reading.good || !turns || reading.step <= 0.0 || numbers.iter().any(|value| !value.is_finite()) {
            self.steady = None;
            return false;
        }
        let now = [reading.rotary_speed, reading.weight];
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
                (
                    [toward(means[0], now[0]), toward(means[1], now[1])],
                    time + reading.step,
                )
            }
            _ => (now, 0.0),
        };
        self.steady = Some((means, time));
        time >= s.settle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reading(torque: f64, predicted: f64) -> Reading {
        Reading {
            step: 1.0,
            rotary_speed: 4.2,
            weight: 12e3,
            good: true,
            torque,
            hook_load: f64::NAN,
            predicted_torque: predicted,
            friction_torque: 30.0,
            predicted_hook_load: 160e3,
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
            let since = second % 100;
            // From 15 s on samples count, and with 19 of them the mean is filled to 0.6.
            assert_eq!(compared.torque.is_some(), since >= 33, "{second}: {compared:?}");
            assert_eq!(compared.hook_load, None);
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
            assert_eq!(monitor.push(&bad).torque, None, "{bad:?}");
        }
    }

    #[test]
    fn the_prediction_follows_only_where_it_may() {
        for follows in [false, true] {
            let settings = MonitorSettings {
                follows,
                ..MonitorSettings::default()
            };
            let mut monitor = Monitor::new(settings);
            let mut last = None;
            // The sensor is 20 N m off.
            for _ in 0..3600 {
                last = monitor.push(&reading(320.0, 300.0)).torque;
            }
            let difference = last.unwrap().difference();
            assert_eq!(difference.abs() < 5.0, follows, "{difference}");
            assert!(monitor.follow().tare() > 5.0, "the estimate is kept in both cases");
        }
    }
}
