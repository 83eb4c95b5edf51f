//! The reduced numbering beside the model's: from one to the other.

use nalgebra::Vector3;

use super::{EndForces, GUIDE, MULTIPLIER, NODE, Reduced, U, ends};
use crate::dynamics::state::State;
use crate::model::{Model, Places};
use crate::simd::Kernel;
use crate::simd::vector::Vector;

/// Places of the model's unknowns.
pub(crate) struct Numbering {
    /// By the model's unknowns.
    places: Vec<Option<usize>>,
    nodes: usize,
}

impl Numbering {
    pub(super) fn of(model: &Model) -> Self {
        let per = model.description.elements_per_link;
        let nodes = model.joints.len() + 2;
        let mut places = vec![None; model.unknowns()];
        for k in 0..nodes {
            let (station, first) = (&model.stations[k * per], NODE * k);
            let rotations = if k == 0 { first + 6 } else { first };
            for i in 0..3 {
                places[station.pipe_above + i] = Some(first + U + i);
                places[station.pipe_above + 3 + i] = Some(rotations + i);
                if station.joint.is_some() {
                    places[station.pipe_below + 3 + i] = Some(first + 6 + i);
                }
            }
            for i in 0..6 {
                places[station.guide + i] = Some(first + GUIDE + i);
            }
            if let Some(joint) = station.joint {
                places[model.multipliers(joint) + 3] = Some(first + MULTIPLIER);
            }
        }
        if let Some(tie) = model.tie {
            places[tie] = Some(NODE * (nodes - 1) + MULTIPLIER);
        }
        Self { places, nodes }
    }

    /// Place of an unknown of the model that is one of the reduced numbering too.
    pub(crate) fn place(&self, unknown: usize) -> Option<usize> {
        self.places[unknown]
    }

    /// Reduced unknowns without an equation; `None` if an unknown is held that is not in the reduced numbering.
    pub(super) fn without_equation(&self, model: &Model, places: &Places) -> Option<Vec<usize>> {
        let last = NODE * (self.nodes - 1);
        let mut out: Vec<usize> = (0..3).chain(last + 6..last + 9).collect();
        out.push(MULTIPLIER);
        if places.tie.is_none() {
            out.push(last + MULTIPLIER);
        }
        for &unknown in &model.held {
            out.push(self.place(unknown)?);
        }
        out.extend(places.driven);
        Some(out)
    }

    /// Takes what `full` holds for the unknowns of `reduced`.
    pub(crate) fn gather(&self, full: &State, reduced: &mut State) {
        let pairs = [
            (&full.q, &mut reduced.q),
            (&full.v, &mut reduced.v),
            (&full.a, &mut reduced.a),
            (&full.lagged, &mut reduced.lagged),
        ];
        for (from, to) in pairs {
            to.fill(0.0);
            for (x, place) in from.iter().zip(&self.places) {
                if let Some(place) = place {
                    to[*place] = *x;
                }
            }
        }
        (reduced.scheme_step, reduced.time, reduced.drive_angle) = (full.scheme_step, full.time, full.drive_angle);
    }
}

impl Reduced {
    /// A state of the right sizes.
    pub(crate) fn state(&self) -> State {
        let (n, spans) = (self.unknowns(), self.spans());
        State {
            q: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            lagged: vec![0.0; n],
            scheme_step: 0.0,
            pipe_axial: vec![0.0; spans],
            guide_axial: vec![0.0; spans],
            bow: vec![[[0.0; 16]; 2]; spans],
            time: 0.0,
            drive_angle: 0.0,
        }
    }

    /// Spins of the pipe.
    pub(crate) fn spins(&self) -> impl Iterator<Item = usize> {
        let last = self.nodes - 1;
        let above = (1..=last).map(|k| NODE * k);
        above.chain((0..last).map(|k| NODE * k + 6))
    }

    /// Station and whether it is the guide's, of a reduced unknown.
    pub(super) fn locate(&self, unknown: usize) -> (usize, bool) {
        (
            self.per * (unknown / NODE),
            (GUIDE..MULTIPLIER).contains(&(unknown % NODE)),
        )
    }

    /// Sum in the world of what `values`, per reduced unknown, and the `spans` on their ends put on the displacements.
    pub(crate) fn sum_in_world<'a>(
        &self,
        model: &Model,
        values: &[f64],
        spans: impl Iterator<Item = &'a EndForces>,
    ) -> Vector3<f64> {
        let of = |values: &[f64], first: usize| Vector3::new(values[first], values[first + 1], values[first + 2]);
        let on_node = |k: usize, pipe: Vector3<f64>, guide: Vector3<f64>| {
            let station = &model.stations[k * self.per];
            station.frame * (station.pipe_to_station * pipe + guide)
        };
        let mut sum = Vector3::zeros();
        for k in 0..self.nodes {
            sum += on_node(k, of(values, NODE * k + U), of(values, NODE * k + GUIDE));
        }
        for (l, [pipe, guide]) in spans.enumerate() {
            sum += on_node(l, of(pipe, 0), of(guide, 0));
            // The pipe's rotations come before its displacements at the bottom end.
            sum += on_node(l + 1, of(pipe, 8 + U), of(guide, 8));
        }
        sum
    }

    /// Shows the reduced state in the model's numbering: inner stations as they are slaved, and the force of each joint,
    /// from those `on_top` of the spans, as its translational multipliers. Lagged accelerations stay as they are.
    pub(crate) fn show(&self, model: &Model, (reduced, on_top): (&State, &[[f64; 3]]), full: &mut State) {
        self.instructions.run(Show {
            by: self,
            model,
            reduced,
            on_top,
            full,
        });
    }
}

