//! Gauss-Jordan elimination of the small blocks, over [`Vector`]: see [`super::super::block`] for the method and its pivoting.

use super::super::block::{PIVOT_RATIO, exchange};
use super::super::vector::Vector;
use super::{SIZE, Six};

/// Rows after k: 1 where a pivot may be looked for.
const AFTER: [[f64; SIZE]; SIZE] = table(true);
/// All rows but k.
const OTHERS: [[f64; SIZE]; SIZE] = table(false);

const fn table(only_after: bool) -> [[f64; SIZE]; SIZE] {
    let mut out = [[0.0; SIZE]; SIZE];
    let mut k = 0;
    while k < SIZE {
        let mut r = 0;
        while r < SIZE {
            if r > k || (!only_after && r < k) {
                out[k][r] = 1.0;
            }
            r += 1;
        }
        k += 1;
    }
    out
}

/// Both halves of a column of sixteen.
#[inline(always)]
pub fn halves(column: &[f64; SIZE]) -> [&[f64; 8]; 2] {
    let (halves, _) = column.as_chunks::<8>();
    [&halves[0], &halves[1]]
}

/// The same, to be changed.
#[inline(always)]
pub fn halves_mut(column: &mut [f64; SIZE]) -> &mut [[f64; 8]] {
    column.as_chunks_mut::<8>().0
}

/// A column of sixteen.
#[inline(always)]
pub fn load<V: Vector>(column: &[f64; SIZE]) -> [V; 2] {
    let [first, second] = halves(column);
    [V::load(first), V::load(second)]
}

/// column -= other scale.
#[inline(always)]
pub fn subtract<V: Vector>(column: &mut [f64; SIZE], other: [V; 2], scale: f64) {
    let scale = V::splat(scale);
    for (half, other) in halves_mut(column).iter_mut().zip(other) {
        V::load(half).minus_product(other, scale).store(half);
    }
}

/// What takes a pivot's column out of another: (column k) / pivot, without the pivot's own row.
struct Pivot<V> {
    multipliers: [V; 2],
    reciprocal: f64,
}

