//! Block elimination along the stations from the top down, with pivoting inside each station's block.
//!
//! Station by station, S_i = D_i - L_{i-1} (S_{i-1}^-1 U_{i-1}); a station couples to the next through its twelve outgoing unknowns
//! only, so the Schur complement touches the next block's first twelve rows and columns.

use super::block::{solve_columns, subtract_product};
use super::system::{BlockParts, BlockSystem, Layout};
use super::{LinearSolver, Singular};

/// Columns solved per station: twelve of the coupling and the right-hand side.
const COLUMNS: usize = 13;

/// The default solver: cost linear in the number of stations, nothing allocated after construction.
pub struct StationElimination {
    instructions: Instructions,
    /// S^-1 (U, r) per station, by slot.
    plain: Vec<[[f64; 12]; COLUMNS]>,
    joint: Vec<[[f64; 24]; COLUMNS]>,
}

/// Which vector instructions the machine has. The results of two machines may differ in rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Instructions {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Instructions {
    fn of_this_machine() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("fma") && is_x86_feature_detected!("avx2") {
                if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
                    return Self::Avx512;
                }
                return Self::Avx2;
            }
        }
        Self::Portable
    }
}

impl StationElimination {
    /// Room for systems of this layout, with the best instructions of this machine.
    pub fn new(layout: &Layout) -> Self {
        Self::with(layout, Instructions::of_this_machine())
    }

    /// The same without special instructions: what the others are held against.
    pub fn portable(layout: &Layout) -> Self {
        Self::with(layout, Instructions::Portable)
    }

    fn with(layout: &Layout, instructions: Instructions) -> Self {
        let joint = (0..layout.stations()).filter(|&s| layout.is_large(s)).count();
        let plain = layout.stations() - joint;
        Self {
            instructions,
            plain: vec![[[0.0; 12]; COLUMNS]; plain],
            joint: vec![[[0.0; 24]; COLUMNS]; joint],
        }
    }

    #[inline(always)]
    fn run<const FUSED: bool>(&mut self, system: &mut BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        let BlockParts {
            layout,
            plain,
            joint,
            upper,
            lower,
        } = system.parts();
        let last = layout.stations() - 1;
        // What the station above adds: columns of L S^-1 (U, r).
        let mut carry = [[0.0; 12]; COLUMNS];
        for station in 0..=last {
            let slot = layout.slot(station);
            let offset = layout.offset(station);
            let mut outgoing = [[0.0; 12]; COLUMNS];
            if layout.is_large(station) {
                let block = &mut joint[slot].data.0;
                for (column, carry) in block.iter_mut().zip(&carry[..12]) {
                    column.iter_mut().zip(carry).for_each(|(x, c)| *x -= c);
                }
                let solution = &mut self.joint[slot];
                solution.iter_mut().for_each(|column| column.fill(0.0));
                if station < last {
                    for (column, coupling) in solution.iter_mut().zip(&upper[station].data.0) {
                        column[12..18].copy_from_slice(&coupling[..6]);
                        column[6..12].copy_from_slice(&coupling[6..]);
                    }
                }
                solution[12].copy_from_slice(&rhs[offset..offset + 24]);
                solution[12].iter_mut().zip(&carry[12]).for_each(|(x, c)| *x -= c);
                solve_columns::<24, COLUMNS, FUSED>(block, solution).map_err(|pivot| Singular { station, pivot })?;
                for (out, column) in outgoing.iter_mut().zip(solution.iter()) {
                    out[..6].copy_from_slice(&column[12..18]);
                    out[6..].copy_from_slice(&column[6..12]);
                }
            } else {
                let block = &mut plain[slot].data.0;
                for (column, carry) in block.iter_mut().zip(&carry[..12]) {
                    column.iter_mut().zip(carry).for_each(|(x, c)| *x -= c);
                }
                let solution = &mut self.plain[slot];
                if station < last {
                    solution[..12].copy_from_slice(&upper[station].data.0);
                } else {
                    solution[..12].fill([0.0; 12]);
                }
                solution[12].copy_from_slice(&rhs[offset..offset + 12]);
                solution[12].iter_mut().zip(&carry[12]).for_each(|(x, c)| *x -= c);
                solve_columns::<12, COLUMNS, FUSED>(block, solution).map_err(|pivot| Singular { station, pivot })?;
                outgoing = *solution;
            }
            if station < last {
                for (carry, out) in carry.iter_mut().zip(&outgoing) {
                    let mut product = [0.0; 12];
                    subtract_product::<12, 12, FUSED>(&mut product, &lower[station].data.0, out);
                    *carry = product.map(|x| -x);
                }
            }
        }
        // Back from the bit: x_i = S_i^-1 r_i - S_i^-1 U_i x_{i+1}.
        let mut below = [0.0; 12];
        for station in (0..=last).rev() {
            let (slot, offset) = (layout.slot(station), layout.offset(station));
            if layout.is_large(station) {
                let [gain @ .., x] = &self.joint[slot];
                let mut x = *x;
                subtract_product::<24, 12, FUSED>(&mut x, gain, &below);
                rhs[offset..offset + 24].copy_from_slice(&x);
                below.copy_from_slice(&x[..12]);
            } else {
                let [gain @ .., x] = &self.plain[slot];
                let mut x = *x;
                subtract_product::<12, 12, FUSED>(&mut x, gain, &below);
                rhs[offset..offset + 12].copy_from_slice(&x);
                below = x;
            }
        }
        Ok(())
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn run_avx2(&mut self, system: &mut BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        self.run::<true>(system, rhs)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl")]
    fn run_avx512(&mut self, system: &mut BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        self.run::<true>(system, rhs)
    }
}

impl LinearSolver for StationElimination {
    fn solve(&mut self, system: &mut BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
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
