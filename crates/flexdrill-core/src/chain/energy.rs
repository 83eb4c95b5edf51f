//! What the chain carries, and its point of the energy ledger: elements and effects; the rest is shared with the whole
//! tool.

use nalgebra::Vector3;

use super::columns::{EndColumn, TENSION, around, at_ends, at_radius, ends, load, product, store};
use super::{Chain, Effect, Under};

use crate::dynamics::carried::{Carried, JointForces};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::{LedgerPoint, SpanForces, SpanWorks};
use crate::dynamics::joints::Joints;
use crate::dynamics::state::State;
use crate::model::{HeldNode, Model};
use crate::simd::Kernel;
use crate::simd::vector::Vector;
use crate::tool::description::Body;

impl Chain {
    /// Evaluates `carried` and `point` at `state`, at which the residual was evaluated last.
    #[expect(clippy::too_many_arguments, reason = "two results, from all that the residual had")]
    pub(crate) fn energy(
        &mut self,
        effects: &impl Effect,
        carried: &mut Carried,
        point: &mut LedgerPoint,
        model: &Model,
        state: &State,
        conditions: &Conditions,
        joints: &Joints,
    ) {
        let instructions = self.model.instructions;
        point.drag.fill(0.0);
        let mut stored = instructions.run(SpanEnergies {
            has_tension: effects.has_tension(),
            chain: self,
            joints: &mut carried.joints,
            point,
            state,
            conditions,
        });
        point.begin_nodes();
        let under = Under {
            model,
            conditions,
            keeps_axial: true,
        };
        let of_effects = effects.energy(self, point, state, &under);
        for (force, q) in self.model.potential.iter().zip(&state.q) {
            stored -= force * q;
        }
        stored += of_effects;
        stored += point.sums.kinetic + self.model.numbered(model).hanger_energy(state);
        // What comes and goes with the motion is added last, so that the other sums are the same with and without it.
        point.begin_touching();
        stored += effects.friction(self, point, &under);
        effects.carry(carried);
        self.deflect_spans(effects, &mut carried.deflection);
        carried.joints.multipliers.copy_from_slice(&self.multipliers);
        let numbered = self.model.numbered(model);
        point.finish(stored, &numbered, conditions, joints, &self.residual, carried);
        self.reactions_inside_a_fixed_guide(effects, carried, model, state, conditions);
    }
}

impl Chain {
    /// Reactions of the supports at stations between the nodes, of a guide that is fixed as a whole: they balance weight
    /// and what effects do to the guide, since nothing else acts there.
    fn reactions_inside_a_fixed_guide(
        &self,
        effects: &impl Effect,
        carried: &mut Carried,
        model: &Model,
        state: &State,
        conditions: &Conditions,
    ) {
        // Only there are stations slaved to supports, whose reactions no residual has.
        if !model.description.guide_fixed {
            return;
        }
        let under = Under {
            model,
            conditions,
            keeps_axial: true,
        };
        let inside = |at: &&HeldNode| self.model.places.held[at.held.start].is_none();
        // The weight begins the sum: without effects the support carries nothing else.
        for at in model.held_nodes.iter().filter(inside) {
            for index in at.held.clone() {
                carried.reactions[index] = -model.weight[model.held[index]];
            }
            let on_guide = effects.on_guide(self, at.station, state, &under);
            for index in at.held.clone() {
                let k = model.held[index] - at.node;
                // By the pipe's motion effects act across the hole only.
                if matches!(k, 1 | 2) {
                    carried.reactions[index] -= on_guide[k - 1];
                }
            }
        }
        // Signs as in the residual: the guide has the opposite of what it does to the pipe, and what the wall does to it.
        let bodies = [(Body::Pipe, 1.0), (Body::Guide, -1.0)];
        for ((body, sign), radius) in bodies.into_iter().zip(model.guide_radii) {
            effects.each_touched(body, &mut |station, touched| {
                let guide = model.stations[station].guide;
                let Ok(first) = model.held.binary_search(&guide) else {
                    return;
                };
                // Where the chain has the node, its reaction comes from the residual.
                if self.model.places.held[first].is_none() {
                    let reactions = &mut carried.reactions[first..first + 6];
                    for (reaction, force) in reactions.iter_mut().zip(at_radius(&touched.force, radius)) {
                        *reaction += sign * force;
                    }
                }
            });
        }
    }
}

/// Adds forces on the ends of span `l`, of pipe (0) or guide (1).
#[inline(always)]
pub(crate) fn add_to_ends(values: &mut [f64], l: usize, body: usize, force: &EndColumn) {
    let [top, bottom] = ends(l, body);
    for (first, half) in [(top, 0), (bottom, 8)] {
        for (to, x) in values[first..first + 6].iter_mut().zip(&force[half..half + 6]) {
            *to += x;
        }
    }
}

