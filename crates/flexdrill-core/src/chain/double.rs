//! One block of sixteen in double precision: Gauss-Jordan elimination with rows exchanged where that is better.

use super::NODE as SIZE;
use super::columns::load;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

/// Ratio of the diagonal entry to the largest candidate below which rows are exchanged. Stiffness and inertia dominate
/// their own equations, so exchanges are rare; the factor covers the different units of displacements and rotations
/// (forces against couples over an element's length of centimetres).
pub(crate) const PIVOT_RATIO: f64 = 1e-3;

/// Per row k, one in the rows after k: the candidates for its pivot.
const AFTER: [[f64; SIZE]; SIZE] = table(Rows::After);
/// Per row k, one in the rows after k + 1: those whose pivots come later.
const LATER: [[f64; SIZE]; SIZE] = table(Rows::AfterPair);
/// Per row k, one in all other rows.
const OTHERS: [[f64; SIZE]; SIZE] = table(Rows::Others);
/// Per row k, one in all rows but k and k + 1.
const OUTSIDE_PAIR: [[f64; SIZE]; SIZE] = table(Rows::OutsidePair);

/// Rows in relation to a pivot.
enum Rows {
    After,
    AfterPair,
    Others,
    OutsidePair,
}

const fn table(rows: Rows) -> [[f64; SIZE]; SIZE] {
    let mut out = [[0.0; SIZE]; SIZE];
    let mut k = 0;
    while k < SIZE {
        let mut r = 0;
        while r < SIZE {
            let counts = match rows {
                Rows::After => r > k,
                Rows::AfterPair => r > k + 1,
                Rows::Others => r != k,
                Rows::OutsidePair => r != k && r != k + 1,
            };
            if counts {
                out[k][r] = 1.0;
            }
            r += 1;
        }
        k += 1;
    }
    out
}

/// Both halves of a column, to be changed.
#[inline(always)]
fn halves_mut(column: &mut [f64; SIZE]) -> &mut [[f64; 8]] {
    column.as_chunks_mut::<8>().0
}

/// column -= other scale.
#[inline(always)]
fn subtract<V: Vector>(column: &mut [f64; SIZE], other: [V; 2], scale: f64) {
    let scale = V::splat(scale);
    for (half, other) in halves_mut(column).iter_mut().zip(other) {
        V::load(half).minus_product(other, scale).store(half);
    }
}

/// One pivot: the multipliers (column k) / pivot of all other rows, and its reciprocal.
struct Pivot<V> {
    multipliers: [V; 2],
    reciprocal: f64,
}

/// Whether the diagonal entry is large enough as pivot k.
#[inline(always)]
fn is_large_enough<V: Vector>(column: &[f64; SIZE], k: usize) -> bool {
    let size = column[k].abs();
    let bound = V::splat(size * (1.0 / PIVOT_RATIO));
    let (candidates, after): ([V; 2], [V; 2]) = (load(column), load(&AFTER[k]));
    let larger = candidates[0].times(after[0]).any_beyond(bound) | candidates[1].times(after[1]).any_beyond(bound);
    !(larger | (size == 0.0) | size.is_nan())
}

#[inline(always)]
fn pivot<V: Vector>(column: &[f64; SIZE], k: usize) -> Pivot<V> {
    let reciprocal = 1.0 / column[k];
    let (column, others): ([V; 2], [V; 2]) = (load(column), load(&OTHERS[k]));
    let scale = V::splat(reciprocal);
    Pivot {
        multipliers: [
            column[0].times(others[0].times(scale)),
            column[1].times(others[1].times(scale)),
        ],
        reciprocal,
    }
}

/// Rows k and k + 1 of columns k and k + 1, P, as one pivot.
struct Pair<V> {
    /// (Columns k and k + 1) P^-1, without the pair's own rows: the multipliers of all other rows.
    multipliers: [[V; 2]; 2],
    /// Diagonal of P^-1.
    own: [f64; 2],
    /// The rest of P^-1, by rows.
    partner: [f64; 2],
}

