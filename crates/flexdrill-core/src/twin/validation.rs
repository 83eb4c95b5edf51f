//! Checks of the settings of a simulation.

use super::settings::SimulationSettings;
use crate::dynamics::Scheme;
use crate::inputs::{InputKind, Inputs};
use crate::motion::{
    AlarmThresholds, ChaoticWhirlSettings, JointLoadSettings, LoadSettings, MOST_REPEATS, ShockSettings,
    StickSlipSettings, TransferSettings, WhirlSettings,
};
use crate::validation::{Bound, ValidationError, count, require};

/// Shortest and longest step (s): below, the mass over its square drowns the stiffness; contacts last milliseconds.
const STEP: Bound = Bound::Within(1e-9, 1.0);
/// Most halvings: each level keeps its own step-constant tangent.
const MOST_HALVINGS: usize = 20;
/// Most samples of a whirl window: an hour at the default rate, some 30 MB per watched station.
const MOST_SAMPLES: f64 = 1e6;
/// Longest window, hold-off or span (s): some thirty years.
const LONGEST: f64 = 1e9;

type Checked = Result<(), ValidationError>;

impl SimulationSettings {
    /// Checks every field; `last_station` is that of the tool to be simulated. [`super::Simulation::new`] does it too.
    ///
    /// # Errors
    /// The first field that does not hold, with its value, bound and unit.
    pub fn validate(&self, last_station: usize) -> Checked {
        STEP.check("time_step", self.time_step, "s")?;
        self.scheme.validate()?;
        count("max_iterations", self.max_iterations as usize, 1, 1000)?;
        Bound::Within(1e-9, 1.0).check("residual_factor", self.residual_factor, "")?;
        count("max_halvings", self.max_halvings as usize, 0, MOST_HALVINGS)?;
        for kind in InputKind::ALL {
            let [low, high] = Inputs::bounds(kind);
            let field = format!("initial_inputs.{kind}");
            Bound::Within(low, high).check(&field, self.initial_inputs.get(kind), kind.si_unit())?;
        }
        validate_slew(self.slew())?;
        self.whirl.validate()?;
        self.stick_slip.validate()?;
        self.shock.validate()?;
        self.joint_load.validate()?;
        self.chaotic_whirl.validate()?;
        self.transfer.validate()?;
        for (field, load) in [
            ("guide_preload", &self.guide_preload),
            ("pressure_folding", &self.pressure_folding),
        ] {
            load.as_ref().map_or(Ok(()), |load| load.validate(field))?;
        }
        Bound::Within(1.0, 20.0).check("ageing.slope", self.ageing.slope, "")?;
        Bound::Positive.check("ageing.rated_moment", self.ageing.rated_moment, "N m")?;
        for (index, &(station, _)) in self.watched.iter().enumerate() {
            count(&format!("watched[{index}].station"), station, 0, last_station)?;
        }
        Bound::Positive.check("whirl_sample_interval", self.whirl_sample_interval, "s")?;
        let longest = MOST_SAMPLES * self.whirl_sample_steps() as f64 * self.time_step;
        Bound::Above(0.0, longest).check("whirl.max_window", self.whirl.max_window, "s")
    }
}

/// Slew limits of rotary speed (rad/s2), weight on bit (N/s), rate of penetration (m/s2) and standpipe pressure (Pa/s).
pub(super) fn validate_slew([speed, weight, advance, pressure]: [f64; 4]) -> Checked {
    Bound::NotNegative.check("rotary_speed_slew", speed, "rad/s2")?;
    Bound::NotNegative.check("weight_on_bit_slew", weight, "N/s")?;
    Bound::NotNegative.check("rate_of_penetration_slew", advance, "m/s2")?;
    Bound::NotNegative.check("standpipe_pressure_slew", pressure, "Pa/s")
}

impl Scheme {
    /// Checks that the scheme is stable for linear motion: gamma >= 1/2 with the alphas' lag, beta > 0, alphas below 1.
    ///
    /// # Errors
    /// As [`SimulationSettings::validate`].
    pub fn validate(&self) -> Checked {
        // Chung and Hulbert 1993: alpha_m <= alpha_f <= 1/2, with gamma and beta at their bounds or above.
        Bound::Within(-1.0, 0.5).check("scheme.alpha_f", self.alpha_f, "")?;
        Bound::Within(-1.0, self.alpha_f).check("scheme.alpha_m", self.alpha_m, "")?;
        // One rounding below the bound is on it.
        let least_gamma = 0.5 - self.alpha_m + self.alpha_f - 1e-12;
        Bound::Within(least_gamma, 2.0).check("scheme.gamma", self.gamma, "")?;
        Bound::Within(0.5 * self.gamma - 1e-12, 4.0).check("scheme.beta", self.beta, "")
    }
}

impl WhirlSettings {
    /// Checks every threshold.
    ///
    /// # Errors
    /// As [`SimulationSettings::validate`].
    pub fn validate(&self) -> Checked {
        let turns = [
            ("window_turns", self.window_turns),
            ("short_window_turns", self.short_window_turns),
        ];
        Bound::Positive.check_all("whirl", &turns, "turns")?;
        Bound::NotNegative.check("whirl.confirmation_turns", self.confirmation_turns, "turns")?;
        let times = [
            ("min_window", self.min_window),
            ("max_window", self.max_window),
            ("evaluation_interval", self.evaluation_interval),
        ];
        Bound::Above(0.0, LONGEST).check_all("whirl", &times, "s")?;
        let times = [
            ("max_bridged_gap", self.max_bridged_gap),
            ("hold_off", self.hold_off),
            ("standstill_time", self.standstill_time),
        ];
        Bound::Within(0.0, LONGEST).check_all("whirl", &times, "s")?;
        Bound::NotNegative.check("whirl.min_rotary_speed", self.min_rotary_speed, "rad/s")?;
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
    fn validate(&self) -> Checked {
        Bound::Above(0.0, LONGEST).check("stick_slip.window", self.window, "s")?;
        Bound::NotNegative.check("stick_slip.gate_speed", self.gate_speed, "rad/s")?;
        self.thresholds.validate("stick_slip.thresholds", "")
    }
}

impl ShockSettings {
    fn validate(&self) -> Checked {
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
    fn validate(&self) -> Checked {
        Bound::Positive.check("joint_load.rated_moment", self.rated_moment, "N m")?;
        Bound::Above(0.0, LONGEST).check("joint_load.interval", self.interval, "s")?;
        self.thresholds.validate("joint_load.thresholds", "")
    }
}

impl LoadSettings {
    fn validate(&self, field: &str) -> Checked {
        Bound::Positive.check(&format!("{field}.rating"), self.rating, "N or N m")?;
        Bound::Above(0.0, LONGEST).check(&format!("{field}.interval"), self.interval, "s")?;
        self.thresholds.validate(&format!("{field}.thresholds"), "")
    }
}

impl TransferSettings {
    fn validate(&self) -> Checked {
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
    fn validate(&self) -> Checked {
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
