//! Load of parts of the tool relative to their rating, as a mean over a short interval: the moment that bends each element
//! of a preloaded guide, or the effective compression of each element of a pipe under pressure.

use serde::{Deserialize, Serialize};

use super::Severity;
use super::hazards::Hold;
use super::hysteresis::{Alarm, AlarmThresholds};

/// How a load is judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LoadSettings {
    /// Load (N or N m) that a part may carry permanently.
    pub rating: f64,
    /// Interval of the mean (s).
    pub interval: f64,
    /// Levels of the mean load over `rating`.
    pub thresholds: AlarmThresholds,
}

/// Level of a load.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct LoadLevel {
    /// Level.
    pub severity: Severity,
    /// Part with the largest mean load, from the top: since the level was reached, or in the last interval while the level
    /// is OK.
    pub part: usize,
    /// That load over the rating.
    pub ratio: f64,
    /// Model time at which the level was reached (s).
    pub since: f64,
    /// Model time of that load (s).
    pub seen: f64,
    /// Whether the condition of the level is met.
    pub hold: Hold,
}

/// Watches the load of all parts. After its construction it does not allocate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LoadWatch {
    settings: LoadSettings,
    /// Integral of each part's load in the interval.
    integrals: Vec<f64>,
    elapsed: f64,
    alarm: Alarm,
    level: LoadLevel,
}

impl LoadWatch {
    /// A watch of `parts`.
    pub fn new(settings: &LoadSettings, parts: usize) -> Self {
        Self {
            settings: *settings,
            integrals: vec![0.0; parts],
            elapsed: 0.0,
            alarm: Alarm::default(),
            level: LoadLevel::default(),
        }
    }

    /// Takes the loads (N or N m, in the order of the parts) over `dt` (s) until model time `time` (s). While the drive does
    /// not turn steadily (`judged` is false), no level rises.
    pub fn push(&mut self, time: f64, dt: f64, loads: impl IntoIterator<Item = f64>, judged: bool) {
        for (integral, load) in self.integrals.iter_mut().zip(loads) {
            *integral += load * dt;
        }
        self.advance(time, dt, judged);
    }

    /// Takes the load (N or N m) of one part over `dt` (s).
    pub fn add(&mut self, part: usize, dt: f64, load: f64) {
        self.integrals[part] += load * dt;
    }

    /// Ends `dt` (s) at model time `time` (s), with the loads of [`LoadWatch::add`]. While the drive does not turn steadily
    /// (`judged` is false), no level rises.
    pub fn advance(&mut self, time: f64, dt: f64, judged: bool) {
        self.elapsed += dt;
        if self.elapsed + 0.5 * dt < self.settings.interval {
            return;
        }
        let mut worst = (0.0, 0);
        for (part, integral) in self.integrals.iter_mut().enumerate() {
            if *integral > worst.0 {
                worst = (*integral, part);
            }
            *integral = 0.0;
        }
        let ratio = worst.0 / self.elapsed / self.settings.rating;
        let value = if judged { ratio } else { 0.0 };
        self.alarm.update(time, self.elapsed, value, &self.settings.thresholds);
        self.elapsed = 0.0;
        let now = self.alarm.severity();
        if now == Severity::Ok || self.alarm.worst_at() == time {
            (self.level.ratio, self.level.part, self.level.seen) = (ratio, worst.1, time);
        }
        (self.level.severity, self.level.since) = (now, self.alarm.since());
        self.level.hold = self.alarm.hold(time);
    }

    /// The level of the load.
    pub fn level(&self) -> LoadLevel {
        self.level
    }

    /// The thresholds in use.
    pub fn settings(&self) -> &LoadSettings {
        &self.settings
    }

    /// Forgets everything but the settings.
    pub fn reset(&mut self) {
        self.integrals.fill(0.0);
        self.elapsed = 0.0;
        self.alarm = Alarm::default();
        self.level = LoadLevel::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_the_worst_part_is_judged_while_the_drive_turns() {
        let settings = LoadSettings {
            rating: 10e3,
            interval: 0.5,
            thresholds: AlarmThresholds {
                levels: [0.8, 1.0, 1.5],
                hysteresis: 0.1,
                hold_off: 5.0,
            },
        };
        let mut watch = LoadWatch::new(&settings, 3);
        let mut run = |from: u32, judged: bool| {
            for step in from..from + 500 {
                // The second part swings about 11 kN, the third stays at 9 kN.
                let swing = 11e3 + 4e3 * f64::from(1 - 2 * (step as i32 % 2));
                watch.push(f64::from(step) * 4e-3, 4e-3, [0.0, swing, 9e3], judged);
            }
            watch.level()
        };
        assert_eq!(run(0, false).severity, Severity::Ok);
        let level = run(500, true);
        assert_eq!((level.severity, level.part), (Severity::Warning, 1));
        assert!((level.ratio - 1.1).abs() < 0.01, "{level:?}");
    }
}
