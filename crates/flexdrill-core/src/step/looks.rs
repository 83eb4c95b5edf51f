//! What observers read of the motion: the state in the model's numbering, which the chain makes when it is asked for, and
//! what every step needs of it without that.

use super::Stepper;
use crate::dynamics::state::State;
use crate::dynamics::view::BottomMotion;

impl Stepper {
    /// State at the end of the last step, in the numbering of the model: a copy.
    pub fn state(&self) -> State {
        let mut state = self.view.clone();
        self.chain
            .show(&self.model, &self.track.state, &self.track.carried.joints, &mut state);
        state
    }

    /// Makes [`Stepper::view`] the state at the end of the last step.
    pub(crate) fn refresh_view(&mut self) {
        if !self.view_is_current {
            self.chain.show(
                &self.model,
                &self.track.state,
                &self.track.carried.joints,
                &mut self.view,
            );
            self.view_is_current = true;
        }
    }

    /// The same as [`Stepper::state`] without a copy, after [`Stepper::refresh_view`].
    pub(crate) fn view(&self) -> &State {
        debug_assert!(self.view_is_current, "an earlier step's view");
        &self.view
    }

    /// One of the displacements, velocities or accelerations at the end of the last step, by the model's unknown.
    pub(crate) fn value(&self, of: fn(&State) -> &[f64], unknown: usize) -> f64 {
        let values = of(&self.track.state);
        self.chain.value(&self.model, values, unknown)
    }

    /// How the bottom of the pipe moves at the end of the last step.
    pub(crate) fn bottom_motion(&self) -> BottomMotion {
        let (chain, state, last) = (&self.chain, &self.track.state, self.model.last());
        let mut above = chain.pipe_translation(&state.a, last - 1);
        if let Some(joint) = self.model.stations[last - 1].joint {
            let at = &self.model.joints[joint];
            above = at.lower.tr_mul(&(at.upper * above));
        }
        let at_bottom = chain.pipe_translation(&state.a, last);
        let spin = chain.model.places.end_spin;
        BottomMotion::new([state.v[spin], state.a[spin]], at_bottom.x, above)
    }

    /// Energy that the tool stores at the end of the last step, as its ledger has it (J).
    #[cfg(test)]
    pub(crate) fn stored_energy(&self) -> f64 {
        self.track.ledger.sums.stored
    }
}
