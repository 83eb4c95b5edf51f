//! The simulation of one tool, step by step.

use std::sync::Arc;

use super::Snapshot;
#[cfg(feature = "checkpoints")]
use super::checkpoint::{CheckpointError, Identity};
use super::observe::Observer;
use super::schedule::EndsInterval;
use super::settings::SimulationSettings;
use super::snapshot::Applied;
use super::validation::validate_slew;
use crate::dynamics::outcome::StepOutcome;
use crate::dynamics::phases::{Clock, Phase, PhaseTimes};
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Tolerances;
use crate::inputs::{InputKind, Inputs};
use crate::simd::Instructions;
use crate::step::StartError;
use crate::step::{Forcing, SolverKind, Stepper, StepperSettings};
use crate::tool::{LiveParameters, ToolDescription, WeightPlace};
use crate::validation::ValidationError;
use flexdrill_motion::WhirlSettings;

/// Why a simulation could not be built or restored.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// The description cannot be computed with.
    #[error("tool: {0}")]
    Tool(#[source] ValidationError),
    /// The settings cannot be computed with.
    #[error("settings: {0}")]
    Settings(#[source] ValidationError),
    /// The tool could not be started.
    #[error("start of the run: {0}")]
    Start(#[from] StartError),
    /// A checkpoint could not be made or restored.
    #[cfg(feature = "checkpoints")]
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// Time in which the weight at the kick-off follows the one that is set (s): slower than the axial vibration of the
/// guide (4 ms), faster than the slew limit of the weight.
const WEIGHT_TIME: f64 = 0.1;

/// The running twin of one tool.
pub struct Simulation {
    pub(super) settings: SimulationSettings,
    pub(super) stepper: Stepper,
    start: Arc<State>,
    pub(super) observer: Observer,
    pub(super) applied: Applied,
    pub(super) step: u64,
    #[cfg(feature = "checkpoints")]
    pub(super) identity: Identity,
}

impl Simulation {
    /// Builds the tool and, with [`ToolDescription::static_start`], brings it to rest under gravity and the initial
    /// weight on bit.
    ///
    /// # Errors
    /// When description or settings cannot be computed with, or the static start does not converge.
    pub fn new(tool: &ToolDescription, settings: &SimulationSettings) -> Result<Self, BuildError> {
        Self::with_solver(tool, settings, SolverKind::default(), Instructions::best())
    }

    /// The same with a choice of linear solver and of vector instructions, for comparisons.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_solver(
        tool: &ToolDescription,
        settings: &SimulationSettings,
        solver: SolverKind,
        instructions: Instructions,
    ) -> Result<Self, BuildError> {
        // The factor scales tolerances only; the number of iterations is a setting.
        let tolerances = Tolerances {
            max_iterations: settings.max_iterations,
            ..Tolerances::default().times(settings.residual_factor)
        };
        // All checks before the stepper is built, which takes seconds for a long tool.
        tool.validate().map_err(BuildError::Tool)?;
        settings
            .validate(tool.links * tool.elements_per_link)
            .map_err(BuildError::Settings)?;
        // Waves above the tool set a bound on the step that only both together show.
        tool.check_step(settings.time_step).map_err(BuildError::Settings)?;
        let mut stepper = Stepper::new(
            tool,
            &StepperSettings {
                time_step: settings.time_step,
                scheme: settings.scheme,
                tolerances,
                max_halvings: settings.max_halvings,
                solver,
                instructions,
            },
        )
        .map_err(BuildError::Tool)?;
        // Under gravity and load the tool needs seconds of model time to
        // come to rest; the static start finds that directly.
        let start = if tool.static_start {
            stepper.settle(&settings.initial_inputs)?
        } else {
            stepper.start_as_given(&settings.initial_inputs, settings.time_step)?
        };
        // The observer takes its sizes and depths from the tool as built.
        let observer = Observer::new(&stepper, settings);
        let mut simulation = Self {
            settings: settings.clone(),
            applied: Applied::default(),
            stepper,
            start: Arc::new(start),
            observer,
            step: 0,
            #[cfg(feature = "checkpoints")]
            // A checkpoint is only accepted by the same tool and settings.
            identity: Identity::of(tool, settings)?,
        };
        // `reset` brings everything to the start, so that a first run and one after a reset are the same to the bit.
        simulation.reset();
        Ok(simulation)
    }

    /// Another simulation in the same state, which shares nothing that changes with this one: with the same inputs it
    /// moves to the same bits, and neither knows of the other. The tool as built, the matrices of its spans and those of
    /// a step are shared; the rest is copied. The fork's phases are not timed.
    #[must_use]
    pub fn fork(&self) -> Self {
        let mut fork = Self {
            settings: self.settings.clone(),
            stepper: self.stepper.clone(),
            start: Arc::clone(&self.start),
            observer: self.observer.clone(),
            applied: self.applied,
            step: self.step,
            #[cfg(feature = "checkpoints")]
            identity: self.identity,
        };
        fork.stepper.stopwatch().set_clock(None);
        fork
    }

    /// Adds to the lateral velocity of the pipe (m/s), node by node from the top and in both directions, what `velocity`
    /// returns. By a disturbance too small to measure, forks of one state part as the motion of the tool is sensitive to
    /// it. The energy audit does not count what it adds.
    pub fn disturb(&mut self, velocity: impl FnMut() -> f64) {
        self.stepper.disturb(velocity);
    }

    /// Advances by one step of [`SimulationSettings::time_step`] towards `inputs`, as fast as the slew limits allow.
    /// When the step fails, or an input is out of [`Inputs::bounds`], nothing changes but the counters.
    pub fn advance(&mut self, inputs: &Inputs) -> StepOutcome {
        // Checked in every step, because callers may pass any numbers; the
        // state must not be touched by one that is out of bounds.
        if let Some(kind) = inputs.out_of_bounds() {
            return StepOutcome::Failed(self.stepper.refuse_input(kind, inputs.get(kind)));
        }
        let dt = self.settings.time_step;
        // The model never sees a jump: inputs approach their targets by the slew limits.
        let (before, settings) = (self.applied.inputs(), &self.settings);
        let slew = settings.weight_on_bit_slew * dt;
        // A weight that is set at the kick-off is reached there by way of the weight at the bit.
        let weight_set = towards(self.applied.weight_set, inputs.weight_on_bit, slew);
        let after = Inputs {
            rotary_speed: towards(
                before.rotary_speed,
                inputs.rotary_speed,
                settings.rotary_speed_slew * dt,
            ),
            weight_on_bit: self.weight_at_bit(weight_set, dt),
            rate_of_penetration: towards(
                before.rate_of_penetration,
                inputs.rate_of_penetration,
                settings.rate_of_penetration_slew * dt,
            ),
            standpipe_pressure: towards(
                before.standpipe_pressure,
                inputs.standpipe_pressure,
                settings.standpipe_pressure_slew * dt,
            ),
        };
        // Inputs change linearly within the step, so that parts of it have their own share.
        let forcing = Forcing::between(&before, &after);
        self.stepper.stopwatch().start();
        let outcome = self.stepper.advance(dt, &forcing);
        self.stepper.stopwatch().lap(Phase::Other);
        // Only a step that was taken counts: after a failure all statistics remain those of the last good state.
        if let StepOutcome::Advanced { iterations, .. } = outcome {
            self.step += 1;
            self.applied = Applied {
                rotary_speed: after.rotary_speed,
                weight_on_bit: after.weight_on_bit,
                rate_of_penetration: after.rate_of_penetration,
                standpipe_pressure: after.standpipe_pressure,
                weight_set,
                weight_at_kickoff: self.stepper.weight_at_kickoff(),
                drive_angle: self.stepper.drive_angle(),
                drive_torque: self.stepper.drive_torque(),
            };
            self.observer
                .after_step(&mut self.stepper, &self.applied, self.step, dt, iterations);
        }
        self.stepper.stopwatch().stop(Phase::Analysis);
        outcome
    }

    /// Weight at the bit (N) after a step of size `dt` (s) with a weight `set` (N). One that is set at the kick-off is
    /// reached by the guide's reaction there: W_b' = (set - reaction) / (tau e^(mu theta)), by no more than what a rope
    /// passes on round the arc, so that the reaction follows in tau or slower. The rock does not pull.
    fn weight_at_bit(&self, set: f64, dt: f64) -> f64 {
        let description = &self.stepper.model().description;
        let reaction = match description.weight_place {
            WeightPlace::Bit => None,
            WeightPlace::Kickoff => self.applied.weight_at_kickoff,
        };
        reaction.map_or(set, |reaction| {
            let gain = libm::exp(description.round_the_arc(&self.stepper.live()));
            let [least, most] = Inputs::bounds(InputKind::WeightOnBit);
            let change = dt / (WEIGHT_TIME * gain) * (set - reaction);
            (self.applied.weight_on_bit + change).clamp(least, most)
        })
    }

    /// A snapshot of the right sizes, to be filled by [`Simulation::snapshot`].
    pub fn new_snapshot(&self) -> Snapshot {
        let mut out = self.observer.new_snapshot(self.stepper.model());
        self.fill(&self.stepper.state(), &mut out);
        out
    }

    /// Fills `out` without allocating. With `end_interval`, the statistics of the contact forces (peaks, root mean squares)
    /// and of the bit (means, root mean squares, peaks) restart.
    pub fn snapshot(&mut self, out: &mut Snapshot, end_interval: bool) {
        let ends = if end_interval {
            EndsInterval::ALL
        } else {
            EndsInterval::NONE
        };
        self.snapshot_ending(out, ends);
    }

    /// The same, after which only these statistics restart.
    pub(super) fn snapshot_ending(&mut self, out: &mut Snapshot, ends: EndsInterval) {
        self.stepper.stopwatch().start();
        self.stepper.refresh_view();
        self.fill(self.stepper.view(), out);
        self.observer.end_interval(ends);
        self.stepper.stopwatch().stop(Phase::Snapshot);
    }

    fn fill(&self, state: &State, out: &mut Snapshot) {
        out.step = self.step;
        out.time = self.time();
        out.applied = self.applied;
        out.energy = *self.stepper.audit();
        out.solver = self.solver_counters();
        self.observer.fill(&self.stepper, state, out);
    }

    /// Parameters that may change while running.
    pub fn live(&self) -> LiveParameters {
        self.stepper.live()
    }

    /// Replaces the live parameters from the next step on.
    ///
    /// # Errors
    /// When one is not finite or negative; then all stay.
    pub fn set_live(&mut self, live: LiveParameters) -> Result<(), ValidationError> {
        live.validate()?;
        self.replace_live(live);
        Ok(())
    }

    pub(super) fn replace_live(&mut self, live: LiveParameters) {
        self.stepper.set_live(live);
    }

    /// Replaces the slew limits of rotary speed (rad/s2) and weight on bit (N/s); those of the other inputs stay.
    ///
    /// # Errors
    /// When one is not finite or negative; then both stay.
    pub fn set_slew(&mut self, rotary_speed: f64, weight_on_bit: f64) -> Result<(), ValidationError> {
        let [.., advance, standpipe_pressure] = self.settings.slew();
        let slew = [rotary_speed, weight_on_bit, advance, standpipe_pressure];
        validate_slew(slew)?;
        self.replace_slew(slew);
        Ok(())
    }

    pub(super) fn replace_slew(&mut self, slew: [f64; 4]) {
        [
            self.settings.rotary_speed_slew,
            self.settings.weight_on_bit_slew,
            self.settings.rate_of_penetration_slew,
            self.settings.standpipe_pressure_slew,
        ] = slew;
    }

    /// Replaces the thresholds of the whirl analysis. They change the reports, not the motion.
    ///
    /// # Errors
    /// When they do not hold, see [`WhirlSettings::validate`]; then the present ones stay.
    pub fn set_whirl(&mut self, whirl: &WhirlSettings) -> Result<(), ValidationError> {
        whirl.validate()?;
        self.replace_whirl(whirl);
        Ok(())
    }

    /// Divides every step into 2^`refinement` equal parts from the next one on, at most four. The motion changes as
    /// with another step; inputs, samples and outputs keep the model step.
    pub fn set_refinement(&mut self, refinement: u32) {
        self.stepper.set_refinement(refinement);
        self.observer.set_refinement(self.stepper.refinement());
    }

    pub(super) fn replace_whirl(&mut self, whirl: &WhirlSettings) {
        self.observer.set_whirl(whirl);
    }

    /// Measures the computing time of each phase with `clock` from now on. The motion is unaffected.
    pub fn set_clock(&mut self, clock: Clock) {
        self.stepper.stopwatch().set_clock(Some(clock));
    }

    /// Computing time per phase since [`Simulation::set_clock`]; zeros without a clock. Resets and checkpoints keep it.
    pub fn phase_times(&self) -> PhaseTimes {
        self.stepper.phase_times()
    }

    /// Sets the trust in the inputs, 0 to 1. It changes the reports, not the motion.
    pub fn set_input_trust(&mut self, trust: f64) {
        self.observer.set_input_trust(trust);
    }

    /// Steps taken since the start or the last reset.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Model time (s).
    pub fn time(&self) -> f64 {
        self.step as f64 * self.settings.time_step
    }

    /// The present settings, with slew limits as set last.
    pub fn settings(&self) -> &SimulationSettings {
        &self.settings
    }

    pub(crate) fn stepper(&self) -> &Stepper {
        &self.stepper
    }

    /// Resets the motion to the state after the start; live parameters and slew limits stay.
    pub fn reset(&mut self) {
        let mut inputs = self.settings.initial_inputs;
        // A tool that starts from rest is run up from standstill, and advances from standstill; one that starts in
        // motion is driven at its speed at once.
        if self.stepper.model().description.static_start {
            (inputs.rotary_speed, inputs.rate_of_penetration) = (0.0, 0.0);
        }
        self.stepper.start_from(&self.start, &inputs);
        self.step = 0;
        self.applied = Applied {
            rotary_speed: inputs.rotary_speed,
            drive_angle: 0.0,
            weight_on_bit: inputs.weight_on_bit,
            rate_of_penetration: inputs.rate_of_penetration,
            standpipe_pressure: inputs.standpipe_pressure,
            weight_set: inputs.weight_on_bit,
            weight_at_kickoff: self.stepper.weight_at_kickoff(),
            drive_torque: self.stepper.drive_torque(),
        };
        self.observer.reset(&self.stepper);
    }
}

/// `from` moved towards `target` by at most `most`, and not at all if that is negative or NaN.
fn towards(from: f64, target: f64, most: f64) -> f64 {
    let most = most.max(0.0);
    from + (target - from).clamp(-most, most)
}
