//! The reduced numbering beside the model's: from one to the other.

use nalgebra::Vector3;

use super::nodes::Nodes;
use super::{EndForces, GUIDE, NODE, Reduced, TIE, U, ends};
use crate::dynamics::energy::JointForces;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

/// Places of the model's unknowns.
pub(crate) struct Numbering {
    /// By the model's unknowns.
    places: Vec<Option<usize>>,
    /// First unknowns of the nodes at which the pipe goes through in one piece.
    welded: Vec<usize>,
}

impl Numbering {
    pub(super) fn of(model: &Model, nodes: &Nodes) -> Self {
        let mut places = vec![None; model.unknowns()];
        for (k, node) in nodes.list.iter().enumerate() {
            let (station, first) = (&model.stations[node.station], NODE * k);
            for i in 0..3 {
                places[station.pipe_above + i] = Some(first + U + i);
                places[station.pipe_above + 3 + i] = Some(first + i);
                if station.joint.is_some() {
                    places[station.pipe_below + 3 + i] = Some(first + 6 + i);
                }
            }
            for i in 0..6 {
                places[station.guide + i] = Some(first + GUIDE + i);
            }
        }
        if let Some(tie) = model.tie {
            places[tie] = Some(NODE * nodes.spans() + TIE);
        }
        let welded = nodes.list.iter().enumerate().filter(|(_, node)| node.joint.is_none());
        let welded = welded.map(|(k, _)| NODE * k).collect();
        Self { places, welded }
    }

    /// Place of an unknown of the model that is one of the reduced numbering too.
    pub(crate) fn place(&self, unknown: usize) -> Option<usize> {
        self.places[unknown]
    }

    /// Unknowns that are held, by supports or, `driven`, by the drive. A support inside a guide that is fixed as a whole
    /// holds none.
    pub(super) fn held(&self, model: &Model, driven: Option<usize>) -> Vec<usize> {
        let held = model.held.iter().filter_map(|&unknown| self.place(unknown));
        held.chain(driven).collect()
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
            for &first in &self.welded {
                to.copy_within(first..first + 3, first + 6);
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
        (0..self.nodes.list.len()).flat_map(|k| [NODE * k, NODE * k + 6])
    }

    /// Station and whether it is the guide's, of a reduced unknown.
    pub(super) fn locate(&self, unknown: usize) -> (usize, bool) {
        (
            self.nodes.list[unknown / NODE].station,
            (GUIDE..TIE).contains(&(unknown % NODE)),
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
            let station = &model.stations[self.nodes.first(k)];
            station.frame * (station.pipe_to_station * pipe + guide)
        };
        let mut sum = Vector3::zeros();
        for k in 0..self.nodes.list.len() {
            sum += on_node(k, of(values, NODE * k + U), of(values, NODE * k + GUIDE));
        }
        for (l, [pipe, guide]) in spans.enumerate() {
            sum += on_node(l, of(pipe, 0), of(guide, 0));
            // The pipe's rotations come before its displacements at the bottom end.
            sum += on_node(l + 1, of(pipe, 8 + U), of(guide, 8));
        }
        sum
    }

    /// Shows the reduced state in the model's numbering: inner stations as they are slaved, and the force
    /// and moment of each joint as its multipliers. Lagged accelerations stay as they are.
    pub(crate) fn show(&self, model: &Model, reduced: &State, forces: &JointForces, full: &mut State) {
        self.instructions.run(Show {
            by: self,
            model,
            reduced,
            forces,
            full,
        });
    }
}

impl Reduced {
    /// What `values` in the reduced numbering mean for the translation of the pipe at `station`, in the pipe's own axes;
    /// at a joint of the end above.
    pub(crate) fn pipe_translation(&self, values: &[f64], station: usize) -> Vector3<f64> {
        let (l, i) = self.nodes.stations[station];
        let node = |k: usize| Vector3::new(values[NODE * k + U], values[NODE * k + U + 1], values[NODE * k + U + 2]);
        if station == 0 {
            return node(0);
        }
        if i == self.nodes.elements(l) {
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
    forces: &'a JointForces,
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
            forces,
            full,
        } = self;
        (full.scheme_step, full.time, full.drive_angle) = (reduced.scheme_step, reduced.time, reduced.drive_angle);
        for (from, to) in [
            (&reduced.q, &mut full.q),
            (&reduced.v, &mut full.v),
            (&reduced.a, &mut full.a),
        ] {
            for (k, node) in from.as_chunks::<NODE>().0.iter().enumerate() {
                let station = &model.stations[by.nodes.list[k].station];
                let u = Vector3::new(node[U], node[U + 1], node[U + 2]);
                for i in 0..3 {
                    to[station.pipe_above + i] = u[i];
                    to[station.pipe_above + 3 + i] = node[i];
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
                        let station = &model.stations[by.nodes.first(l) + i + 1];
                        let first = if body == 0 { station.pipe_above } else { station.guide };
                        to[first..first + 6].copy_from_slice(&lanes[..6]);
                    }
                }
            }
        }
        for (span, node) in by.nodes.list.iter().enumerate() {
            let Some(joint) = node.joint else { continue };
            let (at, first) = (&model.joints[joint], model.multipliers(joint));
            // What the span below asks for at its top, in the frame of the link above.
            let force = Vector3::from(forces.on_top[span]);
            let force = at.upper * force / model.force_scale;
            (0..3).for_each(|i| full.q[first + i] = force[i]);
            for (row, lambda) in forces.multipliers[joint].iter().enumerate() {
                full.q[first + 3 + row] = lambda / model.moment_scale;
            }
        }
        if let (Some(tie), Some(place)) = (model.tie, by.places.tie) {
            full.q[tie] = reduced.q[place];
        }
        for l in 0..by.links.len() {
            let elements = by.nodes.first(l)..by.nodes.first(l + 1);
            full.pipe_axial[elements.clone()].fill(reduced.pipe_axial[l]);
            full.guide_axial[elements].fill(reduced.guide_axial[l]);
        }
    }
}
