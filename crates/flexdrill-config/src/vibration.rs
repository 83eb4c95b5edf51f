//! `stick_slip`, `shock`, `chaotic_whirl` and `joint_load`: levels of the bit's speed swing, of single collisions, of
//! the power of all collisions, and of the joints' stops.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::section::section;
use flexdrill_core::units::{rad_per_s_to_rpm, rpm_to_rad_per_s};
use flexdrill_motion::{
    AgeingSettings, AlarmThresholds, ChaoticWhirlSettings, JointLoadSettings, MOST_REPEATS, ShockSettings,
    StickSlipSettings,
};

section! {
    /// Stick-slip of the bit.
    #[derive(Copy)]
    pub struct StickSlip(this) {
        /// Window of the index (s). Swings with periods up to this length are judged.
        window: f64 = StickSlipSettings::default().window, within(0.1, 60.0), "s",
            "must hold a period of the swing; longer than a minute warns too late";
        /// Mean speed of the drive below which the index is 0 (r/min).
        gate_speed_rpm: f64 = rad_per_s_to_rpm(StickSlipSettings::default().gate_speed).round(),
            within(0.0, 1000.0), "r/min", "near standstill the quotient means nothing";
        /// A level ends below threshold x (1 - hysteresis).
        hysteresis: f64 = StickSlipSettings::default().thresholds.hysteresis, within(0.0, 0.9), "",
            "at 1 a level would never be left";
        /// Time for which the value must stay below that before the level ends (s).
        hold_off: f64 = StickSlipSettings::default().thresholds.hold_off, within(0.0, 3600.0), "s", "an hour";
        /// Thresholds of the index, (max - min) / (2 mean). Default 0.5, 0.8, 1.
        levels: Steps = Steps::from(StickSlipSettings::default().thresholds.levels);
    }
}

section! {
    /// Lateral shock.
    #[derive(Copy)]
    pub struct Shock(this) {
        /// Interval over which the force is integrated (s).
        interval: f64 = ShockSettings::default().interval, within(1e-3, 0.5), "s",
            "longer than a collision of some ms, shorter than a turn of a whirl";
        /// Time over which the resting force is averaged (s).
        mean_time: f64 = ShockSettings::default().mean_time, within(2e-3, 10.0), "s",
            "several intervals; longer than a second takes a new load for a shock";
        /// A level ends below threshold x (1 - hysteresis).
        hysteresis: f64 = ShockSettings::default().thresholds.hysteresis, within(0.0, 0.9), "",
            "at 1 a level would never be left";
        /// Time for which the value must stay below that before the level ends (s).
        hold_off: f64 = ShockSettings::default().thresholds.hold_off, within(0.0, 3600.0), "s", "an hour";
        /// Thresholds of the impulse above the resting force (N s). Default 5, 15, 45.
        levels: Steps = Steps::from(ShockSettings::default().thresholds.levels);
        /// Number of such impulses within `span` that reach the level. Default 10, 3, 1.
        repeats: Repeats = Repeats::default();
        /// Time in which the impulses are counted (s).
        span: f64 = ShockSettings::default().span, above(0.0, 3600.0), "s", "an hour";
    }
}

const REPEATS: Bound = Bound::within(1.0, MOST_REPEATS as f64);

/// Numbers of impulses of three levels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Repeats {
    /// Threshold of WATCH.
    #[schemars(transform = REPEATS.in_schema())]
    pub watch: u32,
    /// Threshold of WARNING.
    #[schemars(transform = REPEATS.in_schema())]
    pub warning: u32,
    /// Threshold of CRITICAL.
    #[schemars(transform = REPEATS.in_schema())]
    pub critical: u32,
}

impl Default for Repeats {
    fn default() -> Self {
        let [watch, warning, critical] = ShockSettings::default().repeats;
        Self {
            watch,
            warning,
            critical,
        }
    }
}

section! {
    /// Chaotic whirl of the pipe.
    #[derive(Copy)]
    pub struct ChaoticWhirl(this) {
        /// Time over which the power of the collisions is averaged (s).
        window: f64 = ChaoticWhirlSettings::default().window, within(0.1, 60.0), "s",
            "shorter shows single blows; longer than a minute warns too late";
        /// A level ends below threshold x (1 - hysteresis).
        hysteresis: f64 = ChaoticWhirlSettings::default().thresholds.hysteresis, within(0.0, 0.9), "",
            "at 1 a level would never be left";
        /// Time for which the value must stay below that before the level ends (s).
        hold_off: f64 = ChaoticWhirlSettings::default().thresholds.hold_off, within(0.0, 3600.0), "s", "an hour";
        /// Thresholds of the power that collisions dissipate per metre of the tool, times the share of the pipe in
        /// chaotic motion (W/m). Default 0.6, 2, 6.
        levels: Steps = Steps::from(ChaoticWhirlSettings::default().thresholds.levels);
    }
}

