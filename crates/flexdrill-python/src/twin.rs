//! One run with its configuration.

use std::sync::Arc;

use flexdrill_config::Config;
use flexdrill_core::dynamics::{StepFailure, StepOutcome};
use flexdrill_core::inputs::{InputKind, InputState, Inputs};
use flexdrill_core::tool::LiveParameters;
use flexdrill_core::twin::{BuildError, Run, RunInputs, Simulation, Snapshot};

use crate::judge::{self, Judge};
use crate::recorder::Recorder;

/// Model time (s) between two choices of the step's refinement: the period of node and replay.
const PERIOD: f64 = 5e-3;

/// Largest lateral velocity (m/s) of [`Twin::disturb`], that of the members of a look-ahead: a ten-thousandth of the
/// velocities that the pipe has in drilling, which no instrument in a well resolves.
const DISTURBANCE: f64 = 1e-5;

/// An input is outside the limits of the configuration.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "{kind} = {value} {} at {time} s: must be {min} to {max} {} (inputs.{kind} in the configuration)",
    kind.unit(),
    kind.unit()
)]
pub struct InputError {
    /// Which input.
    pub kind: InputKind,
    /// Model time from which it would act (s).
    pub time: f64,
    /// The value, in the unit of the rig's samples ([`InputKind::unit`]).
    pub value: f64,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

/// The inputs of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Model steps.
    pub steps: u64,
    /// Inputs in SI, each from a number of steps after the beginning on, rising.
    pub changes: Vec<(u64, Inputs)>,
}

/// A run with its configuration.
pub struct Twin {
    config: Arc<Config>,
    run: Run,
    judge: Judge,
    snapshot: Snapshot,
    /// Model steps between two choices of the refinement.
    period: u64,
}

/// Python shares a twin between threads.
const _: () = {
    const fn shared<T: Send + Sync>() {}
    shared::<Twin>();
};

impl Twin {
    /// A run at its start.
    ///
    /// # Errors
    /// When the tool cannot be built or does not come to rest.
    pub fn new(config: Arc<Config>) -> Result<Self, BuildError> {
        let simulation = Simulation::new(&config.tool(), &config.simulation())?;
        let run = Run::new(simulation, judge::schedule(&config));
        Ok(Self::of(config, run))
    }

    /// A run that continues from a simulation's present state, with all alarms normal.
    pub(crate) fn resumed(config: Arc<Config>, simulation: Simulation, inputs: Inputs, refinement: u32) -> Self {
        let mut run = Run::new(simulation, judge::schedule(&config));
        let applied = RunInputs {
            inputs,
            refinement,
            ..run.applied()
        };
        run.apply(&trusted(applied));
        Self::of(config, run)
    }

    fn of(config: Arc<Config>, run: Run) -> Self {
        Self {
            judge: Judge::new(&config, &run),
            snapshot: run.simulation().new_snapshot(),
            period: ((PERIOD / config.solver.time_step).round() as u64).max(1),
            config,
            run,
        }
    }

    /// Another run in the same state; neither knows of the other.
    #[must_use]
    pub fn fork(&self) -> Self {
        Self {
            config: Arc::clone(&self.config),
            run: self.run.fork(),
            judge: self.judge.fork(),
            snapshot: self.snapshot.clone(),
            period: self.period,
        }
    }

    /// The configuration.
    pub fn config(&self) -> &Arc<Config> {
        &self.config
    }

    /// The simulation, read-only.
    pub fn simulation(&self) -> &Simulation {
        self.run.simulation()
    }

    /// The inputs that act now.
    pub fn inputs(&self) -> Inputs {
        self.run.applied().inputs
    }

    /// The refinement of steps in force.
    pub fn refinement(&self) -> u32 {
        self.run.applied().refinement
    }

    /// A value of an input in SI, from one in the unit of the rig's samples, that acts from `time` (s) on.
    ///
    /// # Errors
    /// When it is outside the limits of the configuration, as a sample of the rig would be refused.
    pub fn checked(&self, kind: InputKind, value: f64, time: f64) -> Result<f64, InputError> {
        let rule = self.config.inputs.rules_of(self.config.used_inputs())[kind.index()];
        let (min, max) = (rule.min, rule.max);
        if (min..=max).contains(&value) {
            Ok(kind.to_si(value))
        } else {
            Err(InputError {
                kind,
                time,
                value,
                min,
                max,
            })
        }
    }

