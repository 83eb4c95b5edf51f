//! `inputs`: what the rig may ask for and what happens when it falls silent.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Checker;
use super::hard_limits::HardLimits;
use super::section::section;
use flexdrill_core::inputs::{InputKind, InputRule, InputRules};

section! {
    /// The inputs of the rig.
    pub struct InputsConfig(this) {
        /// Rotary speed of the top drive.
        rotary_speed: RotarySpeed = RotarySpeed::default(), below;
        /// Axial load that presses the bit on the rock.
        weight_on_bit: WeightOnBit = WeightOnBit::default(), below;
        /// Advance of the tool along the hole. Optional: a rig that does not send it is normal.
        rate_of_penetration: RateOfPenetration = RateOfPenetration::default(), below;
        /// Pressure in the pipe above that outside, at the tool's top. Optional, as the rate of penetration.
        standpipe_pressure: StandpipePressure = StandpipePressure::default(), below;
        /// Selection of the publisher of an input when there are several.
        driver: DriverRule = DriverRule::default();
        /// Checks of samples with a time stamp.
        stamp: StampRule = StampRule::default(), below;
        /// Bounds that no parameter exceeds while the twin runs.
        hard_limits: HardLimits = HardLimits::default(), below;
    }
}

/// `inputs.driver`: selection of the publisher of an input when there are several.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriverRule {
    /// `newest` accepts every publisher, `first` the one that came first until it has been silent for `max_age`,
    /// `named` only those in `named`. Default newest.
    pub policy: DriverPolicy,
    /// The publishers that `policy: named` accepts: absolute names of nodes, or ids as `twin/status` shows them.
    /// Default none.
    pub named: Vec<String>,
}

/// Policy for several publishers of an input.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DriverPolicy {
    /// The node accepts every publisher; the newest sample acts.
    #[default]
    Newest,
    /// The node accepts the publisher that came first, until it has been silent for the input's `max_age`.
    First,
    /// The node accepts only the publishers that `named` lists.
    Named,
}

section! {
    /// `inputs.stamp`: samples of `rig/inputs`, which carry the time of their measurement.
    #[derive(Copy)]
    pub struct StampRule(this) {
        /// Largest time by which a stamp may be ahead of the node's clock (s). The node refuses samples beyond it.
        max_skew: f64 = 0.5, within(0.0, 60.0), "s", "further ahead, the machines' clocks are not set";
    }
}

section! {
    /// `inputs.rotary_speed`.
    #[derive(Copy)]
    pub struct RotarySpeed(this) {
        /// Lowest accepted speed (r/min).
        min_rpm: f64 = 0.0, within(-5000.0, this.max_rpm), "r/min", "not above max_rpm";
        /// Highest accepted speed (r/min).
        max_rpm: f64 = 120.0, within(-5000.0, 5000.0), "r/min", "far above any top drive";
        /// Where the rig measures the speed: at the `surface`, or `downhole` above the tool. Default surface.
        measured: Measured = Measured::Surface;
        /// Fastest change that the model follows of a speed measured at the surface (r/min per s).
        slew_rpm_per_s: f64 = 20.0, above(0.0, 1e6), "r/min per s",
            "0 would never follow; a jump in speed is an infinite torque";
        /// Fastest change that the model follows of a speed measured downhole, which changes faster than any drive
        /// (r/min per s).
        downhole_slew_rpm_per_s: f64 = 200.0, above(0.0, 1e6), "r/min per s",
            "0 would never follow; a jump in speed is an infinite torque";
        /// Value that acts until the first sample.
        initial_rpm: f64 = 0.0, within(this.min_rpm, this.max_rpm), "r/min", "within min_rpm and max_rpm";
        /// Safe value to which the model is brought when the input stays away. It is an upper bound: a held value below
        /// it does not change.
        safe_rpm: f64 = 0.0, within(this.min_rpm, this.max_rpm), "r/min", "within min_rpm and max_rpm";
        /// Rate of the ramp to the safe value.
        safe_ramp_rpm_per_s: f64 = 5.0, above(0.0, 1e6), "r/min per s", "0 would never get there";
        /// Age of the newest good sample from which the input is SLOW (s).
        slow_age: f64 = 2.5, above(0.0, this.max_age), "s", "slow comes before stale (max_age)";
        /// Age of the newest good sample from which the input is STALE (s).
        max_age: f64 = 5.0, above(0.0, 3600.0), "s", "an hour is not live any more";
        /// Time for which the last good value is held after that, before the ramp to the safe value (s).
        hold_before_safe: f64 = 10.0, within(0.0, 86_400.0), "s", "a day is not live any more";
    }
}