section! {
    /// Load of the joints' stops.
    #[derive(Copy)]
    pub struct JointLoad(this) {
        /// Moment that the stop of a joint can carry permanently, from its manufacturer (N m).
        rated_moment_nm: f64 = JointLoadSettings::default().rated_moment, above(0.0, 1e7), "N m",
            "a stop that may carry nothing is always overloaded";
        /// Slope of the Woehler line that weights load cycles as damage, for comparison between stations: 3 for welds
        /// and sharp notches, 5 for machined steel. With `tool.joint.life` the slope of its class counts in place of it.
        woehler_slope: f64 = AgeingSettings::default().slope, within(1.0, 20.0), "",
            "steel has 3 to 8; at 1 only the number of cycles would count";
        /// Interval over which the moment is averaged (s).
        interval: f64 = JointLoadSettings::default().interval, within(1e-3, 10.0), "s",
            "shorter shows the stop's stiffness, longer hides a blow";
        /// A level ends below threshold x (1 - hysteresis).
        hysteresis: f64 = JointLoadSettings::default().thresholds.hysteresis, within(0.0, 0.9), "",
            "at 1 a level would never be left";
        /// Time for which the value must stay below that before the level ends (s).
        hold_off: f64 = JointLoadSettings::default().thresholds.hold_off, within(0.0, 3600.0), "s", "an hour";
        /// Thresholds of the mean moment divided by the rated moment. Default 0.8, 1, 1.5.
        levels: Steps = Steps::from(JointLoadSettings::default().thresholds.levels);
    }
}

/// The widest bound of a threshold: that of an impulse (N s) and of a power (W/m).
const THRESHOLD: Bound = Bound::above(0.0, 1e6);

/// Thresholds of three levels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Steps {
    /// Threshold of WATCH.
    #[schemars(transform = THRESHOLD.in_schema())]
    pub watch: f64,
    /// Threshold of WARNING.
    #[schemars(transform = THRESHOLD.in_schema())]
    pub warning: f64,
    /// Threshold of CRITICAL.
    #[schemars(transform = THRESHOLD.in_schema())]
    pub critical: f64,
}

impl From<[f64; 3]> for Steps {
    fn from([watch, warning, critical]: [f64; 3]) -> Self {
        Self {
            watch,
            warning,
            critical,
        }
    }
}

impl Steps {
    /// In the order of the levels.
    pub fn levels(&self) -> [f64; 3] {
        [self.watch, self.warning, self.critical]
    }

    /// With the way out of a level: hysteresis as a share, hold-off (s).
    pub(super) fn thresholds(&self, hysteresis: f64, hold_off: f64) -> AlarmThresholds {
        AlarmThresholds {
            levels: self.levels(),
            hysteresis,
            hold_off,
        }
    }

    /// `most` is at most that of [`THRESHOLD`].
    pub(super) fn check(&self, c: &mut Checker, most: f64, unit: &'static str) {
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

impl StickSlip {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        c.below("levels", |c| self.levels.check(c, 100.0, ""));
    }

    pub(super) fn describe(&self) -> StickSlipSettings {
        let mut settings = StickSlipSettings::default();
        settings.window = self.window;
        settings.gate_speed = rpm_to_rad_per_s(self.gate_speed_rpm);
        settings.thresholds = self.levels.thresholds(self.hysteresis, self.hold_off);
        settings
    }
}

impl Shock {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        c.below("levels", |c| self.levels.check(c, 1e6, "N s"));
        c.below("repeats", |c| {
            let Repeats {
                watch,
                warning,
                critical,
            } = self.repeats;
            for (key, repeats) in [("watch", watch), ("warning", warning), ("critical", critical)] {
                let reason = "so many times are kept for each level";
                c.count(key, repeats as usize, REPEATS, reason);
            }
        });
    }

    pub(super) fn describe(&self) -> ShockSettings {
        let mut settings = ShockSettings::default();
        settings.interval = self.interval;
        settings.mean_time = self.mean_time;
        settings.thresholds = self.levels.thresholds(self.hysteresis, self.hold_off);
        settings.repeats = [self.repeats.watch, self.repeats.warning, self.repeats.critical];
        settings.span = self.span;
        settings
    }
}

impl ChaoticWhirl {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        c.below("levels", |c| self.levels.check(c, 1e6, "W/m"));
    }

    pub(super) fn describe(&self) -> ChaoticWhirlSettings {
        let mut settings = ChaoticWhirlSettings::default();
        settings.window = self.window;
        settings.thresholds = self.levels.thresholds(self.hysteresis, self.hold_off);
        settings
    }
}

impl JointLoad {
    pub(super) fn describe_ageing(&self) -> AgeingSettings {
        let mut settings = AgeingSettings::default();
        (settings.slope, settings.slope_below_knee) = (self.woehler_slope, self.woehler_slope);
        settings.rated_moment = self.rated_moment_nm;
        settings
    }

    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        c.below("levels", |c| self.levels.check(c, 1e3, ""));
    }

    pub(super) fn describe(&self) -> JointLoadSettings {
        let mut settings = JointLoadSettings::default();
        settings.rated_moment = self.rated_moment_nm;
        settings.interval = self.interval;
        settings.thresholds = self.levels.thresholds(self.hysteresis, self.hold_off);
        settings
    }
}
