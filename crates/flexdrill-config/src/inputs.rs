//! `inputs`: what the rig may ask for and what happens when it falls silent.

use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use flexdrill_core::inputs::{InputRule, InputRules};

/// Both inputs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct InputsConfig {
    /// Of the top drive.
    pub rotary_speed: RotarySpeed,
    /// Weight on bit.
    pub weight_on_bit: WeightOnBit,
}

/// `inputs.rotary_speed`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RotarySpeed {
    /// Default 0.
    pub min_rpm: f64,
    /// Default 120.
    pub max_rpm: f64,
    /// Fastest change that the model follows. Default 20.
    pub slew_rpm_per_s: f64,
    /// Until the first sample. Default 0.
    pub initial_rpm: f64,
    /// Where it is brought to when the rig stays silent. Default 0.
    pub safe_rpm: f64,
    /// How fast it is brought there. Default 5.
    pub safe_ramp_rpm_per_s: f64,
    /// Age at which the input is SLOW (s). Default 2.5.
    pub slow_age: f64,
    /// Age at which it is STALE (s). Default 5.
    pub max_age: f64,
    /// How long the last good value is held after that (s). Default 10.
    pub hold_before_safe: f64,
}

impl Default for RotarySpeed {
    fn default() -> Self {
        Self {
            min_rpm: 0.0,
            max_rpm: 120.0,
            slew_rpm_per_s: 20.0,
            initial_rpm: 0.0,
            safe_rpm: 0.0,
            safe_ramp_rpm_per_s: 5.0,
            slow_age: 2.5,
            max_age: 5.0,
            hold_before_safe: 10.0,
        }
    }
}

/// `inputs.weight_on_bit`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WeightOnBit {
    /// Default 0.
    pub min_kn: f64,
    /// Default 60.
    pub max_kn: f64,
    /// How far below zero a reading may be and still count as zero. Default 0.5.
    pub tare_error_kn: f64,
    /// Fastest change that the model follows. Default 10.
    pub slew_kn_per_s: f64,
    /// Until the first sample. Default 0.
    pub initial_kn: f64,
    /// Where it is brought to when the rig stays silent. Default 0.
    pub safe_kn: f64,
    /// How fast it is brought there. Default 1.
    pub safe_ramp_kn_per_s: f64,
    /// Age at which the input is SLOW (s). Default 2.5.
    pub slow_age: f64,
    /// Age at which it is STALE (s). Default 5.
    pub max_age: f64,
    /// How long the last good value is held after that (s). Default 10.
    pub hold_before_safe: f64,
}

impl Default for WeightOnBit {
    fn default() -> Self {
        Self {
            min_kn: 0.0,
            max_kn: 60.0,
            tare_error_kn: 0.5,
            slew_kn_per_s: 10.0,
            initial_kn: 0.0,
            safe_kn: 0.0,
            safe_ramp_kn_per_s: 1.0,
            slow_age: 2.5,
            max_age: 5.0,
            hold_before_safe: 10.0,
        }
    }
}

impl InputsConfig {
    pub(super) fn check(&self, c: &mut Checker) {
        c.below("rotary_speed", |c| self.rotary_speed.check(c));
        c.below("weight_on_bit", |c| self.weight_on_bit.check(c));
    }
}

impl RotarySpeed {
    fn check(&self, c: &mut Checker) {
        let unit = "r/min";
        c.number(
            "max_rpm",
            self.max_rpm,
            Bound::within(-5000.0, 5000.0),
            unit,
            "far above any top drive",
        );
        let reason = "not above max_rpm";
        c.number(
            "min_rpm",
            self.min_rpm,
            Bound::within(-5000.0, self.max_rpm),
            unit,
            reason,
        );
        let limits = Bound::within(self.min_rpm, self.max_rpm);
        c.number(
            "initial_rpm",
            self.initial_rpm,
            limits,
            unit,
            "within min_rpm and max_rpm",
        );
        c.number("safe_rpm", self.safe_rpm, limits, unit, "within min_rpm and max_rpm");
        let rate = Bound::above(0.0, 1e6);
        let reason = "0 would never follow; a jump in speed is an infinite torque";
        c.number("slew_rpm_per_s", self.slew_rpm_per_s, rate, "r/min per s", reason);
        let reason = "0 would never get there";
        c.number(
            "safe_ramp_rpm_per_s",
            self.safe_ramp_rpm_per_s,
            rate,
            "r/min per s",
            reason,
        );
        check_ages(c, self.slow_age, self.max_age, self.hold_before_safe);
    }
}

impl WeightOnBit {
    fn check(&self, c: &mut Checker) {
        let unit = "kN";
        c.number(
            "max_kn",
            self.max_kn,
            Bound::within(0.0, 2000.0),
            unit,
            "far above any drilling tool",
        );
        let reason = "a bit does not pull, and not above max_kn";
        c.number("min_kn", self.min_kn, Bound::within(0.0, self.max_kn), unit, reason);
        let reason = "a reading further below zero is wrong, not untared";
        c.number(
            "tare_error_kn",
            self.tare_error_kn,
            Bound::within(0.0, 100.0),
            unit,
            reason,
        );
        let limits = Bound::within(self.min_kn, self.max_kn);
        c.number("initial_kn", self.initial_kn, limits, unit, "within min_kn and max_kn");
        c.number("safe_kn", self.safe_kn, limits, unit, "within min_kn and max_kn");
        let rate = Bound::above(0.0, 1e6);
        let reason = "0 would never follow; a jump in load is a blow on the tool";
        c.number("slew_kn_per_s", self.slew_kn_per_s, rate, "kN/s", reason);
        let reason = "0 would never get there";
        c.number("safe_ramp_kn_per_s", self.safe_ramp_kn_per_s, rate, "kN/s", reason);
        check_ages(c, self.slow_age, self.max_age, self.hold_before_safe);
    }
}

fn check_ages(c: &mut Checker, slow_age: f64, max_age: f64, hold_before_safe: f64) {
    let reason = "an hour is not live any more";
    c.number("max_age", max_age, Bound::above(0.0, 3600.0), "s", reason);
    let reason = "slow comes before stale (max_age)";
    c.number("slow_age", slow_age, Bound::above(0.0, max_age), "s", reason);
    let reason = "a day is not live any more";
    c.number(
        "hold_before_safe",
        hold_before_safe,
        Bound::within(0.0, 86_400.0),
        "s",
        reason,
    );
}

impl InputsConfig {
    /// For the input conditioning.
    pub fn rules(&self) -> InputRules {
        let (speed, weight) = (&self.rotary_speed, &self.weight_on_bit);
        [
            InputRule {
                min: speed.min_rpm,
                max: speed.max_rpm,
                tare_error: 0.0,
                initial: speed.initial_rpm,
                safe: speed.safe_rpm,
                safe_ramp: speed.safe_ramp_rpm_per_s,
                slow_age: speed.slow_age,
                max_age: speed.max_age,
                hold_before_safe: speed.hold_before_safe,
            },
            InputRule {
                min: weight.min_kn,
                max: weight.max_kn,
                tare_error: weight.tare_error_kn,
                initial: weight.initial_kn,
                safe: weight.safe_kn,
                safe_ramp: weight.safe_ramp_kn_per_s,
                slow_age: weight.slow_age,
                max_age: weight.max_age,
                hold_before_safe: weight.hold_before_safe,
            },
        ]
    }
}
