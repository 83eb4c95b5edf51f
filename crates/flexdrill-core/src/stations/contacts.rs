//! Contacts of both layers on the whole tool: from the nodes' motion to the gap's own coordinates, and from the gap's
//! force to the nodes.

use nalgebra::{Vector2, Vector3};

use super::assembler::Assembler;
use super::axial::node;
use super::interactions::Interactions;
use super::linear::ContactBlock;
use crate::chain::Touching;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::state::{State, inner_lateral};
use crate::effects::contact::law::{GapLaw, GapVector, LayerContacts};
use crate::effects::contact::{Layers, laws};
use crate::effects::mud_wall::Motion;
use crate::elements::factors::TangentFactors;
use crate::model::{Model, Station};
use crate::simd::Kernel;
use crate::simd::vector::Vector;

impl Assembler {
    /// Finds what touches and adds its forces, Eq. 20 to 34: the sum of Eq. 39.
    pub(super) fn contact_forces(
        &mut self,
        interactions: &mut Interactions,
        model: &Model,
        state: &State,
        conditions: &Conditions,
    ) {
        let Layers {
            inner,
            outer,
            start,
            step,
            ..
        } = &mut interactions.layers;
        self.instructions.run(Search {
            layers: [inner, outer],
            start,
            step: *step,
            model,
            state,
            laws: laws(&model.description, conditions),
            advance: conditions.rate_of_penetration,
        });
        let residual = &mut self.residual;
        let walls = crate::effects::mud_wall::at_stations(model);
        for (s, (station, near)) in model.stations.iter().zip(&walls).enumerate() {
            self.mud[s] = mud_motions(model, station, state);
            let taken = [0, 1].map(|k| near[k].take(&self.mud[s][k]));
            let total = taken.map(|taken| [0, 1].map(|k| taken.film[k] + taken.inertia[k]));
            add_mud_forces(residual, station, total);
        }
        let Layers { inner, outer, .. } = &interactions.layers;
        for (s, touch) in inner.iter() {
            let station = &model.stations[s];
            let (on_pipe, on_guide) = inner_forces(model, station, &touch.force().into());
            scatter(residual, station.pipe_above, &-on_pipe);
            scatter(residual, station.guide, &-on_guide);
        }
        for (s, touch) in outer.iter() {
            scatter(
                residual,
                model.stations[s].guide,
                &-outer_force(model, &touch.force().into()),
            );
        }
    }

    /// Fills the contacts' part of the tangent increment, Eq. 28 and 32.
    pub(super) fn contact_tangent(&mut self, interactions: &Interactions, model: &Model, factors: TangentFactors) {
        let walls = crate::effects::mud_wall::at_stations(model);
        for (s, station) in model.stations.iter().enumerate() {
            let (inner, outer) = (interactions.layers.inner.get(s), interactions.layers.outer.get(s));
            self.increment.touching[s] = match (&inner, &outer) {
                (None, None) => Touching::Nothing,
                (None, Some(_)) => Touching::Guide,
                (Some(_), _) => Touching::Both,
            };
            let near = walls.get(s);
            let near = near.map_or([None; 2], |near| {
                [0, 1].map(|k| near[k].tangent(&self.mud[s][k], &factors))
            });
            if near.iter().any(Option::is_some) {
                self.increment.touching[s] = Touching::Both;
            }
            if self.increment.touching[s] == Touching::Nothing {
                continue;
            }
            let block = &mut self.increment.contact[s];
            *block = [[0.0; 12]; 12];
            add_mud_tangent(block, model, station, near);
            // A local force change of minus `on` times `by` . motion is one of the same form on the nodes.
            if let Some(touch) = inner {
                for term in touch.tangent(factors.stiffness, factors.damping).terms() {
                    let (on, by) = (
                        inner_forces(model, station, &term.on),
                        inner_forces(model, station, &term.by),
                    );
                    add_product::<12>(block, 0, &joined(&on), &joined(&by));
                }
            }
            if let Some(touch) = outer {
                for term in touch.tangent(factors.stiffness, factors.damping).terms() {
                    let (on, by) = (outer_force(model, &term.on), outer_force(model, &term.by));
                    add_product::<6>(block, 6, &on.data.0[0], &by.data.0[0]);
                }
            }
        }
    }
}

/// How the pipe moves in the guide, and the guide in the hole.
pub fn mud_motions(model: &Model, station: &Station, state: &State) -> [Motion; 2] {
    let lateral = |values: &[f64]| {
        let (pipe, guide) = (inner_motion(model, station, values), node(values, station.guide));
        [[pipe[1], pipe[2]], [guide[1], guide[2]]]
    };
    let (mut d, v, a) = (lateral(&state.q), lateral(&state.v), lateral(&state.a));
    d[0] = [d[0][0] + station.offset.x, d[0][1] + station.offset.y];
    [0, 1].map(|k| Motion {
        d: d[k],
        v: v[k],
        a: a[k],
    })
}

/// Adds what mud near the walls takes from the pipe, and gives to the guide, and what it takes from the guide, along y
/// and z of the station.
pub fn add_mud_forces(forces: &mut [f64], station: &Station, [inner, outer]: [[f64; 2]; 2]) {
    let on_pipe = station.pipe_to_station.tr_mul(&Vector3::new(0.0, inner[0], inner[1]));
    (0..3).for_each(|k| forces[station.pipe_above + k] += on_pipe[k]);
    (0..2).for_each(|k| forces[station.guide + 1 + k] += outer[k] - inner[k]);
}

