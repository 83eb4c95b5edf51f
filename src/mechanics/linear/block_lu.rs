//! LU of one small dense block with partial pivoting, column by column so that the compiler can use vector registers.

use nalgebra::SMatrix;

/// A factorised N x N block.
#[derive(Debug, Clone)]
pub struct BlockLu<const N: usize> {
    /// Unit lower and upper factors in one matrix; the upper diagonal holds reciprocals.
    factors: SMatrix<f64, N, N>,
    pivots: [u8; N],
}

/// Pivots below this part of the block's largest entry are taken as zero: rounding of a block whose entries span
/// the range from inertia to contact stiffness.
const PIVOT_FLOOR: f64 = 1e-18;

impl<const N: usize> BlockLu<N> {
    /// An identity.
    pub fn new() -> Self {
        Self {
            factors: SMatrix::identity(),
            pivots: [0; N],
        }
    }

    /// Factorises `block`.
    ///
    /// # Errors
    /// The size of the largest available pivot when it vanishes or is not a number.
    #[inline(always)]
    pub fn factor(&mut self, block: &SMatrix<f64, N, N>) -> Result<(), f64> {
        self.factors = *block;
        let a = &mut self.factors.data.0;
        let floor = PIVOT_FLOOR * block.amax();
        for k in 0..N {
            let mut p = k;
            let mut largest = a[k][k].abs();
            for r in k + 1..N {
                if a[k][r].abs() > largest {
                    largest = a[k][r].abs();
                    p = r;
                }
            }
            if largest.is_nan() || largest <= floor {
                return Err(largest);
            }
            self.pivots[k] = p as u8;
            if p != k {
                for column in a.iter_mut() {
                    column.swap(k, p);
                }
            }
            let reciprocal = 1.0 / a[k][k];
            let mut multipliers = [0.0; N];
            for r in k + 1..N {
                multipliers[r] = a[k][r] * reciprocal;
            }
            a[k][k] = reciprocal;
            a[k][k + 1..].copy_from_slice(&multipliers[k + 1..]);
            for column in a[k + 1..].iter_mut() {
                let scale = column[k];
                // Rows up to k have a zero multiplier: whole-column updates of fixed length vectorise.
                for r in 0..N {
                    column[r] -= multipliers[r] * scale;
                }
            }
        }
        Ok(())
    }

    /// Solves for one right-hand side in place.
    #[inline(always)]
    pub fn solve(&self, b: &mut [f64; N]) {
        let a = &self.factors.data.0;
        for k in 0..N {
            b.swap(k, self.pivots[k] as usize);
        }
        for k in 0..N {
            let scale = b[k];
            for r in k + 1..N {
                b[r] -= a[k][r] * scale;
            }
        }
        for k in (0..N).rev() {
            b[k] *= a[k][k];
            let scale = b[k];
            for r in 0..k {
                b[r] -= a[k][r] * scale;
            }
        }
    }
}
