//! The tool in motion: steps that are halved and retried until they converge, or reported as failed.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::EnergyPoint;
use crate::dynamics::newton::{Newton, Tolerances};
use crate::dynamics::outcome::{EnergyAudit, StepFailure, StepOutcome};
use crate::dynamics::phases::{Phase, Stopwatch};
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::sub_steps::{SubSteps, most_attempts};
#[cfg(feature = "reference")]
use crate::linear::SparseReference;
use crate::linear::{BlockLu, LinearSolver};
use crate::model::Model;
use crate::simd::Instructions;
use crate::tool::description::{Direction, LiveParameters, ToolDescription};
use crate::validation::ValidationError;

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
    /// Block elimination along the stations.
    #[default]
    Stations,
    /// faer's sparse LU, to hold the other against.
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

/// All that a run needs to go on bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepperCheckpoint {
    state: State,
    energy: EnergyPoint,
    audit: EnergyAudit,
    counters: Counters,
    live: LiveParameters,
    turns: f64,
    weight_on_bit: f64,
}

/// Whole turns after which they are taken off the pipe's spins, so that the rounding of the angles stays below that of
/// the forces however long the tool runs.
const UNWIND_TURNS: f64 = 1000.0;

/// Model, state and solver.
pub struct Stepper {
    model: Model,
    newton: Newton,
    scheme: Scheme,
    max_halvings: u32,
    live: LiveParameters,
    state: State,
    trial: State,
    before_step: State,
    energy: EnergyPoint,
    trial_energy: EnergyPoint,
    energy_before_step: EnergyPoint,
    /// Room for the displacements of a step.
    moved: Vec<f64>,
    audit: EnergyAudit,
    counters: Counters,
    /// Whole turns taken off the spins so far.
    turns: f64,
    weight_on_bit: f64,
    /// Whether steps in motion may condense links.
    condense: bool,
    /// Step size for which they are condensed (s).
    condensed_for: f64,
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
            SolverKind::Stations => Box::new(BlockLu::new(&model.layout, instructions)),
            #[cfg(feature = "reference")]
            SolverKind::Reference => Box::new(SparseReference::default()),
        };
        let newton = Newton::new(&model, solver, tolerances, instructions);
        let state = State::at_rest(&model);
        let energy = EnergyPoint::new(&model);
        Ok(Self {
            newton,
            scheme,
            max_halvings,
            live: LiveParameters::of(description),
            trial: state.clone(),
            before_step: state.clone(),
            trial_energy: energy.clone(),
            energy_before_step: energy.clone(),
            moved: vec![0.0; model.unknowns()],
            audit: EnergyAudit::default(),
            counters: Counters::default(),
            turns: 0.0,
            weight_on_bit: 0.0,
            condense: kind == SolverKind::Stations,
            condensed_for: 0.0,
            state,
            energy,
            model,
        })
    }

    /// The tool as built.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// State at the end of the last step.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Newton's parts: the assembler holds the forces of the present state.
    pub fn newton(&self) -> &Newton {
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
        most_attempts(self.max_halvings) * u64::from(self.newton.tolerances.max_iterations)
    }

    /// Times the phases of [`Stepper::advance`] while it runs.
    pub fn stopwatch(&mut self) -> &mut Stopwatch {
        &mut self.newton.assembler.stopwatch
    }

    /// Torque of the drive at the end of the last step (N m).
    pub fn drive_torque(&self) -> f64 {
        self.energy.drive_torque
    }

    /// Live parameters in force.
    pub fn live(&self) -> LiveParameters {
        self.live
    }

    /// Sets the live parameters from the next step on.
    pub fn set_live(&mut self, live: LiveParameters) {
        self.live = live;
    }

    pub(crate) fn parts(&mut self) -> (&Model, &mut Newton, &mut State, &mut State) {
        (&self.model, &mut self.newton, &mut self.state, &mut self.trial)
    }

    /// Conditions at `time` under `weight_on_bit`.
    pub fn conditions(&self, time: f64, weight_on_bit: f64) -> Conditions {
        Conditions::new(&self.model.description, &self.live, time, weight_on_bit)
    }

    /// Takes `state` as the present one, with the audit starting at zero. The accelerations must balance the forces.
    pub fn start_from(&mut self, state: &State, weight_on_bit: f64) {
        self.state.copy_from(state);
        if self.state.scheme_step == 0.0 {
            self.state.lagged.copy_from_slice(&state.a);
        }
        let conditions = self.conditions(self.state.time, weight_on_bit);
        self.newton.assembler.residual(&self.model, &self.state, &conditions);
        self.energy
            .evaluate(&self.model, &self.state, &conditions, &self.newton.assembler);
        self.audit = EnergyAudit::default();
        self.counters = Counters::default();
        self.turns = 0.0;
        self.weight_on_bit = weight_on_bit;
    }

    /// Angle of the drive since the start (rad).
    pub fn drive_angle(&self) -> f64 {
        self.state.drive_angle + self.turns * TAU
    }

    /// What it takes to go on from here.
    pub fn checkpoint(&self) -> StepperCheckpoint {
        StepperCheckpoint {
            state: self.state.clone(),
            energy: self.energy.clone(),
            audit: self.audit,
            counters: self.counters,
            live: self.live,
            turns: self.turns,
            weight_on_bit: self.weight_on_bit,
        }
    }

    /// Goes on from a checkpoint of the same model; `false`, and nothing done, if its sizes are another model's.
    pub fn restore(&mut self, checkpoint: &StepperCheckpoint) -> bool {
        let same = checkpoint.state.q.len() == self.state.q.len()
            && checkpoint.state.pipe_axial.len() == self.state.pipe_axial.len()
            && checkpoint.energy.fits(&self.energy);
        if !same {
            return false;
        }
        self.live = checkpoint.live;
        self.start_from(&checkpoint.state, checkpoint.weight_on_bit);
        self.energy.copy_from(&checkpoint.energy);
        self.audit = checkpoint.audit;
        self.counters = checkpoint.counters;
        self.turns = checkpoint.turns;
        true
    }

    /// Takes whole turns off the spins of the pipe.
    fn unwind(&mut self) {
        if self.state.drive_angle.abs() < UNWIND_TURNS * TAU {
            return;
        }
        let turns = UNWIND_TURNS.copysign(self.state.drive_angle);
        self.turns += turns;
        self.state.drive_angle -= turns * TAU;
        for station in &self.model.stations {
            self.state.q[station.pipe_above + Direction::Psi as usize] -= turns * TAU;
            if station.pipe_below != station.pipe_above {
                self.state.q[station.pipe_below + Direction::Psi as usize] -= turns * TAU;
            }
        }
    }

    /// Makes what steps of size `h` (s) and their halves need, so that [`Stepper::advance`] does not.
    pub fn prepare(&mut self, h: f64) {
        if !self.condense || self.condensed_for == h {
            return;
        }
        let conditions = self.conditions(0.0, 0.0);
        for level in 0..=self.max_halvings {
            let factors = self.scheme.factors(h / f64::from(1_u32 << level));
            self.newton.prepare(&self.model, &conditions, factors);
        }
        self.condensed_for = h;
    }

    /// Advances by `h` (s) under `forcing`. A sub-step that does not converge is halved and retried; when the smallest
    /// one fails, the state stays that before the step.
    pub fn advance(&mut self, h: f64, forcing: &Forcing) -> StepOutcome {
        self.prepare(h);
        let start = (self.state.time, self.state.drive_angle);
        let audit_before = self.audit;
        let mut sub_steps = SubSteps::new(self.max_halvings);
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
                    if sub_steps.is_whole() {
                        // Nothing has changed yet. From here on a later part may fail after an earlier one was taken.
                        self.before_step.copy_from(&self.state);
                        self.energy_before_step.copy_from(&self.energy);
                    }
                    if !sub_steps.reject() {
                        self.state.copy_from(&self.before_step);
                        self.energy.copy_from(&self.energy_before_step);
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
        self.trial.predict_axial(&self.model, &self.state, step);
        let made = self.newton.step(
            &self.model,
            self.scheme,
            step,
            &conditions,
            &self.state,
            &mut self.trial,
        );
        self.newton.assembler.stopwatch.lap(Phase::Assembly);
        let made = made?;
        self.trial_energy
            .evaluate(&self.model, &self.trial, &conditions, &self.newton.assembler);
        self.audit.add_step(
            &self.model,
            step,
            (&self.state, &self.energy),
            (&self.trial, &self.trial_energy),
            &mut self.moved,
        );
        self.newton.assembler.stopwatch.lap(Phase::Energy);
        std::mem::swap(&mut self.state, &mut self.trial);
        std::mem::swap(&mut self.energy, &mut self.trial_energy);
        Ok(made)
    }
}
