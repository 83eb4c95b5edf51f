//! Slots of the guide that close, over the chain. A guide with such slots has a node at every station, because what
//! inner stations of a span do would depend on whether slots are open.

use super::active::Active;
use super::precision::Precision;
use super::tangent::{Additions, Touching};
use super::{Chain, GUIDE};
use crate::dynamics::state::State;
use crate::elements::slots::{Closed, Rotations};

/// First rotation of the guide among a node's unknowns.
const FIRST: usize = GUIDE + 3;

impl Chain {
    /// Evaluates the slots of the active spans at `state`, and adds their moments to the forces of the contacts, which
    /// are gathered next.
    pub(super) fn close_slots(&mut self, state: &State) {
        let (nodes, _) = state.q.as_chunks::<{ super::NODE }>();
        for (l, closed) in self.closed_slots.iter_mut().enumerate() {
            if !self.active.spans[l] {
                continue;
            }
            let rotations: Rotations = std::array::from_fn(|k| nodes[l + k / 3][FIRST + k % 3]);
            *closed = self.model.slots[l].at(&rotations);
            let Some(closed) = closed else { continue };
            let forces = &mut self.contact_forces[l];
            if !self.has_contacts[l] {
                self.has_contacts[l] = true;
                **forces = [[0.0; 16]; 2];
            }
            for (k, moment) in closed.moments.iter().enumerate() {
                // The bottom end's six begin at 8.
                forces[1][3 + k + 5 * (k / 3)] += moment;
            }
        }
    }

    /// Elastic energy of closed slots (J).
    pub(super) fn slots_energy(&self) -> f64 {
        self.closed_slots.iter().flatten().map(|closed| closed.energy).sum()
    }
}

/// Adds the derivative of the moments of closed slots, times `factor`, of the active spans.
pub(super) fn add_slots<S: Precision>(
    to: &mut Additions<S>,
    active: &Active,
    closed_slots: &[Option<Closed>],
    factor: f64,
) {
    for (l, closed) in closed_slots.iter().enumerate().filter(|(l, _)| active.spans[*l]) {
        let Some(closed) = closed else { continue };
        let tangent = closed.tangent();
        let add = |to: &mut [S], from: &[f64]| {
            for (to, from) in to.iter_mut().zip(from) {
                *to += S::of(factor * from);
            }
        };
        for end in 0..2 {
            let block = to.block(l + end, Touching::Guide);
            for j in 0..3 {
                let column = &tangent[3 * end + j][3 * end..3 * end + 3];
                add(&mut block[FIRST + j][FIRST..FIRST + 3], column);
            }
        }
        // The guide's columns are the last six of twelve, its rotations the last three of those.
        let coupling = to.coupling(l, Touching::Guide);
        for j in 0..3 {
            add(&mut coupling.upper[9 + j][FIRST..FIRST + 3], &tangent[3 + j][..3]);
            add(&mut coupling.lower[9 + j][FIRST..FIRST + 3], &tangent[j][3..]);
        }
    }
}