/// One in the lanes of a top end's forces.
static FORCES: [f64; 8] = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0];

/// One in the lane of the pipe's spin, at a span's top and bottom end.
static SPIN: [[f64; 8]; 2] = [
    [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
];

/// Forces of the spans and their kinetic energy into `point`, what their tops carry into `joints`. Gives the elastic and geometric energy (J).
struct SpanEnergies<'a> {
    chain: &'a mut Chain,
    /// Whether the axial forces of the pipe's spans are those of an effect's energy.
    has_tension: bool,
    joints: &'a mut JointForces,
    point: &'a mut LedgerPoint,
    state: &'a State,
    conditions: &'a Conditions,
}

impl Kernel for SpanEnergies<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self) -> f64 {
        let Self {
            chain,
            has_tension,
            joints,
            point,
            state,
            conditions,
        } = self;
        let (alpha, beta) = (V::splat(conditions.rayleigh.alpha), V::splat(conditions.rayleigh.beta));
        let zero = [V::splat(0.0); 2];
        // Pipe and guide are summed in two halves of vectors, and added across the lanes once, at the end.
        let (mut elastic, mut geometric, mut kinetic, mut foreseen) = (zero, zero, zero, zero);
        let ((rates, _), (rates2, _)) = (state.v.as_chunks(), state.a.as_chunks());
        for (l, link) in chain.model.links.iter().enumerate() {
            let kind = &chain.model.kinds[link.kind];
            for body in 0..2 {
                let at_v = at_ends(rates, l, body);
                let stiff = product::<V>(&kind.stiffness[body], &at_v);
                let mut moving = product::<V>(&kind.mass[body], &at_v);
                let mut inert = product::<V>(&kind.mass[body], &at_ends(rates2, l, body));
                let mut dragged = zero;
                // Where both pipes are coupled the momentum of one depends on the velocity of the other.
                if let Some(coupled) = &kind.coupled {
                    let there = at_ends(rates, l, 1 - body);
                    let across = &coupled.mass_across[body];
                    let parts = [
                        product::<V>(across, &there),
                        product::<V>(across, &at_ends(rates2, l, 1 - body)),
                        product::<V>(&coupled.damping[body], &at_v),
                        product::<V>(&coupled.damping_across[body], &there),
                    ];
                    for half in 0..2 {
                        moving[half] = moving[half].plus(parts[0][half]);
                        inert[half] = inert[half].plus(parts[1][half]);
                        dragged[half] = parts[2][half].plus(parts[3][half]);
                    }
                    // What damps by the motion of both is audited apart from the damping of the steel.
                    let mut on = [0.0; 16];
                    store(dragged, &mut on);
                    add_to_ends(&mut point.drag, l, body, &on);
                }
                // Forces of geometric stiffness per axial force; the lane that
                // holds the axial force itself is masked out.
                let mut geometric_forces: [V; 2] = load(&chain.geometric_forces[l][body]);
                geometric_forces[0] = geometric_forces[0].times(V::load(&FORCES));
                let in_use = if body == 0 {
                    state.pipe_axial[l]
                } else {
                    state.guide_axial[l]
                };
                let (beyond, tension_in_use) = if has_tension && body == 0 {
                    // The axial force is that of an energy: nothing is foreseen, and N G q is no update.
                    (V::splat(0.0), V::splat(0.0))
                } else {
                    let unstrained = if body == 0 { chain.along[l].unstrained } else { 0.0 };
                    (
                        V::splat(in_use - (chain.geometric_forces[l][body][TENSION] + unstrained)),
                        V::splat(in_use),
                    )
                };
                // Two lanes of each hold other unknowns; forces are zero there.
                let (mut q, v) = (
                    around::<V>(&state.q, ends(l, body)),
                    around::<V>(&state.v, ends(l, body)),
                );
                if body == 0 {
                    // Turning as a whole strains nothing; but hundreds of turns times the rounding of the forces would be
                    // as large as what the steps make up.
                    let spin = V::splat(-state.q[ends(l, 0)[0] + 3]);
                    for half in 0..2 {
                        q[half] = q[half].plus_product(V::load(&SPIN[half]), spin);
                    }
                }
                // The residual's linear forces are elastic ones, damping and inertia together.
                let linear: [V; 2] = load(&chain.linear[l][body]);
                let mut damped = zero;
                for half in 0..2 {
                    foreseen[half] = foreseen[half].minus_product(v[half], geometric_forces[half].times(beyond));
                    // Forces per axial force become forces by the one in use; what that differs from the present one works as
                    // foresight.
                    geometric_forces[half] = geometric_forces[half].times(tension_in_use);
                    damped[half] = moving[half].times(alpha).plus_product(stiff[half], beta);
                    let mut bent = linear[half].minus(damped[half].plus(inert[half]));
                    if kind.coupled.is_some() {
                        bent = bent.minus(dragged[half]);
                    }
                    elastic[half] = elastic[half].plus_product(q[half], bent);
                    geometric[half] = geometric[half].plus_product(q[half], geometric_forces[half]);
                    kinetic[half] = kinetic[half].plus_product(v[half], moving[half]);
                }
                if body == 0 {
                    let (linear, geometric_forces) = (&chain.linear[l][0], &chain.geometric_forces[l][0]);
                    // A joint carries what the span below needs at its top,
                    // what acts inside it included, less weight and what effects push with there.
                    for (i, top) in joints.on_top[l].iter_mut().enumerate() {
                        let inside = if chain.has_inside[l] {
                            chain.inside[l][0][i]
                        } else {
                            0.0
                        };
                        *top = linear[i] + in_use * geometric_forces[i] + inside
                            - (link.weight_on_top[i] + chain.along[l].on_top[i]);
                    }
                }
                let forces = &mut point.spans[l];
                store(geometric_forces, &mut forces.geometric[body]);
                store(damped, &mut forces.damping[body]);
                store(inert, &mut forces.inertia[body]);
            }
        }
        // Quadratic forms: half of displacement times force, and of velocity times momentum.
        point.sums.kinetic = 0.5 * sum(kinetic);
        point.sums.geometric_energy = 0.5 * sum(geometric);
        point.sums.foresight = sum(foreseen);
        0.5 * sum(elastic) + point.sums.geometric_energy
    }
}

