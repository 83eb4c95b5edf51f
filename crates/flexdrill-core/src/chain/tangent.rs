//! What effects add to the tangent in an iteration. One that acts inside a span adds to the blocks of both its ends and to
//! their coupling: a local derivative there is one on the nodes, with the forces and motions that the slaving makes of them.

use super::precision::{Lanes, Precision};
use super::{BOTTOM, ChainModel, GUIDE, NODE, TIE, TOP};
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

/// The unknowns that additions couple at a node, or in a span.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Touching {
    /// None: the block counts as zero, and its entries are undefined.
    Nothing,
    /// Rows and columns of the guide only.
    Guide,
    /// Those of pipe and guide.
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

    /// Begins the additions of an iteration.
    pub(super) fn begin(&mut self) {
        self.nodes.fill(Touching::Nothing);
        self.spans.fill(Touching::Nothing);
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

/// A local force in its span.
struct InSpan<'a, S> {
    /// Span.
    l: usize,
    /// Whether it is at its top or bottom end.
    at: [bool; 2],
    /// The forces on the nodes above and below by it.
    rows: &'a [[[S; NODE]; 6]; 2],
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
