//! What contacts, the bit and point masses add to the reduced tangent in an iteration. A contact inside a span adds to
//! the blocks of both its ends and to what couples them.

use super::contacts::at_radius;
use super::operator::{Block, Coupling};
use super::residual::{load, plus_column, store};
use super::{BOTTOM, EndColumn, GUIDE, NODE, Reduced, TOP, U};
use crate::dynamics::assembly::Assembler;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::state::{State, motion};
use crate::elements::gap::{GapVector, Touch};
use crate::model::Model;
use crate::simd::Kernel;
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

/// Additions of one iteration.
pub(super) struct Additions {
    /// Per node, of use where `touched`.
    pub blocks: Vec<Block>,
    pub touched: Vec<bool>,
    /// Per span, of use where something crosses.
    pub couplings: Vec<Coupling>,
    pub crossing: Vec<Crossing>,
}

impl Additions {
    pub(super) fn new(nodes: usize) -> Self {
        let coupling = Coupling {
            upper: [[0.0; NODE]; 12],
            lower: [[0.0; NODE]; 12],
        };
        Self {
            blocks: vec![[[0.0; NODE]; NODE]; nodes],
            touched: vec![false; nodes],
            couplings: vec![coupling; nodes - 1],
            crossing: vec![Crossing::Nothing; nodes - 1],
        }
    }

    /// A node's block, to be added to.
    fn block(&mut self, node: usize) -> &mut Block {
        if !self.touched[node] {
            self.touched[node] = true;
            self.blocks[node] = [[0.0; NODE]; NODE];
        }
        &mut self.blocks[node]
    }
}

impl Reduced {
    /// Fills the additions from what was linearised by the last residual at `state`.
    pub(super) fn linearise(
        &mut self,
        assembler: &mut Assembler,
        model: &Model,
        state: &State,
        conditions: &Conditions,
        factors: TangentFactors,
    ) {
        self.additions.touched.fill(false);
        self.additions.crossing.fill(Crossing::Nothing);
        let instructions = self.instructions;
        instructions.run(Contacts {
            by: self,
            assembler,
            model,
            factors,
        });
        assembler.joint_tangent(&self.places.joints, model, state, factors);
        let spin = self.places.bit_spin;
        self.additions.block(spin / NODE)[spin % NODE][spin % NODE] += factors.damping * assembler.bit.slope;
        for (point, places) in model.masses.iter().zip(&self.places.masses) {
            if !point.body.is_coupled() {
                continue;
            }
            let tangent = point.body.coupled_tangent(
                motion(state, places).as_node(),
                conditions.rayleigh.alpha,
                point.gravity.into(),
                [factors.stiffness, factors.damping, factors.mass],
            );
            let block = self.additions.block(places[0] / NODE);
            for (&j, from) in places.iter().zip(&tangent) {
                for (&i, x) in places.iter().zip(from) {
                    block[j % NODE][i % NODE] += x;
                }
            }
        }
    }
}

struct Contacts<'a> {
    by: &'a mut Reduced,
    assembler: &'a Assembler,
    model: &'a Model,
    factors: TangentFactors,
}

/// A product's two factors on the nodes of a span's ends.
#[derive(Clone, Copy)]
struct OnNodes {
    top: [f64; NODE],
    bottom: [f64; NODE],
}

