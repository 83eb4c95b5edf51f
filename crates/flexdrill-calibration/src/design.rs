//! Points at which the twin is run.

use crate::random::Random;

/// Number of random hypercubes of which the one with the most distant points is taken.
const TRIALS: usize = 50;

/// A Latin hypercube: `points` points in `dimensions` dimensions, each coordinate in (0, 1). Along every coordinate there is
/// exactly one point in each of `points` equal intervals (McKay, Beckman and Conover 1979). Of some random hypercubes it
/// is the one whose two nearest points are farthest from each other. The points are a function of the arguments.
pub fn latin_hypercube(points: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = Random::new(seed);
    let mut best = (f64::NEG_INFINITY, Vec::new());
    for _ in 0..TRIALS {
        let columns: Vec<Vec<f64>> = (0..dimensions)
            .map(|_| {
                let order = random.permutation(points);
                let inside = |interval: usize| (interval as f64 + random.uniform()) / points as f64;
                order.into_iter().map(inside).collect()
            })
            .collect();
        let all: Vec<Vec<f64>> = (0..points)
            .map(|point| columns.iter().map(|column| column[point]).collect())
            .collect();
        let apart = nearest(&all);
        if apart > best.0 {
            best = (apart, all);
        }
    }
    best.1
}

/// Square of the distance of the two nearest points; infinite with fewer than two.
fn nearest(points: &[Vec<f64>]) -> f64 {
    let mut least = f64::INFINITY;
    for (index, a) in points.iter().enumerate() {
        for b in &points[..index] {
            let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
            least = least.min(square);
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_interval_of_every_coordinate_has_one_point() {
        for (points, dimensions) in [(1, 1), (7, 3), (60, 7)] {
            let all = latin_hypercube(points, dimensions, 5);
            for coordinate in 0..dimensions {
                let mut intervals: Vec<usize> = all
                    .iter()
                    .map(|point| (point[coordinate] * points as f64) as usize)
                    .collect();
                intervals.sort_unstable();
                assert_eq!(intervals, (0..points).collect::<Vec<_>>());
            }
        }
        assert_eq!(latin_hypercube(9, 2, 1), latin_hypercube(9, 2, 1));
        assert_ne!(latin_hypercube(9, 2, 1), latin_hypercube(9, 2, 2));
    }
}
