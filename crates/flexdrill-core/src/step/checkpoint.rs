//! Checkpoints: the state of a motion, apart from the tool.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::{Counters, Stepper};
use crate::chain::Effect;
use flexdrill_base::energies::Energies;

use crate::dynamics::carried::Carried;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::state::State;
use crate::effects::Histories;
use crate::inputs::Inputs;
use crate::tool::description::LiveParameters;

/// Everything that a run needs to continue bit for bit: of a stepper while it is written, read back on its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepperCheckpoint<'a> {
    state: Cow<'a, State>,
    carried: Cow<'a, Carried>,
    ledger: Cow<'a, LedgerPoint>,
    audit: Energies,
    counters: Counters,
    live: LiveParameters,
    turns: f64,
    inputs: Inputs,
    refinement: u32,
    effects: Histories<'a>,
}

impl Stepper {
    /// The state from which a run continues bit for bit.
    pub fn checkpoint(&self) -> StepperCheckpoint<'_> {
        StepperCheckpoint {
            state: Cow::Borrowed(&self.track.state),
            carried: Cow::Borrowed(&self.track.carried),
            ledger: Cow::Borrowed(&self.track.ledger),
            audit: self.audit,
            counters: self.counters,
            live: self.live,
            turns: self.turns,
            inputs: self.inputs,
            refinement: self.refinement,
            effects: self.effects.histories(),
        }
    }

    /// Continues from a checkpoint of the same model; `false`, and nothing done, if its sizes are another model's.
    pub fn restore(&mut self, checkpoint: &StepperCheckpoint<'_>) -> bool {
        let track = &mut self.track;
        let same = checkpoint.state.q.len() == track.state.q.len()
            && checkpoint.state.pipe_axial.len() == track.state.pipe_axial.len()
            && checkpoint.state.held_friction.len() == track.state.held_friction.len()
            && checkpoint.carried.fits(&track.carried)
            && checkpoint.ledger.fits(&track.ledger)
            && self.effects.fit(&checkpoint.effects);
        if !same {
            return false;
        }
        self.live = checkpoint.live;
        track.state.copy_from(&checkpoint.state);
        let mut conditions = self.conditions(checkpoint.state.time, &checkpoint.inputs);
        self.effects.restore(&checkpoint.effects);
        self.effects.resume(&self.track.state, &mut conditions);
        self.evaluate(&conditions, true);
        self.track.carried.copy_from(&checkpoint.carried);
        self.track.ledger.copy_from(&checkpoint.ledger);
        self.audit = checkpoint.audit;
        self.counters = checkpoint.counters;
        self.turns = checkpoint.turns;
        self.inputs = checkpoint.inputs;
        self.set_refinement(checkpoint.refinement);
        true
    }
}