impl Chain {
    /// Sum of the forces of the spans' tensions in the geometric stiffness, in the world (N).
    pub(crate) fn turned_with_the_tool(&self, effects: &impl Effect, model: &Model, state: &State) -> Vector3<f64> {
        let axial = state.pipe_axial.iter().zip(&state.guide_axial).enumerate();
        let forces = self
            .geometric_forces
            .iter()
            .zip(axial)
            .map(|(slopes, (l, (pipe, guide)))| {
                let tensions = [pipe + effects.tension_beyond(l), *guide];
                [0, 1].map(|body| slopes[body].map(|slope| tensions[body] * slope))
            });
        self.sum_of_spans(model, forces)
    }

    /// Work of the spans over a step of displacements `moved`, from `before` to `after`.
    pub(crate) fn span_works(&self, moved: &[f64], before: &[SpanForces], after: &[SpanForces]) -> SpanWorks {
        self.model.instructions.run(MeanSpanWorks { moved, before, after })
    }
}

/// Work of all spans by the trapezoid rule.
struct MeanSpanWorks<'a> {
    moved: &'a [f64],
    before: &'a [SpanForces],
    after: &'a [SpanForces],
}

impl Kernel for MeanSpanWorks<'_> {
    type Output = SpanWorks;

    #[inline(always)]
    fn run<V: Vector>(self) -> SpanWorks {
        let zero = [V::splat(0.0); 2];
        let mut works = [zero; 3];
        for (l, (before, after)) in self.before.iter().zip(self.after).enumerate() {
            for body in 0..2 {
                let moved = around::<V>(self.moved, ends(l, body));
                let kinds = [
                    (&before.damping[body], &after.damping[body]),
                    (&before.inertia[body], &after.inertia[body]),
                    (&before.geometric[body], &after.geometric[body]),
                ];
                for (work, (before, after)) in works.iter_mut().zip(kinds) {
                    let (f0, f1): ([V; 2], [V; 2]) = (load(before), load(after));
                    for half in 0..2 {
                        work[half] = work[half].plus_product(moved[half], f0[half].plus(f1[half]));
                    }
                }
            }
        }
        SpanWorks {
            damping: 0.5 * sum(works[0]),
            inertia: 0.5 * sum(works[1]),
            geometric: 0.5 * sum(works[2]),
        }
    }
}

/// Sum of the lanes.
#[inline(always)]
fn sum<V: Vector>(lanes: [V; 2]) -> f64 {
    let mut out = [0.0; 16];
    store(lanes, &mut out);
    let (mut top, mut bottom) = (0.0, 0.0);
    for i in 0..6 {
        top += out[i];
        bottom += out[8 + i];
    }
    top + bottom
}
