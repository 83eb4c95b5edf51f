//! Slots of the guide's elements that close, over all stations.

use super::assembler::Assembler;
use super::linear::BlockSystem;
use super::tangent::add_guide_element;
use crate::dynamics::state::State;
use crate::effects::slots::{self, Closed, Rotations};
use crate::elements::beam::ElementMatrix;
use crate::elements::factors::TangentFactors;
use crate::model::Model;

/// The closed slots at a state: number of the element, first unknowns of its nodes, and what they do.
fn closed(model: &Model, state: &State) -> impl Iterator<Item = (usize, [usize; 2], Closed)> {
    (0..model.guide.len()).filter_map(|e| {
        let slots = slots::of_element(model, e)?;
        let nodes = [e, e + 1].map(|station| model.stations[station].guide);
        let rotations: Rotations = std::array::from_fn(|k| state.q[nodes[k / 3] + 3 + k % 3]);
        Some((e, nodes, slots.at(&rotations)?))
    })
}

impl Assembler {
    /// Adds the moments of closed slots.
    pub(super) fn slots_moments(&mut self, model: &Model, state: &State) {
        for (_, nodes, closed) in closed(model, state) {
            for (k, moment) in closed.moments.iter().enumerate() {
                self.residual[nodes[k / 3] + 3 + k % 3] += moment;
            }
        }
    }
}

/// Adds the derivative of [`Assembler::slots_moments`] to the tangent.
pub(crate) fn add_slots_tangent(system: &mut BlockSystem, model: &Model, state: &State, factors: TangentFactors) {
    for (e, _, closed) in closed(model, state) {
        let tangent = closed.tangent();
        let mut matrix = ElementMatrix::zeros();
        for (j, column) in tangent.iter().enumerate() {
            for (i, x) in column.iter().enumerate() {
                matrix[(3 + i + 3 * (i / 3), 3 + j + 3 * (j / 3))] = *x;
            }
        }
        add_guide_element(system, e, &matrix, factors.stiffness);
    }
}

/// Elastic energy of closed slots (J).
pub(crate) fn slots_energy(model: &Model, state: &State) -> f64 {
    closed(model, state).map(|(_, _, closed)| closed.energy).sum()
}
