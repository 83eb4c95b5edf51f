//! One tool, stepped.

use serde::{Deserialize, Serialize};

use super::Snapshot;
use crate::mechanics::{LiveParameters, StepOutcome, ToolDescription};

/// What the rig asks for in this step, SI, after the door (limits, age) and before the slew limits.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Target speed of the top drive (rad/s).
    pub rotary_speed: f64,
    /// Target weight on bit (N).
    pub weight_on_bit: f64,
}

/// How the simulation runs, beside the tool itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulationSettings {
    /// Model step (s).
    pub time_step: f64,
    /// Newmark's gamma.
    pub gamma: f64,
    /// Most Newton iterations per sub-step.
    pub max_iterations: u32,
    /// Most halvings of a step.
    pub max_halvings: u32,
    /// Inputs at the start.
    pub initial_inputs: Inputs,
    /// Slew limit of the rotary speed (rad/s2).
    pub rotary_speed_slew: f64,
    /// Slew limit of the weight on bit (N/s).
    pub weight_on_bit_slew: f64,
}

/// Why a simulation could not be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The description does not make sense.
    #[error("{0}")]
    Description(String),
    /// The tool could not be brought to rest.
    #[error("static start: {0}")]
    StaticStart(String),
}

/// The running twin of one tool.
pub struct Simulation {
    settings: SimulationSettings,
    live: LiveParameters,
    step: u64,
}

impl Simulation {
    /// Builds the tool and, if configured, brings it to rest under gravity and the initial weight on bit.
    ///
    /// # Errors
    /// When the description is inconsistent or the static start does not converge.
    pub fn new(_tool: &ToolDescription, settings: &SimulationSettings) -> Result<Self, BuildError> {
        Ok(Self {
            settings: settings.clone(),
            live: LiveParameters {
                inner_friction: [0.2; 2],
                outer_friction: [0.3; 2],
                bit_friction_factor: 0.235,
            },
            step: 0,
        })
    }

    /// Advances by one step of [`SimulationSettings::time_step`] towards `inputs`.
    pub fn advance(&mut self, _inputs: &Inputs) -> StepOutcome {
        self.step += 1;
        StepOutcome::Advanced {
            iterations: 0,
            halvings: 0,
        }
    }

    /// A snapshot of the right sizes, to be filled by [`Simulation::snapshot`].
    pub fn new_snapshot(&self) -> Snapshot {
        Snapshot::default()
    }

    /// Fills `out` without allocating. With `end_interval`, the peak and root-mean-square statistics of the contact
    /// forces and bit accelerations start anew.
    pub fn snapshot(&mut self, out: &mut Snapshot, _end_interval: bool) {
        out.step = self.step;
        out.time = self.time();
    }

    /// Parameters that may change while running.
    pub fn live(&self) -> LiveParameters {
        self.live
    }

    /// Replaces the live parameters from the next step on.
    pub fn set_live(&mut self, live: LiveParameters) {
        self.live = live;
    }

    /// Replaces the slew limits: rotary speed (rad/s2) and weight on bit (N/s).
    pub fn set_slew(&mut self, rotary_speed: f64, weight_on_bit: f64) {
        self.settings.rotary_speed_slew = rotary_speed;
        self.settings.weight_on_bit_slew = weight_on_bit;
    }

    /// Steps taken.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Model time (s).
    pub fn time(&self) -> f64 {
        self.step as f64 * self.settings.time_step
    }

    /// The settings it runs with.
    pub fn settings(&self) -> &SimulationSettings {
        &self.settings
    }

    /// Back to the state after the start.
    pub fn reset(&mut self) {
        self.step = 0;
    }

    /// The whole state as bytes; [`Simulation::restore`] continues from it bit for bit.
    pub fn checkpoint(&self) -> Vec<u8> {
        Vec::new()
    }

    /// Takes a checkpoint's state.
    ///
    /// # Errors
    /// When the bytes are not a checkpoint of this tool and version.
    pub fn restore(&mut self, _bytes: &[u8]) -> Result<(), BuildError> {
        Ok(())
    }
}