/// Whether the diagonal entry will do as pivot k.
#[inline(always)]
fn will_do<V: Vector>(column: &[f64; SIZE], k: usize) -> bool {
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

/// Takes two pivots, k and k + 1, out of a column, which is read and written once. `between` is the first one's multiplier of row k + 1.
#[inline(always)]
fn take_two<V: Vector>(column: &mut [f64; SIZE], k: usize, first: &Pivot<V>, second: &Pivot<V>, between: f64) {
    let x = column[k];
    let y = column[k + 1] - between * x;
    let (x, y) = (V::splat(x), V::splat(y));
    for (half, (first, second)) in halves_mut(column)
        .iter_mut()
        .zip(first.multipliers.into_iter().zip(second.multipliers))
    {
        V::load(half)
            .minus_product(first, x)
            .minus_product(second, y)
            .store(half);
    }
}

/// Solves `a x = b` for all columns of `b` in place; `a` is destroyed. The last column of `b` is full; of the others, only the first
/// `active(k)` have entries in rows 0 to k. Two pivots are taken at a time: writing the columns is what limits the speed.
///
/// # Errors
/// The size of the largest available pivot when it is zero or not a number.
#[inline(always)]
pub fn sixteen<V: Vector, const C: usize>(
    a: &mut [[f64; SIZE]; SIZE],
    b: &mut [[f64; SIZE]; C],
    active: impl Fn(usize) -> usize,
) -> Result<(), f64> {
    let mut reciprocals = [0.0; SIZE];
    let mut exchanged = false;
    let mut k = 0;
    while k < SIZE {
        if !will_do::<V>(&a[k], k) {
            exchange(k, a, b)?;
            exchanged = true;
        }
        let first: Pivot<V> = pivot(&a[k], k);
        reciprocals[k] = first.reciprocal;
        let between = a[k][k + 1] * first.reciprocal;
        let next = &mut a[k + 1];
        subtract(next, first.multipliers, next[k]);
        if !will_do::<V>(&a[k + 1], k + 1) {
            // The rows are exchanged in all columns, so the first pivot must have been taken out of all of them.
            for column in a[k + 2..].iter_mut().chain(b.iter_mut()) {
                subtract(column, first.multipliers, column[k]);
            }
            exchange(k + 1, a, b)?;
            exchanged = true;
            let second: Pivot<V> = pivot(&a[k + 1], k + 1);
            reciprocals[k + 1] = second.reciprocal;
            for column in a[k + 2..].iter_mut().chain(b.iter_mut()) {
                subtract(column, second.multipliers, column[k + 1]);
            }
        } else {
            let second: Pivot<V> = pivot(&a[k + 1], k + 1);
            reciprocals[k + 1] = second.reciprocal;
            for column in &mut a[k + 2..] {
                take_two(column, k, &first, &second, between);
            }
            let active = if exchanged { C - 1 } else { active(k + 1).min(C - 1) };
            for column in &mut b[..active] {
                take_two(column, k, &first, &second, between);
            }
            take_two(&mut b[C - 1], k, &first, &second, between);
        }
        k += 2;
    }
    let scale: [V; 2] = load(&reciprocals);
    for column in b.iter_mut() {
        for (half, scale) in halves_mut(column).iter_mut().zip(scale) {
            V::load(half).times(scale).store(half);
        }
    }
    Ok(())
}

/// The same for six unknowns in columns filled up to eight with zeros, all columns of `b` full.
///
/// # Errors
/// As [`sixteen`].
#[inline(always)]
pub fn six<V: Vector, const C: usize>(a: &mut Six, b: &mut [[f64; 8]; C]) -> Result<(), f64> {
    let mut reciprocals = [0.0; 8];
    for k in 0..6 {
        let size = a[k][k].abs();
        let bound = V::splat(size * (1.0 / PIVOT_RATIO));
        let larger = V::load(&a[k]).times(V::load(halves(&AFTER[k])[0])).any_beyond(bound);
        if larger | (size == 0.0) | size.is_nan() {
            exchange(k, a, b)?;
        }
        let reciprocal = 1.0 / a[k][k];
        reciprocals[k] = reciprocal;
        let others = V::load(halves(&OTHERS[k])[0]);
        let multipliers = V::load(&a[k]).times(others.times(V::splat(reciprocal)));
        for column in a[k + 1..].iter_mut().chain(b.iter_mut()) {
            let scale = V::splat(column[k]);
            V::load(column).minus_product(multipliers, scale).store(column);
        }
    }
    let scale = V::load(&reciprocals);
    for column in b.iter_mut() {
        V::load(column).times(scale).store(column);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::super::block::solve_columns;
    use super::super::super::vector::Portable;
    use super::*;

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
            solve_columns::<SIZE, 13, false>(&mut a1, &mut b1, |_| 12).unwrap();
            sixteen::<Portable, 13>(&mut a, &mut b, |_| 12).unwrap();
            for (x, expected) in b.as_flattened().iter().zip(b1.as_flattened()) {
                // The same operations in the same order, but for the product with the reciprocal.
                assert!((x - expected).abs() < 1e-9 * expected.abs().max(1.0), "{x} {expected}");
            }
        }
    }

    #[test]
    fn six_unknowns_in_eight_rows() {
        let mut seed = 3;
        let mut a = [[0.0; 8]; 6];
        let mut b = [[0.0; 8]; 3];
        for column in a.iter_mut().chain(b.iter_mut()) {
            column[..6].iter_mut().for_each(|x| *x = random(&mut seed));
        }
        let (matrix, right) = (a, b);
        six::<Portable, 3>(&mut a, &mut b).unwrap();
        for (x, right) in b.iter().zip(right) {
            assert_eq!(x[6..], [0.0; 2]);
            for i in 0..6 {
                let sum: f64 = (0..6).map(|j| matrix[j][i] * x[j]).sum();
                // Condition numbers of random matrices of six are some hundred.
                assert!((sum - right[i]).abs() < 1e-11, "{sum} {}", right[i]);
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
