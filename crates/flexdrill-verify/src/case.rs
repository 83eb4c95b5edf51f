//! A verification case at work: its configuration, the twin, and a way to read off single numbers.

use super::VerifyError;
use super::runs::{self, CaseRun};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, Direction};
use flexdrill_core::twin::Simulation;

/// Names and texts of files in `config/verify/`.
macro_rules! files {
    ($($name:literal)+) => {
        &[$(($name, include_str!(concat!("../../../config/verify/", $name, ".yaml")))),+]
    };
}

/// The configurations of the cases, so that the installed program needs no files.
const FILES: &[(&str, &str)] = files! {
    "axial_rod" "beam_frequencies" "block_on_slope" "cantilever" "capstan" "capstan_chain" "capstan_intervals"
    "capstan_slid_in" "capstan_weight" "chain_in_guide" "curved_guide" "depth_of_cut" "free_vibration"
    "hanging_link" "helical_buckling" "hinged_beam_in_tube" "hooke_chain" "hooke_pair" "hooke_single"
    "joint_play" "mass_onto_gap" "mud_squeeze" "mud_pipe" "mud_coupled" "mud_together" "pin_friction"
    "pin_holding" "pipe_in_guide" "play_rotor" "preload_chord" "preload_tool" "preload_turning" "preload_wall"
    "pressure_buckling" "pressure_closed" "pressure_seal" "pressure_folding" "rolling_rotor"
    "sinusoidal_buckling" "sliding_mass" "slots_couples" "slots_wall" "spine_column" "stuck_guide" "tied_rods"
    "tilted_link" "toggle" "string_windup" "torque_buckling" "torque_folding" "torsion_pendulum" "torsion_rod"
    "unbalanced_rotor"
};

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
