//! The tool in motion: steps that are halved and retried until they converge, or reported as failed.

mod advance;
mod begin;
#[cfg(feature = "checkpoints")]
mod checkpoint;
mod disturb;
mod looks;
mod outside;
mod settings;
mod statics;
mod sub_steps;
#[cfg(test)]
mod tests;
mod track;

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::chain::{Carrier, Chain, ChainEquations, Effect, EndLoad, FromAbove};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::joints::Joints;
use crate::dynamics::outcome::{FailureCause, StepFailure};
use crate::dynamics::phases::{PhaseTimes, Stopwatch};
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Tolerances;
use crate::effects::{self, Effects};
use crate::inputs::{InputKind, Inputs};
use crate::model::{Model, Places};
use crate::simd::Instructions;
use crate::tool::description::{Body, LiveParameters, ToolDescription};
use crate::validation::ValidationError;
use flexdrill_base::energies::Energies;

use sub_steps::most_attempts;
use track::Track;

#[cfg(feature = "checkpoints")]
pub(crate) use checkpoint::StepperCheckpoint;
pub use settings::SolverKind;
pub(crate) use settings::{Counters, Forcing, StepperSettings};
pub use statics::StartError;

/// Finest refinement: a step in four parts.
pub const MOST_REFINEMENT: u32 = 2;

/// Model, state and solver.
#[derive(Clone)]
pub(crate) struct Stepper {
    model: Arc<Model>,
    tolerances: Tolerances,
    instructions: Instructions,
    scheme: Scheme,
    max_halvings: u32,
    /// Steps are taken in 2^refinement parts.
    refinement: u32,
    live: LiveParameters,
    /// The joints at the end of the last step.
    joints: Joints,
    stopwatch: Stopwatch,
    /// The tool over its nodes.
    chain: Chain,
    /// What acts inside the chain's spans.
    effects: Effects,
    /// Where the motion is, in the numbering of the chain.
    track: Track,
    /// The present state in the numbering of the model, as it was asked for last.
    view: State,
    view_is_current: bool,
    audit: Energies,
    counters: Counters,
    /// Whole turns subtracted from the spins so far.
    turns: f64,
    /// Inputs at the end of the last step.
    inputs: Inputs,
    /// Step size that the chain is prepared for (s).
    prepared_for: f64,
}

impl Stepper {
    /// Builds the tool, at rest and undeflected until [`Stepper::settle`] or
    /// [`Stepper::start_as_given`] is called.
    ///
    /// # Errors
    /// See [`Model::new`].
    pub fn new(description: &ToolDescription, settings: &StepperSettings) -> Result<Self, ValidationError> {
        let StepperSettings {
            time_step: h,
            scheme,
            tolerances,
            max_halvings,
            solver,
            instructions,
        } = *settings;
        let model = Arc::new(Model::new(description)?);
        let chain = match solver {
            SolverKind::Chain => Chain::of(&model, &tolerances, h, &effects::acting(&model), instructions),
            SolverKind::Stations => Chain::over_stations(&model, &tolerances, &effects::acting(&model), instructions),
        };
        // What the effects carry from step to step is of this chain's nodes and spans.
        let effects = Effects::of(&model, &chain);
        let track = Track::new(&model, chain.state(&model), chain.spans(), effects.drags());
        let mut stepper = Self {
            tolerances,
            instructions,
            scheme,
            max_halvings,
            refinement: 0,
            live: LiveParameters::of(description),
            joints: Joints::new(&model, instructions),
            stopwatch: Stopwatch::default(),
            effects,
            chain,
            track,
            view: State::at_rest(&model),
            view_is_current: false,
            audit: Energies::default(),
            counters: Counters::default(),
            turns: 0.0,
            inputs: Inputs::ZERO,
            prepared_for: 0.0,
            model,
        };
        // The first step finds its matrices ready, as every later one does.
        stepper.prepare(h);
        Ok(stepper)
    }

    /// The tool as built.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The joints at the end of the last step.
    pub fn joints(&self) -> &Joints {
        &self.joints
    }

    /// When a step counts as solved.
    pub(super) fn tolerances(&self) -> &Tolerances {
        &self.tolerances
    }

    /// What acts inside the spans, at the end of the last step.
    pub(crate) fn effects(&self) -> &Effects {
        &self.effects
    }

    /// What acts on the tool's lower end at the end of the last step; nothing without an effect there.
    pub(crate) fn end_load(&self) -> EndLoad {
        self.effects.end_load().unwrap_or_default()
    }

    /// Energy since the start.
    pub fn audit(&self) -> &Energies {
        &self.audit
    }

    /// Counters since the start.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Nodes of the chain.
    pub fn chain_nodes(&self) -> usize {
        self.chain.nodes()
    }

    /// Most Newton corrections (each an assembly and a solution) that one [`Stepper::advance`] can make, whatever
    /// happens.
    pub fn most_iterations(&self) -> u64 {
        most_attempts(self.max_halvings.max(self.refinement)) * u64::from(self.tolerances.max_iterations)
    }

