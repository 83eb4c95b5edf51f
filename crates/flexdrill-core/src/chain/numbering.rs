//! From the model's numbering to the chain's, and back.

use nalgebra::Vector3;

use super::columns::{EndForces, ends};
use super::nodes::Nodes;
use super::{Chain, ChainModel, GUIDE, NODE, TIE, U};
use crate::dynamics::carried::JointForces;
use crate::dynamics::state::{State, held_friction};
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

/// Places of the model's unknowns in the chain.
pub(crate) struct Numbering {
    /// By the model's unknowns; `None` for those that follow from others.
    places: Vec<Option<usize>>,
    /// First unknowns of the nodes that the pipe passes in one piece.
    in_one_piece: Vec<usize>,
}

impl Numbering {
    pub(super) fn of(model: &Model, nodes: &Nodes) -> Self {
        let mut places = vec![None; model.unknowns()];
        for node in &nodes.list {
            let station = &model.stations[node.station];
            let joint = station.joint.map(|_| station.pipe_below + 3..station.pipe_below + 6);
            let pipe_and_guide = (station.pipe_above..station.pipe_above + 6).chain(station.guide..station.guide + 6);
            for unknown in pipe_and_guide.chain(joint.into_iter().flatten()).chain(model.tie) {
                places[unknown] = Some(place(model, nodes, unknown));
            }
        }
        let in_one_piece = nodes.list.iter().enumerate().filter(|(_, node)| node.joint.is_none());
        Self {
            places,
            in_one_piece: in_one_piece.map(|(k, _)| NODE * k).collect(),
        }
    }

    /// Place of an unknown of the model that is one of the chain too.
    pub(super) fn place(&self, unknown: usize) -> Option<usize> {
        self.places[unknown]
    }

    /// Unknowns that are held, by supports or, `driven`, by the drive. A support inside a guide that is fixed as a whole
    /// holds none.
    pub(super) fn held(&self, model: &Model, driven: Option<usize>) -> Vec<usize> {
        let held = model.held.iter().filter_map(|&unknown| self.place(unknown));
        held.chain(driven).collect()
    }

    /// Takes the unknowns of `chain` from `full`.
    fn gather(&self, full: &State, chain: &mut State) {
        let pairs = [
            (&full.q, &mut chain.q),
            (&full.v, &mut chain.v),
            (&full.a, &mut chain.a),
            (&full.lagged, &mut chain.lagged),
        ];
        for (from, to) in pairs {
            to.fill(0.0);
            for (x, place) in from.iter().zip(&self.places) {
                if let Some(place) = place {
                    to[*place] = *x;
                }
            }
            for &first in &self.in_one_piece {
                to.copy_within(first..first + 3, first + 6);
            }
        }
        chain.pin_moments.copy_from_slice(&full.pin_moments);
        (chain.scheme_step, chain.time, chain.drive_angle) = (full.scheme_step, full.time, full.drive_angle);
    }
}

/// Place of an unknown of a station at a node.
pub(super) fn place(model: &Model, nodes: &Nodes, unknown: usize) -> usize {
    let at = model.layout.station_of(unknown);
    let (station, (span, i)) = (&model.stations[at], nodes.stations[at]);
    let first = NODE * if i == 0 { span } else { span + 1 };
    if model.tie == Some(unknown) {
        return first + TIE;
    }
    match unknown.checked_sub(station.guide) {
        Some(i @ 0..6) => first + GUIDE + i,
        // Of the pipe, below a joint and above: the displacement below follows from that above.
        _ => match (station.joint, unknown.checked_sub(station.pipe_below)) {
            (Some(_), Some(i @ 3..6)) => first + 3 + i,
            (Some(_), Some(i @ 0..3)) => first + U + i,
            _ => match unknown - station.pipe_above {
                i @ 0..3 => first + U + i,
                i => first + i - 3,
            },
        },
    }
}

impl ChainModel {
    /// Place of an unknown of the tool's model that is one of the chain too.
    pub(crate) fn place(&self, unknown: usize) -> Option<usize> {
        self.numbering.place(unknown)
    }
}

impl Chain {
    /// Takes a state in the numbering of the model.
    pub(crate) fn take(&self, model: &Model, from: &State, to: &mut State) {
        self.model.numbering.gather(from, to);
        self.take_deflections(model, from, to);
        to.held_friction.copy_from_slice(&from.held_friction);
    }

