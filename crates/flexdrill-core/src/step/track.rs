//! Where a motion is: the present state, the one that is tried, the one to go back to, each with what it
//! carries and its point of the energy ledger.

use crate::dynamics::carried::Carried;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::state::State;
use crate::model::Model;

/// Where the motion is, in the numbering in which steps are taken, with the room that a step needs.
#[derive(Clone)]
pub(crate) struct Track {
    pub state: State,
    pub trial: State,
    before_step: State,
    pub carried: Carried,
    pub trial_carried: Carried,
    carried_before_step: Carried,
    pub ledger: LedgerPoint,
    pub trial_ledger: LedgerPoint,
    ledger_before_step: LedgerPoint,
    /// Displacements of a step.
    pub moved: Vec<f64>,
}

impl Track {
    /// At `state`, over so many `spans` of a chain; `drags` where an effect damps by viscosity.
    pub fn new(model: &Model, state: State, spans: usize, drags: bool) -> Self {
        let carried = Carried::new(model, spans);
        let ledger = LedgerPoint::new(model, state.q.len(), spans, drags);
        Self {
            trial: state.clone(),
            before_step: state.clone(),
            trial_carried: carried.clone(),
            carried_before_step: carried.clone(),
            carried,
            trial_ledger: ledger.clone(),
            ledger_before_step: ledger.clone(),
            ledger,
            moved: vec![0.0; state.q.len()],
            state,
        }
    }

    /// Keeps the present state for a retreat from the step.
    pub fn keep(&mut self) {
        self.before_step.copy_from(&self.state);
        self.carried_before_step.copy_from(&self.carried);
        self.ledger_before_step.copy_from(&self.ledger);
    }

    /// Goes back to the state kept last.
    pub fn retreat(&mut self) {
        self.state.copy_from(&self.before_step);
        self.carried.copy_from(&self.carried_before_step);
        self.ledger.copy_from(&self.ledger_before_step);
    }

    /// Makes [`Track::moved`] the displacements from the present state to the one that is tried.
    pub fn measure_displacements(&mut self) {
        let ends = self.trial.q.iter().zip(&self.state.q);
        for (moved, (after, before)) in self.moved.iter_mut().zip(ends) {
            *moved = after - before;
        }
    }

    /// Takes the state that was tried as the present one.
    pub fn take(&mut self) {
        std::mem::swap(&mut self.state, &mut self.trial);
        std::mem::swap(&mut self.carried, &mut self.trial_carried);
        std::mem::swap(&mut self.ledger, &mut self.trial_ledger);
    }
}
