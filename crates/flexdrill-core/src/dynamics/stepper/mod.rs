//! The tool in motion: steps that are halved and retried until they converge, or reported as failed.

mod checkpoint;
mod outside;

use std::cell::{Ref, RefCell};
use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::dynamics::conditions::Conditions;
use crate::dynamics::newton::{self, Stride};
use crate::dynamics::outcome::{EnergyAudit, FailureCause, StepFailure, StepOutcome};
use crate::dynamics::phases::{Phase, Stopwatch};
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::{State, translation};
use crate::dynamics::station_equations::StationEquations;
use crate::dynamics::sub_steps::{SubSteps, most_attempts};
use crate::dynamics::tolerances::{Accuracy, Tolerances};
use crate::dynamics::track::Track;
use crate::dynamics::view::{BottomMotion, Shown, StateView};
use crate::inputs::InputKind;
#[cfg(feature = "reference")]
use crate::linear::SparseReference;
use crate::linear::{BlockLu, LinearSolver};
use crate::model::Model;
use crate::reduced::{self, Reduced};
use crate::simd::Instructions;
use crate::tool::description::{Body, Direction, LiveParameters, ToolDescription};
use crate::validation::ValidationError;

pub use checkpoint::StepperCheckpoint;

/// Inputs over one step: both change linearly from its start to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forcing {
    /// Speed of the top drive at start and end (rad/s).
    pub rotary_speed: [f64; 2],
    /// Weight on bit at start and end (N).
    pub weight_on_bit: [f64; 2],
}

/// Which linear solver to use.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SolverKind {
    /// Over the chain of nodes.
    #[default]
    Chain,
    /// Over all stations by block LU: slower and plain, to hold the chain against.
    Stations,
    /// faer's sparse LU, to hold block LU against.
    #[cfg(feature = "reference")]
    Reference,
}

/// Counters since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Counters {
    /// Newton iterations, rejected ones included.
    pub iterations: u64,
    /// Sub-steps that did not converge and were tried again at half the size.
    pub rejected: u64,
    /// Steps that were split.
    pub halved_steps: u64,
    /// Most halvings that a step has needed.
    pub deepest_halving: u32,
    /// Steps that did not converge at the smallest sub-step; the state stayed that before.
    pub failed_steps: u64,
    /// Why and where the last sub-step was rejected.
    pub last_rejection: Option<StepFailure>,
}

/// Finest refinement: a step in four parts.
pub const MOST_REFINEMENT: u32 = 2;

/// Whole turns after which they are taken off the pipe's spins, so that the rounding of the angles stays below that of
/// the forces however long the tool runs.
const UNWIND_TURNS: f64 = 1000.0;

/// Model, state and solver.
pub struct Stepper {
    model: Model,
    newton: StationEquations,
    scheme: Scheme,
    max_halvings: u32,
    /// Steps are taken in 2^refinement parts.
    refinement: u32,
    live: LiveParameters,
    track: Track,
    /// Whether steps are to be taken over a chain of nodes.
    chain: bool,
    /// The tool over its nodes, made for the first step size, and the state as the model numbers it.
    reduced: Option<(Reduced, RefCell<Shown>)>,
    /// Whether steps are taken over the joints.
    over_joints: bool,
    audit: EnergyAudit,
    counters: Counters,
    /// Whole turns taken off the spins so far.
    turns: f64,
    weight_on_bit: f64,
    /// Step size that the chain is prepared for (s); 0 before the first one.
    prepared_for: f64,
}

