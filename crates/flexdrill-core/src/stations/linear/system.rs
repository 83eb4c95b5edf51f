//! Storage of the block-tridiagonal system.

use nalgebra::SMatrix;

use crate::model::layout::{JOINT_BLOCK, Layout, PLAIN_BLOCK};

/// Coupling of a station's outgoing nodes with the same nodes of the next station. Pipe and guide meet inside stations
/// only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// Pipe node towards the bit with the next pipe node.
    pub pipe: SMatrix<f64, 6, 6>,
    /// Guide nodes.
    pub guide: SMatrix<f64, 6, 6>,
}

impl Coupling {
    /// None.
    pub fn zeros() -> Self {
        Self {
            pipe: SMatrix::zeros(),
            guide: SMatrix::zeros(),
        }
    }

    /// An entry of the 12 x 12 matrix over pipe and guide.
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        match (row < 6, column < 6) {
            (true, true) => self.pipe[(row, column)],
            (false, false) => self.guide[(row - 6, column - 6)],
            _ => 0.0,
        }
    }

    /// The pipe's or the guide's part with the index in it, for index `k` of the twelve.
    fn part(&mut self, k: usize) -> (&mut SMatrix<f64, 6, 6>, usize) {
        if k < 6 {
            (&mut self.pipe, k)
        } else {
            (&mut self.guide, k - 6)
        }
    }

    fn clear_row(&mut self, row: usize) {
        let (part, row) = self.part(row);
        part.row_mut(row).fill(0.0);
    }

    fn clear_column(&mut self, column: usize) {
        let (part, column) = self.part(column);
        part.column_mut(column).fill(0.0);
    }
}

impl Layout {
    /// Whether the station has a block of 24.
    pub fn is_large(&self, station: usize) -> bool {
        self.offset(station + 1) - self.offset(station) == JOINT_BLOCK
    }

    /// Index of each station's block among those of its size.
    pub fn slots(&self) -> Vec<usize> {
        let mut made = [0; 2];
        let mut slot = |station| {
            let of_size = &mut made[usize::from(self.is_large(station))];
            *of_size += 1;
            *of_size - 1
        };
        (0..self.stations()).map(&mut slot).collect()
    }

    /// Local index in the station's block of outgoing unknown `k` (0..6 the pipe node towards the bit, 6..12 the
    /// guide).
    pub fn outgoing(&self, station: usize, k: usize) -> usize {
        if self.is_large(station) && k < 6 { k + 12 } else { k }
    }
}

/// Diagonal blocks.
#[derive(Debug, Clone)]
pub struct Diagonal {
    /// Of plain stations, by slot.
    pub plain: Vec<SMatrix<f64, 12, 12>>,
    /// Of joint stations, by slot.
    pub joint: Vec<SMatrix<f64, 24, 24>>,
}

impl Diagonal {
    /// Takes another diagonal's entries; the layouts must be the same.
    pub fn copy_from(&mut self, other: &Self) {
        self.plain.copy_from_slice(&other.plain);
        self.joint.copy_from_slice(&other.joint);
    }
}

/// Diagonal blocks and couplings.
#[derive(Debug, Clone)]
pub struct BlockSystem {
    layout: Layout,
    /// Index of each station's block among those of its size.
    pub slots: Vec<usize>,
    /// Diagonal blocks.
    pub diagonal: Diagonal,
    /// Rows of station i (outgoing), columns of station i + 1.
    pub upper: Vec<Coupling>,
    /// Rows of station i + 1, columns of station i (outgoing).
    pub lower: Vec<Coupling>,
}

impl BlockSystem {
    /// A zero system.
    pub fn new(layout: Layout) -> Self {
        let joint = (0..layout.stations())
            .filter(|&station| layout.is_large(station))
            .count();
        let couplings = layout.stations().saturating_sub(1);
        Self {
            diagonal: Diagonal {
                plain: vec![SMatrix::zeros(); layout.stations() - joint],
                joint: vec![SMatrix::zeros(); joint],
            },
            upper: vec![Coupling::zeros(); couplings],
            lower: vec![Coupling::zeros(); couplings],
            slots: layout.slots(),
            layout,
        }
    }

