//! The elimination in single precision: a block is sixteen vectors, kept in the first-level cache.
//!
//! Newton's residual is evaluated in double precision, so that a correction need only be good to a few digits. Where a
//! multiplier of a later row is larger than a thousand, or a solution is not a number, it is refused and the correction is
//! solved for in double.
//!
//! Block by block from the top down, with D_k the block of node k, U_k and L_k its coupling to the node below, r_k the
//! right-hand side:
//!
//! 1. [`SingleElimination::assemble`] sums up D_k: step-constant part, contacts, joint, dependent rotations;
//! 2. [`subtract_carry`] takes off what the nodes above leave, L_(k-1) D_(k-1)^-1 (U_(k-1), r_(k-1));
//! 3. [`eliminate`] turns (U_k, r_k) into D_k^-1 (U_k, r_k), which is kept;
//! 4. [`SingleElimination::carry`] makes what the next node subtracts;
//!
//! and back up x_k = D_k^-1 r_k - D_k^-1 U_k x_(k+1), by [`minus_coupling`].

mod block;

use super::active::Window;
use super::columns::ONLY;
use super::dependents::{Dependents, FIRST_ROW, MOMENTS, SECOND_ROW};
use super::nodes::{Node, pass};
use super::operator::Operator;
use super::precision::Rounded;
use super::tangent::{Additions, Touching};
use super::{GUIDE, Link, NODE, TIE};
use crate::dynamics::joints::JointTangent;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::single::Single;
use crate::simd::vector::Vector;

use block::{Inverse, eliminate, eliminate_early, eliminate_last};

/// Columns per node: twelve of the coupling and the right-hand side.
const COLUMNS: usize = 13;
/// Largest part of the limit on a residual that a window may leave unbalanced above it.
const LEFT_OUT: f32 = 0.5;
/// Largest square of a multiplier.
const LARGEST_SQUARE: f32 = 1e6;

/// A column of a block.
type Column = [f32; NODE];

/// Room for an elimination.
#[derive(Clone)]
pub(super) struct SingleSweep {
    /// D^-1 (U, r) of each node.
    columns: Vec<Aligned<[Column; COLUMNS]>>,
    /// What the joint of each node adds: columns of the rotations above, of those below.
    joints: Vec<Aligned<[Column; 6]>>,
    /// Blocks of the present node and the next one.
    blocks: [Aligned<[Column; NODE]>; 2],
}

impl SingleSweep {
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            columns: vec![Aligned([[0.0; NODE]; COLUMNS]); nodes],
            joints: vec![Aligned([[0.0; NODE]; 6]); nodes],
            blocks: [Aligned([[0.0; NODE]; NODE]); 2],
        }
    }

    /// Sets what the joint of a node adds.
    #[inline(always)]
    pub(super) fn join(&mut self, node: usize, tangent: &JointTangent<'_>) {
        let to = &mut self.joints[node];
        for k in 0..3 {
            for i in 0..3 {
                to[k][i] = tangent.rotation(k, i) as f32;
                to[k][6 + i] = tangent.rotation(k, 3 + i) as f32;
                to[3 + k][i] = tangent.rotation(3 + k, i) as f32;
                to[3 + k][6 + i] = tangent.rotation(3 + k, 3 + i) as f32;
            }
        }
    }
}

/// One solution; `false` if a pivot is too small.
pub(super) struct SingleElimination<'a> {
    pub sweep: &'a mut SingleSweep,
    pub operator: &'a Operator,
    pub additions: &'a Additions<f32>,
    pub nodes: &'a [Node],
    pub dependents: &'a [Dependents],
    /// Rows per joint that are constraints.
    pub joint_rows: usize,
    pub links: &'a [Link],
    pub rows: &'a [Option<[f64; NODE]>],
    /// The runs of nodes that are solved for; each receives how far up it moves the tool. All other nodes stay.
    pub windows: &'a mut [Window],
    /// One over the limits of the residual.
    pub weights: &'a [f64],
    /// The right-hand side, which becomes the solution.
    pub values: &'a mut [f64],
}

