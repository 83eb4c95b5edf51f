//! What contacts, the bit and point masses add to the reduced tangent in an iteration. A contact inside a span adds to
//! the blocks of both its ends and to what couples them.

use super::precision::{Lanes, Precision};
use super::{BOTTOM, NODE, Reduced, TOP, span_of};
use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::state::{State, motion};
use crate::elements::gap::GapTangent;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

/// What contacts inside a span add to its coupling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Crossing {
    /// Nothing.
    Nothing,
    /// The guide with itself.
    Guide,
    /// Pipe and guide with each other.
    Both,
}

/// What is added to a span's coupling, as [`super::operator::Coupling`].
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct AddedCoupling<S> {
    pub upper: [[S; NODE]; 12],
    pub lower: [[S; NODE]; 12],
}

/// Additions of one iteration.
#[derive(Default)]
pub(super) struct Additions<S> {
    /// Per node, of use where `touched`.
    pub blocks: Vec<Aligned<[[S; NODE]; NODE]>>,
    pub touched: Vec<bool>,
    /// Per span, of use where something crosses.
    pub couplings: Vec<AddedCoupling<S>>,
    pub crossing: Vec<Crossing>,
}

impl<S: Precision> Additions<S> {
    pub(super) fn new(nodes: usize) -> Self {
        let coupling = AddedCoupling {
            upper: [[S::ZERO; NODE]; 12],
            lower: [[S::ZERO; NODE]; 12],
        };
        Self {
            blocks: vec![Aligned([[S::ZERO; NODE]; NODE]); nodes],
            touched: vec![false; nodes],
            couplings: vec![coupling; nodes - 1],
            crossing: vec![Crossing::Nothing; nodes - 1],
        }
    }

    /// A node's block, to be added to.
    #[inline(always)]
    fn block(&mut self, node: usize) -> &mut [[S; NODE]; NODE] {
        let block = &mut self.blocks[node];
        if !self.touched[node] {
            self.touched[node] = true;
            **block = [[S::ZERO; NODE]; NODE];
        }
        block
    }

    /// A span's coupling, to be added to.
    #[inline(always)]
    fn coupling(&mut self, span: usize, crossing: Crossing) -> &mut AddedCoupling<S> {
        let coupling = &mut self.couplings[span];
        if self.crossing[span] == Crossing::Nothing {
            (coupling.upper, coupling.lower) = ([[S::ZERO; NODE]; 12], [[S::ZERO; NODE]; 12]);
        }
        self.crossing[span] = self.crossing[span].max(crossing);
        coupling
    }

    /// Fills the additions, joints left out, from what was linearised by the last residual of `reduced` at `state`.
    pub(super) fn linearise(
        &mut self,
        reduced: &Reduced,
        assembler: &Assembler,
        model: &Model,
        state: &State,
        (conditions, factors): (&Conditions, TangentFactors),
    ) {
        self.touched.fill(false);
        self.crossing.fill(Crossing::Nothing);
        reduced.instructions.run(Contacts {
            to: self,
            reduced,
            assembler,
            factors,
        });
        let spin = reduced.places.bit_spin;
        self.block(spin / NODE)[spin % NODE][spin % NODE] += S::of(factors.damping * assembler.bit.slope);
        for (point, places) in model.masses.iter().zip(&reduced.places.masses) {
            if !point.body.is_coupled() {
                continue;
            }
            let tangent = point.body.coupled_tangent(
                motion(state, places).as_node(),
                conditions.rayleigh.alpha,
                point.gravity.into(),
                [factors.stiffness, factors.damping, factors.mass],
            );
            let block = self.block(places[0] / NODE);
            for (&j, from) in places.iter().zip(&tangent) {
                for (&i, x) in places.iter().zip(from) {
                    block[j % NODE][i % NODE] += S::of(*x);
                }
            }
        }
    }
}

struct Contacts<'a, S> {
    to: &'a mut Additions<S>,
    reduced: &'a Reduced,
    assembler: &'a Assembler,
    factors: TangentFactors,
}

impl<S: Precision> Kernel for Contacts<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let layers = [(&self.assembler.inner, true), (&self.assembler.outer, false)];
        for (layer, inner) in layers {
            for (station, touch) in layer.iter() {
                let (l, i) = span_of(station, self.reduced.per);
                let rows = &S::on_nodes(&self.reduced.kinds[self.reduced.links[l].kind])[i];
                let place = Place {
                    l,
                    at: [i == 0, i == self.reduced.per],
                    rows: if inner { &rows.inner } else { &rows.outer },
                };
                let tangent = touch.tangent(self.factors.stiffness, self.factors.damping);
                if inner {
                    place.add::<V, true>(self.to, &tangent);
                } else {
                    place.add::<V, false>(self.to, &tangent);
                }
            }
        }
    }
}

/// Where a contact is.
struct Place<'a, S> {
    /// Span.
    l: usize,
    /// Whether it is at its top or bottom end.
    at: [bool; 2],
    /// What a local force puts on the nodes above and below.
    rows: &'a [[[S; NODE]; 6]; 2],
}

/// The products of a contact on one node: their first factors and, to be read number by number, their second ones.
struct Factors<L, S> {
    on: [L; 4],
    by: Aligned<[[S; NODE]; 4]>,
}

impl<S: Precision> Place<'_, S> {
    /// [`GapTangent`] on a node.
    #[inline(always)]
    fn factors<V: Vector>(&self, end: usize, tangent: &GapTangent) -> Factors<S::Lanes<V>, S> {
        let of = |x: f64| S::Lanes::<V>::splat(S::of(x));
        let mut row = [S::Lanes::<V>::splat(S::ZERO); 6];
        for (row, from) in row.iter_mut().zip(&self.rows[end]) {
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
                around.times(of(tangent.by_around)),
                along.times(of(tangent.by_along)),
            ],
            by: out,
        }
    }

    /// Adds a contact: to the guide's unknowns, and with `INNER` to those of the pipe.
    #[inline(always)]
    fn add<V: Vector, const INNER: bool>(&self, to: &mut Additions<S>, tangent: &GapTangent) {
        // The guide's columns come last in every list of twelve.
        let first = if INNER { 0 } else { 6 };
        // A station at a node moves with that node only.
        for (end, columns) in [&TOP, &BOTTOM].into_iter().enumerate() {
            if self.at[end] {
                let node = self.factors::<V>(end, tangent);
                let block = to.block(self.l + end);
                for &j in &columns[first..] {
                    add_product::<V, S>(&mut block[j], &node.on, &node.by, j);
                }
                return;
            }
        }
        let above = self.factors::<V>(0, tangent);
        let below = self.factors::<V>(1, tangent);
        let block = to.block(self.l);
        for &j in &TOP[first..] {
            add_product::<V, S>(&mut block[j], &above.on, &above.by, j);
        }
        let block = to.block(self.l + 1);
        for &j in &BOTTOM[first..] {
            add_product::<V, S>(&mut block[j], &below.on, &below.by, j);
        }
        let coupling = to.coupling(self.l, if INNER { Crossing::Both } else { Crossing::Guide });
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
