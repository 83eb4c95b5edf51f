//! Band LU with row pivoting, as in any textbook: the reference that the fast eliminations are held against. It knows nothing of
//! stations and joints but how far the entries lie from the diagonal, and refines its solution against the system itself.

use super::system::BlockSystem;
use super::{LinearSolver, Singular};

/// The reference solver: general, slower, allocates.
#[derive(Debug, Default)]
pub struct BandReference;

impl LinearSolver for BandReference {
    fn solve(&mut self, system: &BlockSystem, rhs: &mut [f64]) -> Result<(), Singular> {
        let n = system.layout().unknowns();
        let mut reach = 0;
        system.for_each_entry(|row, column, _| reach = reach.max(row.abs_diff(column)));
        let mut band = Band::zeros(n, reach);
        system.for_each_entry(|row, column, value| *band.at(row, column) += value);
        let pivots = band.factorise().map_err(|(unknown, pivot)| Singular {
            station: system.layout().station_of(unknown),
            pivot,
        })?;
        // Two rounds of refinement: the reference is to be right to rounding, and a wrong factorisation must show.
        let b = rhs.to_vec();
        let mut x = vec![0.0; n];
        let mut residual = b.clone();
        for _ in 0..3 {
            band.solve(&pivots, &mut residual);
            x.iter_mut().zip(&residual).for_each(|(x, correction)| *x += correction);
            system.residual(&x, &b, &mut residual);
        }
        rhs.copy_from_slice(&x);
        Ok(())
    }
}

/// Entries up to `reach` below and, for what pivoting fills in, twice that above the diagonal, by rows.
struct Band {
    n: usize,
    reach: usize,
    entries: Vec<f64>,
}

impl Band {
    fn zeros(n: usize, reach: usize) -> Self {
        Self {
            n,
            reach,
            entries: vec![0.0; n * (3 * reach + 1)],
        }
    }

    fn at(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.entries[row * (3 * self.reach + 1) + column + self.reach - row]
    }

    /// Becomes L (below the diagonal, its ones left out) and U; returns the row that was taken as pivot in each step, or the unknown
    /// without a pivot and the best that was found.
    fn factorise(&mut self) -> Result<Vec<usize>, (usize, f64)> {
        let mut pivots = Vec::with_capacity(self.n);
        for k in 0..self.n {
            let below = k + 1..(k + self.reach + 1).min(self.n);
            let right = k + 1..(k + 2 * self.reach + 1).min(self.n);
            let mut best = (k, self.at(k, k).abs());
            for row in below.clone() {
                let size = self.at(row, k).abs();
                if size > best.1 {
                    best = (row, size);
                }
            }
            if !(best.1 > 0.0 && best.1.is_finite()) {
                return Err((k, best.1));
            }
            for column in k..right.end {
                let upper = *self.at(k, column);
                *self.at(k, column) = std::mem::replace(self.at(best.0, column), upper);
            }
            pivots.push(best.0);
            let pivot = *self.at(k, k);
            for row in below {
                let factor = *self.at(row, k) / pivot;
                *self.at(row, k) = factor;
                for column in right.clone() {
                    let upper = *self.at(k, column);
                    *self.at(row, column) -= factor * upper;
                }
            }
        }
        Ok(pivots)
    }

    /// Solves with the factors; `x` is the right-hand side before.
    fn solve(&mut self, pivots: &[usize], x: &mut [f64]) {
        for (k, &pivot) in pivots.iter().enumerate() {
            x.swap(k, pivot);
            for row in k + 1..(k + self.reach + 1).min(self.n) {
                x[row] -= *self.at(row, k) * x[k];
            }
        }
        for k in (0..self.n).rev() {
            for column in k + 1..(k + 2 * self.reach + 1).min(self.n) {
                x[k] -= *self.at(k, column) * x[column];
            }
            x[k] /= *self.at(k, k);
        }
    }
}
