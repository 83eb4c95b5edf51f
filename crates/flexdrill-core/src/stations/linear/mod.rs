//! The linear system over all stations, and its solvers.
//!
//! Unknowns are ordered by station, so the matrix is block tridiagonal (Eq. 41 over the whole tool). A plain station
//! has a block of 12 (pipe node, guide node), a joint station one of 24 (end of the link above, guide, start of the
//! link below, multipliers, padding).

mod block;
mod block_lu;
mod increment;
mod sparse;
mod system;
mod tests;

pub(crate) use block::solve_columns;
pub(crate) use block_lu::BlockLu;
pub(crate) use increment::{ContactBlock, TangentIncrement};
pub(crate) use sparse::SparseReference;
pub(crate) use system::{BlockSystem, add_columns};

use crate::dynamics::newton::Singular;

/// Solves the block system of one Newton iteration.
pub trait LinearSolver: Send + Sync {
    /// Solves `system x = rhs`; `rhs` becomes x.
    ///
    /// # Errors
    /// When a block cannot be factorised.
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular>;
}
