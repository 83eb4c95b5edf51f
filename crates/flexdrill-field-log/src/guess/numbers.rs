//! What the numbers of columns say: their size, and how two columns change together.

/// Rows between the two values of a difference: long enough for a driller to change something, short enough that depth
/// does not.
const LAG: usize = 10;
/// Differences, and rows at rest and not at rest, without which a relation is chance.
const FEW: usize = 30;
/// A value below this share of the usual large ones is none.
const REST: f64 = 0.05;

/// The value that a share of the values does not exceed; NaN without values.
pub(crate) fn quantile(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut values: Vec<f64> = values.filter(|value| !value.is_nan()).collect();
    if values.is_empty() {
        return f64::NAN;
    }
    let index = ((values.len() - 1) as f64 * share).round() as usize;
    let (_, value, _) = values.select_nth_unstable_by(index, f64::total_cmp);
    *value
}

/// The usual size of the large values: spikes are beyond it.
pub(crate) fn size(values: &[f64]) -> f64 {
    quantile(values.iter().map(|value| value.abs()), 0.95)
}

/// The size of the values of a column that are not at rest, by its median.
pub(crate) fn usual(values: &[f64]) -> f64 {
    let rest = REST * size(values);
    quantile(
        values.iter().map(|value| value.abs()).filter(|value| *value > rest),
        0.5,
    )
}

/// How far two columns are at rest together: 1 where both always are, 0 where one says nothing about the other. `None` where
/// one of them rests nearly always or nearly never.
pub(crate) fn rest_together(first: &[f64], second: &[f64]) -> Option<f64> {
    let rests = [REST * size(first), REST * size(second)];
    let mut counts = [[0_usize; 2]; 2];
    for (a, b) in first.iter().zip(second).filter(|(a, b)| !a.is_nan() && !b.is_nan()) {
        counts[usize::from(a.abs() > rests[0])][usize::from(b.abs() > rests[1])] += 1;
    }
    let [[neither, only_second], [only_first, both]] = counts;
    let sums = [
        neither + only_second,
        only_first + both,
        neither + only_first,
        only_second + both,
    ];
    let all = sums[0] + sums[1];
    if sums.iter().any(|sum| *sum < FEW || *sum * 50 < all) {
        return None;
    }
    let product: f64 = sums.iter().map(|sum| *sum as f64).product();
    Some((both as f64 * neither as f64 - only_first as f64 * only_second as f64) / product.sqrt())
}

/// How far one column rises where the other falls, while the first is not at rest: -1 for a mirror. `None` where there are
/// too few rows, or one of them does not change.
pub(crate) fn together(first: &[f64], second: &[f64]) -> Option<f64> {
    let rest = REST * size(first);
    let mut steps: Vec<[f64; 2]> = Vec::new();
    let later = first.iter().zip(second).skip(LAG);
    for ((a, b), (a_later, b_later)) in first.iter().zip(second).zip(later) {
        let step = [a_later - a, b_later - b];
        if a.abs() > rest && a_later.abs() > rest && step.iter().all(|step| step.is_finite()) {
            steps.push(step);
        }
    }
    if steps.len() < FEW {
        return None;
    }
    // A spike would decide the correlation alone, so that steps are cut where nine in ten lie below.
    let bounds = [0, 1].map(|index| quantile(steps.iter().map(|step| step[index].abs()), 0.9));
    let cut = steps
        .iter()
        .map(|step| [0, 1].map(|index| step[index].clamp(-bounds[index], bounds[index])));
    let (mut product, mut squares) = (0.0, [0.0, 0.0]);
    for step in cut {
        product += step[0] * step[1];
        squares[0] += step[0] * step[0];
        squares[1] += step[1] * step[1];
    }
    let norm = f64::sqrt(squares[0] * squares[1]);
    (norm > 0.0).then(|| product / norm)
}

