//! What contacts, the bit and point masses add to the reduced tangent in an iteration. A contact inside a span adds to
//! the blocks of both its ends and to what couples them.

use super::precision::{Lanes, OnNodes, Precision};
use super::slaving::{Link, LinkMatrices};
use super::{BOTTOM, NODE, Reduced, TOP, span_of};
use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::state::{State, motion};
use crate::elements::gap::{GapVector, TangentTerms, Touch};
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
            model,
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
    model: &'a Model,
    factors: TangentFactors,
}

impl<S: Precision> Kernel for Contacts<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let (kinds, links): (&[LinkMatrices], &[Link]) = (&self.reduced.kinds, &self.reduced.links);
        let per = self.reduced.per;
        let [inner_radius, outer_radius] = self.model.guide_radii;
        for &station in &self.reduced.hits {
            let (l, i) = span_of(station, per);
            let rows = &S::on_nodes(&kinds[links[l].kind])[i];
            if let Some(touch) = &self.assembler.inner[station] {
                let place = Place {
                    l,
                    i,
                    per,
                    rows,
                    radius: -inner_radius,
                    sign: -1.0,
                };
                place.add::<V, true>(self.to, touch, self.factors);
            }
            if let Some(touch) = &self.assembler.outer[station] {
                let place = Place {
                    l,
                    i,
                    per,
                    rows,
                    radius: outer_radius,
                    sign: 1.0,
                };
                place.add::<V, false>(self.to, touch, self.factors);
            }
        }
    }
}

/// Where a contact is: station `i` of span `l`.
struct Place<'a, S> {
    l: usize,
    i: usize,
    /// Stations per span.
    per: usize,
    rows: &'a OnNodes<S>,
    /// Guide's radius with the sign of the force on it.
    radius: f64,
    sign: f64,
}

/// The sum of six columns.
#[inline(always)]
fn combined<V: Vector, S: Precision>(columns: &[[S; NODE]; 6], x: &[f64; 6]) -> S::Lanes<V> {
    let mut even = S::Lanes::<V>::load(&columns[0]).times(S::Lanes::<V>::splat(S::of(x[0])));
    let mut odd = S::Lanes::<V>::load(&columns[1]).times(S::Lanes::<V>::splat(S::of(x[1])));
    for k in 1..3 {
        even = even.plus_product(
            S::Lanes::<V>::load(&columns[2 * k]),
            S::Lanes::<V>::splat(S::of(x[2 * k])),
        );
        odd = odd.plus_product(
            S::Lanes::<V>::load(&columns[2 * k + 1]),
            S::Lanes::<V>::splat(S::of(x[2 * k + 1])),
        );
    }
    even.plus(odd)
}

/// The products of a contact on one node: their first factors and, to be read number by number, their second ones.
struct Factors<L, S> {
    on: [L; 4],
    by: Aligned<[[S; NODE]; 4]>,
}

impl<S: Precision> Place<'_, S> {
    /// What a local force `x` puts on the node above (0) or below (1): on the guide's unknowns, and with `INNER` on those
    /// of the pipe.
    #[inline(always)]
    fn on_node<V: Vector, const INNER: bool>(&self, end: usize, x: &GapVector) -> S::Lanes<V> {
        let (sign, radius) = (self.sign, self.radius);
        let on_guide = [
            sign * x[0],
            sign * x[1],
            sign * x[2],
            radius * x[3],
            radius * x[4],
            radius * x[5],
        ];
        let guide = combined::<V, S>(&self.rows.guide[end], &on_guide);
        if INNER {
            guide.plus(combined::<V, S>(
                &self.rows.pipe[end],
                &[x[0], x[1], x[2], x[3], x[4], x[5]],
            ))
        } else {
            guide
        }
    }

    #[inline(always)]
    fn factors<V: Vector, const INNER: bool>(&self, end: usize, terms: &TangentTerms) -> Factors<S::Lanes<V>, S> {
        let mut by = Aligned([[S::ZERO; NODE]; 4]);
        for (by, term) in by.iter_mut().zip(terms) {
            self.on_node::<V, INNER>(end, &term.by).store(by);
        }
        let on = [
            self.on_node::<V, INNER>(end, &terms[0].on),
            self.on_node::<V, INNER>(end, &terms[1].on),
            self.on_node::<V, INNER>(end, &terms[2].on),
            self.on_node::<V, INNER>(end, &terms[3].on),
        ];
        Factors { on, by }
    }

    /// Adds a contact: to the guide's unknowns, and with `INNER` to those of the pipe.
    #[inline(always)]
    fn add<V: Vector, const INNER: bool>(&self, to: &mut Additions<S>, touch: &Touch, factors: TangentFactors) {
        let terms = touch.tangent(factors.stiffness, factors.damping);
        // The guide's columns come last in every list of twelve.
        let first = if INNER { 0 } else { 6 };
        // A station at a node moves with that node only.
        if self.i == 0 || self.i == self.per {
            let (end, columns) = if self.i == 0 { (0, &TOP) } else { (1, &BOTTOM) };
            let node = self.factors::<V, INNER>(end, &terms);
            let block = to.block(self.l + end);
            for &j in &columns[first..] {
                add_product::<V, S>(&mut block[j], &node.on, &node.by, j);
            }
            return;
        }
        let above = self.factors::<V, INNER>(0, &terms);
        let below = self.factors::<V, INNER>(1, &terms);
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
    let even = S::Lanes::<V>::load(column)
        .plus_product(on[0], S::Lanes::<V>::splat(by[0][j]))
        .plus_product(on[1], S::Lanes::<V>::splat(by[1][j]));
    let odd = on[2]
        .times(S::Lanes::<V>::splat(by[2][j]))
        .plus_product(on[3], S::Lanes::<V>::splat(by[3][j]));
    even.plus(odd).store(column);
}