impl Reduced {
    /// What `values` in the reduced numbering mean for the translation of the pipe at `station`, in the pipe's own axes;
    /// at a joint of the end above.
    pub(crate) fn pipe_translation(&self, values: &[f64], station: usize) -> Vector3<f64> {
        let (l, i) = self.stations[station];
        let node = |k: usize| Vector3::new(values[NODE * k + U], values[NODE * k + U + 1], values[NODE * k + U + 2]);
        if station == 0 {
            return node(0);
        }
        if i == self.per {
            return node(l + 1);
        }
        let columns = &self.kinds[self.links[l].kind].inner[i - 1][0];
        let [top, bottom] = ends(l, 0);
        let mut out = Vector3::zeros();
        for j in 0..6 {
            for k in 0..3 {
                out[k] += columns[j][k] * values[top + j] + columns[6 + j][k] * values[bottom + j];
            }
        }
        out
    }
}

struct Show<'a> {
    by: &'a Reduced,
    model: &'a Model,
    reduced: &'a State,
    on_top: &'a [[f64; 3]],
    full: &'a mut State,
}

impl Kernel for Show<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            by,
            model,
            reduced,
            on_top,
            full,
        } = self;
        (full.scheme_step, full.time, full.drive_angle) = (reduced.scheme_step, reduced.time, reduced.drive_angle);
        let per = by.per;
        for (from, to) in [
            (&reduced.q, &mut full.q),
            (&reduced.v, &mut full.v),
            (&reduced.a, &mut full.a),
        ] {
            for (k, node) in from.as_chunks::<NODE>().0.iter().enumerate() {
                let station = &model.stations[k * per];
                let rotations = if k == 0 { 6 } else { 0 };
                let u = Vector3::new(node[U], node[U + 1], node[U + 2]);
                for i in 0..3 {
                    to[station.pipe_above + i] = u[i];
                    to[station.pipe_above + 3 + i] = node[rotations + i];
                }
                to[station.guide..station.guide + 6].copy_from_slice(&node[GUIDE..GUIDE + 6]);
                if let Some(joint) = station.joint {
                    let at = &model.joints[joint];
                    let below = at.lower.tr_mul(&(at.upper * u));
                    for i in 0..3 {
                        to[station.pipe_below + i] = below[i];
                        to[station.pipe_below + 3 + i] = node[6 + i];
                    }
                }
            }
            for (l, link) in by.links.iter().enumerate() {
                let inner = &by.kinds[link.kind].inner;
                for body in 0..2 {
                    let [top, bottom] = ends(l, body);
                    let mut x = [V::splat(0.0); 12];
                    for j in 0..6 {
                        x[j] = V::splat(from[top + j]);
                        x[6 + j] = V::splat(from[bottom + j]);
                    }
                    for (i, columns) in inner.iter().enumerate() {
                        let columns = &columns[body];
                        let (mut even, mut odd) = (V::splat(0.0), V::splat(0.0));
                        for j in 0..6 {
                            even = even.plus_product(V::load(&columns[j]), x[j]);
                            odd = odd.plus_product(V::load(&columns[6 + j]), x[6 + j]);
                        }
                        let mut lanes = [0.0; 8];
                        even.plus(odd).store(&mut lanes);
                        let station = &model.stations[l * per + i + 1];
                        let first = if body == 0 { station.pipe_above } else { station.guide };
                        to[first..first + 6].copy_from_slice(&lanes[..6]);
                    }
                }
            }
        }
        for (joint, at) in model.joints.iter().enumerate() {
            let (span, first) = (joint + 1, model.multipliers(joint));
            let place = NODE * span + U;
            // What the span below asks for at its top, in the frame of the link above.
            let force = Vector3::from(on_top[span]);
            let force = at.upper * force / model.force_scale;
            (0..3).for_each(|i| full.q[first + i] = force[i]);
            full.q[first + 3] = reduced.q[place - U + MULTIPLIER];
        }
        if let (Some(tie), Some(place)) = (model.tie, by.places.tie) {
            full.q[tie] = reduced.q[place];
        }
        for l in 0..by.links.len() {
            full.pipe_axial[l * per..(l + 1) * per].fill(reduced.pipe_axial[l]);
            full.guide_axial[l * per..(l + 1) * per].fill(reduced.guide_axial[l]);
        }
    }
}
