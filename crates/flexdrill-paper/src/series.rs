//! Measures of a series in time: root mean square, period, collisions.

/// Root mean square.
pub fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}

/// Root mean square about the mean.
pub(super) fn spread(values: impl ExactSizeIterator<Item = f64> + Clone) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    (values.map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Smallest and largest value.
pub(super) fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// Period of a series.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Period {
    /// Period (s); 0 if the series does not repeat.
    pub period: f64,
    /// Autocorrelation at that lag: 1 for an exact repetition, 0 for none.
    pub strength: f64,
}

/// Part of the best autocorrelation that a shorter lag must reach to be the period instead of its multiple.
const AS_GOOD: f64 = 0.85;

/// The dominant period of a series with samples `interval` (s) apart: the shortest lag between `shortest` (s) and half
/// of the series at which the autocorrelation has a peak that is (nearly) its highest there.
pub fn dominant_period(values: &[f64], interval: f64, shortest: f64) -> Period {
    let count = values.len();
    let (from, to) = ((shortest / interval).ceil() as usize, count / 2);
    if from < 1 || to <= from + 2 {
        return Period::default();
    }
    let mean = values.iter().sum::<f64>() / count as f64;
    let centred: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let correlation = |lag: usize| {
        let (a, b) = (&centred[..count - lag], &centred[lag..]);
        let (mut product, mut square_a, mut square_b) = (0.0, 0.0, 0.0);
        for (x, y) in a.iter().zip(b) {
            product += x * y;
            square_a += x * x;
            square_b += y * y;
        }
        let scale = (square_a * square_b).sqrt();
        if scale > 0.0 { product / scale } else { 0.0 }
    };
    let all: Vec<f64> = (from - 1..=to).map(correlation).collect();
    let peaks: Vec<usize> = (1..all.len() - 1)
        .filter(|&i| all[i] > 0.0 && all[i] >= all[i - 1] && all[i] > all[i + 1])
        .collect();
    let best = peaks.iter().map(|&i| all[i]).fold(0.0, f64::max);
    peaks
        .into_iter()
        .find(|&i| all[i] >= AS_GOOD * best)
        .map_or(Period::default(), |i| Period {
            period: (from - 1 + i) as f64 * interval,
            strength: all[i],
        })
}

/// Number of separate collisions in a force history: times at which it rises from zero.
pub fn contact_episodes(force: impl Iterator<Item = f64>) -> usize {
    let mut touching = false;
    let mut count = 0;
    for value in force {
        count += usize::from(value > 0.0 && !touching);
        touching = value > 0.0;
    }
    count
}

/// Index of the largest value.
pub(super) fn largest(values: &[f64]) -> usize {
    (0..values.len())
        .max_by(|&a, &b| values[a].total_cmp(&values[b]))
        .unwrap_or(0)
}

/// Indices of the two largest peaks of a profile that are at least `apart` from each other along `at` and below their
/// own heights in between, the one nearer to the top first.
pub(super) fn two_peaks(profile: &[f64], at: &[f64], apart: f64) -> [usize; 2] {
    let first = largest(profile);
    let is_peak = |i: usize| {
        let near = |j: usize| (at[j] - at[i]).abs() <= 0.5 * apart;
        (0..profile.len())
            .filter(|&j| near(j))
            .all(|j| profile[j] <= profile[i])
    };
    let far = |i: &usize| (at[*i] - at[first]).abs() >= apart;
    let second = (0..profile.len())
        .filter(far)
        .filter(|&i| is_peak(i))
        .max_by(|&a, &b| profile[a].total_cmp(&profile[b]))
        .or_else(|| {
            (0..profile.len())
                .filter(far)
                .max_by(|&a, &b| profile[a].total_cmp(&profile[b]))
        })
        .unwrap_or(first);
    [first.min(second), first.max(second)]
}
