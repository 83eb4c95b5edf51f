//! The elimination in single precision, a node's block in registers.
//!
//! Newton's residual is taken in double, so that a correction need only be good to a few digits. Pivots go in pairs as in
//! double, without exchanges; where a multiplier of a row still to come is larger than a thousand, or nothing is a number
//! any more, the solution is refused and made in double.

use super::operator::Operator;
use super::tangent::{Additions, Crossing};
use super::{Link, MULTIPLIER, NODE};
use crate::linear::JointIncrement;
use crate::simd::Kernel;
use crate::simd::single::Single;
use crate::simd::vector::Vector;

/// Columns per node: twelve of the coupling and the right-hand side.
const COLUMNS: usize = 13;
/// Largest square of a multiplier.
const LARGEST_SQUARE: f32 = 1e6;

/// A column of a block.
type Column = [f32; NODE];

/// Rows in relation to a pair of pivots.
const BESIDE: [Column; NODE] = table(false);
const BEYOND: [Column; NODE] = table(true);
/// One row.
const ONLY: [Column; NODE] = {
    let mut out = [[0.0; NODE]; NODE];
    let mut k = 0;
    while k < NODE {
        out[k][k] = 1.0;
        k += 1;
    }
    out
};

const fn table(beyond: bool) -> [Column; NODE] {
    let mut out = [[0.0; NODE]; NODE];
    let mut k = 0;
    while k + 1 < NODE {
        let mut r = 0;
        while r < NODE {
            if r > k + 1 || !beyond && r < k {
                out[k][r] = 1.0;
            }
            r += 1;
        }
        k += 1;
    }
    out
}

/// The step-constant part, rounded.
#[derive(Default)]
pub(super) struct SingleOperator {
    blocks: Vec<[Column; NODE]>,
    /// Per kind of span: rows of the node above by columns of the bottom end; rows of the node below by columns of the
    /// top end, pipe and guide in one column as they do not share rows, and apart.
    upper: Vec<[Column; 12]>,
    lower: Vec<[Column; 12]>,
    lower_joined: Vec<[Column; 6]>,
}

fn rounded<const N: usize>(columns: &[[f64; NODE]; N]) -> [Column; N] {
    columns.map(|column| column.map(|x| x as f32))
}

impl SingleOperator {
    pub(super) fn of(operator: &Operator) -> Self {
        let lower: Vec<[Column; 12]> = operator.couplings.iter().map(|c| rounded(&c.lower)).collect();
        Self {
            blocks: operator.blocks.iter().map(rounded).collect(),
            upper: operator.couplings.iter().map(|c| rounded(&c.upper)).collect(),
            lower_joined: lower
                .iter()
                .map(|lower| std::array::from_fn(|c| std::array::from_fn(|i| lower[c][i] + lower[6 + c][i])))
                .collect(),
            lower,
        }
    }
}

/// Room for an elimination.
pub(super) struct SingleSweep {
    columns: Vec<[Column; COLUMNS]>,
    /// What each joint adds: columns of the rotations above, of those below, of the multiplier.
    joints: Vec<[Column; 7]>,
}

impl SingleSweep {
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            columns: vec![[[0.0; NODE]; COLUMNS]; nodes],
            joints: vec![[[0.0; NODE]; 7]; nodes - 2],
        }
    }
}

/// One solution; `false` if a pivot would not do.
pub(super) struct SingleElimination<'a> {
    pub sweep: &'a mut SingleSweep,
    pub operator: &'a Operator,
    pub additions: &'a Additions,
    pub joints: &'a [JointIncrement],
    pub links: &'a [Link],
    pub rows: &'a [Option<[f64; NODE]>],
    /// The right-hand side, which becomes the solution.
    pub values: &'a mut [f64],
}

/// A block under elimination.
struct Pivots<S> {
    /// Inverse of the pivots: what of each row is its own, and what its neighbour's.
    own: S,
    partner: S,
    /// Largest square of the multipliers, by rows.
    squares: S,
}