/// L times the columns where no contact couples pipe and guide: their rows are apart, so that one product does for both.
#[inline(always)]
fn carry_joined<S: Single>(b: &[Column; COLUMNS], lower: &[S; 6], carry: &mut [Column; COLUMNS]) {
    for (column, carry) in b.iter().zip(carry) {
        let x = S::load(column);
        let even = lower[0]
            .times(x.spread_two::<3, 9>())
            .plus_product(lower[2], x.spread_two::<5, 11>())
            .plus_product(lower[4], x.spread_two::<7, 13>());
        let odd = lower[1]
            .times(x.spread_two::<4, 10>())
            .plus_product(lower[3], x.spread_two::<6, 12>())
            .plus_product(lower[5], x.spread_two::<8, 14>());
        even.plus(odd).store(carry);
    }
}

/// L times the columns, pipe and guide coupled.
#[inline(always)]
fn carry_crossed<S: Single>(b: &[Column; COLUMNS], lower: &[S; 12], carry: &mut [Column; COLUMNS]) {
    for (column, carry) in b.iter().zip(carry) {
        let (mut even, mut odd) = (S::splat(0.0), S::splat(0.0));
        for c in 0..6 {
            even = even.plus_product(lower[2 * c], S::splat(column[3 + 2 * c]));
            odd = odd.plus_product(lower[2 * c + 1], S::splat(column[4 + 2 * c]));
        }
        even.plus(odd).store(carry);
    }
}

impl Kernel for SingleElimination<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<V: Vector>(self) -> bool {
        run::<V::Single>(self)
    }
}