impl Stepper {
    /// Builds the tool in its initial state: as given, or at rest if the description asks for it and
    /// [`Stepper::settle`] is called.
    ///
    /// # Errors
    /// See [`Model::new`].
    pub fn new(
        description: &ToolDescription,
        scheme: Scheme,
        tolerances: Tolerances,
        max_halvings: u32,
        kind: SolverKind,
        instructions: Instructions,
    ) -> Result<Self, ValidationError> {
        let model = Model::new(description)?;
        let solver: Box<dyn LinearSolver> = match kind {
            SolverKind::Chain | SolverKind::Stations => Box::new(BlockLu::new(&model.layout, instructions)),
            #[cfg(feature = "reference")]
            SolverKind::Reference => Box::new(SparseReference::default()),
        };
        let state = State::at_rest(&model);
        Ok(Self {
            newton: StationEquations::new(&model, solver, tolerances, instructions),
            scheme,
            max_halvings,
            refinement: 0,
            live: LiveParameters::of(description),
            chain: kind == SolverKind::Chain,
            reduced: None,
            over_joints: false,
            track: Track::new(&model, state, 0),
            audit: EnergyAudit::default(),
            counters: Counters::default(),
            turns: 0.0,
            weight_on_bit: 0.0,
            prepared_for: 0.0,
            model,
        })
    }

