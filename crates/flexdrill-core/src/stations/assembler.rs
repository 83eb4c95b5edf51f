//! Residual and tangent of the whole tool, Eq. 35 and 40 to 42: what is assembled and where it is kept.
//!
//! The residual is internal + inertia + constraint forces - external forces, so Newton solves K_T dq = -R. Evaluating
//! it ([`residual`](Assembler::residual)) linearises joints and contacts into the [`Interactions`], from which the
//! tangent is assembled.
//!
//! [`Interactions`]: crate::stations::Interactions

use super::constants::Constants;
use super::linear::{BlockSystem, TangentIncrement};
use crate::effects::bit::Bit;
use crate::effects::mud_wall::Motion;
use crate::elements::factors::TangentFactors;
use crate::elements::joint::Joint;
use crate::model::Model;
use crate::simd::Instructions;

/// Residual and tangent over all stations.
#[derive(Clone)]
pub struct Assembler {
    /// Internal less external force per unknown.
    pub residual: Vec<f64>,
    /// The whole tangent, as assembled by [`Assembler::tangent`].
    pub system: BlockSystem,
    /// Step-constant part of the tangent for `step_constant_for`: factors, alpha, beta.
    pub(super) step_constant: BlockSystem,
    pub(super) step_constant_for: Option<(TangentFactors, f64, f64)>,
    pub(super) instructions: Instructions,
    /// Packed elements and constant forces.
    pub(super) constants: Constants,
    /// How each station moves in both annuli of mud; empty where mud near walls does not count.
    pub(super) mud: Vec<[Motion; 2]>,
    /// The bit on its rock.
    pub bit: Bit,
    /// What contacts, joints and the bit add to the tangent.
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
            constants: Constants::of(model),
            mud: vec![[Motion::default(); 2]; crate::effects::mud_wall::at_stations(model).len()],
            bit: Bit::at(model, &model.places),
            increment: TangentIncrement::new(
                &model.layout,
                model.joints.len(),
                Joint::constraints(&model.description.joint),
                model.held.iter().chain(&model.driven).copied(),
            ),
            system,
        }
    }

    /// Vector instructions in use.
    pub fn instructions(&self) -> Instructions {
        self.instructions
    }
}
