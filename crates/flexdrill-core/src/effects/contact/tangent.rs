//! The contacts' part of the tangent. A contact inside a span adds to the blocks of both its ends and to their coupling.
//!
//! Its own tangent is the sum of four products on by^T of local forces and motions ([`GapTangent`]). On the nodes it is the same
//! sum with the forces and motions that the slaving makes of them.

use super::law::GapTangent;
use super::{Contact, Layers};
use crate::chain::{Additions, BOTTOM, Chain, GUIDE, Lanes, NODE, Precision, TOP, Touching};
use crate::elements::factors::TangentFactors;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

impl Contact {
    /// Adds the derivative of the forces of the last residual.
    pub(super) fn tangents<S: Precision>(&self, to: &mut Additions<S>, chain: &Chain, factors: TangentFactors) {
        chain.model.instructions.run(Tangents {
            to,
            chain,
            layers: &self.layers,
            factors,
        });
    }
}

struct Tangents<'a, S> {
    to: &'a mut Additions<S>,
    chain: &'a Chain,
    layers: &'a Layers,
    factors: TangentFactors,
}

impl<S: Precision> Kernel for Tangents<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let chain = self.chain;
        let mut guide_sum = GuideSum::<S>::new();
        let layers = [(&self.layers.inner, true), (&self.layers.outer, false)];
        // Contacts of pipe and guide fill the whole node; those of the wall
        // only the guide's part, which is summed per span.
        for (layer, inner) in layers {
            for (station, touch) in layer.among(|station| chain.is_active(chain.span_of(station).0)) {
                let (l, i) = chain.span_of(station);
                let on_nodes = &S::on_nodes(&chain.model.kind(l).on_nodes)[i];
                let contact = InSpan {
                    l,
                    at: [i == 0, i == chain.elements_of(l).len()],
                    rows: if inner { &on_nodes.inner } else { &on_nodes.outer },
                };
                let tangent = touch.tangent(self.factors.stiffness, self.factors.damping);
                // A wall contact at a node acts on that node alone, and need not be spread over the span.
                if inner {
                    contact.add::<V, true>(self.to, &tangent);
                } else if contact.at[0] || contact.at[1] {
                    contact.add::<V, false>(self.to, &tangent);
                } else {
                    // Stations come from the top down, so a change of the span ends its sum.
                    if guide_sum.span != l {
                        guide_sum.add_to_nodes::<V>(self.to);
                        guide_sum.span = l;
                    }
                    guide_sum.add::<V>(&factors::<V, S>(&on_nodes.outer_joined, &tangent));
                }
            }
        }
        guide_sum.add_to_nodes::<V>(self.to);
    }
}

/// The sum of the tangents of the wall contacts inside one span, over the guide's unknowns of both its ends: columns of the
/// top end, then of the bottom end; rows as [`OnNodes::outer_joined`]. Summed before it is added to the nodes, since there
/// are many per span.
struct GuideSum<S> {
    span: usize,
    has_contacts: bool,
    columns: Aligned<[[S; NODE]; 12]>,
}

impl<S: Precision> GuideSum<S> {
    fn new() -> Self {
        Self {
            span: 0,
            has_contacts: false,
            columns: Aligned([[S::ZERO; NODE]; 12]),
        }
    }

    #[inline(always)]
    fn add<V: Vector>(&mut self, contact: &Factors<S::Lanes<V>, S>) {
        if !self.has_contacts {
            self.has_contacts = true;
            *self.columns = [[S::ZERO; NODE]; 12];
        }
        for c in 0..6 {
            add_product::<V, S>(&mut self.columns[c], &contact.on, &contact.by, GUIDE + c);
            add_product::<V, S>(&mut self.columns[6 + c], &contact.on, &contact.by, GUIDE - 8 + c);
        }
    }

    #[inline(always)]
    fn add_to_nodes<V: Vector>(&mut self, to: &mut Additions<S>) {
        if !self.has_contacts {
            return;
        }
        self.has_contacts = false;
        let l = self.span;
        let rows = S::Lanes::<V>::load(S::guide());
        let coupling = to.coupling(l, Touching::Guide);
        for c in 0..6 {
            let (top, bottom) = (
                S::Lanes::<V>::load(&self.columns[c]),
                S::Lanes::<V>::load(&self.columns[6 + c]),
            );
            let (upper, lower) = (&mut coupling.upper[6 + c], &mut coupling.lower[6 + c]);
            S::Lanes::<V>::load(upper).plus_product(bottom, rows).store(upper);
            S::Lanes::<V>::load(lower)
                .plus_product(top.swapped(), rows)
                .store(lower);
        }
        for (node, first) in [(l, 0), (l + 1, 6)] {
            let block = to.block(node, Touching::Guide);
            for c in 0..6 {
                let mut column = S::Lanes::<V>::load(&self.columns[first + c]);
                if first == 6 {
                    column = column.swapped();
                }
                let to = &mut block[GUIDE + c];
                S::Lanes::<V>::load(to).plus_product(column, rows).store(to);
            }
        }
    }
}

