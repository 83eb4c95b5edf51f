//! One block of sixteen: its pairs of pivots, and how they are taken out.

use super::{COLUMNS, Column, NODE};
use crate::simd::aligned::Aligned;
use crate::simd::single::Single;

/// Pairs of pivots. The spin below and the tie's multiplier are pivots in the last node only: elsewhere the one follows
/// from other rotations and the other does not exist. The span above a node does not active the tilts below, so that these
/// may go before what comes from above is known; the rest follows in order.
const PAIRS: [[usize; 2]; 8] = [[6, 15], [7, 8], [0, 1], [2, 3], [4, 5], [9, 10], [11, 12], [13, 14]];
/// Place at which the pair of the tie's multiplier goes in the last node: its row has no pivot before the others are out.
const LAST: usize = 8;

/// The other one of a row's pair.
static PARTNERS: Aligned<[i32; NODE]> = {
    let mut out = [0; NODE];
    let mut n = 0;
    while n < PAIRS.len() {
        let [k, next] = PAIRS[n];
        (out[k], out[next]) = (next as i32, k as i32);
        n += 1;
    }
    Aligned(out)
};
/// Rows beside a pair, and those still to come after it; the last of them is that of the first pair where it goes last.
static BESIDE: Aligned<[Column; LAST + 1]> = Aligned(table(false));
static BEYOND: Aligned<[Column; LAST + 1]> = Aligned(table(true));
/// One row.
pub(in crate::chain) static ONLY: Aligned<[Column; NODE]> = {
    let mut out = [[0.0; NODE]; NODE];
    let mut k = 0;
    while k < NODE {
        out[k][k] = 1.0;
        k += 1;
    }
    Aligned(out)
};

const fn table(beyond: bool) -> [Column; LAST + 1] {
    let mut out = [[0.0; NODE]; LAST + 1];
    let mut n = 0;
    while n <= LAST {
        let mut other = 0;
        while other < PAIRS.len() {
            let counts = if beyond {
                n < LAST && other > n
            } else {
                other != n % LAST
            };
            if counts {
                let [k, next] = PAIRS[other];
                (out[n][k], out[n][next]) = (1.0, 1.0);
            }
            other += 1;
        }
        n += 1;
    }
    out
}

/// The inverse of the pivots that are out: what of each row is its own, and what its partner's.
#[derive(Clone, Copy)]
pub(super) struct Inverse<S> {
    pub own: S,
    pub partner: S,
}

impl<S: Single> Inverse<S> {
    /// Before any pivot: the spin below follows from the others, and is its own pivot.
    #[inline(always)]
    pub fn start() -> Self {
        Self {
            own: S::load(&ONLY[6]),
            partner: S::splat(0.0),
        }
    }
}

/// Takes pair `N`, `K` and `NEXT`, out of the columns of the pairs from `after` on and out of `columns`. Gives the squares
/// of the multipliers of rows still to come.
#[inline(always)]
fn pair<S: Single, const N: usize, const K: usize, const NEXT: usize>(
    a: &mut [Column; NODE],
    after: &[[usize; 2]],
    columns: [&mut [Column]; 2],
    inverse: &mut Inverse<S>,
) -> S {
    let (p, r) = (S::splat(a[K][K]), S::splat(a[K][NEXT]));
    let (q, s) = (S::splat(a[NEXT][K]), S::splat(a[NEXT][NEXT]));
    let reciprocal = S::splat(1.0).over(p.times(s).minus_product(q, r));
    let beside = S::load(&BESIDE[N]);
    let (first, second) = (S::load(&a[K]).times(beside), S::load(&a[NEXT]).times(beside));
    let by_first = first.times(s).minus_product(second, r).times(reciprocal);
    let by_second = second.times(p).minus_product(first, q).times(reciprocal);
    for &[j, k] in after {
        take::<S, K, NEXT>(&mut a[j], by_first, by_second);
        take::<S, K, NEXT>(&mut a[k], by_first, by_second);
    }
    for columns in columns {
        for column in columns {
            take::<S, K, NEXT>(column, by_first, by_second);
        }
    }
    let (row, next) = (S::load(&ONLY[K]), S::load(&ONLY[NEXT]));
    inverse.own = inverse.own.plus_product(row, s.times(reciprocal));
    inverse.own = inverse.own.plus_product(next, p.times(reciprocal));
    inverse.partner = inverse.partner.minus_product(row, q.times(reciprocal));
    inverse.partner = inverse.partner.minus_product(next, r.times(reciprocal));
    let beyond = S::load(&BEYOND[N]);
    let (x, y) = (by_first.times(beyond), by_second.times(beyond));
    x.times(x).largest(y.times(y))
}

