//! What contacts and what acts at nodes add to the tangent in an iteration. A contact inside a span adds to the blocks of
//! both its ends and to their coupling.
//!
//! A contact's own tangent is the sum of four products on by^T of local forces and motions ([`GapTangent`]). On the nodes it
//! is the same sum with the forces and motions that the slaving makes of them.

use super::active::Active;
use super::operator::Crossing;
use super::precision::{Lanes, Precision};
use super::{BOTTOM, ChainModel, GUIDE, NODE, TIE, TOP};
use crate::dynamics::interactions::Interactions;
use crate::dynamics::newton::Iteration;
use crate::elements::factors::TangentFactors;
use crate::elements::gap::GapTangent;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

/// The closed gaps at a node, or in a span, which determine the unknowns that contacts couple.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Touching {
    /// No gap is closed: the block counts as zero, and its entries are undefined.
    Nothing,
    /// Guide on wall: rows and columns of the guide only.
    Guide,
    /// Pipe on guide; the guide may be on the wall too.
    Both,
}

/// What is added to a span's coupling, as [`super::operator::Coupling`].
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct AddedCoupling<S> {
    pub upper: [[S; NODE]; 12],
    pub lower: [[S; NODE]; 12],
}

/// Additions of one iteration.
#[derive(Clone)]
pub(crate) struct Additions<S> {
    /// Per node, with the columns that count: the guide's, or all.
    pub blocks: Vec<Aligned<[[S; NODE]; NODE]>>,
    pub nodes: Vec<Touching>,
    /// Per span, with the columns that count.
    pub couplings: Vec<AddedCoupling<S>>,
    pub spans: Vec<Touching>,
}

impl<S> Default for Additions<S> {
    /// Without nodes: what stands for those of a chain while they are taken out of it.
    fn default() -> Self {
        Self {
            blocks: Vec::new(),
            nodes: Vec::new(),
            couplings: Vec::new(),
            spans: Vec::new(),
        }
    }
}

impl<S: Precision> Additions<S> {
    pub(super) fn new(nodes: usize) -> Self {
        let coupling = AddedCoupling {
            upper: [[S::ZERO; NODE]; 12],
            lower: [[S::ZERO; NODE]; 12],
        };
        Self {
            blocks: vec![Aligned([[S::ZERO; NODE]; NODE]); nodes],
            nodes: vec![Touching::Nothing; nodes],
            couplings: vec![coupling; nodes - 1],
            spans: vec![Touching::Nothing; nodes - 1],
        }
    }

    /// A node's block, whose columns of what is `touching` are made zero before their first use in an iteration.
    #[inline(always)]
    pub(crate) fn block(&mut self, node: usize, touching: Touching) -> &mut [[S; NODE]; NODE] {
        let (block, before) = (&mut self.blocks[node], self.nodes[node]);
        if touching > before {
            if before == Touching::Nothing {
                block[GUIDE..TIE].fill([S::ZERO; NODE]);
            }
            if touching == Touching::Both {
                block[..GUIDE].fill([S::ZERO; NODE]);
                block[TIE] = [S::ZERO; NODE];
            }
            self.nodes[node] = touching;
        }
        block
    }

    /// A span's coupling, in the same way.
    #[inline(always)]
    pub(crate) fn coupling(&mut self, span: usize, touching: Touching) -> &mut AddedCoupling<S> {
        let (coupling, before) = (&mut self.couplings[span], self.spans[span]);
        if touching > before {
            for columns in [&mut coupling.upper, &mut coupling.lower] {
                if before == Touching::Nothing {
                    columns[6..].fill([S::ZERO; NODE]);
                }
                if touching == Touching::Both {
                    columns[..6].fill([S::ZERO; NODE]);
                }
            }
            self.spans[span] = touching;
        }
        coupling
    }

    /// Begins with what couples pipe and guide everywhere.
    fn begin_with(&mut self, crossing: &Crossing<S>, chain: &ChainModel, active: &Active) {
        for (node, _) in active.nodes.iter().enumerate().filter(|(_, active)| **active) {
            self.blocks[node].clone_from(&crossing.blocks[node]);
            self.nodes[node] = Touching::Both;
        }
        for (span, _) in active.spans.iter().enumerate().filter(|(_, active)| **active) {
            self.couplings[span].clone_from(&crossing.couplings[chain.links[span].kind]);
            self.spans[span] = Touching::Both;
        }
    }

    /// Fills the additions, joints left out, from what was linearised by the last residual at `state`, where it is
    /// `active`, and from what is coupled everywhere by the step-constant `crossing`.
    pub(super) fn linearise(
        &mut self,
        chain: &ChainModel,
        active: &Active,
        interactions: &Interactions,
        model: &Model,
        at: &Iteration<'_>,
        crossing: Option<&Crossing<S>>,
    ) {
        let factors = at.factors;
        self.nodes.fill(Touching::Nothing);
        self.spans.fill(Touching::Nothing);
        if let Some(crossing) = crossing {
            self.begin_with(crossing, chain, active);
        }
        chain.instructions.run(ContactTangents {
            to: self,
            chain,
            active,
            interactions,
            factors,
        });
        chain
            .numbered(model)
            .hanger_tangent(factors, |row, column, value| self.add_within_node(row, column, value));
    }
}

