//! What joints, supports, drive and spans carry at an instant: what the next step begins with and what is published.

use serde::{Deserialize, Serialize};

use crate::dynamics::state::Deflection;
use crate::model::Model;

/// Places for numbers that effects keep at the end of a step. The format of a checkpoint has so many.
pub(crate) const EFFECT_PLACES: usize = 1;

/// What the joints of a chain carry.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct JointForces {
    /// Force of each span's pipe on its top end (N), along the axes of the link above.
    pub(crate) on_top: Vec<[f64; 3]>,
    /// Multipliers of the rotational rows of each joint (N m).
    pub(crate) multipliers: Vec<[f64; 2]>,
}

/// What the tool carries at the end of a step. Unlike the ledger's, these figures are part of the motion: the next step
/// deflects its spans and loads its pins by them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Carried {
    /// Of each joint.
    pub(crate) joints: JointForces,
    /// How the weight and what effects push inside deflect each span: what the next step counts with.
    pub(crate) deflection: Vec<Deflection>,
    /// Force of the support of each held unknown on the tool (N, N m), in the order of [`Model::held`].
    pub(crate) reactions: Vec<f64>,
    /// Power taken by the pins of each joint (W); of joints with friction only.
    pub(crate) pin_power: Vec<f64>,
    /// Torque of the drive (N m).
    pub(crate) drive_torque: f64,
    /// What effects keep of the end of the step, each at its place.
    pub(crate) of_effects: [f64; EFFECT_PLACES],
}

impl Carried {
    /// Room for `model` as a chain of so many `spans`; a tool without a chain has none.
    pub fn new(model: &Model, spans: usize) -> Self {
        Self {
            joints: JointForces {
                on_top: vec![[0.0; 3]; spans],
                multipliers: vec![[0.0; 2]; if spans > 0 { model.joints.len() } else { 0 }],
            },
            deflection: vec![[[0.0; 16]; 2]; spans],
            reactions: vec![0.0; model.held.len()],
            pin_power: vec![0.0; model.joints_with_friction()],
            drive_torque: 0.0,
            of_effects: [0.0; EFFECT_PLACES],
        }
    }

    /// Whether it is for the same model as `other`.
    #[cfg(feature = "checkpoints")]
    pub fn fits(&self, other: &Self) -> bool {
        self.joints.on_top.len() == other.joints.on_top.len()
            && self.joints.multipliers.len() == other.joints.multipliers.len()
            && self.deflection.len() == other.deflection.len()
            && self.reactions.len() == other.reactions.len()
            && self.pin_power.len() == other.pin_power.len()
    }

    /// Takes another's values without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.joints.on_top.copy_from_slice(&other.joints.on_top);
        self.joints.multipliers.copy_from_slice(&other.joints.multipliers);
        self.deflection.copy_from_slice(&other.deflection);
        self.reactions.copy_from_slice(&other.reactions);
        self.pin_power.copy_from_slice(&other.pin_power);
        (self.drive_torque, self.of_effects) = (other.drive_torque, other.of_effects);
    }
}
