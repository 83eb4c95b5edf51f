//! `whirl`: the analysis and its warnings.

use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::place::Mesh;
use flexdrill_core::motion::{self, LevelThresholds, Severity, WhirlSettings};
use flexdrill_core::tool::Body;
use flexdrill_core::units::{kn_to_n, n_to_kn, rpm_to_rad_per_s};

/// Whirl analysis and warnings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Whirl {
    /// Length of the sliding window in turns of the tool. Default 4.
    pub window_turns: f64,
    /// Longest window, for a slow or standing tool (s). Default 6: four turns at 40 r/min.
    pub max_window: f64,
    /// Samples of the motion per second (Hz). Default 250.
    pub sample_rate: f64,
    /// `joints`, `all` or `{stations: [5, 10]}`. Default joints, where contact is.
    pub watched: Watched,
    /// Below this rotary speed the tool counts as standing and no ratio is given. Default 5.
    pub gate_speed_rpm: f64,
    /// RMS orbit radius over clearance below which nothing is called whirl. Default 0.1.
    pub min_orbit_ratio: f64,
    /// Part of direction, 0 to 1, from which an orbit is forward or backward and below which it is chaotic. Default 0.6.
    pub steady_direction: f64,
    /// Correlation, 0 to 1, from which a motion without direction counts as the same again, turn by turn, and is not
    /// chaotic. Default 0.8.
    pub min_repetition: f64,
    /// Relative difference to the rate of rolling without slip within which backward whirl counts as rolling. Default 0.15.
    pub rolling_tolerance: f64,
    /// Factors on the confidence while an input is not as it should be.
    pub input_trust: InputTrust,
    /// Below this confidence nothing raises a level. Default 0.5.
    pub min_confidence: f64,
    /// A level is left below threshold x (1 - hysteresis). Default 0.15.
    pub hysteresis: f64,
    /// And after this long there (s). Default 5.
    pub hold_off: f64,
    /// Time for which `critical` stands at least (s). Default 30.
    pub latch: f64,
    /// Highest level of forward whirl: ok, watch, warning or critical. Default warning.
    pub forward_limit: Severity,
    /// When to watch, warn and call critical.
    pub levels: Levels,
}

impl Default for Whirl {
    fn default() -> Self {
        let settings = WhirlSettings::default();
        Self {
            window_turns: settings.window_turns,
            max_window: settings.max_window,
            sample_rate: 250.0,
            watched: Watched::Joints,
            gate_speed_rpm: 5.0,
            min_orbit_ratio: settings.min_orbit_ratio,
            steady_direction: settings.steady_direction,
            min_repetition: settings.min_repetition,
            rolling_tolerance: settings.rolling_tolerance,
            input_trust: InputTrust::default(),
            min_confidence: settings.min_confidence,
            hysteresis: settings.hysteresis,
            hold_off: settings.hold_off,
            latch: settings.latch,
            forward_limit: settings.forward_limit,
            levels: Levels::default(),
        }
    }
}

/// Which places are watched, on both pipes.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Watched {
    /// The stations of the joints.
    #[default]
    Joints,
    /// Every station.
    All,
    /// These stations, 0-based from the top.
    Stations(Vec<usize>),
}

/// Factors on the confidence, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct InputTrust {
    /// Late by a sample or two. Default 0.9.
    pub slow: f64,
    /// The newest sample was refused. Default 0.8.
    pub rejected: f64,
    /// Held for long or on the way to the safe value. Default 0.6.
    pub stale: f64,
    /// The configured start values act. Default 0.6.
    pub not_received: f64,
}

impl Default for InputTrust {
    fn default() -> Self {
        let trust = motion::InputTrust::default();
        Self {
            slow: trust.slow,
            rejected: trust.rejected,
            stale: trust.stale,
            not_received: trust.not_received,
        }
    }
}

impl InputTrust {
    fn check(&self, c: &mut Checker) {
        for (key, value) in [
            ("slow", self.slow),
            ("rejected", self.rejected),
            ("stale", self.stale),
            ("not_received", self.not_received),
        ] {
            let reason = "a factor on the confidence; 0 lets no level rise";
            c.number(key, value, Bound::within(0.0, 1.0), "", reason);
        }
    }

