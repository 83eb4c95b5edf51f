//! Newton's equations over the chain: which residual is evaluated, in which precision a correction is solved for.

use super::active::WHOLE_CORRECTIONS;
use super::effect::{Effect, Under};
use super::geometric::add_geometric;
use super::precision::Precision;
use super::residual::Evaluation;
use super::{Chain, NODE};
use crate::dynamics::carried::Carried;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::joints::Joints;
use crate::dynamics::newton::{Equations, Iteration, LARGEST_DISPLACEMENT, Singular, Stride};
use crate::dynamics::phases::{Phase, Stopwatch};
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Accuracy;
use crate::elements::joint::rotation::LARGEST_TILT;
use crate::model::Model;
use crate::simd::Instructions;
use crate::tool::description::Body;

/// The chain's equations: the chain's data with the effects and joints that they evaluate.
pub(crate) struct ChainEquations<'a, E> {
    pub model: &'a Model,
    pub chain: &'a mut Chain,
    /// What acts inside the spans and at nodes.
    pub effects: &'a mut E,
    pub joints: &'a mut Joints,
    pub stopwatch: &'a mut Stopwatch,
}

impl<E: Effect> ChainEquations<'_, E> {
    /// Evaluates the whole residual at `to`, with the axial forces that it holds or, without `keep_axial`, those of its
    /// displacements.
    pub(crate) fn evaluate(&mut self, to: &mut State, conditions: &Conditions, keep_axial: bool) {
        self.chain.foreseen_part = 0.0;
        let evaluation = if keep_axial {
            Evaluation::WholeWithAxial
        } else {
            Evaluation::Whole
        };
        self.residual_by(evaluation, to, conditions);
    }

    /// Evaluates what the tool carries, and the `point` of the ledger, at `state`, at which the residual was evaluated last.
    pub(crate) fn energy(
        &mut self,
        carried: &mut Carried,
        point: &mut LedgerPoint,
        state: &State,
        conditions: &Conditions,
    ) {
        self.stopwatch.lap(Phase::Assembly);
        self.chain
            .energy(self.effects, carried, point, self.model, state, conditions, self.joints);
    }

    /// Evaluates the residual at `to`: spans, effects, what is attached, joints, in this order.
    fn residual_by(&mut self, evaluation: Evaluation, to: &mut State, conditions: &Conditions) {
        let Self {
            model,
            chain,
            effects,
            joints,
            stopwatch,
        } = self;
        stopwatch.lap(Phase::Other);
        chain.span_forces(evaluation, to, conditions);
        stopwatch.lap(Phase::Assembly);
        chain.clear_inside();
        let under = Under {
            model,
            conditions,
            keeps_axial: matches!(evaluation, Evaluation::WholeWithAxial),
        };
        effects.force(chain, to, &under);
        chain.gather(to);
        stopwatch.lap(Phase::Contact);
        chain.attached_forces(&**effects, to, &under);
        // Joints come last: what they take over from dependent rotations is the whole moment there.
        chain.joint_forces(joints, to, model.moment_scale);
    }

    /// Begins the corrections of a step of size `step` (s) from the state `from`, or with 0 of a state at rest.
    pub(crate) fn begin_corrections(&mut self, from: &State, step: f64) {
        self.joints.begin();
        self.effects.begin(from, step);
    }

    /// Adds up what the last residual left of effects at `state` for the tangent, in one precision.
    fn linearise<S: Precision>(&mut self, state: &State, at: &Iteration<'_>) {
        let Self {
            model, chain, effects, ..
        } = self;
        // Effects read the chain while they add: what they add to is taken out of it meanwhile.
        let mut to = std::mem::take(S::additions(chain));
        to.begin();
        effects.at_stations(&mut to, chain, at);
        let numbered = chain.model.numbered(model);
        numbered.hanger_tangent(at.factors, |row, column, value| to.add_within_node(row, column, value));
        effects.at_ends(at.factors, &mut |row, column, value| {
            to.add_within_node(row, column, value)
        });
        effects.tangent(&mut to, chain, state, at);
        *S::additions(chain) = to;
        // Dependent rotations follow from the joint's rows as the last residual has linearised them.
        chain.set_spins(model.moment_scale);
    }

    /// Solves for the correction in double precision, of the whole tool.
    ///
    /// # Errors
    /// When a block cannot be factorised, or no operator was prepared for the factors.
    pub(super) fn solve_in_double(&mut self, state: &State, at: &Iteration<'_>) -> Result<(), Singular> {
        let Some(operator) = self.chain.operator(at.factors, at.conditions) else {
            return Err(Singular { station: 0, pivot: 0.0 });
        };
        // In double the whole tool is solved: a window needs the columns of an earlier sweep, which single precision has
        // made.
        self.chain.active.set_whole();
        self.linearise::<f64>(state, at);
        let Self {
            chain,
            effects,
            joints,
            stopwatch,
            ..
        } = self;
        // The tangent of steps has no geometric stiffness. The chain of the start has it, as its long steps do not converge
        // without.
        if chain.has_geometric_stiffness() {
            // An effect with the tension of the pipe has that part in its own tangent.
            let of_pipe = if effects.has_tension() { 0.0 } else { 1.0 };
            let (to, active) = (&mut chain.additions, &chain.active);
            add_geometric(to, &chain.model, active, state, [at.factors.stiffness, of_pipe]);
        }
        let (blocks, of_joints) = (&mut chain.sweep.joints, &chain.model.nodes.of_joints);
        let lambda = |joint: usize| chain.multipliers[joint];
        joints.tangents(
            at.factors,
            lambda,
            |_| true,
            // The tangents of joints stay in the sweep, because only the block of one node has them.
            |joint, tangent| {
                for (l, column) in blocks[of_joints[joint]].iter_mut().enumerate() {
                    for (k, x) in column.iter_mut().enumerate() {
                        *x = tangent.rotation(l, k);
                    }
                }
            },
        );
        stopwatch.lap(Phase::Assembly);
        chain.solve_in_double(operator)
    }

    /// Solves for the correction in single precision, of the active part of the tool; `false` where the pivots are too
    /// small for it.
    pub(super) fn solve_in_single(&mut self, state: &State, at: &Iteration<'_>) -> bool {
        // Without an operator for these factors nothing was prepared, and the double solution reports that as an error.
        let Some(operator) = self.chain.operator(at.factors, at.conditions) else {
            return false;
        };
        self.linearise::<f32>(state, at);
        let Self {
            chain,
            joints,
            stopwatch,
            ..
        } = self;
        let (sweep, of_joints) = (&mut chain.single_sweep, &chain.model.nodes.of_joints);
        let lambda = |joint: usize| chain.multipliers[joint];
        // Outside the window the columns of the earlier sweep remain valid.
        let is_active = |joint: usize| chain.active.nodes[of_joints[joint]];
        joints.tangents(at.factors, lambda, is_active, |joint, tangent| {
            sweep.join(of_joints[joint], tangent);
        });
        stopwatch.lap(Phase::Assembly);
        chain.solve_in_single(operator)
    }
}