    /// A state of the right sizes.
    pub(crate) fn state(&self, model: &Model) -> State {
        let (n, spans) = (self.unknowns(), self.spans());
        State {
            q: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            lagged: vec![0.0; n],
            scheme_step: 0.0,
            pipe_axial: vec![0.0; spans],
            guide_axial: vec![0.0; spans],
            deflection: vec![[[0.0; 16]; 2]; spans],
            pin_moments: vec![0.0; self.multipliers.len()],
            held_friction: held_friction(model),
            time: 0.0,
            drive_angle: 0.0,
        }
    }

    /// Spins of the pipe.
    pub(crate) fn spins(&self) -> impl Iterator<Item = usize> {
        (0..self.model.nodes.list.len()).flat_map(|k| [NODE * k, NODE * k + 6])
    }

    /// Station and whether it is the guide's, of an unknown of the chain.
    pub(super) fn locate(&self, unknown: usize) -> (usize, bool) {
        (
            self.model.nodes.list[unknown / NODE].station,
            (GUIDE..TIE).contains(&(unknown % NODE)),
        )
    }

    /// Sum in the world of the forces that `values`, per unknown of the chain, and the `spans`, on their ends, hold.
    pub(crate) fn sum_in_world<'a>(
        &self,
        model: &Model,
        values: &[f64],
        spans: impl Iterator<Item = &'a EndForces>,
    ) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for k in 0..self.model.nodes.list.len() {
            sum += self.on_node(
                model,
                k,
                first_three(values, NODE * k + U),
                first_three(values, NODE * k + GUIDE),
            );
        }
        sum + self.sum_of_spans(model, spans.copied())
    }

    /// Sum in the world of the forces on the ends of all `spans`.
    pub(super) fn sum_of_spans(&self, model: &Model, spans: impl Iterator<Item = EndForces>) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for (l, [pipe, guide]) in spans.enumerate() {
            sum += self.on_node(model, l, first_three(&pipe, 0), first_three(&guide, 0));
            // The pipe's rotations come before its displacements at the bottom end.
            sum += self.on_node(model, l + 1, first_three(&pipe, 8 + U), first_three(&guide, 8));
        }
        sum
    }

    /// Force on node `k` of `pipe` and `guide`, in the world.
    fn on_node(&self, model: &Model, k: usize, pipe: Vector3<f64>, guide: Vector3<f64>) -> Vector3<f64> {
        let station = &model.stations[self.model.nodes.first(k)];
        station.frame * (station.pipe_to_station * pipe + guide)
    }

    /// Shows the chain's state in the model's numbering: inner stations as they are slaved, and the force
    /// and moment of each joint as its multipliers. Lagged accelerations stay as they are.
    pub(crate) fn show(&self, model: &Model, chain: &State, forces: &JointForces, full: &mut State) {
        self.model.instructions.run(Show {
            by: self,
            model,
            chain,
            forces,
            full,
        });
    }
}

impl Chain {
    /// Where an unknown of the model is in the chain; `None` where the chain has no such unknown.
    pub(crate) fn place(&self, unknown: usize) -> Option<usize> {
        self.model.numbering.place(unknown)
    }

    /// What `values` in the chain's numbering mean for an unknown of the model's pipe or guide.
    pub(crate) fn value(&self, model: &Model, values: &[f64], unknown: usize) -> f64 {
        if let Some(place) = self.model.numbering.place(unknown) {
            return values[place];
        }
        let at = model.layout.station_of(unknown);
        let (station, (l, i)) = (&model.stations[at], self.model.nodes.stations[at]);
        if let Some(joint) = station.joint {
            // The displacement below follows from that above.
            let joint = &model.joints[joint];
            let above = self.pipe_translation(values, at);
            return joint.lower.tr_mul(&(joint.upper * above))[unknown - station.pipe_below];
        }
        let (body, k) = match unknown.checked_sub(station.guide) {
            Some(k @ 0..6) => (1, k),
            _ => (0, unknown - station.pipe_above),
        };
        let columns = &self.model.kinds[self.model.links[l].kind].inner[i - 1][body];
        let [top, bottom] = ends(l, body);
        (0..6)
            .map(|j| columns[j][k] * values[top + j] + columns[6 + j][k] * values[bottom + j])
            .sum()
    }