impl<S: Precision> Additions<S> {
    /// Adds the derivative of the force on the unknown `row` by the motion of `column`, both of one node.
    pub(super) fn add_within_node(&mut self, row: usize, column: usize, value: f64) {
        self.block(column / NODE, Touching::Both)[column % NODE][row % NODE] += S::of(value);
    }

    /// Adds the derivative of forces at a node by the motion there, by columns.
    pub(crate) fn add_at_node(&mut self, places: &[usize; 6], tangent: &[[f64; 6]; 6]) {
        let block = self.block(places[0] / NODE, Touching::Both);
        for (&j, from) in places.iter().zip(tangent) {
            for (&i, x) in places.iter().zip(from) {
                block[j % NODE][i % NODE] += S::of(*x);
            }
        }
    }

    /// Adds the derivative of two `components` of a local force at station `i` of span `l`, one below its top end, by the same
    /// components of the motion there, by columns: between pipe and guide or, not `inner`, of the guide alone.
    #[inline(always)]
    pub(crate) fn add_local<V: Vector>(
        &mut self,
        chain: &ChainModel,
        (l, i): (usize, usize),
        inner: bool,
        components: [usize; 2],
        tangent: &[[f64; 2]; 2],
    ) {
        let on_nodes = &S::on_nodes(&chain.kind(l).on_nodes)[i];
        let at = InSpan {
            l,
            at: [false, i == chain.nodes.elements(l)],
            rows: if inner { &on_nodes.inner } else { &on_nodes.outer },
        };
        at.add_local::<V>(self, components, tangent);
    }
}

struct ContactTangents<'a, S> {
    to: &'a mut Additions<S>,
    chain: &'a ChainModel,
    active: &'a Active,
    interactions: &'a Interactions,
    factors: TangentFactors,
}

impl<S: Precision> Kernel for ContactTangents<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let mut guide_sum = GuideSum::<S>::new();
        let layers = [(&self.interactions.inner, true), (&self.interactions.outer, false)];
        // Contacts of pipe and guide fill the whole node; those of the wall
        // only the guide's part, which is summed per span.
        for (layer, inner) in layers {
            let (nodes, spans) = (&self.chain.nodes, &self.active.spans);
            let stations = &nodes.stations;
            for (station, touch) in layer.among(|station| spans[stations[station].0]) {
                let (l, i) = stations[station];
                let on_nodes = &S::on_nodes(&self.chain.kinds[self.chain.links[l].kind].on_nodes)[i];
                let contact = InSpan {
                    l,
                    at: [i == 0, i == nodes.elements(l)],
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

impl<S: Precision> InSpan<'_, S> {
    /// Adds the derivative of two components of a force by those of the motion there, by columns, which both pipes may take part
    /// in.
    #[inline(always)]
    fn add_local<V: Vector>(&self, to: &mut Additions<S>, components: [usize; 2], tangent: &[[f64; 2]; 2]) {
        let [above, below] = self.rows.each_ref().map(|rows| components.map(|k| &rows[k]));
        let (on_above, on_below) = (local::<V, S>(above, tangent), local::<V, S>(below, tangent));
        if self.at[1] {
            let block = to.block(self.l + 1, Touching::Both);
            for &j in &BOTTOM {
                add_local::<V, S>(&mut block[j], &on_below, below, j);
            }
            return;
        }
        let block = to.block(self.l, Touching::Both);
        for &j in &TOP {
            add_local::<V, S>(&mut block[j], &on_above, above, j);
        }
        let block = to.block(self.l + 1, Touching::Both);
        for &j in &BOTTOM {
            add_local::<V, S>(&mut block[j], &on_below, below, j);
        }
        let coupling = to.coupling(self.l, Touching::Both);
        for c in 0..12 {
            add_local::<V, S>(&mut coupling.upper[c], &on_above, below, BOTTOM[c]);
            add_local::<V, S>(&mut coupling.lower[c], &on_below, above, TOP[c]);
        }
    }
}

/// The forces on a node by two components of the motion of a station, `rows` being those by such forces there.
#[inline(always)]
fn local<V: Vector, S: Precision>(rows: [&[S; NODE]; 2], tangent: &[[f64; 2]; 2]) -> [S::Lanes<V>; 2] {
    let (y, z) = (S::Lanes::<V>::load(rows[0]), S::Lanes::<V>::load(rows[1]));
    let [[yy, zy], [yz, zz]] = *tangent;
    [
        y.times(S::Lanes::<V>::splat(S::of(yy)))
            .plus_product(z, S::Lanes::<V>::splat(S::of(zy))),
        y.times(S::Lanes::<V>::splat(S::of(yz)))
            .plus_product(z, S::Lanes::<V>::splat(S::of(zz))),
    ]
}

/// column += on by^T of such forces, for column `j` of the product.
#[inline(always)]
fn add_local<V: Vector, S: Precision>(column: &mut [S; NODE], on: &[S::Lanes<V>; 2], by: [&[S; NODE]; 2], j: usize) {
    S::Lanes::<V>::load(column)
        .plus_product(on[0], S::Lanes::<V>::splat(by[0][j]))
        .plus_product(on[1], S::Lanes::<V>::splat(by[1][j]))
        .store(column);
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
