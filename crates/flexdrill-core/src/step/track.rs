//! Where a motion is: the present state, the one that is tried, the one to go back to, each with its energies.

use crate::dynamics::energy::EnergyPoint;
use crate::dynamics::state::State;
use crate::model::Model;

/// Where the motion is, in the numbering in which steps are taken, with the room that a step needs.
#[derive(Clone)]
pub(crate) struct Track {
    pub state: State,
    pub trial: State,
    before_step: State,
    pub energy: EnergyPoint,
    pub trial_energy: EnergyPoint,
    energy_before_step: EnergyPoint,
    /// Displacements of a step.
    pub moved: Vec<f64>,
}

impl Track {
    /// At `state`, over so many `spans` of a chain; over all stations there are none.
    pub fn new(model: &Model, state: State, spans: usize) -> Self {
        let energy = EnergyPoint::new(model, state.q.len(), spans);
        Self {
            trial: state.clone(),
            before_step: state.clone(),
            trial_energy: energy.clone(),
            energy_before_step: energy.clone(),
            moved: vec![0.0; state.q.len()],
            state,
            energy,
        }
    }

    /// Keeps the present state for a retreat from the step.
    pub fn keep(&mut self) {
        self.before_step.copy_from(&self.state);
        self.energy_before_step.copy_from(&self.energy);
    }

    /// Goes back to the state kept last.
    pub fn retreat(&mut self) {
        self.state.copy_from(&self.before_step);
        self.energy.copy_from(&self.energy_before_step);
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
        std::mem::swap(&mut self.energy, &mut self.trial_energy);
    }
}