impl<V: Vector> Pair<V> {
    /// `None` if the pair is too small: as with one pivot, no multiplier of a later row may be larger than 1 /
    /// [`PIVOT_RATIO`].
    #[inline(always)]
    fn of(first: &[f64; SIZE], second: &[f64; SIZE], k: usize) -> Option<Self> {
        let (p, q, r, s) = (first[k], second[k], first[k + 1], second[k + 1]);
        let reciprocal = 1.0 / (p * s - q * r);
        let (own, partner) = ([s * reciprocal, p * reciprocal], [-(q * reciprocal), -(r * reciprocal)]);
        let (first, second): ([V; 2], [V; 2]) = (load(first), load(second));
        let (outside, later): ([V; 2], [V; 2]) = (load(&OUTSIDE_PAIR[k]), load(&LATER[k]));
        let bound = V::splat(1.0 / PIVOT_RATIO);
        let mut multipliers = [[V::splat(0.0); 2]; 2];
        // A pair without an inverse fails; the multipliers of earlier rows may have any size.
        let mut fails = V::splat(reciprocal).any_beyond(V::splat(f64::MAX));
        for half in 0..2 {
            let (first, second) = (first[half].times(outside[half]), second[half].times(outside[half]));
            let by_first = first.times(V::splat(own[0])).plus_product(second, V::splat(partner[1]));
            let by_second = second.times(V::splat(own[1])).plus_product(first, V::splat(partner[0]));
            fails |= by_first.times(later[half]).any_beyond(bound) | by_second.times(later[half]).any_beyond(bound);
            (multipliers[0][half], multipliers[1][half]) = (by_first, by_second);
        }
        (!fails).then_some(Self {
            multipliers,
            own,
            partner,
        })
    }

    /// Eliminates the pair from another column, which is read and written once.
    #[inline(always)]
    fn eliminate_from(&self, column: &mut [f64; SIZE], k: usize) {
        let (x, y) = (V::splat(column[k]), V::splat(column[k + 1]));
        for (n, half) in halves_mut(column).iter_mut().enumerate() {
            V::load(half)
                .minus_product(self.multipliers[0][n], x)
                .minus_product(self.multipliers[1][n], y)
                .store(half);
        }
    }
}

/// Inverse of the pivots, one by one or in pairs: per row, the entry on the diagonal and that of the pair's other row.
struct Pivots {
    own: [f64; SIZE],
    partner: [f64; SIZE],
}

/// Eliminates pivots k and k + 1 one after the other, with rows exchanged where that is better; seldom needed.
struct OneByOne<'a, const C: usize> {
    k: usize,
    a: &'a mut [[f64; SIZE]; SIZE],
    b: &'a mut [[f64; SIZE]; C],
    pivots: &'a mut Pivots,
}

impl<const C: usize> Kernel for OneByOne<'_, C> {
    type Output = Result<(), f64>;

    #[inline(always)]
    fn run<V: Vector>(self) -> Result<(), f64> {
        let Self { k, a, b, pivots } = self;
        for k in k..k + 2 {
            if !is_large_enough::<V>(&a[k], k) {
                exchange(k, a, b)?;
            }
            let next: Pivot<V> = pivot(&a[k], k);
            (pivots.own[k], pivots.partner[k]) = (next.reciprocal, 0.0);
            for column in a[k + 1..].iter_mut().chain(b.iter_mut()) {
                subtract(column, next.multipliers, column[k]);
            }
        }
        Ok(())
    }
}

