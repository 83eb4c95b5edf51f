//! Block elimination along the stations from the top down, with pivoting inside each station's block.
//!
//! Station by station, S_i = D_i - L_{i-1} (S_{i-1}^-1 U_{i-1}); a station couples to the next through its twelve outgoing unknowns
//! only, so the Schur complement touches the next block's first twelve rows and columns.

use std::hint::black_box;

use super::block::{solve_columns, subtract, subtract_product};
use super::reduction::{REDUCED, Reduction, active};
use super::system::{BlockSystem, Coupling, Layout};
use super::{LinearSolver, Singular};
use crate::simd::instructions::Instructions;

/// Columns solved per station: twelve of the coupling and the right-hand side.
const COLUMNS: usize = 13;

/// The default solver: cost linear in the number of stations, nothing allocated after construction.
pub struct StationElimination {
    instructions: Instructions,
    /// S^-1 (U, r) per station, by slot.
    plain: Vec<[[f64; 12]; COLUMNS]>,
    joint: Vec<[[f64; 24]; COLUMNS]>,
    /// The same of reduced joint stations.
    reduced: Vec<[[f64; REDUCED]; COLUMNS]>,
    /// How each joint station was reduced, if it was.
    reductions: Vec<Option<Reduction>>,
    reduce: bool,
}

impl StationElimination {
    /// Room for systems of this layout, with the best instructions of this machine.
    pub fn new(layout: &Layout) -> Self {
        Self::with(layout, Instructions::of_this_machine())
    }

    /// Every path that this machine can take, named: portable or with vector instructions, joint stations reduced or plain. They are
    /// held against each other.
    pub fn all_paths(layout: &Layout) -> Vec<(String, Self)> {
        let mut paths = Vec::new();
        for instructions in Instructions::all().filter(|i| i.available()) {
            for reduce in [true, false] {
                let mut solver = Self::with(layout, instructions);
                solver.reduce = reduce;
                let joints = if reduce { "reduced" } else { "plain" };
                paths.push((format!("{instructions:?}, {joints} joints"), solver));
            }
        }
        paths
    }

    /// Joint stations that the last solve reduced to 16 unknowns.
    pub fn reduced_stations(&self) -> usize {
        self.reductions.iter().flatten().count()
    }

    fn with(layout: &Layout, instructions: Instructions) -> Self {
        let joint = (0..layout.stations()).filter(|&s| layout.is_large(s)).count();
        let plain = layout.stations() - joint;
        Self {
            instructions,
            plain: vec![[[0.0; 12]; COLUMNS]; plain],
            joint: vec![[[0.0; 24]; COLUMNS]; joint],
            reduced: vec![[[0.0; REDUCED]; COLUMNS]; joint],
            reductions: vec![None; joint],
            reduce: true,
        }
    }

