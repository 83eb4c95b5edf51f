//! What acts between bodies: pipe and guide, guide and wall, the ends that joints connect.
//!
//! Whoever evaluates a residual, the chain or the plain station equations, evaluates these laws into one owner. It holds
//! them as the last residual left them: the tangent, the energy audit and the observers read them from here.

mod joints;

use crate::dynamics::state::{State, bristles};
use crate::elements::gap::LayerContacts;
use crate::model::Model;
use crate::simd::Instructions;

#[cfg(test)]
pub(crate) use joints::JointLinearisation;
pub(crate) use joints::{JointTangent, Joints, pin_lanes, rotations};

/// Contacts and joints at the last residual.
#[derive(Clone)]
pub struct Interactions {
    /// Closed gaps between pipe and guide.
    pub inner: LayerContacts,
    /// Closed gaps between guide and wall.
    pub outer: LayerContacts,
    /// Rotational rows, stops, play and pin friction of the joints.
    pub joints: Joints,
    /// Whether a layer's friction has bristles.
    has_bristles: bool,
    /// Displacements at the start of the step, in the numbering that it is taken in; for bristles only.
    pub(crate) start: Vec<f64>,
    /// Size of the step (s); 0 at rest.
    pub(crate) step: f64,
}

impl Interactions {
    /// Room for those of `model`.
    pub fn new(model: &Model, instructions: Instructions) -> Self {
        let has_bristles = !bristles(model).is_empty();
        Self {
            inner: LayerContacts::new(model.stations.len()),
            outer: LayerContacts::with_friction_factors(
                model
                    .stations
                    .iter()
                    .map(|station| station.wall_friction_factor)
                    .collect(),
            ),
            joints: Joints::new(model, instructions),
            has_bristles,
            // A station has at most 24 unknowns in the numbering of the model, and at most a node of 16 in the chain's.
            start: Vec::with_capacity(if has_bristles { 24 * model.stations.len() } else { 0 }),
            step: 0.0,
        }
    }

    /// Begins the corrections of a step of size `step` (s) from the state `from`, or with a `step` of 0 of a state at rest,
    /// in which bristles keep their forces. The laws forget what they learned of friction in the corrections of the step
    /// before.
    pub(crate) fn begin(&mut self, from: &State, step: f64) {
        self.joints.begin();
        self.step = step;
        self.inner.begin(from.bristles.iter().map(|station| station[0]), step);
        self.outer.begin(from.bristles.iter().map(|station| station[1]), step);
        if self.has_bristles {
            self.start.clear();
            self.start.extend_from_slice(&from.q);
        }
    }

    /// Keeps the friction of the bristles at the end of a step in `to`.
    pub(crate) fn keep_bristles(&self, to: &mut State) {
        if self.has_bristles {
            to.bristles.fill([[0.0; 2]; 2]);
            for (layer, contacts) in [&self.inner, &self.outer].into_iter().enumerate() {
                for (station, touch) in contacts.iter() {
                    to.bristles[station][layer] = [touch.tangential, touch.axial];
                }
            }
        }
    }
}