/// Takes the pivots `K` and `K + 1` out of the columns after them and out of the first `active` of `b` and its last.
#[expect(
    clippy::needless_range_loop,
    reason = "columns by number, so that they stay in registers"
)]
#[inline(always)]
fn pair<S: Single, const K: usize, const NEXT: usize>(
    a: &mut [S; NODE],
    b: &mut [Column; COLUMNS],
    active: usize,
    pivots: &mut Pivots<S>,
) {
    let (p, r) = (a[K].spread::<K>(), a[K].spread::<NEXT>());
    let (q, s) = (a[K + 1].spread::<K>(), a[K + 1].spread::<NEXT>());
    let reciprocal = S::splat(1.0).over(p.times(s).minus_product(q, r));
    let beside = S::load(&BESIDE[K]);
    let (first, second) = (a[K].times(beside), a[K + 1].times(beside));
    let by_first = first.times(s).minus_product(second, r).times(reciprocal);
    let by_second = second.times(p).minus_product(first, q).times(reciprocal);
    let (row, next) = (S::load(&ONLY[K]), S::load(&ONLY[K + 1]));
    pivots.own = pivots.own.plus_product(row, s.times(reciprocal));
    pivots.own = pivots.own.plus_product(next, p.times(reciprocal));
    pivots.partner = pivots.partner.minus_product(row, q.times(reciprocal));
    pivots.partner = pivots.partner.minus_product(next, r.times(reciprocal));
    let beyond = S::load(&BEYOND[K]);
    let (x, y) = (by_first.times(beyond), by_second.times(beyond));
    pivots.squares = x.times(x).largest(y.times(y)).largest(pivots.squares);
    for j in 0..NODE {
        if j > K + 1 {
            let (x, y) = (a[j].spread::<K>(), a[j].spread::<NEXT>());
            a[j] = a[j].minus_product(by_first, x).minus_product(by_second, y);
        }
    }
    for j in 0..COLUMNS {
        if j < active || j == COLUMNS - 1 {
            let (x, y) = (S::splat(b[j][K]), S::splat(b[j][K + 1]));
            S::load(&b[j])
                .minus_product(by_first, x)
                .minus_product(by_second, y)
                .store(&mut b[j]);
        }
    }
}

/// Solves `a x = b`; of the twelve columns `COUPLED` says how many there are, and of these the first six begin at row 3,
/// the others at row 9 or, `CROSSED`, at row 3 too. Gives the largest squares of the multipliers.
#[inline(always)]
fn eliminate<S: Single, const CROSSED: bool, const COUPLED: bool>(mut a: [S; NODE], b: &mut [Column; COLUMNS]) -> S {
    let zero = S::splat(0.0);
    let mut pivots = Pivots {
        own: zero,
        partner: zero,
        squares: zero,
    };
    let [early, late] = match (COUPLED, CROSSED) {
        (false, _) => [0, 0],
        (true, false) => [6, 12],
        (true, true) => [12, 12],
    };
    pair::<S, 0, 1>(&mut a, b, 0, &mut pivots);
    pair::<S, 2, 3>(&mut a, b, early, &mut pivots);
    pair::<S, 4, 5>(&mut a, b, early, &mut pivots);
    pair::<S, 6, 7>(&mut a, b, early, &mut pivots);
    pair::<S, 8, 9>(&mut a, b, late, &mut pivots);
    pair::<S, 10, 11>(&mut a, b, late, &mut pivots);
    pair::<S, 12, 13>(&mut a, b, late, &mut pivots);
    pair::<S, 14, 15>(&mut a, b, late, &mut pivots);
    for (j, column) in b.iter_mut().enumerate() {
        if COUPLED || j == COLUMNS - 1 {
            let x = S::load(column);
            x.times(pivots.own)
                .plus_product(x.swapped(), pivots.partner)
                .store(column);
        }
    }
    pivots.squares
}

/// L times the columns, where pipe and guide do not cross: both at once.
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

/// L times the columns.
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

impl SingleElimination<'_> {
    /// Sets what the joints add.
    #[inline(always)]
    fn join(&mut self) {
        for (to, from) in self.sweep.joints.iter_mut().zip(self.joints) {
            for k in 0..3 {
                for i in 0..3 {
                    to[k][i] = from.rotations[k][i] as f32;
                    to[k][6 + i] = from.rotations[k][3 + i] as f32;
                    to[3 + k][i] = from.rotations[3 + k][i] as f32;
                    to[3 + k][6 + i] = from.rotations[3 + k][3 + i] as f32;
                }
                let (above, below) = (from.rows[0][k] as f32, from.rows[0][3 + k] as f32);
                to[k][MULTIPLIER] = above;
                to[3 + k][MULTIPLIER] = below;
                to[6][k] = above;
                to[6][6 + k] = below;
            }
        }
    }
}

impl Kernel for SingleElimination<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<V: Vector>(mut self) -> bool {
        self.join();
        run::<V::Single>(self)
    }
}

