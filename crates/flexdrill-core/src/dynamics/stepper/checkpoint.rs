//! Checkpoints: the state of a motion, apart from the tool.

use serde::{Deserialize, Serialize};

use super::{Counters, Stepper};
use crate::dynamics::energy::EnergyPoint;
use crate::dynamics::outcome::EnergyAudit;
use crate::dynamics::state::State;
use crate::tool::description::LiveParameters;

/// Everything that a run needs to continue bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepperCheckpoint {
    state: State,
    energy: EnergyPoint,
    audit: EnergyAudit,
    counters: Counters,
    live: LiveParameters,
    turns: f64,
    weight_on_bit: f64,
    refinement: u32,
}

impl Stepper {
    /// The state from which a run continues bit for bit.
    pub fn checkpoint(&self) -> StepperCheckpoint {
        StepperCheckpoint {
            state: self.track.state.clone(),
            energy: self.track.energy.clone(),
            audit: self.audit,
            counters: self.counters,
            live: self.live,
            turns: self.turns,
            weight_on_bit: self.weight_on_bit,
            refinement: self.refinement,
        }
    }

    /// Continues from a checkpoint of the same model; `false`, and nothing done, if its sizes are another model's.
    pub fn restore(&mut self, checkpoint: &StepperCheckpoint) -> bool {
        let track = &mut self.track;
        let same = checkpoint.state.q.len() == track.state.q.len()
            && checkpoint.state.pipe_axial.len() == track.state.pipe_axial.len()
            && checkpoint.energy.fits(&track.energy);
        if !same {
            return false;
        }
        self.live = checkpoint.live;
        track.state.copy_from(&checkpoint.state);
        let conditions = self.conditions(checkpoint.state.time, checkpoint.weight_on_bit);
        self.evaluate(&conditions, true);
        self.track.energy.copy_from(&checkpoint.energy);
        self.audit = checkpoint.audit;
        self.counters = checkpoint.counters;
        self.turns = checkpoint.turns;
        self.weight_on_bit = checkpoint.weight_on_bit;
        self.set_refinement(checkpoint.refinement);
        true
    }
}
