//! A verification case at work: its configuration, the twin, and a way to read off single numbers.

use super::VerifyError;
use super::runs::{self, CaseRun};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, Direction};
use flexdrill_core::twin::Simulation;

/// Texts of `config/verify/`, so that the installed program needs no files.
const FILES: &[(&str, &str)] = &[
    ("axial_rod", include_str!("../../../config/verify/axial_rod.yaml")),
    (
        "beam_frequencies",
        include_str!("../../../config/verify/beam_frequencies.yaml"),
    ),
    (
        "block_on_slope",
        include_str!("../../../config/verify/block_on_slope.yaml"),
    ),
    ("cantilever", include_str!("../../../config/verify/cantilever.yaml")),
    ("capstan", include_str!("../../../config/verify/capstan.yaml")),
    (
        "capstan_chain",
        include_str!("../../../config/verify/capstan_chain.yaml"),
    ),
    (
        "capstan_intervals",
        include_str!("../../../config/verify/capstan_intervals.yaml"),
    ),
    (
        "capstan_slid_in",
        include_str!("../../../config/verify/capstan_slid_in.yaml"),
    ),
    (
        "capstan_weight",
        include_str!("../../../config/verify/capstan_weight.yaml"),
    ),
    (
        "chain_in_guide",
        include_str!("../../../config/verify/chain_in_guide.yaml"),
    ),
    ("curved_guide", include_str!("../../../config/verify/curved_guide.yaml")),
    ("depth_of_cut", include_str!("../../../config/verify/depth_of_cut.yaml")),
    (
        "free_vibration",
        include_str!("../../../config/verify/free_vibration.yaml"),
    ),
    ("hanging_link", include_str!("../../../config/verify/hanging_link.yaml")),
    (
        "helical_buckling",
        include_str!("../../../config/verify/helical_buckling.yaml"),
    ),
    (
        "hinged_beam_in_tube",
        include_str!("../../../config/verify/hinged_beam_in_tube.yaml"),
    ),
    ("hooke_chain", include_str!("../../../config/verify/hooke_chain.yaml")),
    ("hooke_pair", include_str!("../../../config/verify/hooke_pair.yaml")),
    ("hooke_single", include_str!("../../../config/verify/hooke_single.yaml")),
    ("joint_play", include_str!("../../../config/verify/joint_play.yaml")),
    (
        "mass_onto_gap",
        include_str!("../../../config/verify/mass_onto_gap.yaml"),
    ),
    ("mud_squeeze", include_str!("../../../config/verify/mud_squeeze.yaml")),
    ("mud_pipe", include_str!("../../../config/verify/mud_pipe.yaml")),
    ("mud_coupled", include_str!("../../../config/verify/mud_coupled.yaml")),
    ("mud_together", include_str!("../../../config/verify/mud_together.yaml")),
    ("pin_friction", include_str!("../../../config/verify/pin_friction.yaml")),
    ("pin_holding", include_str!("../../../config/verify/pin_holding.yaml")),
    (
        "pipe_in_guide",
        include_str!("../../../config/verify/pipe_in_guide.yaml"),
    ),
    ("play_rotor", include_str!("../../../config/verify/play_rotor.yaml")),
    (
        "preload_chord",
        include_str!("../../../config/verify/preload_chord.yaml"),
    ),
    ("preload_tool", include_str!("../../../config/verify/preload_tool.yaml")),
    (
        "preload_turning",
        include_str!("../../../config/verify/preload_turning.yaml"),
    ),
    ("preload_wall", include_str!("../../../config/verify/preload_wall.yaml")),
    (
        "pressure_buckling",
        include_str!("../../../config/verify/pressure_buckling.yaml"),
    ),
    (
        "pressure_closed",
        include_str!("../../../config/verify/pressure_closed.yaml"),
    ),
    (
        "pressure_seal",
        include_str!("../../../config/verify/pressure_seal.yaml"),
    ),
    (
        "pressure_folding",
        include_str!("../../../config/verify/pressure_folding.yaml"),
    ),
    (
        "rolling_rotor",
        include_str!("../../../config/verify/rolling_rotor.yaml"),
    ),
    (
        "sinusoidal_buckling",
        include_str!("../../../config/verify/sinusoidal_buckling.yaml"),
    ),
    ("sliding_mass", include_str!("../../../config/verify/sliding_mass.yaml")),
    (
        "slots_couples",
        include_str!("../../../config/verify/slots_couples.yaml"),
    ),
    ("slots_wall", include_str!("../../../config/verify/slots_wall.yaml")),
    ("spine_column", include_str!("../../../config/verify/spine_column.yaml")),
    ("stuck_guide", include_str!("../../../config/verify/stuck_guide.yaml")),
    ("tied_rods", include_str!("../../../config/verify/tied_rods.yaml")),
    ("tilted_link", include_str!("../../../config/verify/tilted_link.yaml")),
    ("toggle", include_str!("../../../config/verify/toggle.yaml")),
    (
        "string_windup",
        include_str!("../../../config/verify/string_windup.yaml"),
    ),
    (
        "torque_buckling",
        include_str!("../../../config/verify/torque_buckling.yaml"),
    ),
    (
        "torque_folding",
        include_str!("../../../config/verify/torque_folding.yaml"),
    ),
    (
        "torsion_pendulum",
        include_str!("../../../config/verify/torsion_pendulum.yaml"),
    ),
    ("torsion_rod", include_str!("../../../config/verify/torsion_rod.yaml")),
    (
        "unbalanced_rotor",
        include_str!("../../../config/verify/unbalanced_rotor.yaml"),
    ),
];

