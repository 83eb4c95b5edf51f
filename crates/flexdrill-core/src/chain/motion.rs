//! How the stations of a span move with its ends.

use super::columns::{EndColumn, Ends, at_ends, load, places, product};
use super::slaving::LinkMatrices;
use super::{Chain, NODE};
use crate::dynamics::state::{Deflection, State};
use crate::simd::vector::Vector;

impl Chain {
    /// Local motions of the pipe (0) or the guide (1) at station `i` of span `l`, by each of several `motions` of the ends.
    #[inline(always)]
    pub(crate) fn local<V: Vector, const N: usize>(
        &self,
        motions: [&[f64]; N],
        l: usize,
        i: usize,
        body: usize,
    ) -> [V; N] {
        let columns = &self.model.kinds[self.model.links[l].kind].motion[i][body];
        let [top, bottom] = places(body);
        let (mut above, mut below) = ([V::splat(0.0); N], [V::splat(0.0); N]);
        // Numbers are read where they are multiplied: only there does their load spread them to all lanes.
        if i < self.model.nodes.elements(l) {
            for (sum, x) in above.iter_mut().zip(motions) {
                let node = &x.as_chunks::<NODE>().0[l];
                for j in 0..6 {
                    *sum = sum.plus_product(V::load(&columns[j]), V::splat(node[top + j]));
                }
            }
        }
        if i > 0 {
            for (sum, x) in below.iter_mut().zip(motions) {
                let node = &x.as_chunks::<NODE>().0[l + 1];
                for j in 0..6 {
                    *sum = sum.plus_product(V::load(&columns[6 + j]), V::splat(node[bottom + j]));
                }
            }
        }
        for (sum, below) in above.iter_mut().zip(below) {
            *sum = sum.plus(below);
        }
        above
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
