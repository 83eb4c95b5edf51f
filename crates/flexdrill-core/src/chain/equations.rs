//! Newton's equations over the chain: which residual is evaluated, in which precision a correction is solved for.

use super::active::WHOLE_CORRECTIONS;
use super::geometric::add_geometric;
use super::residual::Evaluation;
use super::shortening::StretchTangents;
use super::slots::add_slots;
use super::{Chain, NODE};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::EnergyPoint;
use crate::dynamics::interactions::Interactions;
use crate::dynamics::newton::{Equations, Iteration, LARGEST_DISPLACEMENT, Singular, Stride};
use crate::dynamics::phases::{Phase, Stopwatch};
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Accuracy;
use crate::elements::joint::rotation::LARGEST_TILT;
use crate::model::Model;
use crate::simd::Instructions;
use crate::tool::description::Body;

/// The chain's equations: the chain's data with the interactions that they evaluate.
pub(crate) struct ChainEquations<'a> {
    pub model: &'a Model,
    pub chain: &'a mut Chain,
    pub interactions: &'a mut Interactions,
    pub stopwatch: &'a mut Stopwatch,
}

impl ChainEquations<'_> {
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

    /// Evaluates `point` at `state`, at which the residual was evaluated last.
    pub(crate) fn energy(&mut self, point: &mut EnergyPoint, state: &State, conditions: &Conditions) {
        self.stopwatch.lap(Phase::Assembly);
        self.chain
            .energy(point, self.model, state, conditions, self.interactions);
    }

    /// Evaluates the residual at `to`: spans, contacts, slots, what is attached, joints, in this
    /// order.
    fn residual_by(&mut self, evaluation: Evaluation, to: &mut State, conditions: &Conditions) {
        let Self {
            model,
            chain,
            interactions,
            stopwatch,
        } = self;
        stopwatch.lap(Phase::Other);
        chain.span_forces(evaluation, model, to, conditions);
        stopwatch.lap(Phase::Assembly);
        chain.contact_forces(interactions, model, to, conditions);
        chain.close_slots(to);
        chain.gather(to);
        stopwatch.lap(Phase::Contact);
        chain.attached_forces(&mut interactions.bit, model, to, conditions);
        // Joints come last: what they take over from dependent rotations is the whole moment there.
        chain.joint_forces(&mut interactions.joints, to, model.moment_scale);
    }

    /// Solves for the correction in double precision, of the whole tool.
    ///
    /// # Errors
    /// When a block cannot be factorised, or no operator was prepared for the factors.
    pub(super) fn solve_in_double(&mut self, state: &State, at: &Iteration<'_>) -> Result<(), Singular> {
        let Self {
            model,
            chain,
            interactions,
            stopwatch,
        } = self;
        let Some(operator) = chain.operator(at.factors, at.conditions) else {
            return Err(Singular { station: 0, pivot: 0.0 });
        };
        // In double the whole tool is solved: a window needs the columns of
        // an earlier sweep, which single precision has made.
        chain.active.set_whole();
        // What changes in each iteration is added to the step-constant part.
        let contacts_and_masses = &mut chain.additions;
        let crossing = chain.operators[operator].crossing.as_ref();
        contacts_and_masses.linearise(
            &chain.model,
            &chain.active,
            interactions,
            model,
            state,
            at,
            crossing,
            &chain.mud,
        );
        if !chain.stretches.is_empty() {
            chain.model.instructions.run(StretchTangents {
                to: &mut chain.additions,
                chain: &chain.model,
                active: &chain.active,
                stretches: &chain.stretches,
                slopes: &chain.geometric_forces,
                state,
                beta: at.conditions.rayleigh.beta,
                factors: at.factors,
            });
        }
        // Slots that are closed stiffen the guide, which only this iteration knows.
        let stiffness = at.factors.stiffness;
        add_slots(&mut chain.additions, &chain.active, &chain.closed_slots, stiffness);
        // The tangent of steps has no geometric stiffness. The chain of the
        // start has it, as its long steps do not converge without.
        if chain.has_geometric_stiffness() {
            // With shortening the pipe's part is in its own tangent.
            let of_pipe = if chain.stretches.is_empty() { 1.0 } else { 0.0 };
            let (to, active) = (&mut chain.additions, &chain.active);
            add_geometric(to, &chain.model, active, state, [stiffness, of_pipe]);
        }
        // Dependent rotations follow from the joint's rows as the last residual has linearised them.
        chain.set_spins(model.moment_scale);
        let (blocks, of_joints) = (&mut chain.sweep.joints, &chain.model.nodes.of_joints);
        let lambda = |joint: usize| chain.multipliers[joint];
        interactions.joints.tangents(
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
        let Self {
            model,
            chain,
            interactions,
            stopwatch,
        } = self;
        // Without an operator for these factors nothing was prepared, and the double solution reports that as an error.
        let Some(operator) = chain.operator(at.factors, at.conditions) else {
            return false;
        };
        // The sums are formed in the precision of the solution, which is half the memory to move.
        let contacts_and_masses = &mut chain.single_additions;
        let crossing = chain.operators[operator].crossing_single.as_ref();
        contacts_and_masses.linearise(
            &chain.model,
            &chain.active,
            interactions,
            model,
            state,
            at,
            crossing,
            &chain.mud,
        );
        if !chain.stretches.is_empty() {
            chain.model.instructions.run(StretchTangents {
                to: &mut chain.single_additions,
                chain: &chain.model,
                active: &chain.active,
                stretches: &chain.stretches,
                slopes: &chain.geometric_forces,
                state,
                beta: at.conditions.rayleigh.beta,
                factors: at.factors,
            });
        }
        let stiffness = at.factors.stiffness;
        add_slots(
            &mut chain.single_additions,
            &chain.active,
            &chain.closed_slots,
            stiffness,
        );
        chain.set_spins(model.moment_scale);
        let (sweep, of_joints) = (&mut chain.single_sweep, &chain.model.nodes.of_joints);
        let lambda = |joint: usize| chain.multipliers[joint];
        // Outside the window the columns of the earlier sweep remain valid.
        let is_active = |joint: usize| chain.active.nodes[of_joints[joint]];
        interactions
            .joints
            .tangents(at.factors, lambda, is_active, |joint, tangent| {
                sweep.join(of_joints[joint], tangent);
            });
        stopwatch.lap(Phase::Assembly);
        chain.solve_in_single(operator)
    }
}

impl Equations for ChainEquations<'_> {
    fn begin(&mut self, stride: &Stride, from: &State) {
        self.interactions.begin(from, stride.h);
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
