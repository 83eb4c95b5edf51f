//! faer's sparse LU with its symbolic part reused: the reference that the station elimination is held against.

use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, MatMut};

use super::LinearSolver;
use super::system::BlockSystem;
use crate::dynamics::newton::Singular;

/// The reference solver: general, slower, allocates.
#[derive(Clone, Default)]
pub struct SparseReference {
    symbolic: Option<SymbolicLu<usize>>,
}

impl LinearSolver for SparseReference {
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        let n = system.layout().unknowns();
        let mut triplets = Vec::new();
        system.for_each_entry(|row, column, value| triplets.push(Triplet::new(row, column, value)));
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &triplets)
            .map_err(|_| Singular { station: 0, pivot: 0.0 })?;
        let symbolic = match &self.symbolic {
            Some(symbolic) => symbolic.clone(),
            None => {
                let symbolic =
                    SymbolicLu::try_new(matrix.symbolic()).map_err(|_| Singular { station: 0, pivot: 0.0 })?;
                self.symbolic.insert(symbolic).clone()
            }
        };
        let lu =
            Lu::try_new_with_symbolic(symbolic, matrix.as_ref()).map_err(|_| Singular { station: 0, pivot: 0.0 })?;
        // Two rounds of refinement: the reference is to be right to rounding, and a wrong factorisation must show.
        let b = rhs.to_vec();
        let mut x = vec![0.0; n];
        let mut r = b.clone();
        for _ in 0..3 {
            let mut correction: Mat<f64> = Mat::from_fn(n, 1, |i, _| r[i]);
            let view: MatMut<'_, f64> = correction.as_mut();
            lu.solve_in_place(view);
            for (i, x) in x.iter_mut().enumerate() {
                *x += correction[(i, 0)];
            }
            system.residual(&x, &b, &mut r);
        }
        rhs.copy_from_slice(&x);
        Ok(())
    }
}
