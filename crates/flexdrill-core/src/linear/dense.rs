//! nalgebra's dense LU: the reference that the tests hold block LU against.

use nalgebra::{DMatrix, DVector};

use super::system::BlockSystem;
use super::{LinearSolver, Singular};

/// The reference solver: general, independent of the block structure, slow; it allocates.
pub struct DenseReference;

impl LinearSolver for DenseReference {
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        let n = system.layout().unknowns();
        let mut matrix = DMatrix::zeros(n, n);
        system.for_each_entry(|row, column, value| matrix[(row, column)] += value);
        let lu = matrix.lu();
        // Two rounds of refinement make the reference right to rounding. They also show a wrong factorisation, which they
        // cannot mend.
        let b = rhs.to_vec();
        let mut x = vec![0.0; n];
        let mut r = b.clone();
        for _ in 0..3 {
            let correction = lu
                .solve(&DVector::from_column_slice(&r))
                .ok_or(Singular { station: 0, pivot: 0.0 })?;
            for (x, correction) in x.iter_mut().zip(&correction) {
                *x += correction;
            }
            system.residual(&x, &b, &mut r);
        }
        rhs.copy_from_slice(&x);
        Ok(())
    }
}
