//! The linear system of a Newton iteration and its solvers.
//!
//! Unknowns are ordered by station, so the matrix is block tridiagonal (Eq. 41 over the whole tool). A plain station
//! has a block of 12 (pipe node, guide node), a joint station one of 24 (end of the link above, guide, start of the
//! link below, multipliers, padding).

mod block;
mod block_lu;
mod increment;
#[cfg(test)]
mod sparse;
mod system;

#[cfg(test)]
pub(crate) use block::solve_columns;
pub(crate) use block::{PIVOT_RATIO, exchange};
pub use block_lu::BlockLu;
pub use increment::{ContactBlock, TangentIncrement, Touching};
#[cfg(test)]
pub use sparse::SparseReference;
pub(super) use system::add_columns;
pub use system::{BlockSystem, Layout};

/// A pivot is zero: the system has no unique solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Singular {
    /// Station of the block, 0-based.
    pub station: usize,
    /// Size of the best pivot found.
    pub pivot: f64,
}

/// Solves the block system of one Newton iteration.
pub trait LinearSolver: Send + Sync {
    /// Solves `system x = rhs`; `rhs` becomes x.
    ///
    /// # Errors
    /// When a block cannot be factorised.
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular>;

    /// Another with the same room.
    fn boxed_clone(&self) -> Box<dyn LinearSolver>;
}

impl Clone for Box<dyn LinearSolver> {
    fn clone(&self) -> Self {
        self.boxed_clone()
    }
}

#[cfg(test)]
mod tests;
