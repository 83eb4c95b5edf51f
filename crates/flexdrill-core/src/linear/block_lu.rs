//! Block LU along the stations: the plain method. It finds the static start, and tests compare the chain with it.
//!
//! A station couples to the next one through its twelve outgoing unknowns only, so that with D the diagonal blocks, U
//! and L the couplings to the next station and back
//!
//! - forward:  S_0 = D_0,  S_i = D_i - L_{i-1} S_{i-1}^-1 U_{i-1},  r_i := r_i - L_{i-1} S_{i-1}^-1 r_{i-1}
//! - backward: x_i = S_i^-1 (r_i - U_i x_{i+1})

use super::block::{solve_columns, subtract_product};
use super::system::{BlockSystem, Coupling, JOINT_BLOCK, Layout, PLAIN_BLOCK};
use super::{LinearSolver, Singular};
use crate::simd::vector::Vector;
use crate::simd::{Instructions, Kernel};

/// Columns solved per station: twelve of the coupling and the right-hand side.
const COLUMNS: usize = 13;
/// Index of the right-hand side's column.
const RIGHT: usize = 12;

/// S^-1 (U, r) of a station with `N` unknowns, by columns.
type Solved<const N: usize> = [[f64; N]; COLUMNS];

/// Cost linear in the number of stations, nothing allocated after construction.
#[derive(Clone)]
pub struct BlockLu {
    instructions: Instructions,
    /// Of plain stations, by slot.
    plain: Vec<Solved<PLAIN_BLOCK>>,
    /// Of joint stations, by slot.
    joint: Vec<Solved<JOINT_BLOCK>>,
}

impl BlockLu {
    /// A solver for systems of this layout.
    pub fn new(layout: &Layout, instructions: Instructions) -> Self {
        let joint = (0..layout.stations()).filter(|&s| layout.is_large(s)).count();
        Self {
            instructions,
            plain: vec![[[0.0; PLAIN_BLOCK]; COLUMNS]; layout.stations() - joint],
            joint: vec![[[0.0; JOINT_BLOCK]; COLUMNS]; joint],
        }
    }
}

impl LinearSolver for BlockLu {
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        self.instructions.run(Solution {
            room: self,
            system,
            rhs,
        })
    }

    fn boxed_clone(&self) -> Box<dyn LinearSolver> {
        Box::new(self.clone())
    }
}

/// One solution, compiled for every width of vectors.
struct Solution<'a> {
    room: &'a mut BlockLu,
    system: &'a BlockSystem,
    rhs: &'a mut [f64],
}

impl Kernel for Solution<'_> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn run<V: Vector>(self) -> Result<(), Singular> {
        let Self { room, system, rhs } = self;
        let layout = system.layout();
        let last = layout.stations() - 1;
        // The last station couples to nothing below.
        let nothing = Coupling::zeros();
        // L S^-1 (U, r) of the station above.
        let mut carry = [[0.0; 12]; COLUMNS];
        for station in 0..=last {
            let (slot, first) = (layout.slot(station), layout.offset(station));
            let upper = system.upper.get(station).unwrap_or(&nothing);
            let singular = |pivot| Singular { station, pivot };
            let outgoing = if layout.is_large(station) {
                let (block, solved) = (&system.diagonal.joint[slot].data.0, &mut room.joint[slot]);
                forward::<V, JOINT_BLOCK>(block, upper, &carry, &rhs[first..], JOINT_OUTGOING, solved)
            } else {
                let (block, solved) = (&system.diagonal.plain[slot].data.0, &mut room.plain[slot]);
                forward::<V, PLAIN_BLOCK>(block, upper, &carry, &rhs[first..], PLAIN_OUTGOING, solved)
            }
            .map_err(singular)?;
            if station < last {
                couple::<V>(&system.lower[station], &outgoing, &mut carry);
            }
        }
        // Backward: the first twelve unknowns of a station are those that the station above couples to.
        let mut below = [0.0; 12];
        for station in (0..=last).rev() {
            let (slot, first) = (layout.slot(station), layout.offset(station));
            if layout.is_large(station) {
                backward::<V, JOINT_BLOCK>(&room.joint[slot], &below, &mut rhs[first..]);
            } else {
                backward::<V, PLAIN_BLOCK>(&room.plain[slot], &below, &mut rhs[first..]);
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
#[inline(always)]
fn forward<V: Vector, const N: usize>(
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
    solve_columns::<V, N, COLUMNS>(&mut schur, solved)?;
    let mut outgoing = [[0.0; 12]; COLUMNS];
    for (out, column) in outgoing.iter_mut().zip(solved.iter()) {
        out[..6].copy_from_slice(&column[pipe..pipe + 6]);
        out[6..].copy_from_slice(&column[guide..guide + 6]);
    }
    Ok(outgoing)
}

/// x = S^-1 r - S^-1 U x_below.
#[inline(always)]
fn backward<V: Vector, const N: usize>(solved: &Solved<N>, below: &[f64; 12], x: &mut [f64]) {
    let [gain @ .., right] = solved;
    let mut sum = *right;
    subtract_product::<V, N, 12>(&mut sum, gain, below);
    x[..N].copy_from_slice(&sum);
}

/// carry = L outgoing. Couplings do not mix pipe and guide.
#[inline(always)]
fn couple<V: Vector>(lower: &Coupling, outgoing: &[[f64; 12]; COLUMNS], carry: &mut [[f64; 12]; COLUMNS]) {
    let padded = |m: &[[f64; 6]; 6]| -> [V; 6] {
        let mut out = [V::splat(0.0); 6];
        for (out, column) in out.iter_mut().zip(m) {
            let mut rows = [0.0; 8];
            rows[..6].copy_from_slice(column);
            *out = V::load(&rows);
        }
        out
    };
    let (pipe, guide) = (padded(&lower.pipe.data.0), padded(&lower.guide.data.0));
    for (out, carry) in outgoing.iter().zip(carry) {
        for (first, matrix) in [(0, &pipe), (6, &guide)] {
            let mut sum = V::splat(0.0);
            for (column, &x) in matrix.iter().zip(&out[first..]) {
                sum = sum.plus_product(*column, V::splat(x));
            }
            let mut rows = [0.0; 8];
            sum.store(&mut rows);
            carry[first..first + 6].copy_from_slice(&rows[..6]);
        }
    }
}

/// The first twelve entries of `column` less those of `carry`.
#[inline(always)]
fn subtract_first<const N: usize>(column: &mut [f64; N], carry: &[f64; 12]) {
    column.iter_mut().zip(carry).for_each(|(x, c)| *x -= c);
}
