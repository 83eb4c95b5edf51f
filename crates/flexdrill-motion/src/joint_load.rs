//! Load of the joints' stops relative to the joints' rating.
//!
//! The judged moment is the mean over a short interval. The peak of a striking stop depends on its stiffness, which is
//! a penalty; the mean, like an impulse, does not.

use serde::{Deserialize, Serialize};

use super::Severity;
use super::hazards::Hold;
use super::hysteresis::AlarmThresholds;
use super::load_watch::{LoadSettings, LoadWatch};

/// How the stops are judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct JointLoadSettings {
    /// Moment (N m) that the stop of a joint may carry permanently.
    pub rated_moment: f64,
    /// Interval of the mean (s), equal to that of shock.
    pub interval: f64,
    /// Levels of the mean moment over `rated_moment`.
    pub thresholds: AlarmThresholds,
}

impl Default for JointLoadSettings {
    fn default() -> Self {
        Self {
            rated_moment: 100.0,
            interval: 0.02,
            thresholds: AlarmThresholds {
                levels: [0.8, 1.0, 1.5],
                hysteresis: 0.15,
                hold_off: 5.0,
            },
        }
    }
}

/// Level of the joints' stops.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JointLoadLevel {
    /// Level.
    pub severity: Severity,
    /// Joint with the largest mean moment, from the top: since the level was reached, or in the last interval while the
    /// level is OK.
    pub joint: usize,
    /// That moment over the rating.
    pub ratio: f64,
    /// Model time at which the level was reached (s).
    pub since: f64,
    /// Model time of that moment (s).
    pub seen: f64,
    /// Whether the condition of the level is met.
    pub hold: Hold,
}

/// Watches the stops of all joints: a load of a part, which is judged as every other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointLoadWatch(LoadWatch);

impl JointLoadWatch {
    /// A watch of `joints` joints.
    pub fn new(settings: &JointLoadSettings, joints: usize) -> Self {
        let settings = LoadSettings {
            rating: settings.rated_moment,
            interval: settings.interval,
            thresholds: settings.thresholds,
        };
        Self(LoadWatch::new(&settings, joints))
    }

    /// Takes the moment (N m) of a joint's stop over a step of `dt` (s).
    pub fn push(&mut self, joint: usize, dt: f64, moment: f64) {
        self.0.add(joint, dt, moment);
    }

    /// Ends a step of `dt` (s) at model time `time` (s). While the drive does not turn steadily, no level rises.
    pub fn advance(&mut self, time: f64, dt: f64, judged: bool) {
        self.0.advance(time, dt, judged);
    }

    /// The level of the joints' stops.
    pub fn level(&self) -> JointLoadLevel {
        let level = self.0.level();
        JointLoadLevel {
            severity: level.severity,
            joint: level.part,
            ratio: level.ratio,
            since: level.since,
            seen: level.seen,
            hold: level.hold,
        }
    }

    /// The thresholds in use.
    pub fn settings(&self) -> &LoadSettings {
        self.0.settings()
    }

    /// Forgets everything but the settings.
    pub fn reset(&mut self) {
        self.0.reset();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stop that strikes for `part` of each interval of 20 ms with the same angular impulse.
    fn run(part: f64, mean: f64) -> JointLoadLevel {
        let mut watch = JointLoadWatch::new(&JointLoadSettings::default(), 3);
        for step in 0..2000 {
            let struck = f64::from(step % 40) < 40.0 * part;
            watch.push(1, 5e-4, if struck { mean / part } else { 0.0 });
            watch.advance(f64::from(step) * 5e-4, 5e-4, true);
        }
        watch.level()
    }

    #[test]
    fn a_hard_stop_counts_as_a_soft_one() {
        for part in [1.0, 0.5, 0.1] {
            let level = run(part, 110.0);
            assert_eq!((level.severity, level.joint), (Severity::Warning, 1));
            assert!((level.ratio - 1.1).abs() < 1e-9, "{level:?}");
        }
        assert_eq!(run(0.1, 60.0).severity, Severity::Ok);
    }

    #[test]
    fn nothing_rises_while_the_tool_is_run_up() {
        let mut watch = JointLoadWatch::new(&JointLoadSettings::default(), 1);
        for step in 0..1000 {
            watch.push(0, 1e-3, 500.0);
            watch.advance(f64::from(step) * 1e-3, 1e-3, false);
        }
        assert_eq!(watch.level().severity, Severity::Ok);
        assert!((watch.level().ratio - 5.0).abs() < 1e-9);
    }
}
