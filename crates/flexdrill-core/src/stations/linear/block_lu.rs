//! Block LU along the stations: the plain method.
//!
//! A station couples to the next one through its twelve outgoing unknowns only, so that with D the diagonal blocks, U
//! and L the couplings to the next station and back
//!
//! - forward:  S_0 = D_0,  S_i = D_i - L_{i-1} S_{i-1}^-1 U_{i-1},  r_i := r_i - L_{i-1} S_{i-1}^-1 r_{i-1}
//! - backward: x_i = S_i^-1 (r_i - U_i x_{i+1})

use super::LinearSolver;
use super::block::{solve_columns, subtract_product};
use super::system::{BlockSystem, Coupling};
use crate::dynamics::newton::Singular;
use crate::model::layout::{JOINT_BLOCK, Layout, PLAIN_BLOCK};

/// Columns solved per station: twelve of the coupling and the right-hand side.
const COLUMNS: usize = 13;
/// Index of the right-hand side's column.
const RIGHT: usize = 12;

/// S^-1 (U, r) of a station with `N` unknowns, by columns.
type Solved<const N: usize> = [[f64; N]; COLUMNS];

/// Cost linear in the number of stations, nothing allocated after construction.
#[derive(Clone)]
pub struct BlockLu {
    /// Of plain stations, by slot.
    plain: Vec<Solved<PLAIN_BLOCK>>,
    /// Of joint stations, by slot.
    joint: Vec<Solved<JOINT_BLOCK>>,
}

impl BlockLu {
    /// A solver for systems of this layout.
    pub fn new(layout: &Layout) -> Self {
        let joint = (0..layout.stations()).filter(|&s| layout.is_large(s)).count();
        Self {
            plain: vec![[[0.0; PLAIN_BLOCK]; COLUMNS]; layout.stations() - joint],
            joint: vec![[[0.0; JOINT_BLOCK]; COLUMNS]; joint],
        }
    }
}

impl LinearSolver for BlockLu {
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        let room = self;
        let layout = system.layout();
        let last = layout.stations() - 1;
        // The last station couples to nothing below.
        let nothing = Coupling::zeros();
        // L S^-1 (U, r) of the station above.
        let mut carry = [[0.0; 12]; COLUMNS];
        for station in 0..=last {
            let (slot, first) = (system.slots[station], layout.offset(station));
            let upper = system.upper.get(station).unwrap_or(&nothing);
            let singular = |pivot| Singular { station, pivot };
            let outgoing = if layout.is_large(station) {
                let (block, solved) = (&system.diagonal.joint[slot].data.0, &mut room.joint[slot]);
                forward::<JOINT_BLOCK>(block, upper, &carry, &rhs[first..], JOINT_OUTGOING, solved)
            } else {
                let (block, solved) = (&system.diagonal.plain[slot].data.0, &mut room.plain[slot]);
                forward::<PLAIN_BLOCK>(block, upper, &carry, &rhs[first..], PLAIN_OUTGOING, solved)
            }
            .map_err(singular)?;
            if station < last {
                couple(&system.lower[station], &outgoing, &mut carry);
            }
        }
        // Backward: the first twelve unknowns of a station are those that the station above couples to.
        let mut below = [0.0; 12];
        for station in (0..=last).rev() {
            let (slot, first) = (system.slots[station], layout.offset(station));
            if layout.is_large(station) {
                backward::<JOINT_BLOCK>(&room.joint[slot], &below, &mut rhs[first..]);
            } else {
                backward::<PLAIN_BLOCK>(&room.plain[slot], &below, &mut rhs[first..]);
            }
            below.copy_from_slice(&rhs[first..first + 12]);
        }
        Ok(())
    }
}

/// First unknowns in a station's block of the nodes that couple to the next station: pipe, guide.
const PLAIN_OUTGOING: [usize; 2] = [0, 6];
/// At a joint the pipe's is the start of the link below.
const JOINT_OUTGOING: [usize; 2] = [12, 6];

/// S = D - carry and S^-1 (U, r) into `solved`; returns its rows of the outgoing unknowns.
fn forward<const N: usize>(
    block: &[[f64; N]; N],
    upper: &Coupling,
    carry: &[[f64; 12]; COLUMNS],
    rhs: &[f64],
    [pipe, guide]: [usize; 2],
    solved: &mut Solved<N>,
) -> Result<[[f64; 12]; COLUMNS], f64> {
    let mut schur = *block;
    for (column, carry) in schur.iter_mut().zip(&carry[..12]) {
        subtract_first(column, carry);
    }
    for j in 0..6 {
        (solved[j], solved[6 + j]) = ([0.0; N], [0.0; N]);
        solved[j][pipe..pipe + 6].copy_from_slice(&upper.pipe.data.0[j]);
        solved[6 + j][guide..guide + 6].copy_from_slice(&upper.guide.data.0[j]);
    }
    solved[RIGHT].copy_from_slice(&rhs[..N]);
    subtract_first(&mut solved[RIGHT], &carry[RIGHT]);
    solve_columns::<N, COLUMNS>(&mut schur, solved)?;
    let mut outgoing = [[0.0; 12]; COLUMNS];
    for (out, column) in outgoing.iter_mut().zip(solved.iter()) {
        out[..6].copy_from_slice(&column[pipe..pipe + 6]);
        out[6..].copy_from_slice(&column[guide..guide + 6]);
    }
    Ok(outgoing)
}

/// x = S^-1 r - S^-1 U x_below.
fn backward<const N: usize>(solved: &Solved<N>, below: &[f64; 12], x: &mut [f64]) {
    let [gain @ .., right] = solved;
    let mut sum = *right;
    subtract_product::<N, 12>(&mut sum, gain, below);
    x[..N].copy_from_slice(&sum);
}

/// carry = L outgoing. Couplings do not mix pipe and guide.
fn couple(lower: &Coupling, outgoing: &[[f64; 12]; COLUMNS], carry: &mut [[f64; 12]; COLUMNS]) {
    for (out, carry) in outgoing.iter().zip(carry) {
        for (first, matrix) in [(0, &lower.pipe), (6, &lower.guide)] {
            let mut sum = [0.0; 6];
            for (column, &x) in matrix.data.0.iter().zip(&out[first..]) {
                sum.iter_mut().zip(column).for_each(|(sum, entry)| *sum += entry * x);
            }
            carry[first..first + 6].copy_from_slice(&sum);
        }
    }
}

/// The first twelve entries of `column` less those of `carry`.
fn subtract_first<const N: usize>(column: &mut [f64; N], carry: &[f64; 12]) {
    column.iter_mut().zip(carry).for_each(|(x, c)| *x -= c);
}
