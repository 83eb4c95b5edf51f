//! How the motion begins: from a given state, with effects held until then.

use super::Stepper;
use super::settings::Counters;
use crate::chain::{ChainEquations, Effect};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::State;
use crate::inputs::Inputs;
use flexdrill_base::energies::Energies;

impl Stepper {
    /// Takes `state`, in the numbering of the model, as the present one, with the audit starting at zero. The
    /// accelerations must balance the forces.
    pub fn start_from(&mut self, state: &State, inputs: &Inputs) {
        let mut conditions = self.conditions(state.time, inputs);
        self.effects.hold();
        let (to, scratch) = (&mut self.track.state, &mut self.track.trial);
        // The view keeps what the chain has no unknowns for, and never writes: supports' and padding's values.
        self.view.copy_from(state);
        self.chain.take(&self.model, state, to);
        let mut equations = ChainEquations {
            model: &self.model,
            chain: &mut self.chain,
            effects: &mut self.effects,
            joints: &mut self.joints,
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
        if state.scheme_step == 0.0 {
            let State { a, lagged, .. } = to;
            lagged.copy_from_slice(a);
        }
        self.effects.release(&self.track.state, &mut conditions);
        self.evaluate(&conditions, false);
        self.audit = Energies::default();
        self.counters = Counters::default();
        self.turns = 0.0;
        self.inputs = *inputs;
    }

    /// Evaluates forces and energies of the present state, with the axial forces that it holds or, without
    /// `keep_axial`, those of its displacements.
    pub(super) fn evaluate(&mut self, conditions: &Conditions, keep_axial: bool) {
        let Self {
            model,
            chain,
            effects,
            joints,
            stopwatch,
            track,
            ..
        } = self;
        let (state, carried, ledger) = (&mut track.state, &mut track.carried, &mut track.ledger);
        let mut equations = ChainEquations {
            model,
            chain,
            effects,
            joints,
            stopwatch,
        };
        equations.begin_corrections(state, 0.0);
        equations.evaluate(state, conditions, keep_axial);
        equations.energy(carried, ledger, state, conditions);
        equations.effects.close(ledger);
        self.view_is_current = false;
    }
}