/// Solves `a x = b` for all columns of `b` in place; `a` is destroyed. The last column of `b` is full; of the others,
/// only the first `active(k)` have entries in rows 0 to k. Two pivots are taken at a time, by the inverse of the two by
/// two: one division to wait for instead of two, and every column is written half as often.
///
/// # Errors
/// The size of the largest available pivot when it is zero or not a number.
#[inline(always)]
pub(super) fn sixteen<V: Vector, const C: usize>(
    a: &mut [[f64; SIZE]; SIZE],
    b: &mut [[f64; SIZE]; C],
    active: impl Fn(usize) -> usize,
) -> Result<(), f64> {
    let mut pivots = Pivots {
        own: [0.0; SIZE],
        partner: [0.0; SIZE],
    };
    let mut exchanged = false;
    let mut k = 0;
    while k < SIZE {
        if let Some(pair) = Pair::<V>::of(&a[k], &a[k + 1], k) {
            for column in &mut a[k + 2..] {
                pair.eliminate_from(column, k);
            }
            let active = if exchanged { C - 1 } else { active(k + 1).min(C - 1) };
            for column in &mut b[..active] {
                pair.eliminate_from(column, k);
            }
            pair.eliminate_from(&mut b[C - 1], k);
            pivots.own[k..k + 2].copy_from_slice(&pair.own);
            pivots.partner[k..k + 2].copy_from_slice(&pair.partner);
        } else {
            let pivots = &mut pivots;
            V::call(OneByOne { k, a, b, pivots })?;
            exchanged = true;
        }
        k += 2;
    }
    let (own, partner): ([V; 2], [V; 2]) = (load(&pivots.own), load(&pivots.partner));
    for column in b.iter_mut() {
        for (n, half) in halves_mut(column).iter_mut().enumerate() {
            let x = V::load(half);
            x.times(own[n]).plus_product(x.swapped(), partner[n]).store(half);
        }
    }
    Ok(())
}

/// Brings the largest candidate to the diagonal.
///
/// # Errors
/// Its size when it is zero or not a number.
#[cold]
#[inline(never)]
pub(crate) fn exchange<const N: usize, const K: usize, const C: usize>(
    k: usize,
    a: &mut [[f64; N]; K],
    b: &mut [[f64; N]; C],
) -> Result<(), f64> {
    let mut p = k;
    for r in k + 1..K {
        if a[k][r].abs() > a[k][p].abs() {
            p = r;
        }
    }
    let size = a[k][p].abs();
    // A block that is singular up to rounding passes this check; Newton's residual then fails to converge.
    if size.is_nan() || size == 0.0 {
        return Err(size);
    }
    if p != k {
        let columns = a[k..].iter_mut().chain(b.iter_mut());
        columns.for_each(|column| column.swap(k, p));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::vector::Portable;
    use crate::stations::linear::solve_columns;

    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*seed >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
    }

    #[test]
    fn the_plain_elimination_gives_the_same() {
        let mut seed = 7;
        for round in 0..50 {
            let mut a = [[0.0; SIZE]; SIZE];
            let mut b = [[0.0; SIZE]; 13];
            for column in a.iter_mut().chain(b.iter_mut()) {
                column.iter_mut().for_each(|x| *x = random(&mut seed));
            }
            if round % 2 == 0 {
                // No exchanges here, many in the other rounds, where the diagonal is made zero.
                (0..SIZE).for_each(|k| a[k][k] += 20.0);
            } else {
                (0..SIZE).for_each(|k| a[k][k] = 0.0);
            }
            let (mut a1, mut b1) = (a, b);
            solve_columns::<SIZE, 13>(&mut a1, &mut b1).unwrap();
            sixteen::<Portable, 13>(&mut a, &mut b, |_| 12).unwrap();
            // Where the diagonal is large only rounding differs. Pivots a thousand times smaller than their column are
            // taken in both ways, but in another order, so that six of sixteen digits are left for certain in the worst
            // of fifty matrices.
            let granted = if round % 2 == 0 { 1e-13 } else { 1e-6 };
            for (x, expected) in b.as_flattened().iter().zip(b1.as_flattened()) {
                assert!(
                    (x - expected).abs() < granted * expected.abs().max(1.0),
                    "{round}: {x} {expected}"
                );
            }
        }
    }

    #[test]
    fn what_is_singular_or_not_a_number_is_an_error() {
        let mut a = [[0.0; SIZE]; SIZE];
        (0..SIZE - 1).for_each(|k| a[k][k] = 1.0);
        assert!(sixteen::<Portable, 1>(&mut a, &mut [[1.0; SIZE]], |_| 0).is_err());
        let mut a = [[0.0; SIZE]; SIZE];
        (0..SIZE).for_each(|k| a[k][k] = 1.0);
        a[3][9] = f64::NAN;
        a[3][3] = f64::NAN;
        assert!(sixteen::<Portable, 1>(&mut a, &mut [[1.0; SIZE]], |_| 0).is_err());
    }
}