    fn describe(&self) -> motion::InputTrust {
        motion::InputTrust {
            slow: self.slow,
            rejected: self.rejected,
            stale: self.stale,
            not_received: self.not_received,
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

/// A level is reached when, for `duration`, there is whirl with both ratios and the force reached.
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
        let settings = WhirlSettings::default();
        Self {
            watch: settings.watch.into(),
            warning: settings.warning.into(),
            critical: settings.critical.into(),
        }
    }
}

impl From<LevelThresholds> for Level {
    fn from(thresholds: LevelThresholds) -> Self {
        Self {
            clearance_ratio: thresholds.clearance_ratio,
            contact_duty: thresholds.contact_duty,
            force_kn: n_to_kn(thresholds.force),
            duration: thresholds.duration,
        }
    }
}

impl Whirl {
    pub(super) fn check(&self, c: &mut Checker, mesh: &Mesh) {
        let reason = "a window must hold a turn of the whirl";
        c.number(
            "window_turns",
            self.window_turns,
            Bound::within(1.0, 100.0),
            "turns",
            reason,
        );
        let reason = "shorter than half a second shows no direction; longer than a minute warns too late";
        c.number("max_window", self.max_window, Bound::within(0.5, 60.0), "s", reason);
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
            "steady_direction",
            self.steady_direction,
            Bound::within(0.1, 1.0),
            "",
            "broad-band motion scatters by 0.2",
        );
        let reason = "broad-band motion reaches 0.5 by chance; noise keeps periodic motion from 1";
        c.number(
            "min_repetition",
            self.min_repetition,
            Bound::within(0.1, 1.0),
            "",
            reason,
        );
        let reason = "wider would call sliding rolling";
        c.number(
            "rolling_tolerance",
            self.rolling_tolerance,
            Bound::within(0.0, 0.5),
            "",
            reason,
        );
        c.below("input_trust", |c| self.input_trust.check(c));
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
        c.number("latch", self.latch, Bound::within(0.0, 1e9), "s", "");
        c.below("levels", |c| self.levels.check(c));
    }

    /// Stations and pipes to watch, up to `last_station`; empty stands for both pipes at every joint.
    pub(super) fn places(&self, last_station: usize) -> Vec<(usize, Body)> {
        let both = |station: usize| [(station, Body::Pipe), (station, Body::Guide)];
        match &self.watched {
            Watched::Joints => Vec::new(),
            Watched::All => (0..=last_station).flat_map(both).collect(),
            Watched::Stations(stations) => stations.iter().copied().flat_map(both).collect(),
        }
    }

    pub(super) fn describe(&self) -> WhirlSettings {
        WhirlSettings {
            window_turns: self.window_turns,
            max_window: self.max_window,
            min_rotary_speed: rpm_to_rad_per_s(self.gate_speed_rpm),
            min_orbit_ratio: self.min_orbit_ratio,
            steady_direction: self.steady_direction,
            min_repetition: self.min_repetition,
            rolling_tolerance: self.rolling_tolerance,
            input_trust: self.input_trust.describe(),
            min_confidence: self.min_confidence,
            hysteresis: self.hysteresis,
            hold_off: self.hold_off,
            latch: self.latch,
            forward_limit: self.forward_limit,
            watch: self.levels.watch.describe(),
            warning: self.levels.warning.describe(),
            critical: self.levels.critical.describe(),
            ..WhirlSettings::default()
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
                    c.require(low <= high || high.is_nan(), name, high, unit, bound, "levels rise");
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
        c.number(
            "force_kn",
            self.force_kn,
            Bound::within(0.0, 1e4),
            "kN",
            "0 asks for none",
        );
        c.number(
            "duration",
            self.duration,
            Bound::within(0.0, 600.0),
            "s",
            "longer would warn too late",
        );
    }

    fn describe(&self) -> LevelThresholds {
        LevelThresholds {
            clearance_ratio: self.clearance_ratio,
            contact_duty: self.contact_duty,
            force: kn_to_n(self.force_kn),
            duration: self.duration,
        }
    }
}
