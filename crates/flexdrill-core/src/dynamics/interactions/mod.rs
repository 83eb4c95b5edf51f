//! What acts between bodies: pipe and guide, guide and wall, the ends that joints connect, bit and rock.
//!
//! Whoever evaluates a residual, the chain or the plain station equations, evaluates these laws into one owner. It holds
//! them as the last residual left them: the tangent, the energy audit and the observers read them from here.

mod joints;

use crate::elements::bit::BitTorque;
use crate::elements::gap::LayerContacts;
use crate::model::Model;
use crate::simd::Instructions;

pub(crate) use joints::{JointLinearisation, JointTangent, Joints, rotations};

/// Contacts, joints and the rock's torque at the last residual.
pub struct Interactions {
    /// Closed gaps between pipe and guide.
    pub inner: LayerContacts,
    /// Closed gaps between guide and wall.
    pub outer: LayerContacts,
    /// Rotational rows and stops of the joints.
    pub joints: Joints,
    /// Torque of the rock on the bit.
    pub bit: BitTorque,
}

impl Interactions {
    /// Room for those of `model`.
    pub fn new(model: &Model, instructions: Instructions) -> Self {
        Self {
            inner: LayerContacts::new(model.stations.len()),
            outer: LayerContacts::new(model.stations.len()),
            joints: Joints::new(model, instructions),
            bit: BitTorque::default(),
        }
    }

    /// Begins the corrections of a step: the laws forget what they learned of friction in the corrections of the step
    /// before.
    pub(crate) fn begin(&mut self) {
        self.bit.begin();
        self.inner.begin();
        self.outer.begin();
    }
}