impl SingleElimination<'_> {
    /// Whether the coupling of span `k` has entries in rows of the pipe by columns of the guide and the other way round.
    #[inline(always)]
    fn crosses(&self, k: usize) -> bool {
        self.operator.crossed || self.additions.spans[k] == Touching::Both
    }

    /// Assembles the block of node `k` into `a` and its coupling and right-hand side into the node's columns, without the
    /// carry from above, and eliminates the early pair of all but the last node. Gives the inverse of that pair and the
    /// squares of its multipliers.
    #[inline(always)]
    fn assemble<S: Single>(&mut self, k: usize, last: bool, a: &mut [Column; NODE]) -> (Inverse<S>, S) {
        // The step-constant block is shared by all nodes alike, and must be copied before anything is added.
        let single = &self.operator.single;
        let zero = S::splat(0.0);
        let mut inverse = Inverse::start();
        // The block: step-constant part, and what contacts, bit and masses add where they touch.
        let constant = &single.blocks[self.operator.block_of[k]];
        let touching = self.additions.nodes[k];
        let added = &self.additions.blocks[k];
        if touching == Touching::Both {
            for ((to, from), added) in a.iter_mut().zip(constant.iter()).zip(added.iter()) {
                S::load(from).plus(S::load(added)).store(to);
            }
        } else {
            for (to, from) in a.iter_mut().zip(constant.iter()) {
                S::load(from).store(to);
            }
            if touching == Touching::Guide {
                for (to, added) in a[GUIDE..TIE].iter_mut().zip(&added[GUIDE..]) {
                    S::load(to).plus(S::load(added)).store(to);
                }
            }
        }
        // The stop of the joint, and the curvature of its rows.
        let joint = self.nodes[k].joint;
        if joint.is_some() {
            let joint = &self.sweep.joints[k];
            for i in 0..3 {
                S::load(&a[i]).plus(S::load(&joint[i])).store(&mut a[i]);
                S::load(&a[6 + i]).plus(S::load(&joint[3 + i])).store(&mut a[6 + i]);
            }
        }
        // The right-hand side: minus the residual.
        let (values, _) = self.values.as_chunks::<NODE>();
        let (node, dependents) = (&values[k], &self.dependents[k]);
        let held = self.rows[k].as_ref().map(|rows| S::round(rows));
        let crossed = !last && self.crosses(k);
        let b = &mut self.sweep.columns[k];
        let mut right = S::round(node);
        let rows = [node[FIRST_ROW], node[SECOND_ROW]];
        if joint.is_some() && self.joint_rows > 0 {
            // The values of the joint's rows are no moments.
            right = right.times(S::round(&MOMENTS));
        }
        let crosses = self.operator.crossed || touching == Touching::Both;
        // The last node has no coupling, and its pivots come in another order.
        if last {
            let mut right = dependents.eliminate(a, &mut [], Rounded(right), rows, crosses).0;
            if let (Some(rows), Some(held)) = (&self.rows[k], held) {
                hold::<S>(a, rows);
                right = right.times(held);
            }
            right.store(&mut b[12]);
            return (inverse, zero);
        }
        // The coupling to the node below.
        let (touching, upper) = (self.additions.spans[k], &single.upper[self.links[k].kind]);
        for (to, from) in b.iter_mut().zip(upper.iter()) {
            S::load(from).store(to);
        }
        if touching != Touching::Nothing {
            let first = if touching == Touching::Guide { 6 } else { 0 };
            let added = &self.additions.couplings[k].upper;
            for (to, from) in b[first..12].iter_mut().zip(&added[first..]) {
                S::load(to).plus(S::load(from)).store(to);
            }
        }
        // Dependent rotations are written by the others, held unknowns take no part.
        let with_pipe = &mut b[..if crossed { 12 } else { 6 }];
        right = dependents.eliminate(a, with_pipe, Rounded(right), rows, crosses).0;
        let is_free = |rows: &[f64; NODE]| rows[FIRST_ROW] != 0.0;
        if joint.is_some() && self.joint_rows == 0 && self.rows[k].as_ref().is_none_or(is_free) {
            right = eliminate_spin(a, &mut b[..12], right);
        }
        if let (Some(rows), Some(held)) = (&self.rows[k], held) {
            hold::<S>(a, rows);
            for column in &mut b[..12] {
                S::load(column).times(held).store(column);
            }
            right = right.times(held);
        }
        right.store(&mut b[12]);
        let squares = if crossed {
            eliminate_early::<S, true>(a, b, &mut inverse)
        } else {
            eliminate_early::<S, false>(a, b, &mut inverse)
        };
        (inverse, squares)
    }

    /// What the node below subtracts: L times the columns of node `k`.
    #[inline(always)]
    fn carry<S: Single>(&self, k: usize, carry: &mut [Column; COLUMNS]) {
        let (single, kind) = (&self.operator.single, self.links[k].kind);
        let touching = self.additions.spans[k];
        let added = &self.additions.couplings[k].lower;
        let b = &self.sweep.columns[k];
        let keep = self.rows[k + 1].as_ref().map(|rows| S::round(rows));
        let zero = S::splat(0.0);
        if self.crosses(k) {
            let first = match touching {
                Touching::Nothing => 12,
                Touching::Guide => 6,
                Touching::Both => 0,
            };
            let mut lower = [zero; 12];
            for (c, lower) in lower.iter_mut().enumerate() {
                *lower = S::load(&single.lower[kind][c]);
                if c >= first {
                    *lower = lower.plus(S::load(&added[c]));
                }
                if let Some(keep) = keep {
                    *lower = lower.times(keep);
                }
            }
            carry_crossed(b, &lower, carry);
            return;
        }
        let mut lower = [zero; 6];
        for (c, lower) in lower.iter_mut().enumerate() {
            *lower = S::load(&single.lower_joined[kind][c]);
            if touching == Touching::Guide {
                *lower = lower.plus(S::load(&added[6 + c]));
            }
            if let Some(keep) = keep {
                *lower = lower.times(keep);
            }
        }
        carry_joined(b, &lower, carry);
    }
}