impl Contacts<'_> {
    /// What a local force `x` at station `i` of span `l` puts on the nodes.
    #[inline(always)]
    fn on_nodes<V: Vector>(&self, (l, i): (usize, usize), x: &GapVector, inner: bool) -> OnNodes {
        let rows = &self.by.kinds[self.by.links[l].kind].force[i];
        let mut out = OnNodes {
            top: [0.0; NODE],
            bottom: [0.0; NODE],
        };
        let radius = self.model.guide_radii[usize::from(!inner)];
        let mut on_guide = at_radius(x, radius);
        if inner {
            on_guide.iter_mut().for_each(|x| *x = -*x);
        }
        let pipe = [x[0], x[1], x[2], x[3], x[4], x[5]];
        if i == self.by.per {
            // A station at a node moves with that node only.
            if inner {
                let bottom = on_bottom::<V>(&rows[0], &pipe);
                out.bottom[..6].copy_from_slice(&bottom[..6]);
            }
            out.bottom[GUIDE..GUIDE + 6].copy_from_slice(&on_guide);
            return out;
        }
        if inner {
            let pipe = on_ends::<V>(&rows[0], &pipe);
            out.top[U..U + 6].copy_from_slice(&pipe[..6]);
            out.bottom[..6].copy_from_slice(&pipe[8..14]);
        }
        let guide = on_ends::<V>(&rows[1], &on_guide);
        out.top[GUIDE..GUIDE + 6].copy_from_slice(&guide[..6]);
        out.bottom[GUIDE..GUIDE + 6].copy_from_slice(&guide[8..14]);
        out
    }

    #[inline(always)]
    fn add_touch<V: Vector>(&mut self, (l, i): (usize, usize), touch: &Touch, inner: bool) {
        let terms = touch.tangent(self.factors.stiffness, self.factors.damping);
        let (mut on_top, mut on_bottom) = ([[V::splat(0.0); 2]; 4], [[V::splat(0.0); 2]; 4]);
        let (mut by_top, mut by_bottom) = ([[0.0; NODE]; 4], [[0.0; NODE]; 4]);
        for (n, term) in terms.iter().enumerate() {
            let on = self.on_nodes::<V>((l, i), &term.on, inner);
            let by = self.on_nodes::<V>((l, i), &term.by, inner);
            (on_top[n], on_bottom[n]) = (load(&on.top), load(&on.bottom));
            (by_top[n], by_bottom[n]) = (by.top, by.bottom);
        }
        // The guide's columns come last in every list of twelve, its rows in the second half.
        let (first, half) = if inner { (0, 0) } else { (6, 1) };
        let per = self.by.per;
        let additions = &mut self.by.additions;
        if i < per {
            let block = additions.block(l);
            for &j in &TOP[first..] {
                add_to::<V>(&mut block[j], &on_top, &by_top, (j, half));
            }
        }
        if i > 0 {
            let block = additions.block(l + 1);
            for &j in &BOTTOM[first..] {
                add_to::<V>(&mut block[j], &on_bottom, &by_bottom, (j, half));
            }
        }
        if i > 0 && i < per {
            let crossing = &mut additions.crossing[l];
            let coupling = &mut additions.couplings[l];
            if *crossing == Crossing::Nothing {
                (coupling.upper, coupling.lower) = ([[0.0; NODE]; 12], [[0.0; NODE]; 12]);
            }
            *crossing = (*crossing).max(if inner { Crossing::Both } else { Crossing::Guide });
            for c in first..12 {
                add_to::<V>(&mut coupling.upper[c], &on_top, &by_bottom, (BOTTOM[c], half));
                add_to::<V>(&mut coupling.lower[c], &on_bottom, &by_top, (TOP[c], half));
            }
        }
    }
}

/// What a local force `x` puts on both ends of a span.
#[inline(always)]
pub(super) fn on_ends<V: Vector>(rows: &[EndColumn; 6], x: &[f64; 6]) -> EndColumn {
    let (mut even, mut odd) = ([V::splat(0.0); 2], [V::splat(0.0); 2]);
    for k in 0..3 {
        even = plus_column(even, &rows[2 * k], V::splat(x[2 * k]));
        odd = plus_column(odd, &rows[2 * k + 1], V::splat(x[2 * k + 1]));
    }
    let mut out = [0.0; 16];
    store([even[0].plus(odd[0]), even[1].plus(odd[1])], &mut out);
    out
}

/// The same on the bottom end only.
#[inline(always)]
fn on_bottom<V: Vector>(rows: &[EndColumn; 6], x: &[f64; 6]) -> [f64; 8] {
    let (mut even, mut odd) = (V::splat(0.0), V::splat(0.0));
    for k in 0..3 {
        even = even.plus_product(load::<V>(&rows[2 * k])[1], V::splat(x[2 * k]));
        odd = odd.plus_product(load::<V>(&rows[2 * k + 1])[1], V::splat(x[2 * k + 1]));
    }
    let mut out = [0.0; 8];
    even.plus(odd).store(&mut out);
    out
}

/// column += on by^T, for column `j` of the product and the halves from `first` on.
#[inline(always)]
fn add_to<V: Vector>(column: &mut [f64; NODE], on: &[[V; 2]; 4], by: &[[f64; NODE]; 4], (j, first): (usize, usize)) {
    let x = [
        V::splat(by[0][j]),
        V::splat(by[1][j]),
        V::splat(by[2][j]),
        V::splat(by[3][j]),
    ];
    let mut sum = load::<V>(column);
    for (half, sum) in sum.iter_mut().enumerate().skip(first) {
        let even = sum.plus_product(on[0][half], x[0]).plus_product(on[1][half], x[1]);
        let odd = on[2][half].times(x[2]).plus_product(on[3][half], x[3]);
        *sum = even.plus(odd);
    }
    store(sum, column);
}

impl Kernel for Contacts<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self) {
        for hit in 0..self.by.hits.len() {
            let station = self.by.hits[hit];
            let place = self.by.span_of(station);
            let assembler = self.assembler;
            if let Some(touch) = &assembler.inner[station] {
                self.add_touch::<V>(place, touch, true);
            }
            if let Some(touch) = &assembler.outer[station] {
                self.add_touch::<V>(place, touch, false);
            }
        }
    }
}
