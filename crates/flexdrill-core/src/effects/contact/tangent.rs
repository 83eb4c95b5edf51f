//! The contacts' part of the tangent. A contact inside a span adds to the blocks of both its ends and to their coupling.
//!
//! Its own tangent is the sum of four products on by^T of local forces and motions ([`GapTangent`]). On the nodes it is the same
//! sum with the forces and motions that the slaving makes of them.
//!
//! [`GapTangent`]: super::law::GapTangent

use super::law::Touch;
use super::{Contact, Layers};
use crate::chain::{Additions, BOTTOM, Chain, GUIDE, Lanes, NODE, Precision, TOP, Touching};
use crate::elements::factors::TangentFactors;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::number::{Eight, Lane};
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
        let (mut numbers, mut above, mut below) = (Numbers::<S>::new(), Factors::new(), Factors::new());
        let layers = [(&self.layers.inner, true), (&self.layers.outer, false)];
        // Contacts of pipe and guide fill the whole node; those of the wall
        // only the guide's part, which is summed per span.
        for (layer, inner) in layers {
            // The derivatives of eight contacts are found at once, when the first of them is needed.
            let mut ready = None;
            for (station, slot) in layer.slots_among(|station| chain.is_active(chain.span_of(station).0)) {
                let (group, lane) = (slot / 8, slot % 8);
                if ready != Some(group) {
                    ready = Some(group);
                    numbers.set::<V>(layer.group(group), self.factors);
                }
                let (l, i) = chain.span_of(station);
                let on_nodes = &S::on_nodes(&chain.model.kind(l).on_nodes)[i];
                let rows = if inner { &on_nodes.inner } else { &on_nodes.outer };
                // A wall contact inside a span acts on both its ends, whose factors are in one column.
                let at = [i == 0, i == chain.elements_of(l).len()];
                if !(inner || at[0] || at[1]) {
                    // Stations come from the top down, so a change of the span ends its sum.
                    if guide_sum.span != l {
                        guide_sum.add_to_nodes::<V>(self.to);
                        guide_sum.span = l;
                    }
                    above.set::<V>(&on_nodes.outer_joined, &numbers, lane);
                    guide_sum.add::<V>(&above);
                    continue;
                }
                // A contact at a node acts on that node alone, and need not be spread over the span.
                if !at[1] {
                    above.set::<V>(&rows[0], &numbers, lane);
                }
                if !at[0] {
                    below.set::<V>(&rows[1], &numbers, lane);
                }
                let contact = InSpan {
                    l,
                    at,
                    above: &above,
                    below: &below,
                };
                if inner {
                    contact.add::<V, true>(self.to);
                } else {
                    contact.add::<V, false>(self.to);
                }
            }
        }
        guide_sum.add_to_nodes::<V>(self.to);
    }
}

/// The derivatives of eight contacts in the precision of the tangent, [`super::law::GapTangent::numbers`]: two numbers after each
/// other, each with a contact per lane.
struct Numbers<S>(Aligned<[[S; NODE]; 8]>);

impl<S: Precision> Numbers<S> {
    fn new() -> Self {
        Self(Aligned([[S::ZERO; NODE]; 8]))
    }

    #[inline(always)]
    fn set<V: Vector>(&mut self, group: &Touch<Lane>, factors: TangentFactors) {
        let tangent = Touch::<Eight<V>>::load(group).tangent(factors.stiffness, factors.damping);
        for (two, to) in tangent.numbers().iter().zip(self.0.iter_mut()) {
            let mut lanes = Aligned([0.0; NODE]);
            let (halves, _) = lanes.as_chunks_mut();
            two[0].0.store(&mut halves[0]);
            two[1].0.store(&mut halves[1]);
            S::Lanes::<V>::round(&lanes).store(to);
        }
    }

