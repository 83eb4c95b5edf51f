//! Gauss-Jordan elimination of one small dense block against several right-hand sides, with threshold pivoting.
//!
//! Every inner loop runs over a whole column of fixed length, so that it compiles to a few vector instructions; the
//! pivot row has a zero multiplier and stays unchanged. Eliminating above and below the pivot at once avoids a second
//! sweep over the right-hand sides.

use crate::chain::double::{PIVOT_RATIO, exchange};

/// Solves `a x = b` for all columns of `b` in place; `a` is destroyed.
///
/// # Errors
/// The size of the largest available pivot when it is zero or not a number.
pub fn solve_columns<const N: usize, const C: usize>(a: &mut [[f64; N]; N], b: &mut [[f64; N]; C]) -> Result<(), f64> {
    let mut reciprocals = [0.0; N];
    for k in 0..N {
        // The search has no branch inside, so that it runs in vectors; exchanges are rare and cold.
        let size = a[k][k].abs();
        let mut small = size.is_nan() | (size == 0.0);
        for (r, x) in a[k].iter().enumerate() {
            small |= (r > k) & (x.abs() * PIVOT_RATIO > size);
        }
        if small {
            exchange(k, a, b)?;
        }
        let reciprocal = 1.0 / a[k][k];
        reciprocals[k] = reciprocal;
        let mut multipliers = [0.0; N];
        for r in 0..N {
            multipliers[r] = if r == k { 0.0 } else { a[k][r] * reciprocal };
        }
        // Columns left of the pivot are eliminated already and not read again.
        for column in a[k + 1..].iter_mut().chain(b.iter_mut()) {
            subtract::<N>(column, &multipliers, column[k]);
        }
    }
    // `a` is diagonal now; the division by the pivots comes last, so that elimination works on unscaled rows.
    for column in b.iter_mut() {
        for r in 0..N {
            column[r] *= reciprocals[r];
        }
    }
    Ok(())
}

/// out -= a x, for a C-column `a` and a vector `x`.
pub fn subtract_product<const N: usize, const C: usize>(out: &mut [f64; N], a: &[[f64; N]; C], x: &[f64; C]) {
    for (column, &scale) in a.iter().zip(x) {
        subtract::<N>(out, column, scale);
    }
}

/// column -= other scale.
fn subtract<const N: usize>(column: &mut [f64; N], other: &[f64; N], scale: f64) {
    for (x, y) in column.iter_mut().zip(other) {
        *x -= y * scale;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_that_needs_pivoting_is_solved() {
        // Zero diagonal: fails without pivoting. x = (3, 1, 2) by hand.
        let mut a = [[0.0, 1.0, 2.0], [2.0, 0.0, 1.0], [1.0, 4.0, 0.0]];
        let mut b = [[4.0, 11.0, 7.0]];
        solve_columns::<3, 1>(&mut a, &mut b).unwrap();
        for (x, expected) in b[0].iter().zip([3.0, 1.0, 2.0]) {
            assert!((x - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn leading_zeros_of_a_column_survive_an_exchange() {
        // The first column of b has no entry in its first row until the exchange brings one there. x = (5, 0) and (1,
        // 2) by hand.
        let mut a = [[0.0, 2.0], [-1.0, 4.0]];
        let mut b = [[0.0, 10.0], [-2.0, 10.0]];
        solve_columns::<2, 2>(&mut a, &mut b).unwrap();
        for (column, expected) in b.iter().zip([[5.0, 0.0], [1.0, 2.0]]) {
            assert!((column[0] - expected[0]).abs() < 1e-14 && (column[1] - expected[1]).abs() < 1e-14);
        }
    }

    #[test]
    fn a_singular_block_is_an_error() {
        let mut a = [[1.0, 2.0], [2.0, 4.0]];
        let mut b = [[1.0, 1.0]];
        assert!(solve_columns::<2, 1>(&mut a, &mut b).is_err());
    }

    #[test]
    fn a_block_that_is_not_a_number_is_an_error() {
        let mut a = [[f64::NAN, 2.0], [2.0, 4.0]];
        let mut b = [[1.0, 1.0]];
        assert!(solve_columns::<2, 1>(&mut a, &mut b).is_err());
    }
}
