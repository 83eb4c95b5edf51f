//! What is attached to the tool, in either numbering of its unknowns: point masses, the axial tie, weight on bit, the
//! rock's torque, point loads.

use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::{State, motion};
use crate::elements::bit::BitTorque;
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

impl<'a> Numbered<'a> {
    /// In the numbering of the model.
    pub(crate) fn of(model: &'a Model) -> Self {
        Self {
            model,
            places: &model.places,
            weight: &model.weight,
        }
    }

    /// Adds axial tie, weight on bit, the rock's torque and the loads to the residual, on unknowns that are `wanted`.
    pub(crate) fn add_end_forces(
        &self,
        residual: &mut [f64],
        bit: &mut BitTorque,
        state: &State,
        conditions: &Conditions,
        wanted: impl Fn(usize) -> bool,
    ) {
        let Self { model, places, .. } = *self;
        if let Some(tie) = places.tie.filter(|&tie| wanted(tie)) {
            let scale = model.force_scale;
            residual[places.pipe_end] += scale * state.q[tie];
            residual[places.guide_end] -= scale * state.q[tie];
            residual[tie] = scale * (state.q[places.pipe_end] - state.q[places.guide_end]);
        }
        if wanted(places.guide_end) {
            residual[places.guide_end] += conditions.weight_on_bit;
        }
        let spin = places.bit_spin;
        if wanted(spin) {
            bit.evaluate(conditions.bit_torque, state.v[spin], conditions.bit_slip_rate);
            residual[spin] += bit.torque;
        }
        for (load, &unknown) in model.loads.iter().zip(&places.loads) {
            if wanted(unknown) {
                residual[unknown] -= load.load.history.at(conditions.time);
            }
        }
    }

    /// Adds the forces of point masses to the residual, on nodes whose first unknown is `wanted`.
    pub(crate) fn add_mass_forces(
        &self,
        residual: &mut [f64],
        state: &State,
        conditions: &Conditions,
        wanted: impl Fn(usize) -> bool,
    ) {
        let alpha = conditions.rayleigh.alpha;
        let masses = self.model.masses.iter().zip(&self.places.masses);
        for (point, places) in masses.filter(|(_, places)| wanted(places[0])) {
            for (k, inertia) in point.body.diagonal().into_iter().enumerate() {
                let u = places[k];
                let gravity = if k < 3 { point.gravity[k] } else { 0.0 };
                residual[u] += inertia * (state.a[u] + alpha * state.v[u] - gravity);
            }
            if point.body.is_coupled() {
                let moving = motion(state, places);
                let forces = point.body.coupled_forces(moving.as_node(), alpha, point.gravity.into());
                places.iter().zip(forces).for_each(|(&u, force)| residual[u] += force);
            }
        }
    }
}
