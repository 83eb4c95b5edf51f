//! Residual and tangent of the whole tool, Eq. 35 and 40 to 42: what is assembled and where it is kept.
//!
//! The residual is internal + inertia + constraint forces - external forces, so Newton solves K_T dq = -R. Evaluating
//! it ([`residual`](Assembler::residual)) keeps the linearised joints and contacts, from which the tangent is
//! assembled.

use crate::dynamics::phases::Stopwatch;
use crate::elements::bit::BitTorque;
use crate::elements::gap::Layer;
use crate::elements::joint::Joint;
use crate::elements::joint::group::JointGroup;
use crate::linear::{BlockSystem, TangentIncrement};
use crate::model::Model;
use crate::simd::Instructions;

use super::factors::TangentFactors;

/// Residual, tangent and the linearised parts they are made of.
pub struct Assembler {
    /// Internal less external force per unknown.
    pub residual: Vec<f64>,
    /// The whole tangent, as assembled by [`Assembler::tangent`].
    pub system: BlockSystem,
    /// Touching pipe-guide gaps.
    pub inner: Layer,
    /// Touching guide-wall gaps.
    pub outer: Layer,
    /// Rotational rows and stops of the joints, eight at a time from the top.
    pub(super) groups: Vec<JointGroup>,
    /// Number of joints.
    pub(super) joints: usize,
    /// Torque of the rock on the bit at the last residual.
    pub bit: BitTorque,
    /// Times what is done here and in the steps around it.
    pub stopwatch: Stopwatch,
    /// Step-constant part of the tangent for `step_constant_for`: factors, alpha, beta.
    pub(super) step_constant: BlockSystem,
    pub(super) step_constant_for: Option<(TangentFactors, f64, f64)>,
    pub(super) instructions: Instructions,
    /// What contacts, joints and the bit add.
    pub increment: TangentIncrement,
}

impl Assembler {
    /// Room for `model`.
    pub fn new(model: &Model, instructions: Instructions) -> Self {
        let system = BlockSystem::new(model.layout.clone());
        Self {
            residual: vec![0.0; model.unknowns()],
            step_constant: system.clone(),
            step_constant_for: None,
            instructions,
            increment: TangentIncrement::new(
                &model.layout,
                model.joints.len(),
                Joint::rotational_rows(model.description.joint.kind),
                model.held.iter().chain(&model.driven).copied(),
            ),
            system,
            inner: Layer::new(model.stations.len()),
            outer: Layer::new(model.stations.len()),
            groups: model.joints.chunks(8).map(JointGroup::of).collect(),
            joints: model.joints.len(),
            bit: BitTorque::default(),
            stopwatch: Stopwatch::default(),
        }
    }

    /// Begins the corrections of a step: what those of the step before have learned of friction is forgotten.
    pub(crate) fn begin(&mut self) {
        self.bit.begin();
        self.inner.begin();
        self.outer.begin();
    }

    /// Vector instructions in use.
    pub fn instructions(&self) -> Instructions {
        self.instructions
    }
}
