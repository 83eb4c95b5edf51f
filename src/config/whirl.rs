//! `whirl`: the analysis and its warnings.

use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::place::Mesh;
use crate::analysis::{Watched, WhirlSettings, WhirlThresholds};
use crate::inputs::units::{kn_to_n, rpm_to_rad_per_s};

/// Whirl analysis and warnings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Whirl {
    /// Length of the sliding window (s). Default 3: two turns at 40 r/min.
    pub window: f64,
    /// Samples of the motion per second (Hz). Default 200.
    pub sample_rate: f64,
    /// `joints`, `all` or `{stations: [5, 10]}`. Default joints, where contact is.
    pub watched: Watched,
    /// Below this rotary speed nothing is called whirl. Default 5.
    pub gate_speed_rpm: f64,
    /// RMS orbit radius over clearance below which nothing is called whirl. Default 0.1.
    pub min_orbit_ratio: f64,
    /// Below this certainty of direction a large orbit is called chaotic. Default 0.5.
    pub min_confidence: f64,
    /// A level is left below threshold x (1 - hysteresis). Default 0.1.
    pub hysteresis: f64,
    /// And after this long there (s). Default 5.
    pub hold_off: f64,
    /// When to watch.
    pub levels: Levels,
}

impl Default for Whirl {
    fn default() -> Self {
        Self {
            window: 3.0,
            sample_rate: 200.0,
            watched: Watched::Joints,
            gate_speed_rpm: 5.0,
            min_orbit_ratio: 0.1,
            min_confidence: 0.5,
            hysteresis: 0.1,
            hold_off: 5.0,
            levels: Levels::default(),
        }
    }
}

/// Thresholds of the three levels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Levels {
    /// Keep an eye on it.
    pub watch: Level,
    /// Act soon.
    pub warning: Level,
    /// Act now.
    pub critical: Level,
}

/// A level is reached when, for `duration`, there is whirl with both ratios exceeded, or the force is exceeded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// Largest distance from the gap's centre over the clearance.
    pub clearance_ratio: f64,
    /// Part of the window in contact, 0 to 1.
    pub contact_duty: f64,
    /// Peak normal contact force.
    pub force_kn: f64,
    /// s.
    pub duration: f64,
}

impl Default for Levels {
    fn default() -> Self {
        let level = |clearance_ratio, contact_duty, force_kn, duration| Level {
            clearance_ratio,
            contact_duty,
            force_kn,
            duration,
        };
        Self {
            watch: level(0.8, 0.1, 2.0, 1.0),
            warning: level(0.95, 0.4, 5.0, 2.0),
            critical: level(1.0, 0.7, 20.0, 2.0),
        }
    }
}

impl Whirl {
    pub(super) fn check(&self, c: &mut Checker, mesh: &Mesh) {
        let reason = "shorter than a tenth of a turn shows no direction; longer than a minute warns too late";
        c.number("window", self.window, Bound::within(0.1, 60.0), "s", reason);
        let reason = "an orbit needs some 20 samples per turn";
        c.number(
            "sample_rate",
            self.sample_rate,
            Bound::within(10.0, 10_000.0),
            "Hz",
            reason,
        );
        if let Watched::Stations(stations) = &self.watched {
            c.below("watched", |c| {
                c.require(!stations.is_empty(), "stations", "[]", "", "at least one station", "");
                c.below("stations", |c| {
                    for (index, station) in stations.iter().enumerate() {
                        let reason = "stations count from 0 at the top";
                        c.count(&index.to_string(), *station, 0, mesh.last_station(), reason);
                    }
                });
            });
        }
        let reason = "a tool that does not turn does not whirl";
        c.number(
            "gate_speed_rpm",
            self.gate_speed_rpm,
            Bound::within(0.0, 1000.0),
            "r/min",
            reason,
        );
        let reason = "a ratio; 1 fills the gap";
        c.number(
            "min_orbit_ratio",
            self.min_orbit_ratio,
            Bound::within(0.0, 1.0),
            "",
            reason,
        );
        c.number(
            "min_confidence",
            self.min_confidence,
            Bound::within(0.0, 1.0),
            "",
            "0 to 1",
        );
        let reason = "at 1 a level would never be left";
        c.number("hysteresis", self.hysteresis, Bound::within(0.0, 0.9), "", reason);
        c.number("hold_off", self.hold_off, Bound::within(0.0, 3600.0), "s", "an hour");
        c.below("levels", |c| self.levels.check(c));
    }

    pub(super) fn describe(&self) -> WhirlSettings {
        WhirlSettings {
            window: self.window,
            sample_rate: self.sample_rate,
            watched: self.watched.clone(),
            gate_speed: rpm_to_rad_per_s(self.gate_speed_rpm),
            min_orbit_ratio: self.min_orbit_ratio,
            min_confidence: self.min_confidence,
            hysteresis: self.hysteresis,
            hold_off: self.hold_off,
            watch: self.levels.watch.describe(),
            warning: self.levels.warning.describe(),
            critical: self.levels.critical.describe(),
        }
    }
}

impl Levels {
    fn check(&self, c: &mut Checker) {
        for (key, level) in [
            ("watch", &self.watch),
            ("warning", &self.warning),
            ("critical", &self.critical),
        ] {
            c.below(key, |c| level.check(c));
        }
        for (key, lower, higher) in [
            ("warning", &self.watch, &self.warning),
            ("critical", &self.warning, &self.critical),
        ] {
            c.below(key, |c| {
                for (name, low, high, unit) in [
                    ("clearance_ratio", lower.clearance_ratio, higher.clearance_ratio, ""),
                    ("contact_duty", lower.contact_duty, higher.contact_duty, ""),
                    ("force_kn", lower.force_kn, higher.force_kn, "kN"),
                ] {
                    let bound = format!("at least that of the level below, {low}");
                    c.require(!(high < low), name, high, unit, bound, "levels rise");
                }
            });
        }
    }
}

impl Level {
    fn check(&self, c: &mut Checker) {
        let reason = "above 1 is penetration";
        c.number(
            "clearance_ratio",
            self.clearance_ratio,
            Bound::within(0.0, 2.0),
            "",
            reason,
        );
        c.number(
            "contact_duty",
            self.contact_duty,
            Bound::within(0.0, 1.0),
            "",
            "a part of the window",
        );
        let reason = "0 would always warn";
        c.number("force_kn", self.force_kn, Bound::above(0.0, 1e4), "kN", reason);
        c.number(
            "duration",
            self.duration,
            Bound::within(0.0, 600.0),
            "s",
            "longer would warn too late",
        );
    }

    fn describe(&self) -> WhirlThresholds {
        WhirlThresholds {
            clearance_ratio: self.clearance_ratio,
            contact_duty: self.contact_duty,
            force: kn_to_n(self.force_kn),
            duration: self.duration,
        }
    }
}