#[expect(
    clippy::needless_range_loop,
    reason = "columns by number, so that they stay in registers"
)]
#[inline(always)]
fn run<S: Single>(by: SingleElimination<'_>) -> bool {
    let SingleElimination {
        sweep,
        operator,
        additions,
        links,
        rows,
        values,
        ..
    } = by;
    let nodes = rows.len();
    let single = &operator.single;
    let zero = S::splat(0.0);
    let mut carry = [[0.0; NODE]; COLUMNS];
    let mut squares = zero;
    let (values, _) = values.as_chunks_mut::<NODE>();
    for k in 0..nodes {
        let base = &single.blocks[operator.block_of[k]];
        let mut a = [zero; NODE];
        for (to, from) in a.iter_mut().zip(base) {
            *to = S::load(from);
        }
        if additions.touched[k] {
            for (to, from) in a.iter_mut().zip(&additions.blocks[k]) {
                *to = to.plus(S::round(from));
            }
        }
        let mut right = S::round(&values[k]);
        if k > 0 {
            if let Some(joint) = sweep.joints.get(k - 1) {
                for i in 0..3 {
                    a[i] = a[i].plus(S::load(&joint[i]));
                    a[6 + i] = a[6 + i].plus(S::load(&joint[3 + i]));
                }
                a[MULTIPLIER] = a[MULTIPLIER].plus(S::load(&joint[6]));
            }
            for i in 0..6 {
                a[i] = a[i].minus(S::load(&carry[i]));
                a[9 + i] = a[9 + i].minus(S::load(&carry[6 + i]));
            }
            right = right.minus(S::load(&carry[12]));
        }
        let held = &rows[k];
        if let Some(rows) = held {
            let keep = S::round(rows);
            for (i, column) in a.iter_mut().enumerate() {
                *column = if rows[i] == 0.0 {
                    S::load(&ONLY[i])
                } else {
                    column.times(keep)
                };
            }
            right = right.times(keep);
        }
        let b = &mut sweep.columns[k];
        right.store(&mut b[12]);
        if k + 1 == nodes {
            squares = eliminate::<S, false, false>(a, b).largest(squares);
            break;
        }
        let crossing = additions.crossing[k];
        let kind = links[k].kind;
        let mut upper = [zero; 12];
        for (to, from) in upper.iter_mut().zip(&single.upper[kind]) {
            *to = S::load(from);
        }
        if crossing != Crossing::Nothing {
            let first = if crossing == Crossing::Guide { 6 } else { 0 };
            let added = &additions.couplings[k].upper;
            for c in first..12 {
                upper[c] = upper[c].plus(S::round(&added[c]));
            }
        }
        if let Some(rows) = held {
            let keep = S::round(rows);
            for column in &mut upper {
                *column = column.times(keep);
            }
        }
        for (to, from) in b.iter_mut().zip(upper) {
            from.store(to);
        }
        let keep_below = rows[k + 1].as_ref().map(|rows| S::round(rows));
        if crossing == Crossing::Both {
            squares = eliminate::<S, true, true>(a, b).largest(squares);
            let added = &additions.couplings[k].lower;
            let mut lower = [zero; 12];
            for c in 0..12 {
                lower[c] = S::load(&single.lower[kind][c]).plus(S::round(&added[c]));
                if let Some(keep) = keep_below {
                    lower[c] = lower[c].times(keep);
                }
            }
            carry_crossed(b, &lower, &mut carry);
        } else {
            squares = eliminate::<S, false, true>(a, b).largest(squares);
            let mut lower = [zero; 6];
            for c in 0..6 {
                lower[c] = S::load(&single.lower_joined[kind][c]);
                if crossing == Crossing::Guide {
                    lower[c] = lower[c].plus(S::round(&additions.couplings[k].lower[6 + c]));
                }
                if let Some(keep) = keep_below {
                    lower[c] = lower[c].times(keep);
                }
            }
            carry_joined(b, &lower, &mut carry);
        }
    }
    let mut lanes = [0.0; NODE];
    squares.store(&mut lanes);
    // What is not a number anywhere is carried down to the last node.
    let last = &sweep.columns[nodes - 1][12];
    if !(lanes.iter().all(|square| *square < LARGEST_SQUARE) && last.iter().all(|x| x.is_finite())) {
        return false;
    }
    let mut next = S::load(&sweep.columns[nodes - 1][12]);
    put(next, &mut values[nodes - 1]);
    for k in (0..nodes - 1).rev() {
        let b = &sweep.columns[k];
        let (mut even, mut odd) = (S::load(&b[12]), zero);
        even = even.minus_product(S::load(&b[0]), next.spread::<0>());
        odd = odd.minus_product(S::load(&b[1]), next.spread::<1>());
        even = even.minus_product(S::load(&b[2]), next.spread::<2>());
        odd = odd.minus_product(S::load(&b[3]), next.spread::<3>());
        even = even.minus_product(S::load(&b[4]), next.spread::<4>());
        odd = odd.minus_product(S::load(&b[5]), next.spread::<5>());
        even = even.minus_product(S::load(&b[6]), next.spread::<9>());
        odd = odd.minus_product(S::load(&b[7]), next.spread::<10>());
        even = even.minus_product(S::load(&b[8]), next.spread::<11>());
        odd = odd.minus_product(S::load(&b[9]), next.spread::<12>());
        even = even.minus_product(S::load(&b[10]), next.spread::<13>());
        odd = odd.minus_product(S::load(&b[11]), next.spread::<14>());
        next = even.plus(odd);
        put(next, &mut values[k]);
    }
    true
}

/// Writes a solution in double.
#[inline(always)]
fn put<S: Single>(x: S, to: &mut [f64; NODE]) {
    let mut lanes = [0.0; NODE];
    x.store(&mut lanes);
    for (to, from) in to.iter_mut().zip(lanes) {
        *to = f64::from(from);
    }
}
