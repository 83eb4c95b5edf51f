//! What is attached to the tool, in either numbering of its unknowns: the axial tie, the connector by which the pipe hangs on
//! the guide, point loads.

use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::State;
use crate::elements::factors::TangentFactors;
use crate::model::{Model, Places};

/// The tool in one numbering of its unknowns: that of the model, or that of the chain.
#[derive(Clone, Copy)]
pub(crate) struct Numbered<'a> {
    pub model: &'a Model,
    /// Where unknowns that mean something by themselves are in this numbering.
    pub places: &'a Places,
    /// Consistent forces of gravity (N, N m).
    pub weight: &'a [f64],
}

impl Numbered<'_> {
    /// Adds the forces of axial tie and hanger to the residual, on unknowns that are `wanted`.
    pub(crate) fn add_ties(&self, residual: &mut [f64], state: &State, wanted: impl Fn(usize) -> bool) {
        let Self { model, places, .. } = *self;
        // The tie holds both ends together along the hole: its multiplier is a force between them.
        if let Some(tie) = places.tie.filter(|&tie| wanted(tie)) {
            let scale = model.force_scale;
            let mut apart = 0.0;
            for (unknown, share) in along_the_hole(model.ends_along[1], places.pipe_end, places.guide_end) {
                residual[unknown] += scale * share * state.q[tie];
                apart += share * state.q[unknown];
            }
            residual[tie] = scale * apart;
        }
        if let Some(stiffness) = model.hanger.filter(|_| wanted(places.pipe_top)) {
            // The first node has both bodies.
            let force = stiffness * self.hanger_stretch(state);
            for (unknown, share) in self.hanger_shares() {
                residual[unknown] += share * force;
            }
        }
    }

    /// Adds the loads to the residual, on unknowns that are `wanted`.
    pub(crate) fn add_loads(&self, residual: &mut [f64], conditions: &Conditions, wanted: impl Fn(usize) -> bool) {
        let Self { model, places, .. } = *self;
        // Loads come last and have no tangent: they depend on time alone.
        for (load, &unknown) in model.loads.iter().zip(&places.loads) {
            if wanted(unknown) {
                residual[unknown] -= load.load.history.at(conditions.time);
            }
        }
    }

    /// Unknowns that stretch the hanger, and how much each does.
    fn hanger_shares(&self) -> [(usize, f64); 4] {
        along_the_hole(self.model.ends_along[0], self.places.pipe_top, self.places.guide_top)
    }

    /// How far the pipe's top has moved down the hole past the guide's (m).
    fn hanger_stretch(&self, state: &State) -> f64 {
        self.hanger_shares()
            .into_iter()
            .map(|(unknown, share)| share * state.q[unknown])
            .sum()
    }

    /// Energy in the connector by which the pipe hangs on the guide (J).
    pub(crate) fn hanger_energy(&self, state: &State) -> f64 {
        let stretch = self.hanger_stretch(state);
        self.model
            .hanger
            .map_or(0.0, |stiffness| 0.5 * stiffness * stretch * stretch)
    }

    /// Hands the hanger's part of the tangent to `add`: unknown of the force, unknown of the motion, value.
    pub(crate) fn hanger_tangent(&self, factors: TangentFactors, mut add: impl FnMut(usize, usize, f64)) {
        if let Some(hanger) = self.model.hanger {
            for (force, by) in self.hanger_shares() {
                for (motion, to) in self.hanger_shares() {
                    add(force, motion, by * to * factors.stiffness * hanger);
                }
            }
        }
    }
}

/// Displacement of the pipe past the guide along the hole's axis, which is `along` in the pipe's frame: the pipe's three
/// displacements from unknown `pipe` on and the guide's u, with their shares.
pub(crate) fn along_the_hole(along: [f64; 3], pipe: usize, guide: usize) -> [(usize, f64); 4] {
    let [u, v, w] = along;
    [(pipe, u), (pipe + 1, v), (pipe + 2, w), (guide, -1.0)]
}
