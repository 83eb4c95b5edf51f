//! Contacts and joints as the witness's last residual left them.

use crate::dynamics::joints::Joints;
use crate::dynamics::state::State;
use crate::effects::contact::Layers;
use crate::model::Model;
use crate::simd::Instructions;

/// What acts between bodies: pipe and guide, guide and wall, the ends that joints connect.
pub struct Interactions {
    pub layers: Layers,
    pub joints: Joints,
}

impl Interactions {
    /// Room for those of `model`.
    pub fn new(model: &Model, instructions: Instructions) -> Self {
        Self {
            layers: Layers::new(model),
            joints: Joints::new(model, instructions),
        }
    }

    /// Begins the corrections of a step of size `step` (s) from the state `from`, or with 0 of a state at rest.
    pub fn begin(&mut self, from: &State, step: f64) {
        self.joints.begin();
        self.layers.begin(from, step);
    }
}