/// A contact in its span.
struct InSpan<'a, S> {
    /// Span.
    l: usize,
    /// Whether it is at its top or bottom end.
    at: [bool; 2],
    /// The forces on the nodes above and below by a local force at the contact.
    rows: &'a [[[S; NODE]; 6]; 2],
}

/// The four products on by^T of a contact, on one node. `on` is kept in vectors, `by` in memory, since its numbers are
/// read one at a time.
struct Factors<L, S> {
    on: [L; 4],
    by: Aligned<[[S; NODE]; 4]>,
}

/// [`GapTangent`] on nodes, `rows` being the forces on them by the six local ones.
#[inline(always)]
fn factors<V: Vector, S: Precision>(rows: &[[S; NODE]; 6], tangent: &GapTangent) -> Factors<S::Lanes<V>, S> {
    let of = |x: f64| S::Lanes::<V>::splat(S::of(x));
    let mut row = [S::Lanes::<V>::splat(S::ZERO); 6];
    for (row, from) in row.iter_mut().zip(rows) {
        *row = S::Lanes::<V>::load(from);
    }
    let (y, z, minus_y, minus_z) = (
        of(tangent.direction[0]),
        of(tangent.direction[1]),
        of(-tangent.direction[0]),
        of(-tangent.direction[1]),
    );
    let normal = row[1].times(y).plus_product(row[2], z);
    let tangential = row[2].times(y).plus_product(row[1], minus_z);
    let around = tangential.plus(row[3]);
    let along = row[0].plus_product(row[4], z).plus_product(row[5], minus_y);
    let tilt = row[4].times(y).plus_product(row[5], z);
    let ([a, b, c], by) = (tangent.by_normal, tangent.by_tangent);
    let mut out = Aligned([[S::ZERO; NODE]; 4]);
    for (to, from) in out.iter_mut().zip([normal, tangential, around, along]) {
        from.store(to);
    }
    Factors {
        on: [
            normal
                .times(of(a))
                .plus_product(around, of(b))
                .plus_product(along, of(c)),
            (normal.times(of(by[0])).plus_product(tangential, of(by[1])))
                .plus_product(tilt, of(by[4]))
                .plus(around.times(of(by[2])).plus_product(along, of(by[3]))),
            (around.times(of(tangent.by_around))).plus_product(along, of(tangent.by_other)),
            (along.times(of(tangent.by_along))).plus_product(around, of(tangent.by_other)),
        ],
        by: out,
    }
}

impl<S: Precision> InSpan<'_, S> {
    /// [`GapTangent`] on a node.
    #[inline(always)]
    fn factors<V: Vector>(&self, end: usize, tangent: &GapTangent) -> Factors<S::Lanes<V>, S> {
        factors::<V, S>(&self.rows[end], tangent)
    }

    /// Adds a contact: to the guide's unknowns, and with `INNER` to those of the pipe.
    #[inline(always)]
    fn add<V: Vector, const INNER: bool>(&self, to: &mut Additions<S>, tangent: &GapTangent) {
        // The guide's columns come last in every list of twelve.
        let (first, touching) = if INNER {
            (0, Touching::Both)
        } else {
            (6, Touching::Guide)
        };
        // A station at a node moves with that node only, and is done here.
        for (end, columns) in [&TOP, &BOTTOM].into_iter().enumerate() {
            if self.at[end] {
                let node = self.factors::<V>(end, tangent);
                let block = to.block(self.l + end, touching);
                for &j in &columns[first..] {
                    add_product::<V, S>(&mut block[j], &node.on, &node.by, j);
                }
                return;
            }
        }
        let above = self.factors::<V>(0, tangent);
        let below = self.factors::<V>(1, tangent);
        let block = to.block(self.l, touching);
        for &j in &TOP[first..] {
            add_product::<V, S>(&mut block[j], &above.on, &above.by, j);
        }
        let block = to.block(self.l + 1, touching);
        for &j in &BOTTOM[first..] {
            add_product::<V, S>(&mut block[j], &below.on, &below.by, j);
        }
        let coupling = to.coupling(self.l, touching);
        for c in first..12 {
            add_product::<V, S>(&mut coupling.upper[c], &above.on, &below.by, BOTTOM[c]);
            add_product::<V, S>(&mut coupling.lower[c], &below.on, &above.by, TOP[c]);
        }
    }
}

/// column += on by^T, for column `j` of the product.
#[inline(always)]
fn add_product<V: Vector, S: Precision>(column: &mut [S; NODE], on: &[S::Lanes<V>; 4], by: &[[S; NODE]; 4], j: usize) {
    S::Lanes::<V>::load(column)
        .plus_product(on[0], S::Lanes::<V>::splat(by[0][j]))
        .plus_product(on[1], S::Lanes::<V>::splat(by[1][j]))
        .plus_product(on[2], S::Lanes::<V>::splat(by[2][j]))
        .plus_product(on[3], S::Lanes::<V>::splat(by[3][j]))
        .store(column);
}