/// Adds the derivatives of the forces of mud near the walls to a contact block.
fn add_mud_tangent(block: &mut ContactBlock, model: &Model, station: &Station, near: [Option<[[f64; 2]; 2]>; 2]) {
    for (layer, tangent) in near.into_iter().enumerate() {
        let Some(tangent) = tangent else { continue };
        let unit = |k: usize| GapVector::from_fn(|i, _| f64::from(u8::from(i == k)));
        for (column, on) in tangent.iter().enumerate() {
            let (on, by) = (unit(1) * on[0] + unit(2) * on[1], unit(1 + column));
            if layer == 0 {
                let (on, by) = (inner_forces(model, station, &on), inner_forces(model, station, &by));
                add_product::<12>(block, 0, &joined(&on), &joined(&by));
            } else {
                let (on, by) = (outer_force(model, &on), outer_force(model, &by));
                add_product::<6>(block, 6, &on.data.0[0], &by.data.0[0]);
            }
        }
    }
}

/// Finds what touches.
struct Search<'a> {
    layers: [&'a mut LayerContacts; 2],
    /// Displacements at the start of the step, for bristles, and its size (s).
    start: &'a [f64],
    step: f64,
    model: &'a Model,
    state: &'a State,
    laws: [GapLaw; 2],
    advance: f64,
}

impl Kernel for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            layers: [inner, outer],
            start,
            step,
            model,
            state,
            laws,
            advance,
        } = self;
        inner.clear();
        outer.clear();
        for (s, station) in model.stations.iter().enumerate() {
            let (lateral, clearance) = (inner_lateral(station, state), station.inner_clearance);
            if lateral.norm_squared() > clearance * clearance {
                let velocity = inner_motion(model, station, &state.v);
                if laws[0].has_bristles() {
                    let travel = inner_motion(model, station, &state.q) - inner_motion(model, station, start);
                    inner.set_travel(six::<V>(&travel));
                }
                inner.push::<V>(&laws[0], s, lateral.into(), clearance, six::<V>(&velocity));
            }
            let clearance = model.outer_clearance;
            let lateral = Vector2::new(state.q[station.guide + 1], state.q[station.guide + 2]);
            if lateral.norm_squared() > clearance * clearance {
                let mut velocity = outer_motion(model, station, &state.v);
                if advance != 0.0 {
                    velocity[0] += advance;
                }
                if laws[1].has_bristles() {
                    let mut travel = outer_motion(model, station, &state.q) - outer_motion(model, station, start);
                    travel[0] += advance * step;
                    outer.set_travel(six::<V>(&travel));
                }
                outer.push::<V>(&laws[1], s, lateral.into(), clearance, six::<V>(&velocity));
            }
        }
        inner.finish::<V>(&laws[0]);
        outer.finish::<V>(&laws[1]);
    }
}

/// Local motion in the first six lanes.
#[inline(always)]
fn six<V: Vector>(motion: &GapVector) -> V {
    let mut lanes = [0.0; 8];
    lanes[..6].copy_from_slice(motion.as_slice());
    V::load(&lanes)
}

/// Adds a force at a node.
#[inline(always)]
fn scatter(residual: &mut [f64], first: usize, force: &GapVector) {
    for (to, x) in residual[first..].iter_mut().zip(force) {
        *to += x;
    }
}

/// Local motion of the inner gap by the nodes' `values`, Eq. 23.
#[inline]
fn inner_motion(model: &Model, station: &Station, values: &[f64]) -> GapVector {
    let pipe = node(values, station.pipe_above);
    let guide = node(values, station.guide);
    let mut local = GapVector::zeros();
    local
        .fixed_rows_mut::<3>(0)
        .copy_from(&(station.pipe_to_station * pipe.fixed_rows::<3>(0) - guide.fixed_rows::<3>(0)));
    local
        .fixed_rows_mut::<3>(3)
        .copy_from(&(pipe.fixed_rows::<3>(3) * station.pipe_radius - guide.fixed_rows::<3>(3) * model.guide_radii[0]));
    local
}

/// Local motion of the outer gap by the nodes' `values`, Eq. 23; the wall's own is left out.
#[inline]
fn outer_motion(model: &Model, station: &Station, values: &[f64]) -> GapVector {
    let mut local = node(values, station.guide);
    local.fixed_rows_mut::<3>(3).scale_mut(model.guide_radii[1]);
    local
}

/// Forces on the pipe node and the guide node from the local force of the inner gap, Eq. 29.
#[inline]
pub fn inner_forces(model: &Model, station: &Station, force: &GapVector) -> (GapVector, GapVector) {
    let mut pipe = *force;
    let turned = station.pipe_to_station.tr_mul(&force.fixed_rows::<3>(0));
    pipe.fixed_rows_mut::<3>(0).copy_from(&turned);
    pipe.fixed_rows_mut::<3>(3).scale_mut(station.pipe_radius);
    let mut guide = -force;
    guide.fixed_rows_mut::<3>(3).scale_mut(model.guide_radii[0]);
    (pipe, guide)
}

/// Force on the guide node from the local force of the outer gap, Eq. 33.
#[inline]
pub fn outer_force(model: &Model, force: &GapVector) -> GapVector {
    let mut guide = *force;
    guide.fixed_rows_mut::<3>(3).scale_mut(model.guide_radii[1]);
    guide
}

/// Forces on pipe and guide in one.
#[inline(always)]
fn joined((pipe, guide): &(GapVector, GapVector)) -> [f64; 12] {
    let mut out = [0.0; 12];
    out[..6].copy_from_slice(pipe.as_slice());
    out[6..].copy_from_slice(guide.as_slice());
    out
}

/// Adds on by^T at (`first`, `first`) of a contact block.
#[inline(always)]
fn add_product<const N: usize>(block: &mut ContactBlock, first: usize, on: &[f64; N], by: &[f64; N]) {
    for (column, by) in block[first..].iter_mut().zip(by) {
        for (x, on) in column[first..].iter_mut().zip(on) {
            *x += on * by;
        }
    }
}