    /// Halvings of the smallest sub-step that there can be.
    fn finest_level(&self) -> u32 {
        self.max_halvings.max(MOST_REFINEMENT)
    }

    /// Steps are taken in 2^this parts.
    pub fn refinement(&self) -> u32 {
        self.refinement
    }

    /// Takes steps in 2^`refinement` parts from the next one on: [`Stepper::finest_refinement`] at most.
    pub fn set_refinement(&mut self, refinement: u32) {
        self.refinement = refinement.min(self.finest_refinement());
    }

    /// Most halvings of the step that may be asked for: down to the smallest step for which the inner stations of a span
    /// follow its ends, [`MOST_REFINEMENT`] at most.
    pub fn finest_refinement(&self) -> u32 {
        self.chain.finest_refinement(self.prepared_for).min(MOST_REFINEMENT)
    }

    /// Times the phases of [`Stepper::advance`] while it runs.
    pub fn stopwatch(&mut self) -> &mut Stopwatch {
        &mut self.stopwatch
    }

    /// Time per phase so far.
    pub(crate) fn phase_times(&self) -> PhaseTimes {
        self.stopwatch.times()
    }

    /// Torque of the drive at the end of the last step (N m).
    pub fn drive_torque(&self) -> f64 {
        self.track.carried.drive_torque
    }

    /// Power taken by the pins of each joint at the end of the last step (W), top to bottom; none without friction in the
    /// joints.
    pub fn joint_friction(&self) -> &[f64] {
        &self.track.carried.pin_power
    }

    /// Torque at the tool's top that the pins of all joints take at the end of the last step (N m): their power over the
    /// first link's own speed, which the drive prescribes or, below a string, follows from it; negative in reverse. NaN
    /// below a hundredth of a radian per second and below a tenth of the speed asked for, where no rotation takes it.
    pub fn joint_friction_torque(&self) -> f64 {
        let speed = self.track.state.v[self.places().top_spin];
        if speed.abs() < (0.1 * self.inputs.rotary_speed.abs()).max(1e-2) {
            f64::NAN
        } else {
            self.joint_friction().iter().sum::<f64>() / speed
        }
    }

    /// What turns the tool's top, and may carry it, at the end of the last step; `None` where it is held or driven.
    pub(crate) fn load_above(&self) -> Option<FromAbove> {
        self.effects.load_above(&self.track.state)
    }

    /// What carries the tool along the hole; `None` where a support does.
    pub(crate) fn carrier(&self) -> Option<Carrier> {
        self.load_above()?.carrier
    }

    /// Live parameters in force.
    pub fn live(&self) -> LiveParameters {
        self.live
    }

    /// Sets the live parameters from the next step on.
    pub fn set_live(&mut self, live: LiveParameters) {
        self.live = live;
    }

    /// The equations of a `chain` with its `effects`, which are others than those of the steps, with the joints of this tool.
    fn equations_of<'a>(&'a mut self, (chain, effects): &'a mut (Chain, Effects)) -> ChainEquations<'a, Effects> {
        ChainEquations {
            model: &self.model,
            chain,
            effects,
            joints: &mut self.joints,
            stopwatch: &mut self.stopwatch,
        }
    }

    /// A chain with a node at every station, on which the start is found, with its effects.
    fn chain_over_stations(&self) -> (Chain, Effects) {
        let chain = Chain::over_stations(
            &self.model,
            &self.tolerances,
            &effects::acting(&self.model),
            self.instructions,
        );
        let effects = Effects::of(&self.model, &chain);
        (chain, effects)
    }

    /// Conditions at `time` under `inputs`.
    pub fn conditions(&self, time: f64, inputs: &Inputs) -> Conditions {
        Conditions::under(&self.model.description, &self.live, time, inputs)
    }

    /// Where unknowns are in the numbering in which steps are taken.
    pub(super) fn places(&self) -> &Places {
        &self.chain.model.places
    }

    /// Angle of the drive since the start (rad).
    pub fn drive_angle(&self) -> f64 {
        self.track.state.drive_angle + self.turns * TAU
    }

    /// Makes what steps of size `h` (s) and their halves need, so that [`Stepper::advance`] does not.
    pub fn prepare(&mut self, h: f64) {
        if self.prepared_for == h {
            return;
        }
        self.prepared_for = h;
        self.effects.prepare(h);
        let (conditions, finest) = (self.conditions(0.0, &Inputs::ZERO), self.finest_level());
        for level in 0..=finest {
            let factors = self.scheme.factors(h / f64::from(1_u32 << level));
            self.chain.prepare(&self.model, &conditions, factors);
        }
    }

    /// Counts a step that is not tried because an input (rad/s or N) is out of its bounds, and says so.
    pub(crate) fn refuse_input(&mut self, kind: InputKind, value: f64) -> StepFailure {
        let failure = StepFailure {
            cause: FailureCause::InputOutOfBounds(kind),
            time: self.track.state.time,
            step: 0.0,
            station: 0,
            body: Body::Pipe,
            value,
        };
        self.counters.last_rejection = Some(failure);
        self.counters.failed_steps += 1;
        failure
    }
}
