//! Weights that may be advised for the hole, and a search among them.

use flexdrill_config::Config;
use flexdrill_core::units::n_to_kn;

use super::tool::wear_flats;

/// Weights around the best of the coarse ones, in their steps.
const FINE: [f64; 6] = [-0.75, -0.5, -0.25, 0.25, 0.5, 0.75];
/// Part of the present weight by which advice may change it. The hole alone is looked at, and a weight far from the present
/// one is another drilling programme: it brings whirl, stick-slip or buckling that nothing here sees.
const MOST_CHANGE: f64 = 0.5;

/// A range of weights (kN).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tried {
    /// Smallest.
    pub low: f64,
    /// Largest.
    pub high: f64,
}

/// The range of weights that may be advised from the present one (kN): within a half of it and the limits of the
/// inputs, and where the bit cuts.
pub fn allowed(config: &Config, now: f64) -> Tried {
    let weight = &config.inputs.weight_on_bit;
    let flats = n_to_kn(wear_flats(config));
    let high = weight.max_kn.min((1.0 + MOST_CHANGE) * now);
    // Near the force of the wear flats next to nothing cuts, and nothing there is known.
    let low = weight.min_kn.max((1.0 - MOST_CHANGE) * now).max(1.1 * flats);
    Tried {
        low: low.min(high),
        high,
    }
}

/// The weight (kN) of a range whose measure is smallest, with that: of `coarse` weights over the range, and of some around the
/// best of them. A weight without a measure is left out; none where all are.
pub fn best<T>(
    tried: Tried,
    coarse: usize,
    measure: impl Fn(f64) -> Option<T>,
    size: impl Fn(&T) -> f64,
) -> Option<(f64, T)> {
    let Tried { low, high } = tried;
    let step = (high - low) / (coarse.max(2) - 1) as f64;
    // A tenth of a kilonewton is what a driller can set.
    let rounded = |weight: f64| ((10.0 * weight).round() / 10.0).clamp(low, high);
    let mut best: Option<(f64, T)> = None;
    let mut consider = |weight: f64| {
        let weight = rounded(weight);
        if let Some(found) = measure(weight)
            && best.as_ref().is_none_or(|(_, least)| size(&found) < size(least))
        {
            best = Some((weight, found));
        }
        best.as_ref().map(|(weight, _)| *weight)
    };
    let mut around = None;
    for index in 0..coarse.max(2) {
        around = consider(low + index as f64 * step);
    }
    if let Some(middle) = around {
        for share in FINE {
            consider(middle + share * step);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_measure_is_found_to_a_quarter_of_a_step_and_a_tenth_of_a_kilonewton() {
        let tried = Tried { low: 5.0, high: 15.0 };
        // Steps of 2 kN: 7.3 kN are within a quarter of one, 0.5 kN, of what is tried, and 0.05 kN of rounding.
        let (weight, off) = best(tried, 6, |weight| Some((weight - 7.3).abs()), |off| *off).unwrap();
        assert!((weight - 7.3).abs() <= 0.3 && off == (weight - 7.3).abs(), "{weight}");
        // Beyond the range its end is the nearest.
        assert_eq!(
            best(tried, 6, |weight| Some(20.0 - weight), |off| *off).unwrap().0,
            15.0
        );
        // What is not known is left out.
        let known = |weight: f64| (weight > 10.0).then_some(weight);
        assert!((best(tried, 6, known, |off| *off).unwrap().0 - 10.5).abs() < 0.51);
        assert_eq!(best(tried, 6, |_| None::<f64>, |off| *off), None);
    }
}
