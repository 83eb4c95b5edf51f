//! The residual R of Eq. 35: elements, point masses, contacts, joints, axial tie, weight on bit, bit torque and loads.

use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::phases::Phase;
use crate::dynamics::state::{State, motion};
use crate::elements::bit::BitTorque;
use crate::elements::element_form::{add, load};
use crate::model::{Model, Places};
use crate::simd::Kernel;
use crate::simd::vector::Vector;

impl Assembler {
    /// Evaluates the residual of Eq. 35 at `state`, in a step the R of Eq. 40 with the F of Eq. 42; with the rock's
    /// torque on the bit, Eq. 1. Entries of held, driven and padding unknowns are their reactions until
    /// [`Assembler::drop_reactions`].
    pub fn residual(&mut self, model: &Model, state: &State, conditions: &Conditions) {
        self.stopwatch.lap(Phase::Other);
        self.instructions.run(ElementForces {
            residual: &mut self.residual,
            model,
            state,
            conditions,
        });
        mass_forces(&mut self.residual, &model.places, model, (state, conditions), |_| true);
        self.stopwatch.lap(Phase::Assembly);
        self.contact_forces(model, state, conditions);
        self.stopwatch.lap(Phase::Contact);
        self.joint_forces(model, state);
        let residual = &mut self.residual;
        end_forces(
            &mut self.bit,
            residual,
            &model.places,
            model,
            (state, conditions),
            |_| true,
        );
    }

    /// Sets the residual of unknowns without an equation to zero. Reactions are read before this.
    pub fn drop_reactions(&mut self, model: &Model) {
        for &unknown in model.held.iter().chain(&model.driven).chain(&model.padding) {
            self.residual[unknown] = 0.0;
        }
    }
}

/// Axial tie, weight on bit, the rock's torque and loads, in the numbering of `places`, on nodes whose unknowns are
/// `wanted`.
pub(crate) fn end_forces(
    bit: &mut BitTorque,
    residual: &mut [f64],
    places: &Places,
    model: &Model,
    (state, conditions): (&State, &Conditions),
    wanted: impl Fn(usize) -> bool,
) {
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

/// Adds the forces of point masses, in the numbering of `places`, on nodes whose unknowns are `wanted`.
pub(crate) fn mass_forces(
    residual: &mut [f64],
    places: &Places,
    model: &Model,
    (state, conditions): (&State, &Conditions),
    wanted: impl Fn(usize) -> bool,
) {
    let alpha = conditions.rayleigh.alpha;
    let masses = model.masses.iter().zip(&places.masses);
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
        for (element, &tension) in model.elements.list.iter().zip(tensions) {
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
    }
}
