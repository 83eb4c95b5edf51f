//! The state in the model's numbering, as observers read it: made from that over the joints when it is asked for.

use std::cell::Ref;
use std::ops::Deref;

use nalgebra::Vector3;

use crate::dynamics::state::State;

/// A look at the present state in the model's numbering.
#[derive(Debug)]
pub enum StateView<'a> {
    /// Steps are taken in this numbering.
    Stations(&'a State),
    /// It was made from the state over the joints.
    Joints(Ref<'a, State>),
}

impl Deref for StateView<'_> {
    type Target = State;

    fn deref(&self) -> &State {
        match self {
            Self::Stations(state) => state,
            Self::Joints(state) => state,
        }
    }
}

/// The state as it was shown last.
pub(crate) struct Shown {
    state: State,
    outdated: bool,
}

impl Shown {
    pub fn of(state: &State) -> Self {
        Self {
            state: state.clone(),
            outdated: true,
        }
    }

    /// The present state has changed.
    pub fn outdate(&mut self) {
        self.outdated = true;
    }

    /// Takes what is no unknown over the joints from `state`.
    pub fn copy_from(&mut self, state: &State) {
        self.state.copy_from(state);
        self.outdated = true;
    }

    /// Whether the present state is another one.
    pub fn outdated(&self) -> bool {
        self.outdated
    }

    /// Makes it the present one by `show`.
    pub fn bring_up(&mut self, show: impl FnOnce(&mut State)) {
        show(&mut self.state);
        self.outdated = false;
    }

    /// The state that was shown last.
    pub fn state(&self) -> &State {
        &self.state
    }
}

/// How the bottom of the pipe moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BottomMotion {
    /// Spin rate of the bit (rad/s).
    pub spin_rate: f64,
    /// Its derivative (rad/s2).
    pub spin_acceleration: f64,
    /// Acceleration of the bit down the hole (m/s2).
    pub axial_acceleration: f64,
    /// Square of the lateral acceleration of the station above the bit, which the hole does not hold (m2/s4).
    pub lateral_square: f64,
}

impl BottomMotion {
    /// Of the spin's rate and acceleration, the bit's axial acceleration and the acceleration of the station above.
    pub fn new(spin: [f64; 2], axial_acceleration: f64, above: Vector3<f64>) -> Self {
        Self {
            spin_rate: spin[0],
            spin_acceleration: spin[1],
            axial_acceleration,
            lateral_square: above.y * above.y + above.z * above.z,
        }
    }
}