impl<E: Effect> Equations for ChainEquations<'_, E> {
    fn begin(&mut self, stride: &Stride, from: &State) {
        self.begin_corrections(from, stride.h);
        self.chain.accuracy = stride.accuracy;
        self.chain.foresee(from, stride.foresight, stride.foreseen_part);
        self.chain.limits.for_step(stride.h);
    }

    fn residual(&mut self, to: &mut State, at: &Iteration<'_>) {
        // After a correction only its share is evaluated, by the tangent that it was solved with.
        let operator = self.chain.operator(at.factors, at.conditions);
        let evaluation = match operator.filter(|_| at.corrections > 0) {
            Some(operator) => Evaluation::Correction { operator },
            None => Evaluation::Whole,
        };
        self.residual_by(evaluation, to, at.conditions);
    }

    fn solve(&mut self, to: &State, at: &Iteration<'_>) -> Result<(), Singular> {
        let chain = &mut *self.chain;
        if at.corrections < WHOLE_CORRECTIONS {
            chain.active.set_whole();
        } else {
            let weights = chain.limits.weights(chain.accuracy);
            chain.active.set_windows(&chain.residual, weights);
        }
        // The first corrections reduce the residual fast even in single precision; later ones need double.
        let is_solved = at.corrections < chain.single_corrections && self.solve_in_single(to, at);
        let solved = if is_solved {
            Ok(())
        } else {
            self.solve_in_double(to, at)
        };
        self.stopwatch.lap(Phase::Solve);
        solved
    }

    fn residuals(&self) -> &[f64] {
        &self.chain.residual
    }

    fn weights(&self, accuracy: Accuracy) -> &[f64] {
        self.chain.limits.weights(accuracy)
    }

    fn correction(&self) -> (&[f64], &[f64]) {
        (&self.chain.correction, &self.chain.model.moving)
    }

    fn driven(&self) -> &[usize] {
        &self.chain.model.driven
    }

    fn out_of_range(&self, state: &State) -> Option<(usize, f64)> {
        let beyond = |(unknown, &value): (usize, &f64)| {
            let most = match unknown % NODE {
                3..=5 | 9..=11 => LARGEST_DISPLACEMENT,
                1 | 2 | 7 | 8 | 13 | 14 => LARGEST_TILT,
                _ => return None,
            };
            (value.abs() > most).then_some((unknown, value))
        };
        state.q.iter().enumerate().find_map(beyond)
    }

    fn locate(&self, unknown: usize) -> (usize, Body) {
        let (station, guide) = self.chain.locate(unknown);
        (station, if guide { Body::Guide } else { Body::Pipe })
    }

    fn instructions(&self) -> Instructions {
        self.chain.model.instructions
    }
}
