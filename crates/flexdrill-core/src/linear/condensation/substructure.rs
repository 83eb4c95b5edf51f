//! A pipe or the guide between two joint stations: its inner nodes condensed to its two ends.

use nalgebra::{DMatrix, Matrix6};

use super::pivots::{halves_mut, load};
use crate::simd::vector::Vector;

/// Block-tridiagonal matrix of one substructure from end to end: nodes 0 (top end) to m + 1 (bottom end), six unknowns
/// each. The ends' diagonal blocks are not part of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// Diagonal blocks of the inner nodes.
    pub diagonal: Vec<Matrix6<f64>>,
    /// Rows of node k, columns of node k + 1, k from 0 to m.
    pub upper: Vec<Matrix6<f64>>,
    /// Rows of node k + 1, columns of node k.
    pub lower: Vec<Matrix6<f64>>,
}

/// The inner nodes eliminated. With inner unknowns i and ends t, b: A_ii x_i = r_i - A_it x_t - A_ib x_b.
#[derive(Debug, Clone)]
pub struct Substructure {
    /// As it was before.
    pub chain: Chain,
    /// A_ii^-1, by columns of `padded` rows.
    pub inverse: Vec<f64>,
    /// A_ii^-1 (A_it, A_ib), twelve columns of `padded` rows.
    pub gain: Vec<f64>,
    /// -(A_ti; A_bi) A_ii^-1, by columns of twelve rows and four of padding: what a force inside puts on the ends.
    pub onto_ends: Vec<[f64; 16]>,
    /// Inner unknowns, filled up to a multiple of eight.
    pub padded: usize,
    /// -A_ti A_ii^-1 A_it.
    pub top: Matrix6<f64>,
    /// -A_bi A_ii^-1 A_ib.
    pub bottom: Matrix6<f64>,
    /// Rows of the top end, columns of the bottom end.
    pub upper: Matrix6<f64>,
    /// Rows of the bottom end, columns of the top end.
    pub lower: Matrix6<f64>,
}

/// Relative difference below which two chains count as one. Links of a regular tool differ by the rounding of their
/// geometry only; sharing keeps the matrices in the first-level cache. It can only slow the iteration down, by as much:
/// the residual is every link's own.
const SAME: f64 = 1e-11;

impl Chain {
    /// Whether `other` is the same but for rounding.
    pub fn is_close(&self, other: &Self) -> bool {
        let parts = |chain: &Self| {
            chain
                .diagonal
                .iter()
                .chain(&chain.upper)
                .chain(&chain.lower)
                .copied()
                .collect::<Vec<_>>()
        };
        let (mine, theirs) = (parts(self), parts(other));
        mine.len() == theirs.len() && mine.iter().zip(&theirs).all(|(a, b)| close(a.as_slice(), b.as_slice()))
    }
}

/// Whether two matrices of the same shape are the same but for rounding.
pub fn close(a: &[f64], b: &[f64]) -> bool {
    let scale = a.iter().chain(b).fold(0.0_f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * scale)
}

impl Substructure {
    /// Condenses `chain`, or `None` if its inner matrix is singular.
    pub fn of(chain: Chain) -> Option<Self> {
        let m = chain.diagonal.len();
        if m == 0 {
            return Some(Self {
                inverse: Vec::new(),
                gain: Vec::new(),
                onto_ends: Vec::new(),
                padded: 0,
                top: Matrix6::zeros(),
                bottom: Matrix6::zeros(),
                upper: chain.upper[0],
                lower: chain.lower[0],
                chain,
            });
        }
        let n = 6 * m;
        let mut inner = DMatrix::<f64>::zeros(n, n);
        for (k, block) in chain.diagonal.iter().enumerate() {
            inner.view_mut((6 * k, 6 * k), (6, 6)).copy_from(block);
        }
        for k in 1..m {
            inner.view_mut((6 * k - 6, 6 * k), (6, 6)).copy_from(&chain.upper[k]);
            inner.view_mut((6 * k, 6 * k - 6), (6, 6)).copy_from(&chain.lower[k]);
        }
        let mut to_ends = DMatrix::<f64>::zeros(n, 12);
        to_ends.view_mut((0, 0), (6, 6)).copy_from(&chain.lower[0]);
        to_ends.view_mut((n - 6, 6), (6, 6)).copy_from(&chain.upper[m]);
        let mut of_ends = DMatrix::<f64>::zeros(12, n);
        of_ends.view_mut((0, 0), (6, 6)).copy_from(&chain.upper[0]);
        of_ends.view_mut((6, n - 6), (6, 6)).copy_from(&chain.lower[m]);

        let lu = inner.full_piv_lu();
        let inverse = lu.try_inverse()?;
        let gain = lu.solve(&to_ends)?;
        let schur = -(&of_ends * &gain);
        let onto = -(&of_ends * &inverse);
        let padded = n.next_multiple_of(8);
        let columns = |m: &DMatrix<f64>| {
            let mut out = vec![0.0; padded * m.ncols()];
            for (to, from) in out.chunks_exact_mut(padded).zip(m.column_iter()) {
                to.iter_mut().zip(from.iter()).for_each(|(to, &from)| *to = from);
            }
            out
        };
        let part = |row, column| Matrix6::from(schur.fixed_view::<6, 6>(row, column));
        Some(Self {
            inverse: columns(&inverse),
            gain: columns(&gain),
            onto_ends: onto
                .column_iter()
                .map(|column| std::array::from_fn(|i| column.get(i).copied().unwrap_or(0.0)))
                .collect(),
            padded,
            top: part(0, 0),
            bottom: part(6, 6),
            upper: part(0, 6),
            lower: part(6, 0),
            chain,
        })
    }

