//! The guide between two joint stations while it touches the wall there: its inner nodes eliminated one by one.

use nalgebra::Matrix6;

use super::substructure::Substructure;
use super::{PaddedColumns, pivots};
use crate::linear::increment::{ContactBlock, Touching};
use crate::simd::vector::Vector;

/// Columns of an inner node: the next node's six, the top end's six, the right-hand side.
pub const COLUMNS: usize = 13;
/// First of the top end's.
pub const TOP: usize = 6;
/// The right-hand side.
pub const RIGHT: usize = 12;

/// The solved columns of one inner node, rows filled up to eight.
pub type Solved = [[f64; 8]; COLUMNS];

/// What the span puts on its ends.
#[derive(Debug, Clone, Copy)]
pub struct InterfaceMatrices {
    /// On the top end's diagonal block.
    pub top: PaddedColumns,
    /// On the bottom end's.
    pub bottom: PaddedColumns,
    /// Rows of the top end, columns of the bottom end.
    pub upper: PaddedColumns,
    /// Rows of the bottom end, columns of the top end.
    pub lower: PaddedColumns,
    /// On the ends' right-hand sides.
    pub right: [[f64; 8]; 2],
}

impl InterfaceMatrices {
    /// Nothing put on the ends.
    pub const NOTHING: Self = Self {
        top: [[0.0; 8]; 6],
        bottom: [[0.0; 8]; 6],
        upper: [[0.0; 8]; 6],
        lower: [[0.0; 8]; 6],
        right: [[0.0; 8]; 2],
    };
}

/// A 6 x 6 matrix with its columns filled up to eight.
pub fn six(m: &Matrix6<f64>) -> PaddedColumns {
    std::array::from_fn(|j| std::array::from_fn(|i| if i < 6 { m[(i, j)] } else { 0.0 }))
}

/// Matrices of an inner node and its neighbours, filled up to eight rows.
#[derive(Debug, Clone)]
pub struct GuideChain {
    pub(super) diagonal: Vec<PaddedColumns>,
    pub(super) upper: Vec<PaddedColumns>,
    pub(super) lower: Vec<PaddedColumns>,
}

impl GuideChain {
    /// Of a guide's chain.
    pub fn of(substructure: &Substructure) -> Self {
        let all = |m: &[Matrix6<f64>]| m.iter().map(six).collect();
        Self {
            diagonal: all(&substructure.chain.diagonal),
            upper: all(&substructure.chain.upper),
            lower: all(&substructure.chain.lower),
        }
    }

    /// Eliminates the inner nodes from the top down; `contact` and `touching` are the inner stations', `forces` their
    /// right-hand sides, six per node.
    ///
    /// # Errors
    /// Inner node and size of a pivot that vanished.
    #[inline(always)]
    pub fn condense<V: Vector>(
        &self,
        touching: &[Touching],
        contact: &[ContactBlock],
        forces: &[f64],
        solved: &mut [Solved],
    ) -> Result<InterfaceMatrices, (usize, f64)> {
        let mut out = InterfaceMatrices {
            upper: self.upper[0],
            ..InterfaceMatrices::NOTHING
        };
        // What the node above adds: columns of L S^-1 (U, A_t, r).
        let mut carry = [[0.0; 8]; COLUMNS];
        let last = solved.len() - 1;
        for (k, solved) in solved.iter_mut().enumerate() {
            let mut block = self.diagonal[k];
            if touching[k] == Touching::Guide {
                for (column, change) in block.iter_mut().zip(&contact[k][6..]) {
                    for (x, c) in column.iter_mut().zip(&change[6..]) {
                        *x += c;
                    }
                }
            }
            for j in 0..6 {
                for i in 0..8 {
                    block[j][i] -= carry[j][i];
                    solved[j][i] = self.upper[k + 1][j][i];
                    solved[TOP + j][i] = if k == 0 {
                        self.lower[0][j][i]
                    } else {
                        -carry[TOP + j][i]
                    };
                }
            }
            let mut right = [0.0; 8];
            right[..6].copy_from_slice(&forces[6 * k..6 * k + 6]);
            for i in 0..8 {
                solved[RIGHT][i] = right[i] - carry[RIGHT][i];
            }
            pivots::six::<V, COLUMNS>(&mut block, solved).map_err(|pivot| (k, pivot))?;
            // The top end's coupling to this node is what `upper` holds now; it moves on to the next node.
            let mut onto_next = [[0.0; 8]; 6];
            for j in 0..6 {
                times::<V>(&out.upper, &solved[j], &mut onto_next[j]);
                times::<V>(&out.upper, &solved[TOP + j], &mut out.top[j]);
            }
            times::<V>(&out.upper, &solved[RIGHT], &mut out.right[0]);
            out.upper = onto_next;
            carry = [[0.0; 8]; COLUMNS];
            for (carry, solved) in carry.iter_mut().zip(solved.iter()) {
                times::<V>(&self.lower[k + 1], solved, carry);
                for x in carry.iter_mut() {
                    *x = -*x;
                }
            }
            if k == last {
                for j in 0..6 {
                    out.bottom[j] = negative(&carry[j]);
                    out.lower[j] = negative(&carry[TOP + j]);
                }
                out.right[1] = negative(&carry[RIGHT]);
            }
        }
        Ok(out)
    }
}

/// Inner displacements from the bottom up, six per node, from those of the ends.
#[inline(always)]
pub fn expand<V: Vector>(solved: &[Solved], top: &[f64; 6], bottom: &[f64; 6], mut set: impl FnMut(usize, &[f64; 8])) {
    let mut below = [0.0; 8];
    below[..6].copy_from_slice(bottom);
    for (k, solved) in solved.iter().enumerate().rev() {
        let mut sum = V::load(&solved[RIGHT]);
        for j in 0..6 {
            sum = sum
                .minus_product(V::load(&solved[j]), V::splat(below[j]))
                .minus_product(V::load(&solved[TOP + j]), V::splat(top[j]));
        }
        let mut x = [0.0; 8];
        sum.store(&mut x);
        set(k, &x);
        below = x;
    }
}

/// out -= m x.
#[inline(always)]
fn times<V: Vector>(m: &PaddedColumns, x: &[f64; 8], out: &mut [f64; 8]) {
    let mut sum = V::load(out);
    for (column, &x) in m.iter().zip(x) {
        sum = sum.minus_product(V::load(column), V::splat(x));
    }
    sum.store(out);
}

#[inline(always)]
fn negative(x: &[f64; 8]) -> [f64; 8] {
    let mut out = *x;
    for x in &mut out {
        *x = -*x;
    }
    out
}
