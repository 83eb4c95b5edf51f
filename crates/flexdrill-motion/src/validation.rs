//! Checks of the settings of every watch.

use crate::{
    AlarmThresholds, ChaoticWhirlSettings, JointLoadSettings, LoadSettings, MOST_REPEATS, ShockSettings,
    StickSlipSettings, TransferSettings, WhirlSettings,
};
use flexdrill_base::validation::{Bound, ValidationError, count, require};

/// Longest window, hold-off or span (s): some thirty years.
const LONGEST: f64 = 1e9;

type Checked = Result<(), ValidationError>;

impl WhirlSettings {
    /// Checks every threshold.
    ///
    /// # Errors
    /// The first threshold that does not hold, with its value, bound and unit.
    pub fn validate(&self) -> Checked {
        let turns = [
            ("window_turns", self.window_turns),
            ("short_window_turns", self.short_window_turns),
        ];
        // Zero turns would be a window without samples.
        Bound::Positive.check_all("whirl", &turns, "turns")?;
        Bound::NotNegative.check("whirl.confirmation_turns", self.confirmation_turns, "turns")?;
        let times = [
            ("min_window", self.min_window),
            ("max_window", self.max_window),
            ("evaluation_interval", self.evaluation_interval),
        ];
        // Below LONGEST, because windows reserve memory for all their samples.
        Bound::Above(0.0, LONGEST).check_all("whirl", &times, "s")?;
        let times = [
            ("max_bridged_gap", self.max_bridged_gap),
            ("hold_off", self.hold_off),
            ("standstill_time", self.standstill_time),
        ];
        // Zero is allowed here: it switches bridging or holding off.
        Bound::Within(0.0, LONGEST).check_all("whirl", &times, "s")?;
        Bound::NotNegative.check("whirl.min_rotary_speed", self.min_rotary_speed, "rad/s")?;
        // Shares and trust are weights between nothing and all.
        let shares = [
            ("min_orbit_ratio", self.min_orbit_ratio),
            ("large_orbit_ratio", self.large_orbit_ratio),
            ("min_axis_ratio", self.min_axis_ratio),
            ("steady_direction", self.steady_direction),
            ("min_repetition", self.min_repetition),
            ("min_confidence", self.min_confidence),
            ("rolling_tolerance", self.rolling_tolerance),
            ("input_trust.slow", self.input_trust.slow),
            ("input_trust.rejected", self.input_trust.rejected),
            ("input_trust.stale", self.input_trust.stale),
            ("input_trust.not_received", self.input_trust.not_received),
        ];
        Bound::Within(0.0, 1.0).check_all("whirl", &shares, "")?;
        // At 1 a level would never be left.
        Bound::Within(0.0, 0.99).check("whirl.hysteresis", self.hysteresis, "")?;
        // Levels must rise, or the lower of two would never be seen.
        rising("whirl.backward_cycles", &self.backward_cycles, "")?;
        rising("whirl.forward_power", &self.forward_power, "W/m")?;
        for (index, &turns) in self.lasting_turns.iter().enumerate() {
            Bound::Within(0.0, LONGEST).check(&format!("whirl.lasting_turns[{index}]"), turns, "turns")?;
        }
        Ok(())
    }
}

/// Thresholds of levels: positive, and none below the one before.
fn rising(field: &str, levels: &[f64], unit: &'static str) -> Checked {
    let mut before = 0.0;
    for (index, &level) in levels.iter().enumerate() {
        let field = format!("{field}[{index}]");
        Bound::Positive.check(&field, level, unit)?;
        require(
            level >= before,
            &field,
            "a level below the one before; thresholds must rise",
        )?;
        before = level;
    }
    Ok(())
}

impl StickSlipSettings {
    /// Checks every threshold.
    ///
    /// # Errors
    /// As [`WhirlSettings::validate`].
    pub fn validate(&self) -> Checked {
        Bound::Above(0.0, LONGEST).check("stick_slip.window", self.window, "s")?;
        Bound::NotNegative.check("stick_slip.gate_speed", self.gate_speed, "rad/s")?;
        self.thresholds.validate("stick_slip.thresholds", "")
    }
}

impl ShockSettings {
    /// Checks every threshold.
    ///
    /// # Errors
    /// As [`WhirlSettings::validate`].
    pub fn validate(&self) -> Checked {
        let times = [("interval", self.interval), ("mean_time", self.mean_time)];
        Bound::Above(0.0, LONGEST).check_all("shock", &times, "s")?;
        Bound::Above(0.0, LONGEST).check("shock.span", self.span, "s")?;
        for (index, &repeats) in self.repeats.iter().enumerate() {
            count(&format!("shock.repeats[{index}]"), repeats as usize, 1, MOST_REPEATS)?;
        }
        self.thresholds.validate("shock.thresholds", "N s")
    }
}

impl JointLoadSettings {
    /// Checks every threshold.
    ///
    /// # Errors
    /// As [`WhirlSettings::validate`].
    pub fn validate(&self) -> Checked {
        Bound::Positive.check("joint_load.rated_moment", self.rated_moment, "N m")?;
        Bound::Above(0.0, LONGEST).check("joint_load.interval", self.interval, "s")?;
        self.thresholds.validate("joint_load.thresholds", "")
    }
}

impl LoadSettings {
    /// Checks every threshold of the load that errors name `field`.
    ///
    /// # Errors
    /// As [`WhirlSettings::validate`].
    pub fn validate(&self, field: &str) -> Checked {
        Bound::Positive.check(&format!("{field}.rating"), self.rating, "N or N m")?;
        Bound::Above(0.0, LONGEST).check(&format!("{field}.interval"), self.interval, "s")?;
        self.thresholds.validate(&format!("{field}.thresholds"), "")
    }
}

impl TransferSettings {
    /// Checks every threshold.
    ///
    /// # Errors
    /// As [`WhirlSettings::validate`].
    pub fn validate(&self) -> Checked {
        Bound::Above(0.0, LONGEST).check("transfer.window", self.window, "s")?;
        Bound::Positive.check("transfer.least_weight", self.least_weight, "N")?;
        Bound::Above(0.0, 1.0).check("transfer.steadiness", self.steadiness, "")?;
        self.weight.validate("transfer.weight", "")?;
        self.short.validate("transfer.short", "")?;
        self.torque.validate("transfer.torque", "")?;
        self.stall.validate("transfer.stall", "s")
    }
}

impl ChaoticWhirlSettings {
    /// Checks every threshold.
    ///
    /// # Errors
    /// As [`WhirlSettings::validate`].
    pub fn validate(&self) -> Checked {
        Bound::Above(0.0, LONGEST).check("chaotic_whirl.window", self.window, "s")?;
        self.thresholds.validate("chaotic_whirl.thresholds", "W/m")
    }
}

impl AlarmThresholds {
    fn validate(&self, under: &str, unit: &'static str) -> Checked {
        rising(&format!("{under}.levels"), &self.levels, unit)?;
        Bound::Within(0.0, 0.99).check(&format!("{under}.hysteresis"), self.hysteresis, "")?;
        Bound::Within(0.0, LONGEST).check(&format!("{under}.hold_off"), self.hold_off, "s")
    }
}