    /// What `values` in the chain's numbering mean for the translation of the pipe at `station`, in the pipe's own axes;
    /// at a joint of the end above.
    pub(crate) fn pipe_translation(&self, values: &[f64], station: usize) -> Vector3<f64> {
        let (l, i) = self.model.nodes.stations[station];
        let node = |k: usize| Vector3::new(values[NODE * k + U], values[NODE * k + U + 1], values[NODE * k + U + 2]);
        if station == 0 {
            return node(0);
        }
        if i == self.model.nodes.elements(l) {
            return node(l + 1);
        }
        let columns = &self.model.kinds[self.model.links[l].kind].inner[i - 1][0];
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

/// Three numbers from place `first` on.
fn first_three(values: &[f64], first: usize) -> Vector3<f64> {
    Vector3::new(values[first], values[first + 1], values[first + 2])
}

struct Show<'a> {
    by: &'a Chain,
    model: &'a Model,
    chain: &'a State,
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
            chain,
            forces,
            full,
        } = self;
        // What is no unknown is the same in both numberings.
        full.pin_moments.copy_from_slice(&chain.pin_moments);
        (full.scheme_step, full.time, full.drive_angle) = (chain.scheme_step, chain.time, chain.drive_angle);
        full.held_friction.copy_from_slice(&chain.held_friction);
        for (from, to) in [
            (&chain.q, &mut full.q),
            (&chain.v, &mut full.v),
            (&chain.a, &mut full.a),
        ] {
            // Nodes first: joint stations have a second pipe node, which follows from the first by Eq. 12.
            for (k, node) in from.as_chunks::<NODE>().0.iter().enumerate() {
                let station = &model.stations[by.model.nodes.list[k].station];
                let u = Vector3::new(node[U], node[U + 1], node[U + 2]);
                for i in 0..3 {
                    to[station.pipe_above + i] = u[i];
                    to[station.pipe_above + 3 + i] = node[i];
                }
                to[station.guide..station.guide + 6].copy_from_slice(&node[GUIDE..GUIDE + 6]);
                if let Some(joint) = station.joint {
                    let at = &model.joints[joint];
                    // The displacement below is that above, turned into the frame of the link below.
                    let below = at.lower.tr_mul(&(at.upper * u));
                    for i in 0..3 {
                        to[station.pipe_below + i] = below[i];
                        to[station.pipe_below + 3 + i] = node[6 + i];
                    }
                }
            }
            // Inner stations follow by the slaving. Their velocities and accelerations follow alike, as it is constant.
            for (l, link) in by.model.links.iter().enumerate() {
                let inner = &by.model.kinds[link.kind].inner;
                for body in 0..2 {
                    let [top, bottom] = ends(l, body);
                    let mut x = [V::splat(0.0); 12];
                    for j in 0..6 {
                        x[j] = V::splat(from[top + j]);
                        x[6 + j] = V::splat(from[bottom + j]);
                    }
                    for (i, columns) in inner.iter().enumerate() {
                        let columns = &columns[body];
                        // Two sums instead of one halve the chain of dependent products.
                        let (mut even, mut odd) = (V::splat(0.0), V::splat(0.0));
                        for j in 0..6 {
                            even = even.plus_product(V::load(&columns[j]), x[j]);
                            odd = odd.plus_product(V::load(&columns[6 + j]), x[6 + j]);
                        }
                        let mut lanes = [0.0; 8];
                        even.plus(odd).store(&mut lanes);
                        let station = &model.stations[by.model.nodes.first(l) + i + 1];
                        let first = if body == 0 { station.pipe_above } else { station.guide };
                        to[first..first + 6].copy_from_slice(&lanes[..6]);
                    }
                }
            }
        }
        // Multipliers are needed by observers only: the chain has eliminated them.
        for (span, node) in by.model.nodes.list.iter().enumerate() {
            let Some(joint) = node.joint else { continue };
            let (at, first) = (&model.joints[joint], model.multipliers(joint));
            // The force of the span below on its top, in the frame of the link above.
            let force = Vector3::from(forces.on_top[span]);
            let force = at.upper * force / model.force_scale;
            (0..3).for_each(|i| full.q[first + i] = force[i]);
            for (row, lambda) in forces.multipliers[joint].iter().enumerate() {
                full.q[first + 3 + row] = lambda / model.moment_scale;
            }
        }
        if let (Some(tie), Some(place)) = (model.tie, by.model.places.tie) {
            full.q[tie] = chain.q[place];
        }
        // An axial force of a span holds for each of its elements.
        for l in 0..by.model.links.len() {
            let elements = by.model.nodes.first(l)..by.model.nodes.first(l + 1);
            full.pipe_axial[elements.clone()].fill(chain.pipe_axial[l]);
            full.guide_axial[elements].fill(chain.guide_axial[l]);
        }
    }
}