/// Takes the pivots' rows, times the multipliers, off a column.
#[inline(always)]
fn take<S: Single, const K: usize, const NEXT: usize>(column: &mut Column, by_first: S, by_second: S) {
    let (x, y) = (S::splat(column[K]), S::splat(column[NEXT]));
    S::load(column)
        .minus_product(by_first, x)
        .minus_product(by_second, y)
        .store(column);
}

/// Takes the early pair out of a block and of its coupling, whose first six columns, or `CROSSED` all, have something in
/// their rows.
#[inline(always)]
pub(super) fn begin<S: Single, const CROSSED: bool>(
    a: &mut [Column; NODE],
    b: &mut [Column; COLUMNS],
    inverse: &mut Inverse<S>,
) -> S {
    let (coupling, right) = b.split_at_mut(12);
    let coupling = &mut coupling[..if CROSSED { 12 } else { 6 }];
    pair::<S, 1, 7, 8>(a, &PAIRS[2..], [coupling, right], inverse)
}

/// Solves `a x = b`, of which the early pairs are out; the last six columns of the coupling begin at row 9 or, `CROSSED`,
/// at row 3.
#[inline(always)]
pub(super) fn eliminate<S: Single, const CROSSED: bool>(
    a: &mut [Column; NODE],
    b: &mut [Column; COLUMNS],
    mut inverse: Inverse<S>,
) -> S {
    let squares = {
        let (coupling, right) = b.split_at_mut(12);
        let early = &mut coupling[..if CROSSED { 12 } else { 6 }];
        let first = pair::<S, 2, 0, 1>(a, &PAIRS[3..], [early, right], &mut inverse);
        let second = pair::<S, 3, 2, 3>(a, &PAIRS[4..], [early, right], &mut inverse);
        let third = pair::<S, 4, 4, 5>(a, &PAIRS[5..], [early, right], &mut inverse);
        let fourth = pair::<S, 5, 9, 10>(a, &PAIRS[6..], [coupling, right], &mut inverse);
        let fifth = pair::<S, 6, 11, 12>(a, &PAIRS[7..], [coupling, right], &mut inverse);
        let sixth = pair::<S, 7, 13, 14>(a, &[], [coupling, right], &mut inverse);
        first
            .largest(second)
            .largest(third.largest(fourth))
            .largest(fifth.largest(sixth))
    };
    for column in b {
        solve(column, inverse);
    }
    squares
}

/// Solves for one column of the last node, whose multiplier goes last.
#[inline(always)]
pub(super) fn eliminate_last<S: Single>(a: &mut [Column; NODE], right: &mut Column) -> S {
    let zero = S::splat(0.0);
    let mut inverse = Inverse {
        own: zero,
        partner: zero,
    };
    let with_first = |n: usize| {
        let mut after = [[0; 2]; 8];
        let count = 8 - n;
        after[..count - 1].copy_from_slice(&PAIRS[n + 1..]);
        after[count - 1] = PAIRS[0];
        (after, count)
    };
    let mut squares = zero;
    macro_rules! take_out {
        ($n:literal, $k:literal, $next:literal) => {
            let (after, count) = with_first($n);
            let right = std::slice::from_mut(right);
            let largest = pair::<S, $n, $k, $next>(a, &after[..count], [&mut [], right], &mut inverse);
            squares = squares.largest(largest);
        };
    }
    take_out!(1, 7, 8);
    take_out!(2, 0, 1);
    take_out!(3, 2, 3);
    take_out!(4, 4, 5);
    take_out!(5, 9, 10);
    take_out!(6, 11, 12);
    take_out!(7, 13, 14);
    let column = std::slice::from_mut(right);
    squares = squares.largest(pair::<S, LAST, 6, 15>(a, &[], [&mut [], column], &mut inverse));
    solve(right, inverse);
    squares
}

/// The solution of a column that has nothing of other rows left.
#[inline(always)]
fn solve<S: Single>(column: &mut Column, inverse: Inverse<S>) {
    let x = S::load(column);
    x.times(inverse.own)
        .plus_product(x.taken(&PARTNERS), inverse.partner)
        .store(column);
}
