//! One run of the twin: the simulation, the inputs that act from each step on, and the frames made from it.
//!
//! The node and a replay both drive a [`Run`]. The sequence of [`RunInputs`] and the configuration determine it to the
//! bit; no clock is read here.

use super::schedule::{Due, EndsInterval};
use super::{Schedule, Simulation, Snapshot};
use crate::dynamics::outcome::StepOutcome;
use crate::inputs::InputState;
use crate::inputs::Inputs;
use crate::tool::LiveParameters;
use flexdrill_motion::WhirlSettings;

/// Everything that acts on the model from a step on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunInputs {
    /// Steps taken before these values act, counted from the last reset.
    pub step: u64,
    /// Steps skipped so far.
    pub skipped: u64,
    /// Whether the model is reset to its state after the start, before this step.
    pub reset: bool,
    /// The rig's targets, towards which the model slews.
    pub inputs: Inputs,
    /// Slew limits: rotary speed (rad/s2), weight on bit (N/s), rate of penetration (m/s2), standpipe pressure (Pa/s).
    pub slew: [f64; 4],
    /// Friction and bit coefficients in force.
    pub live: LiveParameters,
    /// Thresholds of the whirl analysis.
    pub whirl: WhirlSettings,
    /// The worse state of both inputs, as one of the messages' INPUT_ constants.
    pub input_quality: u8,
    /// Every step is taken in 2^this equal parts.
    pub refinement: u32,
    /// The steps at which each output is due.
    pub schedule: Schedule,
}

/// Everything that the outputs of one step are made from.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// State of the tool.
    pub snapshot: Snapshot,
    /// Steps taken or skipped since the start, not reset with the model: the instant on the rig's clock.
    pub ticks: u64,
    /// Which outputs are due.
    pub due: Due,
    /// Which statistics end with this frame.
    pub ends_interval: EndsInterval,
    /// As in [`RunInputs`].
    pub input_quality: u8,
}

/// A simulation with the inputs that act on it.
pub struct Run {
    simulation: Simulation,
    applied: RunInputs,
    /// Steps taken before the last reset.
    before_reset: u64,
}

impl Run {
    /// A run of a simulation at its start.
    pub fn new(mut simulation: Simulation, schedule: Schedule) -> Self {
        let settings = simulation.settings();
        let applied = RunInputs {
            step: 0,
            skipped: 0,
            reset: false,
            inputs: settings.initial_inputs,
            slew: settings.slew(),
            live: simulation.live(),
            whirl: settings.whirl,
            input_quality: 0,
            refinement: simulation.quality().choice.wanted,
            schedule,
        };
        simulation.set_refinement(applied.refinement);
        Self {
            simulation,
            applied,
            before_reset: 0,
        }
    }

    /// A run that goes on from a simulation's present state under `applied`, such as a restored one.
    pub fn resumed(simulation: Simulation, applied: &RunInputs) -> Self {
        let mut run = Self::new(simulation, applied.schedule);
        run.apply(&RunInputs {
            reset: false,
            ..*applied
        });
        run
    }

    /// Another run in the same state, see [`Simulation::fork`].
    #[must_use]
    pub fn fork(&self) -> Self {
        Self {
            simulation: self.simulation.fork(),
            applied: self.applied,
            before_reset: self.before_reset,
        }
    }

    /// Disturbs the motion, see [`Simulation::disturb`].
    pub fn disturb(&mut self, velocity: impl FnMut() -> f64) {
        self.simulation.disturb(velocity);
    }

    /// Fills `out` with the present state and ends the interval of its statistics.
    pub fn look(&mut self, out: &mut Snapshot) {
        self.simulation.snapshot(out, true);
    }

    /// The inputs that act now; `step` is the current step.
    pub fn applied(&self) -> RunInputs {
        RunInputs {
            step: self.simulation.step(),
            reset: false,
            ..self.applied
        }
    }

    /// Lets `applied` act from the next step on; its `step` is ignored. The values come from a checked configuration
    /// and are not checked again; a coefficient that is NaN makes the next step fail.
    pub fn apply(&mut self, applied: &RunInputs) {
        if applied.reset {
            self.before_reset += self.simulation.step();
            self.simulation.reset();
        }
        if applied.slew != self.applied.slew || applied.reset {
            self.simulation.replace_slew(applied.slew);
        }
        if applied.live != self.applied.live || applied.reset {
            self.simulation.replace_live(applied.live);
        }
        if applied.whirl != self.applied.whirl {
            self.simulation.replace_whirl(&applied.whirl);
        }
        self.simulation.set_refinement(applied.refinement);
        let trust = &applied.whirl.input_trust;
        self.simulation.set_input_trust(match applied.input_quality {
            quality if quality == InputState::NotReceived as u8 => trust.not_received,
            quality if quality == InputState::Slow as u8 => trust.slow,
            quality if quality == InputState::Stale as u8 => trust.stale,
            quality if quality == InputState::Rejected as u8 => trust.rejected,
            _ => 1.0,
        });
        self.applied = *applied;
    }

    /// Advances by one step.
    pub fn advance(&mut self) -> StepOutcome {
        self.simulation.advance(&self.applied.inputs)
    }

    /// The refinement that the motion asks for.
    pub fn wanted_refinement(&self) -> u32 {
        self.simulation.quality().choice.wanted
    }

    /// Counts steps as skipped; the model does not move.
    pub fn skip(&mut self, steps: u64) {
        self.applied.skipped += steps;
    }

    /// Which outputs are due now.
    pub fn due(&self) -> Due {
        self.applied.schedule.due(self.simulation.step())
    }

    /// Fills a frame with the present state, without allocating. The caller captures one frame whenever an output is
    /// due, since a frame can end the interval of the statistics.
    pub fn capture(&mut self, frame: &mut Frame) {
        let step = self.simulation.step();
        frame.ends_interval = self.applied.schedule.ends_interval(step);
        self.simulation
            .snapshot_ending(&mut frame.snapshot, frame.ends_interval);
        frame.ticks = self.ticks();
        frame.due = self.due();
        frame.input_quality = self.applied.input_quality;
    }

    /// A frame of the right sizes.
    pub fn new_frame(&self) -> Frame {
        Frame {
            snapshot: self.simulation.new_snapshot(),
            ..Frame::default()
        }
    }

    /// Steps taken or skipped since the start.
    pub fn ticks(&self) -> u64 {
        self.before_reset + self.simulation.step() + self.applied.skipped
    }

    /// The simulation, read-only.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }
}