    #[inline(always)]
    fn run<const FUSED: bool>(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        let layout = system.layout();
        let last = layout.stations() - 1;
        let nothing = Coupling::zeros();
        // What the station above adds: columns of L S^-1 (U, r).
        let mut carry = [[0.0; 12]; COLUMNS];
        for station in 0..=last {
            let (slot, offset) = (layout.slot(station), layout.offset(station));
            let upper = system.upper.get(station).unwrap_or(&nothing);
            let singular = |pivot| Singular { station, pivot };
            let mut outgoing = [[0.0; 12]; COLUMNS];
            if layout.is_large(station) {
                let mut block = system.diagonal.joint[slot].data.0;
                for (column, carry) in block.iter_mut().zip(&carry[..12]) {
                    subtract_first(column, carry);
                }
                let mut right = [0.0; 24];
                right.copy_from_slice(&rhs[offset..offset + 24]);
                subtract_first(&mut right, &carry[12]);
                let reduction = if self.reduce && station < last {
                    Reduction::of(&block, &right)
                } else {
                    None
                };
                self.reductions[slot] = reduction;
                if let Some(reduction) = reduction {
                    let mut reduced = [[0.0; REDUCED]; REDUCED];
                    let solution = &mut self.reduced[slot];
                    reduction.reduce::<FUSED>(&block, &right, &mut reduced, &mut solution[12]);
                    for j in 0..6 {
                        solution[j] = reduction.pipe_coupling(&upper.pipe.data.0[j]);
                        solution[6 + j] = reduction.guide_coupling(&upper.guide.data.0[j]);
                    }
                    solve_columns::<REDUCED, COLUMNS, FUSED>(&mut reduced, solution, active).map_err(singular)?;
                    for (out, column) in outgoing.iter_mut().zip(solution.iter()) {
                        *out = reduction.outgoing(column);
                    }
                    reduction.add_offset(&mut outgoing[12]);
                } else {
                    let solution = &mut self.joint[slot];
                    solution.iter_mut().for_each(|column| column.fill(0.0));
                    for j in 0..6 {
                        solution[j][12..18].copy_from_slice(&upper.pipe.data.0[j]);
                        solution[6 + j][6..12].copy_from_slice(&upper.guide.data.0[j]);
                    }
                    solution[12] = right;
                    solve_columns::<24, COLUMNS, FUSED>(&mut block, solution, |_| 12).map_err(singular)?;
                    for (out, column) in outgoing.iter_mut().zip(solution.iter()) {
                        out[..6].copy_from_slice(&column[12..18]);
                        out[6..].copy_from_slice(&column[6..12]);
                    }
                }
            } else {
                let mut block = system.diagonal.plain[slot].data.0;
                for (column, carry) in block.iter_mut().zip(&carry[..12]) {
                    subtract_first(column, carry);
                }
                let solution = &mut self.plain[slot];
                for j in 0..6 {
                    solution[j][..6].copy_from_slice(&upper.pipe.data.0[j]);
                    solution[j][6..].fill(0.0);
                    solution[6 + j][..6].fill(0.0);
                    solution[6 + j][6..].copy_from_slice(&upper.guide.data.0[j]);
                }
                solution[12].copy_from_slice(&rhs[offset..offset + 12]);
                subtract_first(&mut solution[12], &carry[12]);
                solve_columns::<12, COLUMNS, FUSED>(&mut block, solution, |k| if k < 6 { 6 } else { 12 })
                    .map_err(singular)?;
                outgoing = *solution;
            }
            if station < last {
                couple::<FUSED>(&system.lower[station], &outgoing, &mut carry);
            }
        }
        // Back from the bit: x_i = S_i^-1 r_i - S_i^-1 U_i x_{i+1}.
        let mut below = [0.0; 12];
        for station in (0..=last).rev() {
            let (slot, offset) = (layout.slot(station), layout.offset(station));
            if !layout.is_large(station) {
                let [gain @ .., x] = &self.plain[slot];
                let mut x = *x;
                subtract_product::<12, 12, FUSED>(&mut x, gain, &below);
                rhs[offset..offset + 12].copy_from_slice(&x);
                below = x;
                continue;
            }
            let rhs = &mut rhs[offset..offset + 24];
            if let Some(reduction) = &self.reductions[slot] {
                let [gain @ .., x] = &self.reduced[slot];
                let mut x = *x;
                subtract_product::<REDUCED, 12, FUSED>(&mut x, gain, &below);
                let upper = &system.upper[station].pipe.data.0;
                reduction.expand::<FUSED>(&system.diagonal.joint[slot].data.0, &x, upper, &below, rhs);
            } else {
                let [gain @ .., x] = &self.joint[slot];
                let mut x = *x;
                subtract_product::<24, 12, FUSED>(&mut x, gain, &below);
                rhs.copy_from_slice(&x);
            }
            below.copy_from_slice(&rhs[..12]);
        }
        Ok(())
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn run_avx2(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        self.run::<true>(system, rhs)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl")]
    fn run_avx512(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        self.run::<true>(system, rhs)
    }
}

/// carry = lower * outgoing. Couplings do not mix pipe and guide.
#[inline(always)]
fn couple<const FUSED: bool>(lower: &Coupling, outgoing: &[[f64; 12]; COLUMNS], carry: &mut [[f64; 12]; COLUMNS]) {
    // Six rows fill up to a vector of eight; the minus sign makes the product a subtraction.
    let (mut pipe, mut guide) = ([[0.0; 8]; 6], [[0.0; 8]; 6]);
    for j in 0..6 {
        for i in 0..6 {
            pipe[j][i] = -lower.pipe.data.0[j][i];
            guide[j][i] = -lower.guide.data.0[j][i];
        }
    }
    for c in 0..COLUMNS {
        // Keeps the compiler from gathering eight columns into one vector, which is much slower than eight rows.
        let c = black_box(c);
        let (out, carry) = (&outgoing[c], &mut carry[c]);
        let (mut on_pipe, mut on_guide) = ([0.0; 8], [0.0; 8]);
        for j in 0..6 {
            subtract::<8, FUSED>(&mut on_pipe, &pipe[j], out[j]);
            subtract::<8, FUSED>(&mut on_guide, &guide[j], out[6 + j]);
        }
        carry[..6].copy_from_slice(&on_pipe[..6]);
        carry[6..].copy_from_slice(&on_guide[..6]);
    }
}

/// The first twelve entries of `column` less those of `carry`.
#[inline(always)]
fn subtract_first<const N: usize>(column: &mut [f64; N], carry: &[f64; 12]) {
    column.iter_mut().zip(carry).for_each(|(x, c)| *x -= c);
}

impl LinearSolver for StationElimination {
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        match self.instructions {
            Instructions::Portable => self.run::<false>(system, rhs),
            // SAFETY: chosen only where the processor was found to have these instructions.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => unsafe { self.run_avx2(system, rhs) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => unsafe { self.run_avx512(system, rhs) },
        }
    }
}
