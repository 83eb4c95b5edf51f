//! Runs with bit torque: the statistics, which chaos does not change.

use super::{NUDGES, Record};

/// Runs of one step.
const RUNS: usize = NUDGES.len();

/// A number of the runs with the step in question and of those with the finer one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// Of the runs with the step.
    pub runs: [f64; RUNS],
    /// Of those with the finer one.
    pub fine: [f64; RUNS],
}

impl Figure {
    /// Whether the ranges of the two threes overlap. Six draws of one distribution fall into two threes that lie apart
    /// in 2 of 20 ways, so this holds for 90 % of numbers that the step does not change.
    pub fn overlaps(&self) -> bool {
        let ends = |x: &[f64]| {
            x.iter()
                .fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)))
        };
        let (runs, fine) = (ends(&self.runs), ends(&self.fine));
        runs.0 <= fine.1 && fine.0 <= runs.1
    }

    /// Mean of the runs over that of the finer ones, less 1.
    pub fn excess(&self) -> f64 {
        self.runs.iter().sum::<f64>() / self.fine.iter().sum::<f64>() - 1.0
    }
}

/// Profiles of the RMS contact force along the tool. Distances: root sum square of the differences at all stations,
/// over the size of the finer runs' mean profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile {
    /// Between two runs of the step: least and largest.
    pub runs: [f64; 2],
    /// Between two finer runs.
    pub fine: [f64; 2],
    /// Between a run and a finer one.
    pub between: [f64; 2],
    /// The part of the latter that the scatter of the runs does not explain: the root of the mean square between the
    /// two groups minus the mean square within them; 0 if that is negative.
    pub systematic: f64,
    /// Size of the runs' mean profile over that of the finer ones, less 1.
    pub excess: f64,
    /// Part of the stations with contact where [`Figure::overlaps`].
    pub overlapping: f64,
}

impl Profile {
    fn of(runs: [&[f64]; RUNS], fine: [&[f64]; RUNS]) -> Self {
        let (whole, fine_whole) = (mean(&runs), mean(&fine));
        let scale = size(fine_whole.iter().copied()).max(f64::MIN_POSITIVE);
        let distance = |a: &[f64], b: &[f64]| size(a.iter().zip(b).map(|(x, y)| x - y)) / scale;
        let within = |group: [&[f64]; RUNS]| -> Vec<f64> {
            (0..RUNS)
                .flat_map(|i| (0..i).map(move |j| distance(group[i], group[j])))
                .collect()
        };
        let (in_runs, in_fine) = (within(runs), within(fine));
        let between: Vec<f64> = runs.iter().flat_map(|a| fine.iter().map(|b| distance(a, b))).collect();
        let square = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>() / x.len() as f64;
        let unexplained = square(&between) - 0.5 * (square(&in_runs) + square(&in_fine));
        // Stations without contact in all runs agree independently of the step, and do not count.
        let touched: Vec<Figure> = (0..whole.len())
            .map(|k| Figure {
                runs: runs.map(|run| run[k]),
                fine: fine.map(|run| run[k]),
            })
            .filter(|figure| figure.runs.iter().chain(&figure.fine).any(|&force| force > 0.0))
            .collect();
        let overlapping = touched.iter().filter(|figure| figure.overlaps()).count();
        Self {
            runs: ends(&in_runs),
            fine: ends(&in_fine),
            between: ends(&between),
            systematic: unexplained.max(0.0).sqrt(),
            excess: size(whole.iter().copied()) / scale - 1.0,
            overlapping: overlapping as f64 / touched.len().max(1) as f64,
        }
    }
}

/// Root sum square.
fn size(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|x| x * x).sum::<f64>().sqrt()
}

fn mean(group: &[&[f64]; RUNS]) -> Vec<f64> {
    (0..group[0].len())
        .map(|k| group.iter().map(|run| run[k]).sum::<f64>() / RUNS as f64)
        .collect()
}

/// Smallest and largest.
fn ends(values: &[f64]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::MAX, f64::MIN], |[low, high], &x| [low.min(x), high.max(x)])
}

/// Comparison of three runs with the step and three with a finer one, with starts perturbed by [`NUDGES`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Of both layers together.
    pub whole: Profile,
    /// Pipe-guide, guide-wall.
    pub layers: [Profile; 2],
    /// Of the bit speed (rad/s).
    pub ripple: Figure,
    /// Mean over time and stations.
    pub whirl_ratio: Figure,
}

impl Statistics {
    /// Compares `runs` with `fine`.
    pub fn of(runs: &[Record; RUNS], fine: &[Record; RUNS]) -> Self {
        let figure = |of: fn(&Record) -> f64| Figure {
            runs: runs.each_ref().map(of),
            fine: fine.each_ref().map(of),
        };
        let profile = |part: std::ops::Range<usize>| {
            let of = |records: &'_ [Record; RUNS]| records.each_ref().map(|record| record.rms[part.clone()].to_vec());
            let (runs, fine) = (of(runs), of(fine));
            Profile::of(runs.each_ref().map(Vec::as_slice), fine.each_ref().map(Vec::as_slice))
        };
        let layers = fine[0].layers();
        Self {
            whole: profile(0..fine[0].rms.len()),
            layers: layers.map(profile),
            ripple: figure(Record::ripple),
            whirl_ratio: figure(|record| record.whirl_ratio),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_share_a_point_overlap() {
        let figure = |fine| Figure {
            runs: [1.0, 3.0, 2.0],
            fine,
        };
        assert!(figure([3.0, 5.0, 4.0]).overlaps() && figure([1.5, 1.6, 1.7]).overlaps());
        assert!(!figure([3.1, 5.0, 4.0]).overlaps() && !figure([0.0, 0.9, 0.5]).overlaps());
        assert_eq!(figure([2.0, 4.0, 6.0]).excess(), -0.5);
    }

    #[test]
    fn a_systematic_difference_is_told_from_scatter() {
        // Profiles of 400 stations, 10 % larger with the step; each run scatters by 5 % of its own.
        let mut seed = 1_u32;
        let mut scatter = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // Uniform, variance 1.
            (f64::from(seed >> 8) / f64::from(1 << 24) - 0.5) * 12_f64.sqrt()
        };
        let mut group = |level: f64| [(); 3].map(|()| (0..400).map(|_| level + 0.05 * scatter()).collect::<Vec<_>>());
        let (runs, fine) = (group(1.1), group(1.0));
        let profile = Profile::of(runs.each_ref().map(Vec::as_slice), fine.each_ref().map(Vec::as_slice));
        // Distances of independent runs: sqrt(2) x 5 %, within 3 standard errors of 400 draws (0.3 %); between:
        // sqrt(10^2 + 7.1^2) %.
        for distance in profile.runs.into_iter().chain(profile.fine) {
            assert!((distance - 0.0707).abs() < 0.01, "{profile:?}");
        }
        assert!((profile.between[0] - 0.1225).abs() < 0.01, "{profile:?}");
        assert!((profile.systematic - 0.1).abs() < 0.01, "{profile:?}");
        assert!((profile.excess - 0.1).abs() < 0.01, "{profile:?}");
    }
}