/// The share of the changes of a column that are falls; `None` where it does not change.
pub(crate) fn falls(values: &[f64]) -> Option<f64> {
    let numbers: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    let (mut rise, mut fall) = (0.0, 0.0);
    for pair in numbers.windows(2) {
        let step = pair[1] - pair[0];
        if step > 0.0 {
            rise += step;
        } else {
            fall -= step;
        }
    }
    (rise + fall > 0.0).then(|| fall / (rise + fall))
}

/// The share of the rows in which the first is above the second by more than `by`.
pub(crate) fn above(first: &[f64], second: &[f64], by: f64) -> f64 {
    let pairs = first.iter().zip(second).filter(|(a, b)| !a.is_nan() && !b.is_nan());
    let (mut all, mut above) = (0_usize, 0_usize);
    for (a, b) in pairs {
        all += 1;
        above += usize::from(a - b > by);
    }
    if all == 0 { 0.0 } else { above as f64 / all as f64 }
}

/// The growth of a depth (m) over the advance that a rate (m/h) gives in the same time (s); `None` where the depth grows by
/// less than 2 m.
pub(crate) fn growth_over_advance(depth: &[f64], rate: &[f64], times: &[f64]) -> Option<f64> {
    let (mut growth, mut advance) = (0.0, 0.0);
    let later = depth.iter().zip(times).skip(1);
    for (((depth, rate), time), (depth_later, time_later)) in depth.iter().zip(rate).zip(times).zip(later) {
        let (step, duration) = (depth_later - depth, time_later - time);
        // A gap, and a depth that a driller sets, are no drilling.
        if step.is_finite() && rate.is_finite() && (0.0..=30.0).contains(&duration) && step.abs() < 1.0 {
            growth += step;
            advance += rate.max(0.0) * duration / 3600.0;
        }
    }
    (growth > 2.0 && advance > 0.0).then(|| growth / advance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rests_and_mirrors_are_found_and_chance_is_none() {
        // A saw tooth that rests for a third of the time, its mirror, and a constant.
        let weight: Vec<f64> = (0..300)
            .map(|row| if row % 90 < 30 { 0.0 } else { 10.0 + f64::from(row % 17) })
            .collect();
        let hook: Vec<f64> = weight.iter().map(|weight| 200.0 - weight).collect();
        let torque: Vec<f64> = weight.iter().map(|weight| 3.0 * weight).collect();
        let constant = vec![5.0; 300];
        assert!(together(&weight, &hook).is_some_and(|both| both < -0.99));
        assert!(rest_together(&weight, &torque).is_some_and(|both| both > 0.99));
        assert_eq!(rest_together(&weight, &constant), None);
        assert_eq!(together(&weight, &constant), None);
        assert_eq!(together(&weight[..20], &hook[..20]), None);
        // A rest against its opposite.
        let other: Vec<f64> = weight
            .iter()
            .map(|weight| if *weight == 0.0 { 1.0 } else { 0.0 })
            .collect();
        assert!(rest_together(&weight, &other).is_some_and(|both| both < -0.99));
    }

    #[test]
    fn a_depth_grows_by_its_rate() {
        let times: Vec<f64> = (0..3600).map(f64::from).collect();
        let rate = vec![36.0; 3600];
        let depth: Vec<f64> = times.iter().map(|time| 1000.0 + time * 0.01).collect();
        let ratio = growth_over_advance(&depth, &rate, &times);
        // The sums have rounding errors only.
        assert!(ratio.is_some_and(|ratio| (ratio - 1.0).abs() < 1e-9), "{ratio:?}");
        assert_eq!(falls(&depth), Some(0.0));
        assert_eq!(growth_over_advance(&rate, &rate, &times), None);
    }

    #[test]
    fn quantiles_of_nothing_are_no_number() {
        assert!(
            quantile(std::iter::empty(), 0.5).is_nan() && size(&[f64::NAN]).is_nan() && usual(&[0.0, 0.0]).is_nan()
        );
        assert_eq!(quantile([3.0, 1.0, 2.0].into_iter(), 0.5), 2.0);
        assert_eq!(above(&[], &[], 0.0), 0.0);
    }
}
