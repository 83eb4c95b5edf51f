//! How a simulation runs.

use serde::{Deserialize, Serialize};

use super::step_choice::StepRule;
use crate::dynamics::Scheme;
use crate::inputs::Inputs;
use crate::tool::Body;
use crate::units::{kn_to_n, m_per_h_to_m_per_s, mpa_to_pa, rpm_to_rad_per_s};
use flexdrill_motion::{
    AgeingSettings, ChaoticWhirlSettings, JointLoadSettings, LoadSettings, ShockSettings, StickSlipSettings,
    TransferSettings, WhirlSettings,
};

/// How a simulation runs: the step, the scheme, the first inputs, and how the motion is judged.
///
/// ```
/// use flexdrill_core::twin::SimulationSettings;
///
/// let settings = SimulationSettings::default().with(|settings| settings.time_step = 0.25e-3);
/// assert_eq!(settings.max_halvings, 6);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SimulationSettings {
    /// Model step (s).
    pub time_step: f64,
    /// Whether a step is taken whole or, where the motion asks for it and the pace allows it, in parts.
    pub step: StepRule,
    /// How time is integrated.
    pub scheme: Scheme,
    /// Most Newton iterations per sub-step.
    pub max_iterations: u32,
    /// Factor on the forces and moments that Newton's iteration may leave unbalanced: below 1 where their sum over very
    /// many steps is to be small.
    pub residual_factor: f64,
    /// Most halvings of a step.
    pub max_halvings: u32,
    /// Inputs at the start.
    pub initial_inputs: Inputs,
    /// Slew limit of the rotary speed (rad/s2).
    pub rotary_speed_slew: f64,
    /// Slew limit of the weight on bit (N/s).
    pub weight_on_bit_slew: f64,
    /// Slew limit of the rate of penetration (m/s2).
    pub rate_of_penetration_slew: f64,
    /// Slew limit of the standpipe pressure (Pa/s).
    pub standpipe_pressure_slew: f64,
    /// How whirl is found and judged.
    pub whirl: WhirlSettings,
    /// How the stick-slip index is formed.
    pub stick_slip: StickSlipSettings,
    /// How lateral shock is measured and judged.
    pub shock: ShockSettings,
    /// How the load of the joints' stops is judged.
    pub joint_load: JointLoadSettings,
    /// How chaotic whirl is judged.
    pub chaotic_whirl: ChaoticWhirlSettings,
    /// How transfer from the surface to the bit is averaged and judged.
    pub transfer: TransferSettings,
    /// How the bending moment of a preloaded guide is judged; `None` without a rating.
    pub guide_preload: Option<LoadSettings>,
    /// How the effective compression of a pipe under pressure is judged; `None` without a rating.
    pub pressure_folding: Option<LoadSettings>,
    /// How load cycles are counted as damage.
    pub ageing: AgeingSettings,
    /// Stations and pipes whose orbits are watched; empty watches both pipes at every joint.
    pub watched: Vec<(usize, Body)>,
    /// Time between samples of the whirl analysis (s), rounded to whole steps.
    pub whirl_sample_interval: f64,
}

impl Default for SimulationSettings {
    /// Those of `config/default.yaml`, where the reasons stand; a test holds the two together. It starts without speed
    /// and without weight on bit.
    fn default() -> Self {
        Self {
            time_step: 0.5e-3,
            step: StepRule::Auto,
            scheme: Scheme::generalised_alpha(0.45),
            max_iterations: 15,
            residual_factor: 1.0,
            max_halvings: 6,
            initial_inputs: Inputs::default(),
            rotary_speed_slew: rpm_to_rad_per_s(20.0),
            weight_on_bit_slew: kn_to_n(10.0),
            rate_of_penetration_slew: m_per_h_to_m_per_s(10.0),
            standpipe_pressure_slew: mpa_to_pa(1.0),
            whirl: WhirlSettings::default(),
            stick_slip: StickSlipSettings::default(),
            shock: ShockSettings::default(),
            joint_load: JointLoadSettings::default(),
            chaotic_whirl: ChaoticWhirlSettings::default(),
            transfer: TransferSettings::default(),
            guide_preload: None,
            pressure_folding: None,
            ageing: AgeingSettings::default(),
            watched: Vec::new(),
            whirl_sample_interval: 1.0 / 250.0,
        }
    }
}

impl SimulationSettings {
    /// The settings after `change`.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    /// Slew limits of rotary speed (rad/s2), weight on bit (N/s), rate of penetration (m/s2) and standpipe pressure (Pa/s).
    pub fn slew(&self) -> [f64; 4] {
        [
            self.rotary_speed_slew,
            self.weight_on_bit_slew,
            self.rate_of_penetration_slew,
            self.standpipe_pressure_slew,
        ]
    }

    /// Steps between two samples of the whirl analysis.
    pub(super) fn whirl_sample_steps(&self) -> u64 {
        ((self.whirl_sample_interval / self.time_step).round() as u64).max(1)
    }
}
