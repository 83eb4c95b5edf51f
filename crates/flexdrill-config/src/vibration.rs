//! `stick_slip` and `shock`: levels of the bit's speed ripple and of collisions.

use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use flexdrill_core::motion::{AlarmThresholds, ShockSettings, StickSlipSettings};
use flexdrill_core::units::{rad_per_s_to_rpm, rpm_to_rad_per_s};

/// Stick-slip of the bit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StickSlip {
    /// Window of the index (s). Default 3: two turns at 40 r/min.
    pub window: f64,
    /// Speed of the drive below which the index is 0. Default 10: a quarter of 40 r/min.
    pub gate_speed_rpm: f64,
    /// A level is left below threshold x (1 - hysteresis). Default 0.15.
    pub hysteresis: f64,
    /// And after this long there (s). Default 5.
    pub hold_off: f64,
    /// Index, (max - min) / (2 mean), from which to watch, warn and call critical. Default 0.5, 0.8, 1.
    pub levels: Steps,
}

/// Lateral shock.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Shock {
    /// Interval over which the force is summed up (s). Default 0.02.
    pub interval: f64,
    /// Time over which the resting force is averaged (s). Default 0.1.
    pub mean_time: f64,
    /// A level is left below threshold x (1 - hysteresis). Default 0.15.
    pub hysteresis: f64,
    /// And after this long there (s). Default 5.
    pub hold_off: f64,
    /// Impulse above the resting force (N s) from which to watch, warn and call critical. Default 5, 15, 45.
    pub levels: Steps,
}

/// Thresholds of three levels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Steps {
    /// Keep an eye on it.
    pub watch: f64,
    /// Act soon.
    pub warning: f64,
    /// Act now.
    pub critical: f64,
}

impl Default for StickSlip {
    fn default() -> Self {
        let settings = StickSlipSettings::default();
        Self {
            window: settings.window,
            // Back from rad/s, without the conversion's last digit.
            gate_speed_rpm: rad_per_s_to_rpm(settings.gate_speed).round(),
            hysteresis: settings.thresholds.hysteresis,
            hold_off: settings.thresholds.hold_off,
            levels: Steps::of(&settings.thresholds),
        }
    }
}

impl Default for Shock {
    fn default() -> Self {
        let settings = ShockSettings::default();
        Self {
            interval: settings.interval,
            mean_time: settings.mean_time,
            hysteresis: settings.thresholds.hysteresis,
            hold_off: settings.thresholds.hold_off,
            levels: Steps::of(&settings.thresholds),
        }
    }
}

impl Steps {
    fn of(thresholds: &AlarmThresholds) -> Self {
        let [watch, warning, critical] = thresholds.levels;
        Self {
            watch,
            warning,
            critical,
        }
    }

    fn check(&self, c: &mut Checker, most: f64, unit: &'static str) {
        let keys = [
            ("watch", self.watch),
            ("warning", self.warning),
            ("critical", self.critical),
        ];
        for (key, value) in keys {
            c.number(key, value, Bound::above(0.0, most), unit, "0 would always be reached");
        }
        for pair in keys.windows(2) {
            let (low, (key, high)) = (pair[0].1, pair[1]);
            let bound = format!("at least that of the level below, {low}");
            c.require(low <= high || high.is_nan(), key, high, unit, bound, "levels rise");
        }
    }
}

fn check_held(c: &mut Checker, hysteresis: f64, hold_off: f64) {
    let reason = "at 1 a level would never be left";
    c.number("hysteresis", hysteresis, Bound::within(0.0, 0.9), "", reason);
    c.number("hold_off", hold_off, Bound::within(0.0, 3600.0), "s", "an hour");
}

impl StickSlip {
    pub(super) fn check(&self, c: &mut Checker) {
        let reason = "must hold a period of the ripple; longer than a minute warns too late";
        c.number("window", self.window, Bound::within(0.1, 60.0), "s", reason);
        let reason = "near standstill the quotient means nothing";
        c.number(
            "gate_speed_rpm",
            self.gate_speed_rpm,
            Bound::within(0.0, 1000.0),
            "r/min",
            reason,
        );
        check_held(c, self.hysteresis, self.hold_off);
        c.below("levels", |c| self.levels.check(c, 100.0, ""));
    }

    pub(super) fn describe(&self) -> StickSlipSettings {
        StickSlipSettings {
            window: self.window,
            gate_speed: rpm_to_rad_per_s(self.gate_speed_rpm),
            thresholds: AlarmThresholds {
                levels: [self.levels.watch, self.levels.warning, self.levels.critical],
                hysteresis: self.hysteresis,
                hold_off: self.hold_off,
            },
        }
    }
}

impl Shock {
    pub(super) fn check(&self, c: &mut Checker) {
        let reason = "longer than a collision of some ms, shorter than a turn of a whirl";
        c.number("interval", self.interval, Bound::within(1e-3, 0.5), "s", reason);
        let reason = "several intervals; longer than a second takes a new load for a shock";
        c.number("mean_time", self.mean_time, Bound::within(2e-3, 10.0), "s", reason);
        check_held(c, self.hysteresis, self.hold_off);
        c.below("levels", |c| self.levels.check(c, 1e6, "N s"));
    }

    pub(super) fn describe(&self) -> ShockSettings {
        ShockSettings {
            interval: self.interval,
            mean_time: self.mean_time,
            thresholds: AlarmThresholds {
                levels: [self.levels.watch, self.levels.warning, self.levels.critical],
                hysteresis: self.hysteresis,
                hold_off: self.hold_off,
            },
        }
    }
}