/// What a case compares and its formula: the comment at the head of its configuration.
pub fn head(case: &str) -> Option<String> {
    let (_, text) = FILES.iter().find(|(name, _)| *name == case)?;
    let lines = text.lines().map_while(|line| line.strip_prefix('#'));
    Some(
        lines
            .map(|line| line.strip_prefix(' ').unwrap_or(line))
            .collect::<Vec<_>>()
            .join("\n"),
    )
}

/// A running case.
pub struct CaseTwin {
    case: &'static str,
    /// Its configuration.
    pub config: Config,
    /// Its twin.
    pub simulation: Simulation,
    inputs: Inputs,
}

impl CaseTwin {
    /// Builds the case's tool.
    ///
    /// # Errors
    /// When configuration or tool are refused.
    pub fn new(case: &'static str) -> Result<Self, VerifyError> {
        Self::with(case, Ok)
    }

    /// The same with a changed configuration.
    ///
    /// # Errors
    /// As [`CaseTwin::new`].
    pub fn with(
        case: &'static str,
        change: impl FnOnce(Config) -> Result<Config, flexdrill_config::ConfigError>,
    ) -> Result<Self, VerifyError> {
        Self::within(case, 1.0, change)
    }

    /// The same with a factor on the forces that Newton's iteration may leave unbalanced.
    ///
    /// # Errors
    /// As [`CaseTwin::new`].
    pub fn within(
        case: &'static str,
        residual_factor: f64,
        change: impl FnOnce(Config) -> Result<Config, flexdrill_config::ConfigError>,
    ) -> Result<Self, VerifyError> {
        let text = FILES
            .iter()
            .find(|(name, _)| *name == case)
            .map(|(_, text)| *text)
            .ok_or(VerifyError::Missing {
                case,
                what: "its configuration",
            })?;
        let config = change(Config::from_text(&format!("config/verify/{case}.yaml"), text)?)?;
        let settings = config.simulation().with(|settings| {
            settings.residual_factor = residual_factor;
            // A case that advances does so from the start.
            settings.rate_of_penetration_slew = 1.0;
        });
        let simulation =
            Simulation::new(&config.tool(), &settings).map_err(|source| VerifyError::Build { case, source })?;
        Ok(Self {
            case,
            config,
            simulation,
            inputs: settings.initial_inputs,
        })
    }

    /// Sets the rate of penetration that the next steps go towards (m/s).
    pub fn set_rate_of_penetration(&mut self, rate: f64) {
        self.inputs.rate_of_penetration = rate;
    }

    /// Advances one step.
    ///
    /// # Errors
    /// When it fails.
    pub fn step(&mut self) -> Result<(), VerifyError> {
        match self.simulation.advance(&self.inputs) {
            StepOutcome::Advanced { .. } => Ok(()),
            StepOutcome::Failed(failure) => Err(VerifyError::Step {
                case: self.case,
                failure,
            }),
        }
    }

    /// Advances to `time` (s).
    ///
    /// # Errors
    /// When a step fails.
    pub fn run_to(&mut self, time: f64) -> Result<(), VerifyError> {
        let steps = (time / self.simulation.settings().time_step).round() as u64;
        while self.simulation.step() < steps {
            self.step()?;
        }
        Ok(())
    }

    /// Model time (s).
    pub fn time(&self) -> f64 {
        self.simulation.time()
    }

    /// Displacement (m or rad) of the node at `station`; at a joint, of the link above.
    pub fn displacement(&self, station: usize, body: Body, direction: Direction) -> f64 {
        self.simulation
            .displacement(station, body, direction)
            .unwrap_or(f64::NAN)
    }

    /// Velocity (m/s or rad/s), as [`CaseTwin::displacement`].
    pub fn velocity(&self, station: usize, body: Body, direction: Direction) -> f64 {
        self.simulation.velocity(station, body, direction).unwrap_or(f64::NAN)
    }

    /// Last station.
    pub fn last(&self) -> usize {
        self.simulation.last_station()
    }

    /// Normal force in the inner gap at `station` (N).
    pub fn inner_normal(&self, station: usize) -> f64 {
        self.simulation.normal_force(station, Body::Pipe).unwrap_or(f64::NAN)
    }
}

impl Drop for CaseTwin {
    fn drop(&mut self) {
        if runs::wanted() {
            runs::ended(CaseRun {
                config: self.config.clone(),
                settings: self.simulation.settings().clone(),
                inputs: self.inputs,
                steps: self.simulation.step(),
            });
        }
    }
}

/// Frequency (Hz) of a signal by its first and last crossing of zero, interpolated between samples `dt` (s) apart.
pub fn crossing_frequency(samples: &[f64], dt: f64) -> Option<f64> {
    let mut crossings = samples
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| (pair[0] < 0.0) != (pair[1] < 0.0))
        .map(|(index, pair)| dt * (index as f64 + pair[0] / (pair[0] - pair[1])));
    let first = crossings.next()?;
    let (count, last) = crossings.fold((0, first), |(count, _), at| (count + 1, at));
    (count > 0).then(|| f64::from(count) / (2.0 * (last - first)))
}
