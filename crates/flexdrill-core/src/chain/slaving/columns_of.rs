//! Matrices of a span as columns of vectors.

use nalgebra::DMatrix;

use super::{ForceRows, MotionColumns, SpanMatrix, row};
use crate::chain::columns::{EndColumn, TENSION};
use crate::simd::aligned::Aligned;

/// Lateral rows of the stations' maps, all stations of a span in the lanes of one column.
pub(super) fn lateral_columns(maps: &[[DMatrix<f64>; 2]]) -> Aligned<[SpanMatrix; 2]> {
    let mut lateral = Aligned([[[0.0; 16]; 12]; 2]);
    for (i, maps) in maps.iter().enumerate().skip(1) {
        for (columns, map) in lateral.iter_mut().zip(maps) {
            for (j, column) in columns.iter_mut().enumerate() {
                (column[i - 1], column[8 + i - 1]) = (map[(1, j)], map[(2, j)]);
            }
        }
    }
    lateral
}

/// A station's maps by columns: the motion is their sum, each times an unknown of the ends.
pub(super) fn motion_columns(maps: &[DMatrix<f64>; 2]) -> Aligned<MotionColumns> {
    let columns = |map: &DMatrix<f64>| {
        std::array::from_fn(|j| {
            let mut column = [0.0; 8];
            (0..6).for_each(|k| column[k] = map[(k, j)]);
            column
        })
    };
    Aligned([columns(&maps[0]), columns(&maps[1])])
}

/// The same maps by rows: the force on the ends is their sum, each times a component of the local force.
pub(super) fn force_rows(maps: &[DMatrix<f64>; 2]) -> Aligned<ForceRows> {
    let rows = |map: &DMatrix<f64>| std::array::from_fn(|k| end_column(|j| map[(k, j)]));
    Aligned([rows(&maps[0]), rows(&maps[1])])
}

/// Geometric stiffness with the axial force in the lane [`TENSION`].
pub(super) fn with_tension(
    mut matrices: Aligned<[SpanMatrix; 2]>,
    tension: &[[f64; 12]; 2],
) -> Aligned<[SpanMatrix; 2]> {
    for (columns, tension) in matrices.iter_mut().zip(tension) {
        for (column, tension) in columns.iter_mut().zip(tension) {
            column[TENSION] = *tension;
        }
    }
    matrices
}

pub(super) fn columns(matrix: &DMatrix<f64>) -> SpanMatrix {
    std::array::from_fn(|j| end_column(|i| matrix[(i, j)]))
}

/// A column of the twelve unknowns of both ends.
pub(super) fn end_column(of: impl Fn(usize) -> f64) -> EndColumn {
    let mut column = [0.0; 16];
    (0..12).for_each(|i| column[row(i)] = of(i));
    column
}
