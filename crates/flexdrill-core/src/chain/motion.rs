//! How the stations of a span move with its ends.

use super::columns::{EndColumn, Ends, at_ends, load, places, product};
use super::slaving::LinkMatrices;
use super::{Chain, NODE};
use crate::dynamics::state::{Deflection, State};
use crate::simd::vector::Vector;

impl Chain {
    /// Local motions of pipe and guide at station `i` of span `l`, by end unknowns `x`.
    #[inline(always)]
    pub(crate) fn local<V: Vector>(&self, x: &[f64], l: usize, i: usize, body: usize) -> V {
        let columns = &self.model.kinds[self.model.links[l].kind].motion[i][body];
        // The numbers are read where they are multiplied: only there does a load spread them to all lanes.
        let (nodes, [top, bottom]) = (x.as_chunks::<NODE>().0, places(body));
        let (mut above, mut below) = (V::splat(0.0), V::splat(0.0));
        if i < self.model.nodes.elements(l) {
            let node = &nodes[l];
            for j in 0..6 {
                above = above.plus_product(V::load(&columns[j]), V::splat(node[top + j]));
            }
        }
        if i > 0 {
            let node = &nodes[l + 1];
            for j in 0..6 {
                below = below.plus_product(V::load(&columns[6 + j]), V::splat(node[bottom + j]));
            }
        }
        above.plus(below)
    }

    /// How far a pipe (0) or guide (1) has moved locally at station `i` of span `l` since the displacements `start`.
    #[inline(always)]
    pub(crate) fn travel<V: Vector>(&self, state: &State, start: &[f64], l: usize, i: usize, body: usize) -> V {
        let now = self.local::<V>(&state.q, l, i, body);
        now.minus(self.local::<V>(start, l, i, body))
    }
}

/// Lateral positions of a span's stations, a station per lane: as the ends move them, and deflected between the ends.
#[inline(always)]
fn position<V: Vector>(lateral: &[EndColumn; 12], ends: &Ends, deflection: &EndColumn) -> [V; 2] {
    let (slaved, deflection): ([V; 2], [V; 2]) = (product(lateral, ends), load(deflection));
    [slaved[0].plus(deflection[0]), slaved[1].plus(deflection[1])]
}

/// How the stations of a span move, the first left out, one per lane: along y and z, the pipe in the guide and the guide in the
/// hole.
pub(crate) struct SpanMotion<V> {
    /// Positions (m).
    pub d: [[V; 2]; 2],
    /// Velocities (m/s).
    pub v: [[V; 2]; 2],
    /// Accelerations (m/s2).
    pub a: [[V; 2]; 2],
}

impl Chain {
    /// How the stations of span `l` move at `state`.
    #[inline(always)]
    pub(crate) fn span_motion<V: Vector>(&self, state: &State, l: usize) -> SpanMotion<V> {
        let kind = self.model.kind(l);
        let (nodes, _) = state.q.as_chunks::<NODE>();
        SpanMotion {
            d: self.positions::<V>(nodes, &state.deflection[l], l),
            v: relative::<V>(kind, &state.v, l),
            a: relative::<V>(kind, &state.a, l),
        }
    }

    /// Lateral positions of the pipe in the guide and of the guide in the hole.
    #[inline(always)]
    pub(crate) fn positions<V: Vector>(&self, nodes: &[[f64; NODE]], deflection: &Deflection, l: usize) -> [[V; 2]; 2] {
        let (link, kind) = (&self.model.links[l], self.model.kind(l));
        let pipe = position::<V>(&kind.lateral[0], &at_ends(nodes, l, 0), &deflection[0]);
        let guide = position::<V>(&kind.lateral[1], &at_ends(nodes, l, 1), &deflection[1]);
        let y = V::load(&link.offset[0]).plus(pipe[0].minus(guide[0]));
        let z = V::load(&link.offset[1]).plus(pipe[1].minus(guide[1]));
        [[y, z], guide]
    }
}

/// How the stations of span `l` move by end unknowns `x`, as [`SpanMotion`].
#[inline(always)]
fn relative<V: Vector>(kind: &LinkMatrices, x: &[f64], l: usize) -> [[V; 2]; 2] {
    let (nodes, _) = x.as_chunks::<NODE>();
    let pipe: [V; 2] = product(&kind.lateral[0], &at_ends(nodes, l, 0));
    let guide: [V; 2] = product(&kind.lateral[1], &at_ends(nodes, l, 1));
    [[pipe[0].minus(guide[0]), pipe[1].minus(guide[1])], guide]
}