    /// Number `n` of the contact in `lane`.
    #[inline(always)]
    fn get(&self, n: usize, lane: usize) -> S {
        self.0[n / 2][8 * (n % 2) + lane % 8]
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
    fn add<V: Vector>(&mut self, contact: &Factors<S>) {
        if !self.has_contacts {
            self.has_contacts = true;
            *self.columns = [[S::ZERO; NODE]; 12];
        }
        let on = contact.on::<V>();
        for c in 0..6 {
            add_product::<V, S>(&mut self.columns[c], &on, &contact.by, GUIDE + c);
            add_product::<V, S>(&mut self.columns[6 + c], &on, &contact.by, GUIDE - 8 + c);
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

/// A contact in its span, with its factors on the nodes above and below.
struct InSpan<'a, S> {
    /// Span.
    l: usize,
    /// Whether it is at its top or bottom end, and acts on that node alone.
    at: [bool; 2],
    above: &'a Factors<S>,
    below: &'a Factors<S>,
}

/// The four products on by^T of a contact, on one node.
struct Factors<S> {
    on: Aligned<[[S; NODE]; 4]>,
    by: Aligned<[[S; NODE]; 4]>,
}

impl<S: Precision> Factors<S> {
    fn new() -> Self {
        Self {
            on: Aligned([[S::ZERO; NODE]; 4]),
            by: Aligned([[S::ZERO; NODE]; 4]),
        }
    }

    /// Those of the contact in `lane`, `rows` being the forces on the node by the six local ones.
    #[inline(always)]
    fn set<V: Vector>(&mut self, rows: &[[S; NODE]; 6], numbers: &Numbers<S>, lane: usize) {
        // Called, not inlined: the products then read single numbers of `by` from memory, and the load spreads them to all lanes.
        // Inlined, the compiler takes each out of a register with two shuffles, and a processor with one port for shuffles takes
        // twice as long.
        V::call(Factorise {
            to: self,
            rows,
            numbers,
            lane,
        });
    }

    #[inline(always)]
    fn on<V: Vector>(&self) -> [S::Lanes<V>; 4] {
        let [a, b, c, d] = &*self.on;
        [
            S::Lanes::<V>::load(a),
            S::Lanes::<V>::load(b),
            S::Lanes::<V>::load(c),
            S::Lanes::<V>::load(d),
        ]
    }
}

/// [`Factors::set`].
struct Factorise<'a, S> {
    to: &'a mut Factors<S>,
    rows: &'a [[S; NODE]; 6],
    numbers: &'a Numbers<S>,
    lane: usize,
}

impl<S: Precision> Kernel for Factorise<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            to,
            rows,
            numbers,
            lane,
        } = self;
        let mut row = [S::Lanes::<V>::splat(S::ZERO); 6];
        for (row, from) in row.iter_mut().zip(rows) {
            *row = S::Lanes::<V>::load(from);
        }
        let mut number = [S::Lanes::<V>::splat(S::ZERO); 15];
        for (n, number) in number.iter_mut().enumerate() {
            *number = S::Lanes::<V>::splat(numbers.get(n, lane));
        }
        let [y, z, minus_y, minus_z, ..] = number;
        let [.., a, b, c, d, e, f, g, h, by_around, by_along, by_other] = number;
        // The local directions of the contact on the node.
        let normal = row[1].times(y).plus_product(row[2], z);
        let tangential = row[2].times(y).plus_product(row[1], minus_z);
        let around = tangential.plus(row[3]);
        let along = row[0].plus_product(row[4], z).plus_product(row[5], minus_y);
        let tilt = row[4].times(y).plus_product(row[5], z);
        for (to, from) in to.by.iter_mut().zip([normal, tangential, around, along]) {
            from.store(to);
        }
        // The force by each of them.
        let on = [
            normal.times(a).plus_product(around, b).plus_product(along, c),
            (normal.times(d).plus_product(tangential, e))
                .plus_product(tilt, h)
                .plus(around.times(f).plus_product(along, g)),
            around.times(by_around).plus_product(along, by_other),
            along.times(by_along).plus_product(around, by_other),
        ];
        for (to, from) in to.on.iter_mut().zip(on) {
            from.store(to);
        }
    }
}

impl<S: Precision> InSpan<'_, S> {
    /// Adds a contact: to the guide's unknowns, and with `INNER` to those of the pipe.
    #[inline(always)]
    fn add<V: Vector, const INNER: bool>(&self, to: &mut Additions<S>) {
        // The guide's columns come last in every list of twelve.
        let (first, touching) = if INNER {
            (0, Touching::Both)
        } else {
            (6, Touching::Guide)
        };
        let (above, below) = (self.above, self.below);
        // A station at a node moves with that node only, and is done here.
        for (end, (columns, node)) in [(&TOP, above), (&BOTTOM, below)].into_iter().enumerate() {
            if self.at[end] {
                let (block, on) = (to.block(self.l + end, touching), node.on::<V>());
                for &j in &columns[first..] {
                    add_product::<V, S>(&mut block[j], &on, &node.by, j);
                }
                return;
            }
        }
        let (on_above, on_below) = (above.on::<V>(), below.on::<V>());
        let block = to.block(self.l, touching);
        for &j in &TOP[first..] {
            add_product::<V, S>(&mut block[j], &on_above, &above.by, j);
        }
        let block = to.block(self.l + 1, touching);
        for &j in &BOTTOM[first..] {
            add_product::<V, S>(&mut block[j], &on_below, &below.by, j);
        }
        let coupling = to.coupling(self.l, touching);
        for c in first..12 {
            add_product::<V, S>(&mut coupling.upper[c], &on_above, &below.by, BOTTOM[c]);
            add_product::<V, S>(&mut coupling.lower[c], &on_below, &above.by, TOP[c]);
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
