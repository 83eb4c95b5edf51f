//! Guyan's slaving of the inner stations to the ends of a span.

use nalgebra::DMatrix;

/// Slowest frequency of K x = omega^2 M x (rad/s); `None` where M is not positive.
pub(super) fn slowest(stiffness: &DMatrix<f64>, mass: &DMatrix<f64>) -> Option<f64> {
    // L^-1 K L^-T of K x = omega^2 L L^T x.
    let factor = mass.clone().cholesky()?.l();
    let left = factor.solve_lower_triangular(stiffness)?;
    let both = factor.solve_lower_triangular(&left.transpose())?;
    let symmetric = 0.5 * (&both + both.transpose());
    Some(symmetric.symmetric_eigenvalues().min().max(0.0).sqrt())
}

/// A span's inner nodes, their ends held (Guyan).
pub(super) struct Guyan {
    /// Displacements of all nodes by those of the two ends, twelve columns.
    pub(super) slaved: DMatrix<f64>,
    /// K_ii^-1.
    pub(super) compliance: DMatrix<f64>,
    /// Slowest inner frequency (rad/s).
    pub(super) slowest: f64,
}

impl Guyan {
    /// Of a span all of whose inner nodes are held too.
    pub(super) fn held(per: usize) -> Self {
        let n = 6 * (per + 1);
        let mut slaved = DMatrix::zeros(n, 12);
        for i in 0..6 {
            (slaved[(i, i)], slaved[(n - 6 + i, 6 + i)]) = (1.0, 1.0);
        }
        Self {
            slaved,
            compliance: DMatrix::zeros(n - 12, n - 12),
            slowest: f64::INFINITY,
        }
    }

    pub(super) fn of(stiffness: &DMatrix<f64>, mass: &DMatrix<f64>) -> Option<Self> {
        let n = stiffness.nrows();
        let held = Self::held(n / 6 - 1);
        let inner = n - 12;
        if inner == 0 {
            return Some(held);
        }
        let mut slaved = held.slaved;
        let part = |matrix: &DMatrix<f64>| matrix.view((6, 6), (inner, inner)).clone_owned();
        let mut to_ends = DMatrix::zeros(inner, 12);
        to_ends
            .view_mut((0, 0), (inner, 6))
            .copy_from(&stiffness.view((6, 0), (inner, 6)));
        to_ends
            .view_mut((0, 6), (inner, 6))
            .copy_from(&stiffness.view((6, n - 6), (inner, 6)));
        let inside = part(stiffness).cholesky()?;
        slaved.view_mut((6, 0), (inner, 12)).copy_from(&-inside.solve(&to_ends));
        Some(Self {
            slaved,
            compliance: inside.inverse(),
            slowest: slowest(&part(stiffness), &part(mass))?,
        })
    }
}