    /// From the forces inside, `forces` (filled up with zeros): what they put on the ends (top, bottom), and in
    /// `clamped` the inner displacements while the ends do not move.
    #[inline(always)]
    pub fn condense<V: Vector>(&self, forces: &[f64], clamped: &mut [f64]) -> [f64; 16] {
        let mut ends = [V::splat(0.0); 2];
        for (column, &force) in self.onto_ends.iter().zip(forces) {
            let (force, column) = (V::splat(force), load::<V>(column));
            ends[0] = ends[0].plus_product(column[0], force);
            ends[1] = ends[1].plus_product(column[1], force);
        }
        clamped[..self.padded].fill(0.0);
        add_product::<V>(&self.inverse, self.padded, forces, clamped);
        let mut out = [0.0; 16];
        for (half, ends) in halves_mut(&mut out).iter_mut().zip(ends) {
            ends.store(half);
        }
        out
    }

    /// Inner displacements from those of the ends (top, bottom); `clamped` are those of [`Substructure::condense`].
    #[inline(always)]
    pub fn expand<V: Vector>(&self, ends: &[f64; 12], clamped: &mut [f64]) {
        let mut negative = *ends;
        for x in &mut negative {
            *x = -*x;
        }
        add_product::<V>(&self.gain, self.padded, &negative, clamped);
    }
}

/// out += a x, `a` by columns of `rows`, a multiple of eight.
#[inline(always)]
fn add_product<V: Vector>(a: &[f64], rows: usize, x: &[f64], out: &mut [f64]) {
    let (out, _) = out.as_chunks_mut::<8>();
    let mut first = 0;
    // Three vectors of eight at a time: the paper's link of five elements in one go.
    while first + 24 <= rows {
        columns::<V, 3>(a, rows, first, x, &mut out[first / 8..]);
        first += 24;
    }
    while first + 8 <= rows {
        columns::<V, 1>(a, rows, first, x, &mut out[first / 8..]);
        first += 8;
    }
}

/// The same for `N` vectors of rows.
#[inline(always)]
fn columns<V: Vector, const N: usize>(a: &[f64], rows: usize, first: usize, x: &[f64], out: &mut [[f64; 8]]) {
    // Even and odd columns apart: half as long a chain of additions.
    let (mut even, mut odd) = ([V::splat(0.0); N], [V::splat(0.0); N]);
    for (pair, x) in a.chunks_exact(2 * rows).zip(x.chunks_exact(2)) {
        let (first_column, second_column) = pair.split_at(rows);
        let (first_part, _) = first_column[first..first + 8 * N].as_chunks::<8>();
        let (second_part, _) = second_column[first..first + 8 * N].as_chunks::<8>();
        for n in 0..N {
            even[n] = even[n].plus_product(V::load(&first_part[n]), V::splat(x[0]));
            odd[n] = odd[n].plus_product(V::load(&second_part[n]), V::splat(x[1]));
        }
    }
    for n in 0..N {
        V::load(&out[n]).plus(even[n]).plus(odd[n]).store(&mut out[n]);
    }
}
