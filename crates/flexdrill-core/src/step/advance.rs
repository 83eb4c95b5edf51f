//! A step in time: in parts that are halved and retried until they converge.

use std::f64::consts::TAU;

use super::Stepper;
use super::settings::Forcing;
use super::sub_steps::SubSteps;
use crate::chain::{Asked, ChainEquations, Effect};
use crate::dynamics::energy::{StepEnd, StepWork};
use crate::dynamics::newton::{self, Rejected, Stride};
use crate::dynamics::outcome::StepOutcome;
use crate::dynamics::phases::Phase;
use crate::dynamics::tolerances::Accuracy;

/// Whole turns after which they are subtracted from the pipe's spins, so that the rounding of the angles stays below that of
/// the forces however long the tool runs.
const UNWIND_TURNS: f64 = 1000.0;

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

impl Stepper {
    /// Advances by `h` (s) under `forcing`, in the parts of [`Stepper::set_refinement`]. A sub-step that does not converge
    /// is halved and retried; when the smallest one fails, the state stays that before the step.
    pub fn advance(&mut self, h: f64, forcing: &Forcing) -> StepOutcome {
        // Parts of a step are tangents and operators of their own step sizes, made before they are needed.
        self.prepare(h);
        let whole = WholeStep {
            h,
            time: self.track.state.time,
            drive_angle: self.track.state.drive_angle,
            forcing: *forcing,
        };
        let audit_before = self.audit;
        let mut sub_steps = SubSteps::new(self.max_halvings, self.refinement);
        // With parts, a later one may fail after an earlier one was accepted, so the state before the step is kept.
        if self.refinement > 0 {
            self.keep();
        }
        let mut iterations = 0;
        // Parts are halved on failure and joined again where the time allows; their order is that of time.
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
                    // Corrections of rejected parts count as cost, too.
                    iterations += made;
                    self.counters.rejected += 1;
                    self.counters.last_rejection = Some(failure);
                    if sub_steps.is_first() {
                        // Nothing has changed yet. From here on a later part may fail after an earlier one was taken.
                        self.keep();
                    }
                    // The smallest part has failed: state and audit return to the
                    // step's beginning, as if it had not been tried.
                    if !sub_steps.reject() {
                        self.retreat();
                        self.audit = audit_before;
                        self.counters.failed_steps += 1;
                        self.counters.iterations += u64::from(iterations);
                        return StepOutcome::Failed(failure);
                    }
                }
            }
        }
        let deepest = sub_steps.deepest();
        // Angles are reduced by whole turns after the step, so that their rounding does not grow with the run.
        self.unwind();
        self.view_is_current = false;
        self.inputs = forcing.end();
        self.counters.iterations += u64::from(iterations);
        self.counters.halved_steps += u64::from(deepest > 0);
        self.counters.deepest_halving = self.counters.deepest_halving.max(deepest);
        StepOutcome::Advanced {
            iterations,
            halvings: deepest,
        }
    }

    /// Keeps the present state for [`Stepper::retreat`].
    fn keep(&mut self) {
        self.track.keep();
        self.effects.keep();
    }

    /// Goes back to the state kept last.
    fn retreat(&mut self) {
        self.track.retreat();
        self.effects.retreat();
    }

    /// The sub-step between two parts (0 to 1) of a whole step.
    fn sub_step(&mut self, whole: &WholeStep, (from, to): (f64, f64)) -> Result<u32, Rejected> {
        // Conditions at the end of the part: the scheme is implicit.
        let mut conditions = self.conditions(whole.time + whole.h * to, &whole.forcing.at(to));
        conditions.drive_angle = whole.drive_angle_at(to);
        let step = whole.h * (to - from);
        let [speed_0, speed_1] = whole.forcing.rotary_speed;
        let asked = Asked {
            h: step,
            rotary_speed: speed_0 + (speed_1 - speed_0) * to,
            drive_angle: self.track.state.drive_angle,
        };
        // What is above the tool moves first, and sets conditions of the tool's own part.
        self.effects.lead(&asked, &mut conditions);
        // A sub-step has its own foresight: axial forces are extrapolated over it.
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
            effects,
            joints,
            stopwatch,
            track,
            ..
        } = self;
        let (from, to) = (&track.state, &mut track.trial);
        // Spans are deflected by the forces at the start of the step.
        to.deflection.copy_from_slice(&track.carried.deflection);
        // Pins resist by the forces there, too.
        chain.set_pin_moments(
            &model.description.joint.friction,
            &track.carried.joints,
            &mut to.pin_moments,
        );
        let mut equations = ChainEquations {
            model,
            chain,
            effects,
            joints,
            stopwatch,
        };
        // On failure nothing of the track has been taken, and the caller halves.
        let iterations = newton::step(&mut equations, &stride, &conditions, from, to)?;
        equations.effects.leave(to);
        equations.energy(&mut track.trial_carried, &mut track.trial_ledger, to, &conditions);
        // The works of the ledger are over these displacements.
        track.measure_displacements();
        let spans = chain.span_works(&track.moved, &track.ledger.spans, &track.trial_ledger.spans);
        let numbered = chain.model.numbered(model);
        // From here on the part is accepted: effects take over their trial states.
        effects.accept(&track.trial);
        effects.close(&mut track.trial_ledger);
        // The ledger compares the ends of the part with their forces.
        let work = StepWork {
            h: step,
            moved: &track.moved,
            spans,
            before: StepEnd {
                state: &track.state,
                carried: &track.carried,
                point: &track.ledger,
            },
            after: StepEnd {
                state: &track.trial,
                carried: &track.trial_carried,
                point: &track.trial_ledger,
            },
        };
        effects.work(chain, &work, &mut self.audit);
        work.enter(&mut self.audit, &numbered, self.instructions);
        stopwatch.lap(Phase::Energy);
        track.take();
        Ok(iterations)
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
        self.effects.unwind(turns);
        let unwind = |spin: usize| state.q[spin] -= turns * TAU;
        self.chain.spins().for_each(unwind);
    }
}
