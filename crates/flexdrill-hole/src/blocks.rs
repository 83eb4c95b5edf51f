//! Linear systems of a beam: a block of 4 x 4 per node, coupled to its neighbours.

use nalgebra::{Matrix4, Vector4};

/// A block-tridiagonal matrix with symmetric coupling. Its blocks on the diagonal may be unsymmetric: the law of the bit is.
#[derive(Debug, Clone, Default)]
pub(crate) struct Blocks {
    /// Block i of the diagonal.
    pub diagonal: Vec<Matrix4<f64>>,
    /// Block that couples node i (rows) to node i + 1 (columns).
    pub upper: Vec<Matrix4<f64>>,
}

impl Blocks {
    /// Sets all blocks of `nodes` nodes to 0.
    pub(crate) fn reset(&mut self, nodes: usize) {
        self.diagonal.clear();
        self.diagonal.resize(nodes, Matrix4::zeros());
        self.upper.clear();
        self.upper.resize(nodes - 1, Matrix4::zeros());
    }

    /// `out` = this matrix times `x`.
    pub(crate) fn times(&self, x: &[Vector4<f64>], out: &mut Vec<Vector4<f64>>) {
        out.clear();
        out.extend(self.diagonal.iter().zip(x).map(|(block, x)| block * x));
        for (index, block) in self.upper.iter().enumerate() {
            out[index] += block * x[index + 1];
            out[index + 1] += block.tr_mul(&x[index]);
        }
    }

    /// Solves for a right-hand side in its place, by elimination from the first node to the last. Destroys the matrix.
    ///
    /// None if a pivot block is singular.
    pub(crate) fn solve(&mut self, rhs: &mut [Vector4<f64>]) -> Option<()> {
        let last = rhs.len() - 1;
        for index in 0..last {
            let pivot = self.diagonal[index].try_inverse()?;
            let coupling = self.upper[index];
            let eliminated = pivot * coupling;
            rhs[index] = pivot * rhs[index];
            self.diagonal[index + 1] -= coupling.tr_mul(&eliminated);
            rhs[index + 1] -= coupling.tr_mul(&rhs[index]);
            self.upper[index] = eliminated;
        }
        rhs[last] = self.diagonal[last].try_inverse()? * rhs[last];
        for index in (0..last).rev() {
            rhs[index] -= self.upper[index] * rhs[index + 1];
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_gives_its_right_hand_side_back() {
        let mut matrix = Blocks::default();
        matrix.reset(3);
        for (index, block) in matrix.diagonal.iter_mut().enumerate() {
            *block = Matrix4::from_fn(|row, column| ((row * 5 + column * 3 + index) % 7) as f64)
                + Matrix4::identity() * 20.0;
        }
        for block in &mut matrix.upper {
            *block = Matrix4::from_fn(|row, column| (row as f64) - 0.5 * (column as f64));
        }
        let wanted: Vec<_> = (0..3).map(|i| Vector4::new(1.0, -2.0, 3.0, f64::from(i))).collect();
        let mut rhs = Vec::new();
        matrix.times(&wanted, &mut rhs);
        matrix.clone().solve(&mut rhs).unwrap();
        for (got, wanted) in rhs.iter().zip(&wanted) {
            assert!((got - wanted).norm() < 1e-12, "{got}");
        }
    }

    #[test]
    fn a_singular_matrix_is_no_panic() {
        let mut matrix = Blocks::default();
        matrix.reset(2);
        assert!(matrix.solve(&mut [Vector4::zeros(); 2]).is_none());
    }
}
