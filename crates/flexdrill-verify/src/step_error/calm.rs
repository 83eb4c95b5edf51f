//! Two runs without bit torque, point by point.

use super::{Record, range};

/// Largest differences of two runs of the same motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calm {
    /// Of the bit speed, over its range.
    pub bit_speed: f64,
    /// Of a joint's coordinate, over that coordinate's own range.
    pub positions: f64,
    /// Joint of that difference, from 0 at the top.
    pub worst_joint: usize,
    /// Range of that coordinate (m).
    pub position_range: f64,
    /// Of the contact forces averaged over an interval, over the layer's range: pipe-guide, guide-wall. Forces
    /// of a station with little contact have hardly any range.
    pub forces: [f64; 2],
    /// Those ranges (N).
    pub force_ranges: [f64; 2],
}

impl Calm {
    /// Compares `coarse` with `fine`.
    pub fn of(coarse: &Record, fine: &Record) -> Self {
        let speeds = range(fine.bit_speed.iter().copied());
        let (mut positions, mut worst_joint, mut position_range) = (0.0, 0, 0.0);
        for coordinate in 0..fine.positions.first().map_or(0, Vec::len) {
            let of = |record: &Record| record.positions.iter().map(|at| at[coordinate]).collect::<Vec<_>>();
            let (a, b) = (of(coarse), of(fine));
            let own = range(b.iter().copied());
            let error = over(apart(&a, &b), own);
            if error > positions {
                (positions, worst_joint, position_range) = (error, coordinate / 2, own);
            }
        }
        let whole = fine
            .layers()
            .map(|layer| range(fine.forces.iter().flat_map(|at| at[layer.clone()].iter().copied())));
        let layers = fine.layers();
        let forces = [0, 1].map(|k| {
            let errors = (coarse.forces.iter().zip(&fine.forces))
                .map(|(a, b)| apart(&a[layers[k].clone()], &b[layers[k].clone()]));
            over(errors.fold(0.0, f64::max), whole[k])
        });
        Self {
            bit_speed: over(apart(&coarse.bit_speed, &fine.bit_speed), speeds),
            positions,
            worst_joint,
            position_range,
            forces,
            force_ranges: whole,
        }
    }
}

/// Largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (x, y)| m.max((x - y).abs()))
}

/// `difference / range`, and 0 for 0 / 0.
fn over(difference: f64, range: f64) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / range }
}
