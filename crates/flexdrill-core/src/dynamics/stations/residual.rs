//! The residual R of Eq. 35: elements, point masses, contacts, joints, axial tie, weight on bit, bit torque and loads.

use super::assembler::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::interactions::Interactions;
use crate::dynamics::numbered::Numbered;
use crate::dynamics::state::{State, element_values};
use crate::elements::element_form::{add, load};
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

impl Assembler {
    /// Evaluates the residual of Eq. 35 at `state`, in a step the R of Eq. 40 with the F of Eq. 42; with the rock's
    /// torque on the bit, Eq. 1. Entries of held, driven and padding unknowns are their reactions until
    /// [`Assembler::drop_reactions`].
    pub fn residual(&mut self, interactions: &mut Interactions, model: &Model, state: &State, conditions: &Conditions) {
        self.instructions.run(ElementForces {
            residual: &mut self.residual,
            model,
            state,
            conditions,
        });
        if model.shortens() {
            self.shortening_forces(model, state, conditions);
        }
        self.slots_moments(model, state);
        let numbered = Numbered::of(model);
        numbered.add_mass_forces(&mut self.residual, state, conditions, |_| true);
        self.contact_forces(interactions, model, state, conditions);
        self.joint_forces(&mut interactions.joints, model, state);
        let bit = &mut interactions.bit;
        numbered.add_end_forces(&mut self.residual, bit, state, conditions, |_| true);
    }

    /// Sets the residual of unknowns without an equation to zero. Reactions are read before this.
    pub fn drop_reactions(&mut self, model: &Model) {
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            self.residual[unknown] = 0.0;
        }
    }
}

/// Sets the residual to the elements' elastic, damping (Eq. 7), inertia and geometric forces, less gravity: Eq. 10.
struct ElementForces<'a> {
    residual: &'a mut [f64],
    model: &'a Model,
    state: &'a State,
    conditions: &'a Conditions,
}

impl Kernel for ElementForces<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            residual,
            model,
            state,
            conditions,
        } = self;
        for (r, w) in residual.iter_mut().zip(&model.weight) {
            *r = -w;
        }
        let (alpha, beta) = (V::splat(conditions.rayleigh.alpha), V::splat(conditions.rayleigh.beta));
        let tensions = state.pipe_axial.iter().chain(&state.guide_axial);
        // With shortening all of the pipe's geometric stiffness comes later.
        let later = if model.shortens() { model.pipe.len() } else { 0 };
        for (e, (element, &tension)) in model.elements.list.iter().zip(tensions).enumerate() {
            let tension = if e < later { 0.0 } else { tension };
            let forms = &model.elements.kinds[element.kind as usize];
            let nodes = [element.nodes[0] as usize, element.nodes[1] as usize];
            let zero = V::splat(0.0);
            let (mut x, mut a, mut stretched) = ([zero; 2], [zero; 2], [zero; 2]);
            for n in 0..2 {
                let q: V = load(&state.q, nodes[n]);
                let v: V = load(&state.v, nodes[n]);
                x[n] = q.plus_product(beta, v);
                a[n] = load::<V>(&state.a, nodes[n]).plus_product(alpha, v);
                stretched[n] = q.times(V::splat(tension));
            }
            let mut force = forms.stiffness.product(forms.to_element(x));
            forms.mass.add_product(forms.to_element(a), &mut force);
            forms.geometric.add_product(forms.to_element(stretched), &mut force);
            let force = forms.to_nodes(force);
            add(residual, nodes[0], force[0]);
            add(residual, nodes[1], force[1]);
        }
        preload_forces(residual, model, state);
        mud_forces(residual, model, state, conditions.rayleigh.alpha);
    }
}

/// Adds the inertia of the mud, Rayleigh damping with it (`alpha`, 1/s), and its viscous damping.
fn mud_forces(residual: &mut [f64], model: &Model, state: &State, alpha: f64) {
    let pushed = |unknown: usize| state.a[unknown] + alpha * state.v[unknown];
    model.add_mud_forces(residual, |mud| mud.mass, pushed);
    model.add_mud_forces(residual, |mud| mud.drag, |unknown| state.v[unknown]);
}

/// Adds the guide's preload: its stiffness times the displacements, less its couples.
fn preload_forces(residual: &mut [f64], model: &Model, state: &State) {
    for (r, couple) in residual.iter_mut().zip(&model.preload) {
        *r -= couple;
    }
    for (preload, nodes) in model.preloads() {
        let force = preload.stiffness * element_values(&state.q, nodes);
        for (k, x) in force.iter().enumerate() {
            residual[nodes[k / 6] + k % 6] += x;
        }
    }
}