    /// Numbering of its unknowns.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.diagonal.plain.iter_mut().for_each(|block| block.fill(0.0));
        self.diagonal.joint.iter_mut().for_each(|block| block.fill(0.0));
        self.upper.fill(Coupling::zeros());
        self.lower.fill(Coupling::zeros());
    }

    /// Takes another system's entries; the layouts must be the same.
    pub fn copy_from(&mut self, other: &Self) {
        self.diagonal.copy_from(&other.diagonal);
        self.upper.copy_from_slice(&other.upper);
        self.lower.copy_from_slice(&other.lower);
    }

    /// Adds to an entry of a station's diagonal block.
    #[inline]
    pub fn add(&mut self, station: usize, row: usize, column: usize, value: f64) {
        *self.entry(station, row, column) += value;
    }

    /// An entry of a station's diagonal block.
    #[inline]
    pub fn entry(&mut self, station: usize, row: usize, column: usize) -> &mut f64 {
        let slot = self.slots[station];
        if self.layout.is_large(station) {
            &mut self.diagonal.joint[slot][(row, column)]
        } else {
            &mut self.diagonal.plain[slot][(row, column)]
        }
    }

    /// Adds a matrix, given by columns, times `factor` at (`first`, `first`) of a station's diagonal block.
    #[inline]
    pub fn add_scaled<const N: usize>(&mut self, station: usize, first: usize, matrix: &[[f64; N]; N], factor: f64) {
        let slot = self.slots[station];
        if self.layout.is_large(station) {
            add_columns(&mut self.diagonal.joint[slot].data.0, first, matrix, factor);
        } else {
            add_columns(&mut self.diagonal.plain[slot].data.0, first, matrix, factor);
        }
    }

    /// Adds a dense N x N matrix at (`row`, `column`) of a station's diagonal block.
    #[inline]
    pub fn add_block<const N: usize>(
        &mut self,
        station: usize,
        row: usize,
        column: usize,
        matrix: &SMatrix<f64, N, N>,
    ) {
        let slot = self.slots[station];
        if self.layout.is_large(station) {
            let mut view = self.diagonal.joint[slot].fixed_view_mut::<N, N>(row, column);
            view += matrix;
        } else {
            let mut view = self.diagonal.plain[slot].fixed_view_mut::<N, N>(row, column);
            view += matrix;
        }
    }

    /// Makes an unknown's equation `x = rhs`, decoupled from all others.
    pub fn hold(&mut self, unknown: usize) {
        let station = self.layout.station_of(unknown);
        let local = unknown - self.layout.offset(station);
        let slot = self.slots[station];
        if self.layout.is_large(station) {
            self.diagonal.joint[slot].row_mut(local).fill(0.0);
            self.diagonal.joint[slot].column_mut(local).fill(0.0);
            self.diagonal.joint[slot][(local, local)] = 1.0;
        } else {
            self.diagonal.plain[slot].row_mut(local).fill(0.0);
            self.diagonal.plain[slot].column_mut(local).fill(0.0);
            self.diagonal.plain[slot][(local, local)] = 1.0;
        }
        if station > 0 && local < 12 {
            self.upper[station - 1].clear_column(local);
            self.lower[station - 1].clear_row(local);
        }
        if station + 1 < self.layout.stations()
            && let Some(k) = (0..12).find(|&k| self.layout.outgoing(station, k) == local)
        {
            self.upper[station].clear_row(k);
            self.lower[station].clear_column(k);
        }
    }

    /// Visits every stored entry as (row, column, value) in global indices; zeros inside blocks included, so that the
    /// pattern does not depend on the values.
    pub fn for_each_entry(&self, mut visit: impl FnMut(usize, usize, f64)) {
        let layout = &self.layout;
        for station in 0..layout.stations() {
            let offset = layout.offset(station);
            let slot = self.slots[station];
            let size = if layout.is_large(station) {
                JOINT_BLOCK
            } else {
                PLAIN_BLOCK
            };
            for column in 0..size {
                for row in 0..size {
                    let value = if layout.is_large(station) {
                        self.diagonal.joint[slot][(row, column)]
                    } else {
                        self.diagonal.plain[slot][(row, column)]
                    };
                    visit(offset + row, offset + column, value);
                }
            }
            if station + 1 < layout.stations() {
                let next = layout.offset(station + 1);
                for i in 0..12 {
                    let out = offset + layout.outgoing(station, i);
                    for j in 0..12 {
                        visit(out, next + j, self.upper[station].entry(i, j));
                        visit(next + j, out, self.lower[station].entry(j, i));
                    }
                }
            }
        }
    }

    /// r = rhs - A x.
    pub fn residual(&self, x: &[f64], rhs: &[f64], r: &mut [f64]) {
        r.copy_from_slice(rhs);
        self.for_each_entry(|row, column, value| r[row] -= value * x[column]);
    }
}

/// Adds a matrix times `factor` at (`first`, `first`) of one as large or larger, both given by columns.
#[inline(always)]
pub fn add_columns<const N: usize, const M: usize>(
    to: &mut [[f64; M]; M],
    first: usize,
    matrix: &[[f64; N]; N],
    factor: f64,
) {
    for (to, column) in to[first..first + N].iter_mut().zip(matrix) {
        for (x, y) in to[first..first + N].iter_mut().zip(column) {
            *x += factor * y;
        }
    }
}
