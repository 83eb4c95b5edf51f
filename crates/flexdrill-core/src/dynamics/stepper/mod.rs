//! The tool in motion: steps that are halved and retried until they converge, or reported as failed.

#[cfg(feature = "checkpoints")]
mod checkpoint;
mod looks;
mod outside;
mod settings;

use std::f64::consts::TAU;

use crate::chain::{Chain, ChainEquations};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::{SpanWorks, StepEnds};
use crate::dynamics::interactions::Interactions;
use crate::dynamics::newton::{self, Rejected, Stride};
use crate::dynamics::numbered::Numbered;
use crate::dynamics::outcome::{EnergyAudit, FailureCause, StepFailure, StepOutcome};
use crate::dynamics::phases::{Phase, PhaseTimes, Stopwatch};
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::stations::{StationEquations, StationRoom};
use crate::dynamics::sub_steps::{SubSteps, most_attempts};
use crate::dynamics::tolerances::{Accuracy, Tolerances};
use crate::dynamics::track::Track;
use crate::inputs::InputKind;
#[cfg(test)]
use crate::linear::SparseReference;
use crate::linear::{BlockLu, LinearSolver};
use crate::model::Model;
use crate::simd::Instructions;
use crate::tool::description::{Body, Direction, LiveParameters, ToolDescription};
use crate::validation::ValidationError;

#[cfg(feature = "checkpoints")]
pub use checkpoint::StepperCheckpoint;
pub use settings::{Counters, Forcing, SolverKind, StepperSettings};

/// A whole step, of which parts are taken.
struct WholeStep {
    /// Its size (s).
    h: f64,
    /// Time at its start (s).
    time: f64,
    /// Angle of the drive at its start (rad).
    drive_angle: f64,
    forcing: Forcing,
}

impl WholeStep {
    /// Angle of the drive (rad) at a part of the step, 0 to 1: the speed changes linearly.
    fn drive_angle_at(&self, part: f64) -> f64 {
        let [speed_0, speed_1] = self.forcing.rotary_speed;
        self.drive_angle + self.h * part * (speed_0 + 0.5 * (speed_1 - speed_0) * part)
    }
}

/// Finest refinement: a step in four parts.
pub const MOST_REFINEMENT: u32 = 2;

/// Whole turns after which they are subtracted from the pipe's spins, so that the rounding of the angles stays below that of
/// the forces however long the tool runs.
const UNWIND_TURNS: f64 = 1000.0;

