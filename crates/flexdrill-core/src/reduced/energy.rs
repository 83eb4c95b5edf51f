//! The energy audit's point over the joints: elements and friction; the rest is shared with the whole tool.

use super::contacts::at_radius;
use super::residual::{load, store};
use super::tangent::on_ends;
use super::{EndColumn, Reduced, ends};
use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::EnergyPoint;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

impl Reduced {
    /// Evaluates `point` at `state`, at which the residual was evaluated last.
    pub(crate) fn energy(
        &mut self,
        point: &mut EnergyPoint,
        model: &Model,
        state: &State,
        conditions: &Conditions,
        assembler: &Assembler,
    ) {
        let instructions = self.instructions;
        let mut stored = instructions.run(SpanEnergies {
            by: self,
            point,
            state,
            conditions,
        });
        point.add_masses(&self.places, model, state, conditions);
        stored += point.kinetic;
        point.friction.fill(0.0);
        point.contact_dissipation = 0.0;
        stored += instructions.run(Friction {
            by: self,
            point,
            model,
            assembler,
        });
        point.finish(stored, &self.places, model, conditions, assembler, &self.residual);
    }
}

/// Adds forces on a span's ends.
#[inline(always)]
fn add(values: &mut [f64], [top, bottom]: [usize; 2], force: &EndColumn) {
    for i in 0..6 {
        values[top + i] += force[i];
        values[bottom + i] += force[8 + i];
    }
}

/// Forces of the spans and their kinetic energy into `point`. Gives the elastic and geometric energy (J).
struct SpanEnergies<'a> {
    by: &'a mut Reduced,
    point: &'a mut EnergyPoint,
    state: &'a State,
    conditions: &'a Conditions,
}

impl Kernel for SpanEnergies<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self) -> f64 {
        let Self {
            by,
            point,
            state,
            conditions,
        } = self;
        point.geometric.fill(0.0);
        point.damping.fill(0.0);
        point.inertia.fill(0.0);
        let (alpha, beta) = (V::splat(conditions.rayleigh.alpha), V::splat(conditions.rayleigh.beta));
        let zero = [V::splat(0.0); 2];
        let (mut elastic, mut geometric, mut kinetic, mut foreseen) = (zero, zero, zero, zero);
        for (l, link) in by.links.iter().enumerate() {
            let kind = &by.kinds[link.kind];
            for body in 0..2 {
                let at = ends(l, body);
                let (mut bent, mut stiff, mut moving) = (zero, zero, zero);
                let (mut inert, mut stretched) = (zero, zero);
                let (mut q, mut v) = ([0.0; 16], [0.0; 16]);
                for j in 0..12 {
                    let (unknown, row) = if j < 6 { (at[0] + j, j) } else { (at[1] + j - 6, j + 2) };
                    (q[row], v[row]) = (state.q[unknown], state.v[unknown]);
                    let (by_q, by_v, by_a) = (V::splat(q[row]), V::splat(v[row]), V::splat(state.a[unknown]));
                    let (k, m): ([V; 2], [V; 2]) = (load(&kind.stiffness[body][j]), load(&kind.mass[body][j]));
                    let g: [V; 2] = load(&kind.geometric[body][j]);
                    for half in 0..2 {
                        bent[half] = bent[half].plus_product(k[half], by_q);
                        stiff[half] = stiff[half].plus_product(k[half], by_v);
                        moving[half] = moving[half].plus_product(m[half], by_v);
                        inert[half] = inert[half].plus_product(m[half], by_a);
                        stretched[half] = stretched[half].plus_product(g[half], by_q);
                    }
                }
                let in_use = if body == 0 {
                    state.pipe_axial[l]
                } else {
                    state.guide_axial[l]
                };
                let beyond = V::splat(in_use - by.tension(&state.q, l, body));
                let in_use = V::splat(in_use);
                let (q, v): ([V; 2], [V; 2]) = (load(&q), load(&v));
                let mut damped = zero;
                for half in 0..2 {
                    foreseen[half] = foreseen[half].minus_product(v[half], stretched[half].times(beyond));
                    stretched[half] = stretched[half].times(in_use);
                    damped[half] = moving[half].times(alpha).plus_product(stiff[half], beta);
                    elastic[half] = elastic[half].plus_product(q[half], bent[half]);
                    geometric[half] = geometric[half].plus_product(q[half], stretched[half]);
                    kinetic[half] = kinetic[half].plus_product(v[half], moving[half]);
                }
                let mut column = [0.0; 16];
                if body == 0 {
                    let force = bent[0].plus(damped[0]).plus(inert[0]).plus(stretched[0]);
                    store([force, bent[1]], &mut column);
                    for (i, top) in by.on_top[l].iter_mut().enumerate() {
                        let touched = if by.any[l] { by.touched[l][0][i] } else { 0.0 };
                        *top = column[i] + touched - link.weight_on_top[i];
                    }
                }
                for (values, force) in [
                    (&mut point.geometric, stretched),
                    (&mut point.damping, damped),
                    (&mut point.inertia, inert),
                ] {
                    store(force, &mut column);
                    add(values, at, &column);
                }
            }
        }
        point.kinetic = 0.5 * sum(kinetic);
        point.geometric_energy = 0.5 * sum(geometric);
        point.foresight = sum(foreseen);
        0.5 * sum(elastic) + point.geometric_energy
    }
}

/// Friction of all contacts into `point`, with the power of their damping. Gives the energy in their springs (J).
struct Friction<'a> {
    by: &'a Reduced,
    point: &'a mut EnergyPoint,
    model: &'a Model,
    assembler: &'a Assembler,
}

impl Kernel for Friction<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self) -> f64 {
        let Self {
            by,
            point,
            model,
            assembler,
        } = self;
        let mut stored = 0.0;
        for &station in &by.hits {
            let (l, i) = by.span_of(station);
            let rows = &by.kinds[by.links[l].kind].force[i];
            let mut on_guide = [0.0; 6];
            if let Some(touch) = &assembler.inner[station] {
                let force = touch.friction_force();
                add(
                    &mut point.friction,
                    ends(l, 0),
                    &on_ends::<V>(&rows[0], &at_radius(&force, 1.0)),
                );
                on_guide = at_radius(&-force, model.guide_radii[0]);
                stored += touch.energy;
                point.contact_dissipation += touch.dissipation;
            }
            if let Some(touch) = &assembler.outer[station] {
                let force = at_radius(&touch.friction_force(), model.guide_radii[1]);
                (0..6).for_each(|k| on_guide[k] += force[k]);
                stored += touch.energy;
                point.contact_dissipation += touch.dissipation;
            }
            add(&mut point.friction, ends(l, 1), &on_ends::<V>(&rows[1], &on_guide));
        }
        stored
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