    /// The tool as built.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// State at the end of the last step.
    pub fn state(&self) -> StateView<'_> {
        let Some((reduced, shown)) = self.reduced.as_ref().filter(|_| self.over_joints) else {
            return StateView::Stations(&self.track.state);
        };
        let (now, forces) = (&self.track.state, &self.track.energy.joints);
        let outdated = shown.borrow().outdated();
        if outdated {
            let mut shown = shown.borrow_mut();
            shown.bring_up(|full| reduced.show(&self.model, now, forces, full));
        }
        StateView::Joints(Ref::map(shown.borrow(), Shown::state))
    }

    /// How the bottom of the pipe moves at the end of the last step.
    pub(crate) fn bottom_motion(&self) -> BottomMotion {
        let (state, last) = (&self.track.state, self.model.last());
        let bottom = &self.model.stations[last];
        let (spin, axial) = (bottom.pipe_above + Direction::Psi as usize, bottom.pipe_above);
        match &self.reduced {
            Some((reduced, _)) if self.over_joints => {
                let mut above = reduced.pipe_translation(&state.a, last - 1);
                if let Some(joint) = self.model.stations[last - 1].joint {
                    let at = &self.model.joints[joint];
                    above = at.lower.tr_mul(&(at.upper * above));
                }
                let at_bottom = reduced.pipe_translation(&state.a, last);
                let spin = reduced.places.bit_spin;
                BottomMotion::new([state.v[spin], state.a[spin]], at_bottom.x, above)
            }
            _ => {
                let above = translation(&state.a, self.model.stations[last - 1].pipe_below);
                BottomMotion::new([state.v[spin], state.a[spin]], state.a[axial], above)
            }
        }
    }

    /// Newton's parts: the assembler holds the forces of the present state.
    pub fn newton(&self) -> &StationEquations {
        &self.newton
    }

    /// Energy since the start.
    pub fn audit(&self) -> &EnergyAudit {
        &self.audit
    }

    /// Counters since the start.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Most Newton corrections (each an assembly and a solution) that one [`Stepper::advance`] can make, whatever
    /// happens.
    pub fn most_iterations(&self) -> u64 {
        most_attempts(self.max_halvings.max(self.refinement)) * u64::from(self.newton.tolerances.max_iterations)
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
        let chain = self.reduced.as_ref();
        let finest = chain.map_or(MOST_REFINEMENT, |(chain, _)| chain.finest_refinement(self.prepared_for));
        finest.min(MOST_REFINEMENT)
    }

    /// Times the phases of [`Stepper::advance`] while it runs.
    pub fn stopwatch(&mut self) -> &mut Stopwatch {
        &mut self.newton.assembler.stopwatch
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

    /// Goes back to the stations, where a start is found; [`Stepper::prepare`] then decides anew.
    pub(crate) fn leave_joints(&mut self) {
        if self.over_joints {
            self.over_joints = false;
            self.prepared_for = 0.0;
            self.track = Track::new(&self.model, State::at_rest(&self.model), 0);
        }
    }

    /// What the static start works on, station by station.
    pub(crate) fn parts(&mut self) -> (&Model, &mut StationEquations, &mut State, &mut State) {
        (
            &self.model,
            &mut self.newton,
            &mut self.track.state,
            &mut self.track.trial,
        )
    }

    /// Conditions at `time` under `weight_on_bit`.
    pub fn conditions(&self, time: f64, weight_on_bit: f64) -> Conditions {
        Conditions::new(&self.model.description, &self.live, time, weight_on_bit)
    }

    /// Takes `state` as the present one, with the audit starting at zero. The accelerations must balance the forces.
    pub fn start_from(&mut self, state: &State, weight_on_bit: f64) {
        let conditions = self.conditions(state.time, weight_on_bit);
        if let (true, Some((reduced, shown))) = (self.over_joints, &mut self.reduced) {
            let track = &mut self.track;
            shown.get_mut().copy_from(state);
            reduced.numbering.gather(state, &mut track.state);
            reduced.take_bows(&self.model, state, &mut track.state);
            let mut equations = reduced::equations(reduced, &mut self.newton.assembler);
            let (to, scratch) = (&mut track.state, &mut track.trial);
            // The stations' balance is not quite the joints'.
            let at_rest = to.v.iter().all(|&v| v == 0.0);
            if at_rest {
                equations.polish_rest(&self.model, to, scratch, &conditions);
            }
            let h = if at_rest { 0.0 } else { self.prepared_for };
            scratch.copy_from(to);
            if equations
                .balance_accelerations(&self.model, scratch, &conditions, h)
                .is_ok()
            {
                to.copy_from(scratch);
            }
        } else {
            self.track.state.copy_from(state);
        }
        if state.scheme_step == 0.0 {
            let State { a, lagged, .. } = &mut self.track.state;
            lagged.copy_from_slice(a);
        }
        self.evaluate(&conditions, !self.over_joints);
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
            newton,
            reduced,
            track,
            ..
        } = self;
        let assembler = &mut newton.assembler;
        if let (true, Some((reduced, shown))) = (self.over_joints, reduced) {
            reduced::equations(reduced, assembler).evaluate(model, &mut track.state, conditions, keep_axial);
            reduced.energy(&mut track.energy, model, &track.state, conditions, assembler);
            shown.get_mut().outdate();
        } else {
            assembler.residual(model, &track.state, conditions);
            track.energy.evaluate(model, &track.state, conditions, assembler);
        }
    }

    /// Angle of the drive since the start (rad).
    pub fn drive_angle(&self) -> f64 {
        self.track.state.drive_angle + self.turns * TAU
    }

    /// Takes whole turns off the spins of the pipe.
    fn unwind(&mut self) {
        let state = &mut self.track.state;
        if state.drive_angle.abs() < UNWIND_TURNS * TAU {
            return;
        }
        let turns = UNWIND_TURNS.copysign(state.drive_angle);
        self.turns += turns;
        state.drive_angle -= turns * TAU;
        let mut unwind = |spin: usize| state.q[spin] -= turns * TAU;
        if let (true, Some((reduced, _))) = (self.over_joints, &self.reduced) {
            reduced.spins().for_each(unwind);
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
        if !self.chain || self.prepared_for == h {
            return;
        }
        let conditions = self.conditions(0.0, 0.0);
        self.prepared_for = h;
        if self.reduced.is_none() {
            let instructions = self.newton.assembler.instructions();
            let reduced = Reduced::of(&self.model, &self.newton.tolerances, h, instructions);
            self.reduced = reduced.map(|reduced| (reduced, RefCell::new(Shown::of(&self.track.state))));
        }
        let finest = self.finest_level();
        let Some((reduced, _)) = &mut self.reduced else { return };
        for level in 0..=finest {
            let factors = self.scheme.factors(h / f64::from(1_u32 << level));
            reduced.prepare(&self.model, &conditions, factors);
        }
        if !self.over_joints {
            let track = Track::new(&self.model, reduced.state(), reduced.spans());
            let before = std::mem::replace(&mut self.track, track).state;
            self.over_joints = true;
            self.start_from(&before, self.weight_on_bit);
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

    /// Advances by `h` (s) under `forcing`, in the parts of [`Stepper::set_refinement`]. A sub-step that does not converge is halved and retried; when the smallest
    /// one fails, the state stays that before the step.
    pub fn advance(&mut self, h: f64, forcing: &Forcing) -> StepOutcome {
        self.prepare(h);
        let start = (self.track.state.time, self.track.state.drive_angle);
        let audit_before = self.audit;
        let mut sub_steps = SubSteps::new(self.max_halvings, self.refinement);
        if self.refinement > 0 {
            self.track.keep();
        }
        let mut iterations = 0;
        while let Some(part) = sub_steps.part() {
            match self.sub_step(h, start, forcing, part) {
                Ok(made) => {
                    iterations += made;
                    sub_steps.accept();
                }
                Err((made, failure)) => {
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
        if let Some((_, shown)) = &mut self.reduced {
            shown.get_mut().outdate();
        }
        self.weight_on_bit = forcing.weight_on_bit[1];
        self.counters.iterations += u64::from(iterations);
        self.counters.halved_steps += u64::from(deepest > 0);
        self.counters.deepest_halving = self.counters.deepest_halving.max(deepest);
        StepOutcome::Advanced {
            iterations,
            halvings: deepest,
        }
    }

    /// The sub-step between two parts (0 to 1) of a step of size `h` that begins at time `start` with the drive at
    /// `start_angle`.
    fn sub_step(
        &mut self,
        h: f64,
        (start, start_angle): (f64, f64),
        forcing: &Forcing,
        (from, to): (f64, f64),
    ) -> Result<u32, (u32, StepFailure)> {
        let time = start + h * to;
        let [load_0, load_1] = forcing.weight_on_bit;
        let mut conditions = self.conditions(time, load_0 + (load_1 - load_0) * to);
        let [speed_0, speed_1] = forcing.rotary_speed;
        conditions.drive_angle = start_angle + h * to * (speed_0 + 0.5 * (speed_1 - speed_0) * to);
        let step = h * (to - from);
        let stride = Stride {
            scheme: self.scheme,
            h: step,
            foresight: step,
            foreseen_part: self.scheme.foreseen_part(),
            accuracy: Accuracy::Motion,
        };
        let stride = (stride, self.newton.tolerances.max_iterations);
        let Self {
            model,
            newton,
            reduced,
            track,
            ..
        } = self;
        let iterations;
        let (from, to, energy) = (&track.state, &mut track.trial, &mut track.trial_energy);
        let (places, weight) = if let (true, Some((reduced, _))) = (self.over_joints, reduced) {
            let mut equations = reduced::equations(reduced, &mut newton.assembler);
            to.bow.copy_from_slice(&track.energy.bow);
            let made = newton::step(&mut equations, model, stride, &conditions, from, to);
            newton.assembler.stopwatch.lap(Phase::Assembly);
            iterations = made?;
            reduced.energy(energy, model, to, &conditions, &newton.assembler);
            (&reduced.places, &reduced.weight)
        } else {
            let made = newton::step(newton, model, stride, &conditions, from, to);
            newton.assembler.stopwatch.lap(Phase::Assembly);
            iterations = made?;
            energy.evaluate(model, to, &conditions, &newton.assembler);
            (&model.places, &model.weight)
        };
        self.audit.add_step(
            (model, places, weight, newton.assembler.instructions()),
            step,
            (&track.state, &track.energy),
            (&track.trial, &track.trial_energy),
            &mut track.moved,
        );
        newton.assembler.stopwatch.lap(Phase::Energy);
        track.take();
        Ok(iterations)
    }
}
