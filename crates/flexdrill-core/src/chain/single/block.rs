//! One block of sixteen: its pairs of pivots, and their elimination.
//!
//! A pair of pivots is the inverse of a block of two by two: one division to wait for instead of two, and each column is
//! read and written half as often. Pairs are known at compile time, so that no row is exchanged.

use super::{COLUMNS, Column, NODE};
use crate::chain::columns::ONLY;
use crate::simd::aligned::Aligned;
use crate::simd::single::Single;

/// Pairs of pivots, in the order of their elimination. The spin below (6) and the tie's multiplier (15) are pivots in the
/// last node only: elsewhere the one follows from other rotations and the other does not exist. The tilts below (7, 8) are
/// not coupled to the span above, so that they are eliminated before the carry from above is known.
const PAIRS: [[usize; 2]; 8] = [[6, 15], [7, 8], [0, 1], [2, 3], [4, 5], [9, 10], [11, 12], [13, 14]];
/// Place of the tie's pair in the order of the last node: the multiplier's row has a zero on the diagonal until the other
/// rows are eliminated.
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
/// Per pair, one in all rows but its own. The last entry is for the tie's pair at the end of the order.
static OTHER_ROWS: Aligned<[Column; LAST + 1]> = Aligned(table(false));
/// Per pair, one in the rows whose pivots come later.
static LATER_ROWS: Aligned<[Column; LAST + 1]> = Aligned(table(true));
const fn table(later: bool) -> [Column; LAST + 1] {
    let mut out = [[0.0; NODE]; LAST + 1];
    let mut n = 0;
    while n <= LAST {
        let mut other = 0;
        while other < PAIRS.len() {
            let counts = if later {
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

/// The inverse of the pivots eliminated so far: per row, the entry on the diagonal and that of the pair's other row.
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

/// Eliminates pair `N`, rows `K` and `NEXT`, from the columns of the pairs in `after` and from `columns`. Gives the squares
/// of the multipliers of later rows.
#[inline(always)]
fn eliminate_pair<S: Single, const N: usize, const K: usize, const NEXT: usize>(
    a: &mut [Column; NODE],
    after: &[[usize; 2]],
    columns: [&mut [Column]; 2],
    inverse: &mut Inverse<S>,
) -> S {
    // The pair's block is [p q; r s], by rows; its inverse is [s -q; -r p] / (p s - q r).
    let (p, r) = (S::splat(a[K][K]), S::splat(a[K][NEXT]));
    let (q, s) = (S::splat(a[NEXT][K]), S::splat(a[NEXT][NEXT]));
    let reciprocal = S::splat(1.0).over(p.times(s).minus_product(q, r));
    // Multipliers of all other rows (Gauss-Jordan): both columns of the pair times its inverse.
    let others = S::load(&OTHER_ROWS[N]);
    let (first, second) = (S::load(&a[K]).times(others), S::load(&a[NEXT]).times(others));
    let by_first = first.times(s).minus_product(second, r).times(reciprocal);
    let by_second = second.times(p).minus_product(first, q).times(reciprocal);
    // Columns of earlier pairs are left alone: nothing reads them any more.
    for &[j, k] in after {
        subtract::<S, K, NEXT>(&mut a[j], by_first, by_second);
        subtract::<S, K, NEXT>(&mut a[k], by_first, by_second);
    }
    for columns in columns {
        for column in columns {
            subtract::<S, K, NEXT>(column, by_first, by_second);
        }
    }
    // The pair's own rows keep their right-hand sides: the inverse is applied at the end, to all rows at once.
    let (row, next) = (S::load(&ONLY[K]), S::load(&ONLY[NEXT]));
    inverse.own = inverse.own.plus_product(row, s.times(reciprocal));
    inverse.own = inverse.own.plus_product(next, p.times(reciprocal));
    inverse.partner = inverse.partner.minus_product(row, q.times(reciprocal));
    inverse.partner = inverse.partner.minus_product(next, r.times(reciprocal));
    // A large multiplier in a later row means that the pair was a poor pivot for it.
    let later = S::load(&LATER_ROWS[N]);
    let (x, y) = (by_first.times(later), by_second.times(later));
    x.times(x).largest(y.times(y))
}

/// Subtracts the pair's rows, times the multipliers, from a column.
#[inline(always)]
fn subtract<S: Single, const K: usize, const NEXT: usize>(column: &mut Column, by_first: S, by_second: S) {
    let (x, y) = (S::splat(column[K]), S::splat(column[NEXT]));
    S::load(column)
        .minus_product(by_first, x)
        .minus_product(by_second, y)
        .store(column);
}

/// Eliminates the early pair from a block and from its coupling. Only the first six columns of the coupling, those of the
/// pipe, have entries in the pair's rows; all twelve where contacts have them `CROSSED`.
#[inline(always)]
pub(super) fn eliminate_early<S: Single, const CROSSED: bool>(
    a: &mut [Column; NODE],
    b: &mut [Column; COLUMNS],
    inverse: &mut Inverse<S>,
) -> S {
    let (coupling, right) = b.split_at_mut(12);
    let coupling = &mut coupling[..if CROSSED { 12 } else { 6 }];
    eliminate_pair::<S, 1, 7, 8>(a, &PAIRS[2..], [coupling, right], inverse)
}

/// Solves `a x = b`, from which the early pair is eliminated. The last six columns of the coupling, those of the guide,
/// are zero above row 9 until the guide's pairs are reached, unless they are `CROSSED`.
#[inline(always)]
pub(super) fn eliminate<S: Single, const CROSSED: bool>(
    a: &mut [Column; NODE],
    b: &mut [Column; COLUMNS],
    mut inverse: Inverse<S>,
) -> S {
    let squares = {
        let (coupling, right) = b.split_at_mut(12);
        let early = &mut coupling[..if CROSSED { 12 } else { 6 }];
        let first = eliminate_pair::<S, 2, 0, 1>(a, &PAIRS[3..], [early, right], &mut inverse);
        let second = eliminate_pair::<S, 3, 2, 3>(a, &PAIRS[4..], [early, right], &mut inverse);
        let third = eliminate_pair::<S, 4, 4, 5>(a, &PAIRS[5..], [early, right], &mut inverse);
        let fourth = eliminate_pair::<S, 5, 9, 10>(a, &PAIRS[6..], [coupling, right], &mut inverse);
        let fifth = eliminate_pair::<S, 6, 11, 12>(a, &PAIRS[7..], [coupling, right], &mut inverse);
        let sixth = eliminate_pair::<S, 7, 13, 14>(a, &[], [coupling, right], &mut inverse);
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

/// Solves for one column of the last node: the tie's pair comes last.
#[inline(always)]
pub(super) fn eliminate_last<S: Single>(a: &mut [Column; NODE], right: &mut Column) -> S {
    let zero = S::splat(0.0);
    let mut inverse = Inverse {
        own: zero,
        partner: zero,
    };
    // The pairs after pair n, then the tie's.
    let after = |n: usize| {
        let mut after = [[0; 2]; 8];
        let count = 8 - n;
        after[..count - 1].copy_from_slice(&PAIRS[n + 1..]);
        after[count - 1] = PAIRS[0];
        (after, count)
    };
    let mut squares = zero;
    macro_rules! eliminate_next {
        ($n:literal, $k:literal, $next:literal) => {
            let (later, count) = after($n);
            let right = std::slice::from_mut(right);
            let largest = eliminate_pair::<S, $n, $k, $next>(a, &later[..count], [&mut [], right], &mut inverse);
            squares = squares.largest(largest);
        };
    }
    eliminate_next!(1, 7, 8);
    eliminate_next!(2, 0, 1);
    eliminate_next!(3, 2, 3);
    eliminate_next!(4, 4, 5);
    eliminate_next!(5, 9, 10);
    eliminate_next!(6, 11, 12);
    eliminate_next!(7, 13, 14);
    let column = std::slice::from_mut(right);
    squares = squares.largest(eliminate_pair::<S, LAST, 6, 15>(
        a,
        &[],
        [&mut [], column],
        &mut inverse,
    ));
    solve(right, inverse);
    squares
}

/// The solution of a column from which all other rows are eliminated: the inverse of the pairs times it.
#[inline(always)]
fn solve<S: Single>(column: &mut Column, inverse: Inverse<S>) {
    let x = S::load(column);
    x.times(inverse.own)
        .plus_product(x.taken(&PARTNERS), inverse.partner)
        .store(column);
}
