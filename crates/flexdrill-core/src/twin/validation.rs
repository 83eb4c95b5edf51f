//! Checks of the settings of a simulation.

use super::settings::SimulationSettings;
use crate::dynamics::Scheme;
use crate::inputs::{InputKind, Inputs};
use crate::validation::{Bound, ValidationError, count};

/// Shortest and longest step (s): below, the mass over its square drowns the stiffness; contacts last milliseconds.
const STEP: Bound = Bound::Within(1e-9, 1.0);
/// Most halvings: each level keeps its own step-constant tangent.
const MOST_HALVINGS: usize = 20;
/// Most samples of a whirl window: an hour at the default rate, some 30 MB per watched station.
const MOST_SAMPLES: f64 = 1e6;

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
        Bound::Within(1.0, 20.0).check("ageing.slope_below_knee", self.ageing.slope_below_knee, "")?;
        Bound::Positive.check("ageing.rated_moment", self.ageing.rated_moment, "N m")?;
        for knee in self.ageing.knees {
            Bound::NotNegative.check("ageing.knees", knee, "")?;
        }
        for (index, &(station, _)) in self.watched.iter().enumerate() {
            count(&format!("watched[{index}].station"), station, 0, last_station)?;
        }
        Bound::Positive.check("whirl_sample_interval", self.whirl_sample_interval, "s")?;
        let longest = MOST_SAMPLES * self.whirl_sample_steps() as f64 * self.time_step;
        Bound::Above(0.0, longest).check("whirl.max_window", self.whirl.max_window, "s")
    }
}

/// Slew limits of rotary speed (rad/s2), weight on bit (N/s), rate of penetration (m/s2) and standpipe pressure (Pa/s).
pub(super) fn validate_slew([speed, weight, advance, standpipe_pressure]: [f64; 4]) -> Checked {
    Bound::NotNegative.check("rotary_speed_slew", speed, "rad/s2")?;
    Bound::NotNegative.check("weight_on_bit_slew", weight, "N/s")?;
    Bound::NotNegative.check("rate_of_penetration_slew", advance, "m/s2")?;
    Bound::NotNegative.check("standpipe_pressure_slew", standpipe_pressure, "Pa/s")
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
