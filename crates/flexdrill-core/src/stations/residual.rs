//! The residual R of Eq. 35: elements, point masses, contacts, joints, axial tie, weight on bit, bit torque and loads.

use super::assembler::Assembler;
use super::axial::{add, element_values};
use super::constants::Constants;
use super::interactions::Interactions;
use crate::chain::Effect;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::State;
use crate::effects::bodies::Bodies;
use crate::model::Model;

impl Assembler {
    /// Evaluates the residual of Eq. 35 at `state`, in a step the R of Eq. 40 with the F of Eq. 42; with the rock's
    /// torque on the bit, Eq. 1. Entries of held, driven and padding unknowns are their reactions until
    /// [`Assembler::drop_reactions`].
    pub fn residual(&mut self, interactions: &mut Interactions, model: &Model, state: &State, conditions: &Conditions) {
        element_forces(&mut self.residual, &self.constants, model, state, conditions);
        if crate::effects::shortening::is_on(model) {
            self.shortening_forces(model, state, conditions);
        }
        self.slots_moments(model, state);
        if let Some(bodies) = Bodies::at(model, Some) {
            bodies.add_forces(&mut self.residual, state, conditions.rayleigh.alpha, |_| true);
        }
        self.contact_forces(interactions, model, state, conditions);
        self.joint_forces(&mut interactions.joints, model, state);
        let numbered = self.constants.numbered(model);
        numbered.add_ties(&mut self.residual, state, |_| true);
        if let Some((pressure, forces)) = &self.constants.pressure {
            let at_top = pressure.at_top(conditions.standpipe_pressure);
            let entries = self.residual.iter_mut().zip(forces);
            entries.for_each(|(residual, force)| *residual -= at_top * force);
        }
        self.bit.evaluate(state, conditions);
        self.bit.applied(&mut self.residual, &|_| true);
        numbered.add_loads(&mut self.residual, conditions, |_| true);
    }

    /// Sets the residual of unknowns without an equation to zero. Reactions are read before this.
    pub fn drop_reactions(&mut self, model: &Model) {
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            self.residual[unknown] = 0.0;
        }
    }
}

/// Sets the residual to the elements' elastic, damping (Eq. 7), inertia and geometric forces, less gravity: Eq. 10.
fn element_forces(residual: &mut [f64], constants: &Constants, model: &Model, state: &State, conditions: &Conditions) {
    for (r, w) in residual.iter_mut().zip(&model.weight) {
        *r = -w;
    }
    let (alpha, beta) = (conditions.rayleigh.alpha, conditions.rayleigh.beta);
    let tensions = state.pipe_axial.iter().chain(&state.guide_axial);
    // With shortening all of the pipe's geometric stiffness comes later.
    let later = if crate::effects::shortening::is_on(model) {
        model.pipe.len()
    } else {
        0
    };
    for (e, (element, &tension)) in constants.elements.iter().zip(tensions).enumerate() {
        let tension = if e < later { 0.0 } else { tension };
        let at = |values: &[f64]| element_values(values, element.nodes);
        let (q, v, a) = (at(&state.q), at(&state.v), at(&state.a));
        let force =
            element.stiffness * (q + v * beta) + element.mass * (a + v * alpha) + element.geometric * q * tension;
        add(residual, element.nodes, &force);
    }
    preload_forces(residual, &constants.preload, model, state);
    mud_forces(residual, model, state, alpha);
}

/// Adds the inertia of the mud, Rayleigh damping with it (`alpha`, 1/s), and its viscous damping.
fn mud_forces(residual: &mut [f64], model: &Model, state: &State, alpha: f64) {
    let pushed = |unknown: usize| state.a[unknown] + alpha * state.v[unknown];
    model.add_mud_forces(residual, |mud| mud.mass, pushed);
    model.add_mud_forces(residual, |mud| mud.drag, |unknown| state.v[unknown]);
}

/// Adds the guide's preload: its stiffness times the displacements, less its couples.
fn preload_forces(residual: &mut [f64], couples: &[f64], model: &Model, state: &State) {
    for (r, couple) in residual.iter_mut().zip(couples) {
        *r -= couple;
    }
    for (preload, nodes) in super::constants::preloads(model) {
        let force = preload.stiffness * element_values(&state.q, nodes);
        add(residual, nodes, &force);
    }
}
