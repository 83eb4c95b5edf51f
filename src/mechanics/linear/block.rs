//! Gaussian elimination of one small dense block against several right-hand sides, with partial pivoting.
//!
//! Every inner loop runs over a whole column of fixed length (entries that must not change get a zero multiplier), so that it becomes a
//! few vector instructions.

/// Solves `a x = b` for all columns of `b` in place; `a` is destroyed. `FUSED` uses fused multiply-add, which is fast only where the
/// processor has it.
///
/// # Errors
/// The size of the largest available pivot when it is zero or not a number.
#[inline(always)]
pub fn solve_columns<const N: usize, const C: usize, const FUSED: bool>(
    a: &mut [[f64; N]; N],
    b: &mut [[f64; N]; C],
) -> Result<(), f64> {
    let mut reciprocals = [0.0; N];
    for k in 0..N {
        let mut p = k;
        let mut size = a[k][k].abs();
        for (r, x) in a[k].iter().enumerate().skip(k + 1) {
            if x.abs() > size {
                size = x.abs();
                p = r;
            }
        }
        // A block that is singular but for rounding passes here; Newton's residual then tells.
        if size.is_nan() || size == 0.0 {
            return Err(size);
        }
        if p != k {
            a[k..]
                .iter_mut()
                .chain(b.iter_mut())
                .for_each(|column| column.swap(k, p));
        }
        let reciprocal = 1.0 / a[k][k];
        reciprocals[k] = reciprocal;
        let mut multipliers = [0.0; N];
        for r in k + 1..N {
            multipliers[r] = a[k][r] * reciprocal;
        }
        for column in a[k + 1..].iter_mut() {
            subtract::<N, FUSED>(column, &multipliers, column[k]);
        }
        for column in b.iter_mut() {
            subtract::<N, FUSED>(column, &multipliers, column[k]);
        }
    }
    for k in (0..N).rev() {
        let mut above = [0.0; N];
        above[..k].copy_from_slice(&a[k][..k]);
        for column in b.iter_mut() {
            let x = column[k] * reciprocals[k];
            subtract::<N, FUSED>(column, &above, x);
            column[k] = x;
        }
    }
    Ok(())
}

/// out -= a x, for a C-column `a` and a vector `x`.
#[inline(always)]
pub fn subtract_product<const N: usize, const C: usize, const FUSED: bool>(
    out: &mut [f64; N],
    a: &[[f64; N]; C],
    x: &[f64; C],
) {
    for (column, &scale) in a.iter().zip(x) {
        subtract::<N, FUSED>(out, column, scale);
    }
}

#[inline(always)]
fn subtract<const N: usize, const FUSED: bool>(column: &mut [f64; N], other: &[f64; N], scale: f64) {
    for r in 0..N {
        column[r] = if FUSED {
            other[r].mul_add(-scale, column[r])
        } else {
            column[r] - other[r] * scale
        };
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
        solve_columns::<3, 1, false>(&mut a, &mut b).unwrap();
        for (x, expected) in b[0].iter().zip([3.0, 1.0, 2.0]) {
            assert!((x - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn a_singular_block_is_an_error() {
        let mut a = [[1.0, 2.0], [2.0, 4.0]];
        let mut b = [[1.0, 1.0]];
        assert!(solve_columns::<2, 1, false>(&mut a, &mut b).is_err());
    }
}