/// Eliminates the spin below a joint with play from a block, its coupling and the right-hand side, which it gives back. It is
/// not coupled to the span above. Its row is left as that of a rotation that follows from others: one on the diagonal.
#[inline(always)]
fn eliminate_spin<S: Single>(a: &mut [Column; NODE], coupling: &mut [Column], right: S) -> S {
    let pivot = 1.0 / a[FIRST_ROW][FIRST_ROW];
    let only = S::load(&ONLY[FIRST_ROW]);
    // Exactly one in its own row: that row is then zero, and takes the entry over the pivot without cancellation.
    let mut by = a[FIRST_ROW].map(|x| x * pivot);
    by[FIRST_ROW] = 1.0;
    let by = S::load(&by);
    let reduced = |column: S, entry: f32| {
        let cleared = column.minus_product(by, S::splat(entry));
        cleared.plus_product(only, S::splat(entry * pivot))
    };
    for (k, column) in a.iter_mut().enumerate() {
        if k != FIRST_ROW {
            reduced(S::load(column), column[FIRST_ROW]).store(column);
        }
    }
    for column in coupling {
        reduced(S::load(column), column[FIRST_ROW]).store(column);
    }
    a[FIRST_ROW] = ONLY[FIRST_ROW];
    let mut lanes = Aligned([0.0; NODE]);
    right.store(&mut lanes);
    reduced(right, lanes[FIRST_ROW])
}

/// Keeps the rows of a block that are equations; a held row says that its unknown is the right-hand side, which is zero.
#[inline(always)]
fn hold<S: Single>(a: &mut [Column; NODE], rows: &[f64; NODE]) {
    let keep = S::round(rows);
    for (i, column) in a.iter_mut().enumerate() {
        if rows[i] == 0.0 {
            *column = ONLY[i];
        } else {
            S::load(column).times(keep).store(column);
        }
    }
}

/// Subtracts the carry from above from a block and its right-hand side.
#[inline(always)]
fn subtract_carry<S: Single>(
    a: &mut [Column; NODE],
    right: &mut Column,
    carry: &[Column; COLUMNS],
    rows: Option<&[f64; NODE]>,
) {
    for i in 0..6 {
        S::load(&a[i]).minus(S::load(&carry[i])).store(&mut a[i]);
        S::load(&a[9 + i]).minus(S::load(&carry[6 + i])).store(&mut a[9 + i]);
    }
    S::load(right).minus(S::load(&carry[12])).store(right);
    // The carry has nothing in held rows, but it has in the columns of their unknowns.
    if let Some(rows) = rows {
        for i in (0..6).chain(9..15) {
            if rows[i] == 0.0 {
                a[i] = ONLY[i];
            }
        }
    }
}

#[inline(always)]
fn run<S: Single>(mut elimination: SingleElimination<'_>) -> bool {
    for w in 0..elimination.windows.len() {
        let window = elimination.windows[w];
        let Some(top) = elimination.solve_window::<S>(window) else {
            return false;
        };
        elimination.windows[w].top = elimination.follow_upward::<S>(window.first, top);
    }
    true
}

