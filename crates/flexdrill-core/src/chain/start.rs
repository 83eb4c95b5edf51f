//! A start over the chain: a state at rest, and accelerations in balance with its forces.

use super::dependents::{FIRST_ROW, SECOND_ROW};
use super::effect::Effect;
use super::equations::ChainEquations;
use super::{NODE, TIE};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::newton::{Iteration, Singular, correct, worst};
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Accuracy;
use crate::elements::factors::TangentFactors;

/// Most corrections of a state at rest.
const MOST_STATIC_CORRECTIONS: u32 = 20;
/// Part of the limits at rest at which they end.
const SETTLED: f64 = 0.1;
/// Mass in a static tangent without geometric stiffness (1/s2): one over the square of 5 ms. Without that stiffness
/// neither a joint that touches nothing nor the guide's turn about its own axis has any stiffness: they move by no more
/// than their inertia lets them in this time. Motions between two contacts are slower, so that the corrections converge.
const STATIC_MASS: f64 = 4e4;

impl<E: Effect> ChainEquations<'_, E> {
    /// Static corrections of a state at rest, as long as they bring the residual down, or until a part of the limits is left
    /// where the tangent has no geometric stiffness; `scratch` is overwritten. Where the static tangent has no inverse (a body
    /// that could float), the state is not changed.
    pub(crate) fn polish_rest(&mut self, state: &mut State, scratch: &mut State, conditions: &Conditions) {
        let still = TangentFactors {
            stiffness: 1.0,
            damping: 0.0,
            mass: 0.0,
        };
        // With the geometric stiffness these are Newton's corrections, and end at rounding.
        let is_exact = self.chain.has_geometric_stiffness();
        let factors = TangentFactors {
            mass: if is_exact { 0.0 } else { STATIC_MASS },
            ..still
        };
        self.chain.prepare(self.model, conditions, factors);
        let at = Iteration::first(conditions, factors);
        self.begin_corrections(state, 0.0);
        self.evaluate(state, conditions, false);
        let mut best = worst(&self.chain.residual, self.chain.limits.weights(Accuracy::Rest));
        for _ in 0..MOST_STATIC_CORRECTIONS {
            if best <= SETTLED && !is_exact {
                return;
            }
            scratch.copy_from(state);
            if self.solve_in_double(scratch, &at).is_err() {
                return;
            }
            correct(self, scratch, still);
            self.evaluate(scratch, conditions, false);
            let ratio = worst(&self.chain.residual, self.chain.limits.weights(Accuracy::Rest));
            if ratio.is_nan() || ratio >= best {
                return;
            }
            best = ratio;
            state.copy_from(scratch);
        }
    }

    /// Accelerations in balance with the forces at `state`, as far as steps of size `h` (s) can follow them.
    ///
    /// # Errors
    /// When the mass matrix with the constraints is singular.
    pub(crate) fn balance_accelerations(
        &mut self,
        state: &mut State,
        conditions: &Conditions,
        h: f64,
    ) -> Result<(), Singular> {
        state.a.fill(0.0);
        let factors = TangentFactors {
            stiffness: h * h,
            damping: h,
            mass: 1.0,
        };
        self.chain.prepare(self.model, conditions, factors);
        self.begin_corrections(state, 0.0);
        self.evaluate(state, conditions, false);
        // The rows hold already; what is asked for is how their second derivatives can be zero.
        let has_rows = self.chain.model.joint_rows > 0;
        for residual in self.chain.residual.chunks_exact_mut(NODE) {
            residual[SECOND_ROW] = 0.0;
            residual[TIE] = 0.0;
            if has_rows {
                residual[FIRST_ROW] = 0.0;
            }
        }
        self.solve_in_double(state, &Iteration::first(conditions, factors))?;
        for (i, &x) in self.chain.correction.iter().enumerate() {
            if i % NODE == TIE {
                state.q[i] += x;
            } else {
                state.a[i] = x;
            }
        }
        Ok(())
    }
}