/// Location of the speed measurement.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Measured {
    /// At the top drive, whose inertia limits the rate of change.
    #[default]
    Surface,
    /// Above the tool, including the torsional swing of the string.
    Downhole,
}

impl RotarySpeed {
    /// Fastest change that the model follows (r/min per s), by where the speed is measured.
    pub fn fastest_change_rpm_per_s(&self) -> f64 {
        match self.measured {
            Measured::Surface => self.slew_rpm_per_s,
            Measured::Downhole => self.downhole_slew_rpm_per_s,
        }
    }
}

section! {
    /// `inputs.weight_on_bit`.
    #[derive(Copy)]
    pub struct WeightOnBit(this) {
        /// Lowest accepted weight (kN).
        min_kn: f64 = 0.0, within(0.0, this.max_kn), "kN", "a bit does not pull, and not above max_kn";
        /// Highest accepted weight (kN).
        max_kn: f64 = 60.0, within(0.0, 2000.0), "kN", "far above any drilling tool";
        /// Largest negative reading that counts as zero (kN).
        tare_error_kn: f64 = 0.5, within(0.0, 100.0), "kN", "a reading further below zero is wrong, not untared";
        /// Fastest change of the weight that the model follows (kN/s).
        slew_kn_per_s: f64 = 10.0, above(0.0, 1e6), "kN/s",
            "0 would never follow; a jump in load is a blow on the tool";
        /// Value that acts until the first sample.
        initial_kn: f64 = 0.0, within(this.min_kn, this.max_kn), "kN", "within min_kn and max_kn";
        /// Safe value to which the model is brought when the input stays away. It is an upper bound: a held value below
        /// it does not change.
        safe_kn: f64 = 0.0, within(this.min_kn, this.max_kn), "kN", "within min_kn and max_kn";
        /// Rate of the ramp to the safe value.
        safe_ramp_kn_per_s: f64 = 1.0, above(0.0, 1e6), "kN/s", "0 would never get there";
        /// Age of the newest good sample from which the input is SLOW (s).
        slow_age: f64 = 2.5, above(0.0, this.max_age), "s", "slow comes before stale (max_age)";
        /// Age of the newest good sample from which the input is STALE (s).
        max_age: f64 = 5.0, above(0.0, 3600.0), "s", "an hour is not live any more";
        /// Time for which the last good value is held after that, before the ramp to the safe value (s).
        hold_before_safe: f64 = 10.0, within(0.0, 86_400.0), "s", "a day is not live any more";
    }
}

section! {
    /// `inputs.rate_of_penetration`: positive while the hole deepens, negative while the tool is pulled back.
    #[derive(Copy)]
    pub struct RateOfPenetration(this) {
        /// Lowest accepted rate (m/h).
        min_m_per_h: f64 = -200.0, within(-3000.0, this.max_m_per_h), "m/h", "not above max_m_per_h; pipe is not tripped faster";
        /// Highest accepted rate (m/h).
        max_m_per_h: f64 = 200.0, within(-3000.0, 3000.0), "m/h", "pipe is not tripped faster";
        /// Fastest change of the rate that the model follows (m/h per s).
        slew_m_per_h_per_s: f64 = 10.0, above(0.0, 1e6), "m/h per s",
            "0 would never follow; a jump in advance is a blow on the tool";
        /// Rate that the model assumes until the first sample, and throughout a run without samples.
        assumed_m_per_h: f64 = 0.0, within(this.min_m_per_h, this.max_m_per_h), "m/h", "within min_m_per_h and max_m_per_h";
        /// Safe value to which the model is brought when the input was sent and stays away. It is an upper bound: a held
        /// value below it does not change.
        safe_m_per_h: f64 = 0.0, within(this.min_m_per_h, this.max_m_per_h), "m/h", "within min_m_per_h and max_m_per_h";
        /// Rate of the ramp to the safe value.
        safe_ramp_m_per_h_per_s: f64 = 1.0, above(0.0, 1e6), "m/h per s", "0 would never get there";
        /// Age of the newest good sample from which the input is SLOW (s).
        slow_age: f64 = 15.0, above(0.0, this.max_age), "s", "slow comes before stale (max_age)";
        /// Age of the newest good sample from which the input is STALE (s).
        max_age: f64 = 30.0, above(0.0, 3600.0), "s", "an hour is not live any more";
        /// Time for which the last good value is held after that, before the ramp to the safe value (s).
        hold_before_safe: f64 = 60.0, within(0.0, 86_400.0), "s", "a day is not live any more";
    }
}