/// Model, state and solver.
pub struct Stepper {
    model: Model,
    tolerances: Tolerances,
    instructions: Instructions,
    scheme: Scheme,
    max_halvings: u32,
    /// Steps are taken in 2^refinement parts.
    refinement: u32,
    live: LiveParameters,
    /// Contacts, joints and bit at the end of the last step.
    interactions: Interactions,
    stopwatch: Stopwatch,
    /// The tool over its nodes; `None` where steps are taken over all stations.
    chain: Option<Chain>,
    /// The tool over all stations, for the start.
    stations: StationRoom,
    /// Where the motion is: in the numbering of the chain, or without one in that of the model.
    track: Track,
    /// The present state in the numbering of the model, as it was asked for last; of a chain only.
    view: State,
    view_is_current: bool,
    audit: EnergyAudit,
    counters: Counters,
    /// Whole turns subtracted from the spins so far.
    turns: f64,
    weight_on_bit: f64,
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
            solver: kind,
            instructions,
        } = *settings;
        let model = Model::new(description)?;
        let solver: Box<dyn LinearSolver> = match kind {
            SolverKind::Chain | SolverKind::Stations => Box::new(BlockLu::new(&model.layout, instructions)),
            #[cfg(test)]
            SolverKind::Reference => Box::new(SparseReference::default()),
        };
        let view = State::at_rest(&model);
        let chain = (kind == SolverKind::Chain).then(|| Chain::of(&model, &tolerances, h, instructions));
        let track = match &chain {
            Some(chain) => Track::new(&model, chain.state(), chain.spans()),
            None => Track::new(&model, view.clone(), 0),
        };
        let mut stepper = Self {
            tolerances,
            instructions,
            scheme,
            max_halvings,
            refinement: 0,
            live: LiveParameters::of(description),
            interactions: Interactions::new(&model, instructions),
            stopwatch: Stopwatch::default(),
            stations: StationRoom::new(&model, solver, tolerances, instructions),
            chain,
            track,
            view,
            view_is_current: false,
            audit: EnergyAudit::default(),
            counters: Counters::default(),
            turns: 0.0,
            weight_on_bit: 0.0,
            prepared_for: 0.0,
            model,
        };
        stepper.prepare(h);
        Ok(stepper)
    }

    /// The tool as built.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Contacts, joints and bit at the end of the last step.
    pub fn interactions(&self) -> &Interactions {
        &self.interactions
    }

    #[cfg(test)]
    /// The last residual over all stations, with its reactions.
    pub(crate) fn station_residual(&self) -> &[f64] {
        &self.stations.assembler.residual
    }

    /// When a step counts as solved.
    pub(super) fn tolerances(&self) -> &Tolerances {
        &self.tolerances
    }

    /// Energy since the start.
    pub fn audit(&self) -> &EnergyAudit {
        &self.audit
    }

    /// Counters since the start.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Nodes of the chain, if steps are taken over one.
    pub fn chain_nodes(&self) -> Option<usize> {
        self.chain.as_ref().map(Chain::nodes)
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
        let finest = |chain: &Chain| chain.finest_refinement(self.prepared_for);
        self.chain.as_ref().map_or(MOST_REFINEMENT, finest).min(MOST_REFINEMENT)
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
        self.track.energy.drive_torque
    }

    /// Live parameters in force.
    pub fn live(&self) -> LiveParameters {
        self.live
    }

    /// Sets the live parameters from the next step on.
    pub fn set_live(&mut self, live: LiveParameters) {
        self.live = live;
    }

    /// The equations over all stations.
    pub(super) fn over_stations(&mut self) -> StationEquations<'_> {
        StationEquations {
            model: &self.model,
            room: &mut self.stations,
            interactions: &mut self.interactions,
            stopwatch: &mut self.stopwatch,
        }
    }

    /// Conditions at `time` under `weight_on_bit`.
    pub fn conditions(&self, time: f64, weight_on_bit: f64) -> Conditions {
        Conditions::new(&self.model.description, &self.live, time, weight_on_bit)
    }

    /// Takes `state`, in the numbering of the model, as the present one, with the audit starting at zero. The
    /// accelerations must balance the forces.
    pub fn start_from(&mut self, state: &State, weight_on_bit: f64) {
        let conditions = self.conditions(state.time, weight_on_bit);
        let (to, scratch) = (&mut self.track.state, &mut self.track.trial);
        if let Some(chain) = &mut self.chain {
            // The view keeps what the chain has no unknowns for, and never writes: supports' and padding's values.
            self.view.copy_from(state);
            chain.take(&self.model, state, to);
            let mut equations = ChainEquations {
                model: &self.model,
                chain,
                interactions: &mut self.interactions,
                stopwatch: &mut self.stopwatch,
            };
            // The balance over all stations is not quite the balance over the nodes.
            let at_rest = to.v.iter().all(|&v| v == 0.0);
            if at_rest {
                equations.polish_rest(to, scratch, &conditions);
            }
            let h = if at_rest { 0.0 } else { self.prepared_for };
            scratch.copy_from(to);
            if equations.balance_accelerations(scratch, &conditions, h).is_ok() {
                to.copy_from(scratch);
            }
        } else {
            to.copy_from(state);
        }
        if state.scheme_step == 0.0 {
            let State { a, lagged, .. } = to;
            lagged.copy_from_slice(a);
        }
        self.evaluate(&conditions, self.chain.is_none());
        self.audit = EnergyAudit::default();
        self.counters = Counters::default();
        self.turns = 0.0;
        self.weight_on_bit = weight_on_bit;
    }

    /// Evaluates forces and energies of the present state, with the axial forces that it holds or, without
    /// `keep_axial`, those of its displacements.
    fn evaluate(&mut self, conditions: &Conditions, keep_axial: bool) {
        let Self {
            model,
            chain,
            stations,
            interactions,
            stopwatch,
            track,
            ..
        } = self;
        let (state, energy) = (&mut track.state, &mut track.energy);
        if let Some(chain) = chain {
            let mut equations = ChainEquations {
                model,
                chain,
                interactions,
                stopwatch,
            };
            equations.evaluate(state, conditions, keep_axial);
            equations.energy(energy, state, conditions);
        } else {
            stations.assembler.residual(interactions, model, state, conditions);
            energy.evaluate(model, state, conditions, &stations.assembler, interactions);
        }
        self.view_is_current = false;
    }

    /// Angle of the drive since the start (rad).
    pub fn drive_angle(&self) -> f64 {
        self.track.state.drive_angle + self.turns * TAU
    }

    /// Subtracts whole turns from the spins of the pipe.
    fn unwind(&mut self) {
        let state = &mut self.track.state;
        if state.drive_angle.abs() < UNWIND_TURNS * TAU {
            return;
        }
        let turns = UNWIND_TURNS.copysign(state.drive_angle);
        self.turns += turns;
        state.drive_angle -= turns * TAU;
        let mut unwind = |spin: usize| state.q[spin] -= turns * TAU;
        if let Some(chain) = &self.chain {
            chain.spins().for_each(unwind);
            return;
        }
        for station in &self.model.stations {
            unwind(station.pipe_above + Direction::Psi as usize);
            if station.pipe_below != station.pipe_above {
                unwind(station.pipe_below + Direction::Psi as usize);
            }
        }
    }

    /// Makes what steps of size `h` (s) and their halves need, so that [`Stepper::advance`] does not.
    pub fn prepare(&mut self, h: f64) {
        if self.prepared_for == h {
            return;
        }
        self.prepared_for = h;
        let (conditions, finest) = (self.conditions(0.0, 0.0), self.finest_level());
        if let Some(chain) = &mut self.chain {
            for level in 0..=finest {
                let factors = self.scheme.factors(h / f64::from(1_u32 << level));
                chain.prepare(&self.model, &conditions, factors);
            }
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

    /// Advances by `h` (s) under `forcing`, in the parts of [`Stepper::set_refinement`]. A sub-step that does not converge
    /// is halved and retried; when the smallest one fails, the state stays that before the step.
    pub fn advance(&mut self, h: f64, forcing: &Forcing) -> StepOutcome {
        self.prepare(h);
        let whole = WholeStep {
            h,
            time: self.track.state.time,
            drive_angle: self.track.state.drive_angle,
            forcing: *forcing,
        };
        let audit_before = self.audit;
        let mut sub_steps = SubSteps::new(self.max_halvings, self.refinement);
        if self.refinement > 0 {
            self.track.keep();
        }
        let mut iterations = 0;
        while let Some(part) = sub_steps.part() {
            match self.sub_step(&whole, part) {
                Ok(made) => {
                    iterations += made;
                    sub_steps.accept();
                }
                Err(Rejected {
                    iterations: made,
                    failure,
                }) => {
                    iterations += made;
                    self.counters.rejected += 1;
                    self.counters.last_rejection = Some(failure);
                    if sub_steps.is_first() {
                        // Nothing has changed yet. From here on a later part may fail after an earlier one was taken.
                        self.track.keep();
                    }
                    if !sub_steps.reject() {
                        self.track.retreat();
                        self.audit = audit_before;
                        self.counters.failed_steps += 1;
                        self.counters.iterations += u64::from(iterations);
                        return StepOutcome::Failed(failure);
                    }
                }
            }
        }
        let deepest = sub_steps.deepest();
        self.unwind();
        self.view_is_current = false;
        self.weight_on_bit = forcing.weight_on_bit[1];
        self.counters.iterations += u64::from(iterations);
        self.counters.halved_steps += u64::from(deepest > 0);
        self.counters.deepest_halving = self.counters.deepest_halving.max(deepest);
        StepOutcome::Advanced {
            iterations,
            halvings: deepest,
        }
    }

    /// The sub-step between two parts (0 to 1) of a whole step.
    fn sub_step(&mut self, whole: &WholeStep, (from, to): (f64, f64)) -> Result<u32, Rejected> {
        let [load_0, load_1] = whole.forcing.weight_on_bit;
        let mut conditions = self.conditions(whole.time + whole.h * to, load_0 + (load_1 - load_0) * to);
        conditions.drive_angle = whole.drive_angle_at(to);
        let step = whole.h * (to - from);
        let stride = Stride {
            scheme: self.scheme,
            h: step,
            foresight: step,
            foreseen_part: self.scheme.foreseen_part(),
            accuracy: Accuracy::Motion,
            most_iterations: self.tolerances.max_iterations,
        };
        let Self {
            model,
            chain,
            stations,
            interactions,
            stopwatch,
            track,
            ..
        } = self;
        let (from, to, energy) = (&track.state, &mut track.trial, &mut track.trial_energy);
        let (iterations, numbered, spans) = if let Some(chain) = chain {
            // Spans are deflected by the forces at the start of the step.
            to.deflection.copy_from_slice(&track.energy.deflection);
            let mut equations = ChainEquations {
                model,
                chain,
                interactions,
                stopwatch,
            };
            let made = newton::step(&mut equations, &stride, &conditions, from, to)?;
            equations.energy(energy, to, &conditions);
            track.measure_displacements();
            let spans = chain.span_works(&track.moved, &track.energy.spans, &track.trial_energy.spans);
            (made, chain.model.numbered(model), spans)
        } else {
            let mut equations = StationEquations {
                model,
                room: stations,
                interactions,
                stopwatch,
            };
            let made = newton::step(&mut equations, &stride, &conditions, from, to)?;
            energy.evaluate(model, to, &conditions, &stations.assembler, interactions);
            track.measure_displacements();
            (made, Numbered::of(model), SpanWorks::default())
        };
        let ends = StepEnds {
            h: step,
            moved: &track.moved,
            spans,
            before: (&track.state, &track.energy),
            after: (&track.trial, &track.trial_energy),
        };
        self.audit.add_step(&numbered, &ends, self.instructions);
        stopwatch.lap(Phase::Energy);
        track.take();
        Ok(iterations)
    }
}