impl SingleElimination<'_> {
    /// Solves for a window, and gives the solution of its first node; `None` if a pivot is too small.
    #[inline(always)]
    fn solve_window<S: Single>(&mut self, window: Window) -> Option<S> {
        let zero = S::splat(0.0);
        let mut carry = Aligned([[0.0; NODE]; COLUMNS]);
        if let Some(above) = window.first.checked_sub(1) {
            // An earlier correction eliminated the nodes above, and they are in balance now: their right-hand side is zero.
            self.sweep.columns[above][12] = [0.0; NODE];
            self.carry::<S>(above, &mut carry);
        }
        let mut blocks = self.sweep.blocks;
        let (mut inverse, mut squares) = (Inverse::start(), zero);
        for next in window.first..=window.last + 1 {
            // A node's assembly and early pair do not wait for the node above, and fill the gaps between its divisions.
            let early = if next <= window.last {
                self.assemble::<S>(next, next == window.last, &mut blocks[next % 2])
            } else {
                (inverse, zero)
            };
            if next > window.first {
                let k = next - 1;
                let rows = self.rows[k].as_ref();
                let crosses = k < window.last && self.crosses(k);
                let (a, b) = (&mut blocks[k % 2], &mut self.sweep.columns[k]);
                if k > 0 {
                    subtract_carry::<S>(a, &mut b[12], &carry, rows);
                }
                let largest = if k == window.last {
                    eliminate_last::<S>(a, &mut b[12])
                } else if crosses {
                    eliminate::<S, true>(a, b, inverse)
                } else {
                    eliminate::<S, false>(a, b, inverse)
                };
                squares = squares.largest(largest);
                if k < window.last {
                    self.carry::<S>(k, &mut carry);
                }
            }
            squares = squares.largest(early.1);
            inverse = early.0;
        }
        // The solutions are judged before they are used: all multipliers,
        // and the last node for numbers that are not finite.
        let (values, _) = self.values.as_chunks_mut::<NODE>();
        let mut lanes = Aligned([0.0; NODE]);
        squares.store(&mut lanes);
        // The carry brings a value that is not a number down to the last node, wherever it began.
        let last = &self.sweep.columns[window.last][12];
        if !(lanes.iter().all(|square| *square < LARGEST_SQUARE) && last.iter().all(|x| x.is_finite())) {
            return None;
        }
        // Upwards, as in double, with the rounded columns.
        let mut next = S::load(last);
        store_solution(next, &mut values[window.last], self.nodes[window.last]);
        for k in (window.first..window.last).rev() {
            let columns = &self.sweep.columns[k];
            next = minus_coupling(S::load(&columns[12]), &columns[..12], next);
            store_solution(next, &mut values[k], self.nodes[k]);
        }
        Some(next)
    }

    /// Moves the nodes above node `k` as they follow its solution `x`, until the force on the next one is small. Gives the
    /// first that moves.
    #[inline(always)]
    fn follow_upward<S: Single>(&mut self, mut k: usize, mut x: S) -> usize {
        while let Some(next) = k.checked_sub(1) {
            let upper = &self.operator.single.upper[self.links[next].kind];
            let (weights, _) = self.weights.as_chunks::<NODE>();
            let force = minus_coupling(S::splat(0.0), &upper[..], x).times(S::round(&weights[next]));
            let mut lanes = Aligned([0.0_f32; NODE]);
            force.store(&mut lanes);
            if !lanes.iter().any(|force| force.abs() > LEFT_OUT) {
                break;
            }
            x = minus_coupling(S::splat(0.0), &self.sweep.columns[next][..12], x);
            x.store(&mut lanes);
            // The node may belong to another window, whose solution it keeps.
            let (values, _) = self.values.as_chunks_mut::<NODE>();
            for (to, from) in values[next].iter_mut().zip(*lanes) {
                *to += f64::from(from);
            }
            pass(&mut values[next], self.nodes[next]);
            k = next;
        }
        k
    }
}

/// `from` minus the twelve columns of the coupling times the solution `x` of the node below.
#[inline(always)]
fn minus_coupling<S: Single>(from: S, b: &[Column], x: S) -> S {
    let (mut even, mut odd) = (from, S::splat(0.0));
    even = even.minus_product(S::load(&b[0]), x.spread::<0>());
    odd = odd.minus_product(S::load(&b[1]), x.spread::<1>());
    even = even.minus_product(S::load(&b[2]), x.spread::<2>());
    odd = odd.minus_product(S::load(&b[3]), x.spread::<3>());
    even = even.minus_product(S::load(&b[4]), x.spread::<4>());
    odd = odd.minus_product(S::load(&b[5]), x.spread::<5>());
    even = even.minus_product(S::load(&b[6]), x.spread::<9>());
    odd = odd.minus_product(S::load(&b[7]), x.spread::<10>());
    even = even.minus_product(S::load(&b[8]), x.spread::<11>());
    odd = odd.minus_product(S::load(&b[9]), x.spread::<12>());
    even = even.minus_product(S::load(&b[10]), x.spread::<13>());
    odd = odd.minus_product(S::load(&b[11]), x.spread::<14>());
    even.plus(odd)
}

/// Writes the solution of a node in double precision.
#[inline(always)]
fn store_solution<S: Single>(x: S, to: &mut [f64; NODE], node: Node) {
    let mut lanes = Aligned([0.0; NODE]);
    x.store(&mut lanes);
    for (to, from) in to.iter_mut().zip(*lanes) {
        *to = f64::from(from);
    }
    pass(to, node);
}