section! {
    /// `inputs.standpipe_pressure`: inside minus outside at the tool's top, which a gauge at the standpipe reads when the
    /// losses above the tool are subtracted.
    #[derive(Copy)]
    pub struct StandpipePressure(this) {
        /// Lowest accepted pressure (MPa).
        min_mpa: f64 = 0.0, within(-150.0, this.max_mpa), "MPa", "not above max_mpa; beyond any pump";
        /// Highest accepted pressure (MPa).
        max_mpa: f64 = 70.0, within(-150.0, 150.0), "MPa", "beyond any pump";
        /// Largest negative reading that counts as zero (MPa).
        tare_error_mpa: f64 = 0.2, within(0.0, 5.0), "MPa", "a reading further below zero is wrong, not untared";
        /// Fastest change of the pressure that the model follows (MPa/s).
        slew_mpa_per_s: f64 = 1.0, above(0.0, 1e6), "MPa/s",
            "0 would never follow; a jump in pressure is a blow on the tool";
        /// Pressure that the model assumes until the first sample, and throughout a run without samples.
        assumed_mpa: f64 = 0.0, within(this.min_mpa, this.max_mpa), "MPa", "within min_mpa and max_mpa";
        /// Safe value to which the model is brought when the input was sent and stays away. It is an upper bound: a held
        /// value below it does not change.
        safe_mpa: f64 = 0.0, within(this.min_mpa, this.max_mpa), "MPa", "within min_mpa and max_mpa";
        /// Rate of the ramp to the safe value.
        safe_ramp_mpa_per_s: f64 = 0.2, above(0.0, 1e6), "MPa/s", "0 would never get there";
        /// Age of the newest good sample from which the input is SLOW (s).
        slow_age: f64 = 5.0, above(0.0, this.max_age), "s", "slow comes before stale (max_age)";
        /// Age of the newest good sample from which the input is STALE (s).
        max_age: f64 = 10.0, above(0.0, 3600.0), "s", "an hour is not live any more";
        /// Time for which the last good value is held after that, before the ramp to the safe value (s).
        hold_before_safe: f64 = 30.0, within(0.0, 86_400.0), "s", "a day is not live any more";
    }
}

impl InputsConfig {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        let named = self.driver.named.len();
        c.require(
            self.driver.policy != DriverPolicy::Named || named > 0,
            "driver.named",
            "[]",
            "",
            "a list of nodes or ids when driver.policy is named",
            "otherwise nobody may drive",
        );
        c.require(
            self.driver.policy == DriverPolicy::Named || named == 0,
            "driver.named",
            format!("{named} names"),
            "",
            "left out unless driver.policy is named",
            "a list that nobody looks at misleads",
        );
    }

    /// For the input conditioning, of a tool that uses the required inputs only.
    pub fn rules(&self) -> InputRules {
        self.rules_of(InputKind::ALL.map(|kind| !kind.is_optional()))
    }

    /// For the input conditioning; `used` says which inputs the tool's mechanics depend on, by [`InputKind::index`].
    pub fn rules_of(&self, used: [bool; InputKind::COUNT]) -> InputRules {
        // The order is that of `InputKind::index`; rules are found by it.
        let (speed, weight) = (&self.rotary_speed, &self.weight_on_bit);
        let (advance, pressure) = (&self.rate_of_penetration, &self.standpipe_pressure);
        [
            InputRule {
                min: speed.min_rpm,
                max: speed.max_rpm,
                // A speed has no tare: the sensor counts turns, and its zero is exact.
                tare_error: 0.0,
                initial: speed.initial_rpm,
                safe: speed.safe_rpm,
                safe_ramp: speed.safe_ramp_rpm_per_s,
                slow_age: speed.slow_age,
                max_age: speed.max_age,
                hold_before_safe: speed.hold_before_safe,
                used: used[0],
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
                used: used[1],
            },
            InputRule {
                min: advance.min_m_per_h,
                max: advance.max_m_per_h,
                tare_error: 0.0,
                // Optional inputs begin with an assumed value, because a rig need not have them at all.
                initial: advance.assumed_m_per_h,
                safe: advance.safe_m_per_h,
                safe_ramp: advance.safe_ramp_m_per_h_per_s,
                slow_age: advance.slow_age,
                max_age: advance.max_age,
                hold_before_safe: advance.hold_before_safe,
                used: used[2],
            },
            InputRule {
                // A pressure sensor has an offset at zero, as the hook load
                // has, so small negative readings are its tare.
                min: pressure.min_mpa,
                max: pressure.max_mpa,
                tare_error: pressure.tare_error_mpa,
                initial: pressure.assumed_mpa,
                safe: pressure.safe_mpa,
                safe_ramp: pressure.safe_ramp_mpa_per_s,
                slow_age: pressure.slow_age,
                max_age: pressure.max_age,
                hold_before_safe: pressure.hold_before_safe,
                used: used[3],
            },
        ]
    }
}