    /// Advances by `steps` model steps towards `inputs`. `recorder` takes its samples, with the state at the start if it
    /// has none, and the events of the alarms.
    ///
    /// # Errors
    /// When a step fails; the state is then that before this step.
    pub fn advance(
        &mut self,
        inputs: &Inputs,
        steps: u64,
        mut recorder: Option<&mut Recorder>,
    ) -> Result<(), StepFailure> {
        for number in 0..steps {
            let step = self.run.simulation().step();
            if number == 0 || step.is_multiple_of(self.period) {
                self.apply(inputs, step);
            }
            if step == 0 {
                let first = recorder.as_deref_mut().filter(|recorder| recorder.samples() == 0);
                self.look_where_due(first);
            }
            if let StepOutcome::Failed(failure) = self.run.advance() {
                return Err(failure);
            }
            self.look_where_due(recorder.as_deref_mut());
        }
        Ok(())
    }

    /// Judges the alarms and takes a sample, each where it is due.
    fn look_where_due(&mut self, recorder: Option<&mut Recorder>) {
        let events = self.judge.look(&mut self.run);
        let Some(recorder) = recorder else { return };
        recorder.alarms.extend(events);
        if recorder.is_due(self.run.simulation().step()) {
            self.run.look(&mut self.snapshot);
            recorder.sample(&self.snapshot);
        }
    }

    /// Lets `inputs` act, and at the borders of a period the refinement that the motion asks for.
    fn apply(&mut self, inputs: &Inputs, step: u64) {
        let applied = self.run.applied();
        let refinement = if step.is_multiple_of(self.period) {
            self.run.wanted_refinement()
        } else {
            applied.refinement
        };
        let wanted = trusted(RunInputs {
            inputs: *inputs,
            refinement,
            ..applied
        });
        if wanted != applied {
            self.run.apply(&wanted);
        }
    }

    /// Advances by the part of `plan` from `done` steps on, at most `most` steps; returns how many steps are done then.
    ///
    /// # Errors
    /// As [`Twin::advance`].
    pub fn follow(
        &mut self,
        plan: &Plan,
        done: u64,
        most: u64,
        mut recorder: Option<&mut Recorder>,
    ) -> Result<u64, StepFailure> {
        let end = plan.steps.min(done.saturating_add(most));
        let mut at = done;
        while at < end {
            let next = plan.changes.partition_point(|(from, _)| *from <= at);
            let inputs = match next.checked_sub(1).and_then(|last| plan.changes.get(last)) {
                Some((_, inputs)) => *inputs,
                None => self.inputs(),
            };
            let until = plan.changes.get(next).map_or(end, |(from, _)| end.min(*from));
            self.advance(&inputs, until - at, recorder.as_deref_mut())?;
            at = until;
        }
        Ok(at)
    }

    /// Adds a sample of the present state to `recorder`; the statistics go on.
    pub fn look(&self, recorder: &mut Recorder) {
        recorder.sample(&self.run.simulation().new_snapshot());
    }

    /// A snapshot that was filled before, for sizes.
    pub fn sizes(&self) -> &Snapshot {
        &self.snapshot
    }

    /// Resets the motion to the state after the start, and all alarms to normal.
    pub fn reset(&mut self) {
        let initial = self.run.simulation().settings().initial_inputs;
        self.run.apply(&RunInputs {
            reset: true,
            inputs: initial,
            ..self.run.applied()
        });
        let refinement = self.run.wanted_refinement();
        self.run.apply(&RunInputs {
            refinement,
            ..self.run.applied()
        });
        self.judge = Judge::new(&self.config, &self.run);
    }

    /// Disturbs the lateral motion of the pipe by up to 1e-5 m/s, by the numbers that follow from `seed`: forks of one
    /// state then part as the motion is sensitive to it.
    pub fn disturb(&mut self, seed: u64) {
        let mut random = fastrand::Rng::with_seed(seed);
        self.run.disturb(|| DISTURBANCE * (2.0 * random.f64() - 1.0));
    }

    /// Replaces friction and bit coefficients from the next step on.
    ///
    /// # Errors
    /// When one is negative or not finite; then all stay.
    pub fn set_live(&mut self, live: LiveParameters) -> Result<(), flexdrill_core::validation::ValidationError> {
        live.validate()?;
        self.run.apply(&RunInputs {
            live,
            ..self.run.applied()
        });
        Ok(())
    }
}

/// Inputs that a caller sets are known.
fn trusted(applied: RunInputs) -> RunInputs {
    RunInputs {
        input_quality: InputState::Ok as u8,
        ..applied
    }
}
