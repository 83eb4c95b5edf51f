//! Bands of what members compute.
//!
//! The value of another plausible tool falls below the `i`-th of `n` like ones with probability `i / (n + 1)`, whatever their
//! distribution. With weights the `i`-th stands at
//!
//! ```text
//! P_i = (n M_i + 1/2) / (n + 1),   M_i = w_1 + ... + w_{i-1} + w_i / 2,
//! ```
//!
//! `n` being the effective number of members, which is `i / (n + 1)` for equal weights. Between members the quantile is linear
//! in probability. Beyond the outermost it goes on as a normal distribution with the members' deviation, and says so: with
//! fewer than 19 members a band from 5 to 95 % is wider than what they span.

use statrs::distribution::{ContinuousCDF as _, Normal};

use super::weights::effective_number;

/// Least effective number of members that have a band. With fewer, most of a band from 5 to 95 % would be beyond them.
pub const LEAST_MEMBERS: f64 = 8.0;

/// The quantiles of 5, 50 and 95 % over plausible tools.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Quantiles of 5, 50 and 95 %.
    pub quantiles: [f64; 3],
    /// Whether an end lies beyond the outermost member.
    pub extended: bool,
    /// Effective number of members.
    pub of: f64,
}

impl Band {
    /// Of members with these weights and values, widened about its middle by `factor`; those whose value is not a number
    /// count for nothing. `None` with fewer than [`LEAST_MEMBERS`].
    pub fn of(members: impl IntoIterator<Item = (f64, f64)>, factor: f64) -> Option<Self> {
        let mut known: Vec<(f64, f64)> = members
            .into_iter()
            .filter(|(weight, value)| *weight > 0.0 && value.is_finite())
            .collect();
        known.sort_by(|a, b| a.1.total_cmp(&b.1));
        let weights: Vec<f64> = known.iter().map(|(weight, _)| *weight).collect();
        // Rounding must not cost a member that is there.
        let n = effective_number(&weights);
        if n < LEAST_MEMBERS - 1e-9 {
            return None;
        }
        let places = places(&known, n);
        let normal = Normal::standard();
        let deviation = deviation(&known, n);
        let mut extended = false;
        let mut quantile = |p: f64| {
            let (first, last) = (places[0], places[places.len() - 1]);
            // The tail goes on from the outermost member, so that the quantile is continuous.
            let beyond =
                |(place, value): (f64, f64)| value + deviation * (normal.inverse_cdf(p) - normal.inverse_cdf(place));
            if p < first.0 {
                extended = true;
                return beyond(first);
            }
            if p > last.0 {
                extended = true;
                return beyond(last);
            }
            let above = places.partition_point(|(place, _)| *place < p).max(1);
            match (places.get(above - 1), places.get(above)) {
                (Some((p0, x0)), Some((p1, x1))) => x0 + (x1 - x0) * (p - p0) / (p1 - p0),
                _ => last.1,
            }
        };
        let [low, middle, high] = [0.05, 0.5, 0.95].map(&mut quantile);
        Some(Self {
            quantiles: [
                middle - factor * (middle - low),
                middle,
                middle + factor * (high - middle),
            ],
            extended,
            of: n,
        })
    }

    /// The same of a quantity that has no value outside `range`: a tail or a factor may reach beyond it, the quantity not.
    #[must_use]
    pub fn within(self, range: [f64; 2]) -> Self {
        Self {
            quantiles: self.quantiles.map(|quantile| quantile.clamp(range[0], range[1])),
            ..self
        }
    }
}

/// Probability and value of each member, in the order of values.
fn places(known: &[(f64, f64)], n: f64) -> Vec<(f64, f64)> {
    let sum: f64 = known.iter().map(|(weight, _)| weight).sum();
    let mut below = 0.0;
    known
        .iter()
        .map(|(weight, value)| {
            let middle = (below + 0.5 * weight) / sum;
            below += weight;
            ((n * middle + 0.5) / (n + 1.0), *value)
        })
        .collect()
}

/// Standard deviation of the distribution that members with an effective number `n` were drawn from.
fn deviation(known: &[(f64, f64)], n: f64) -> f64 {
    let sum: f64 = known.iter().map(|(weight, _)| weight).sum();
    let mean = known.iter().map(|(weight, value)| weight * value).sum::<f64>() / sum;
    let square = known.iter().map(|(weight, value)| weight * (value - mean).powi(2));
    (square.sum::<f64>() / sum * n / (n - 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn equal(values: &[f64], factor: f64) -> Option<Band> {
        Band::of(values.iter().map(|value| (1.0, *value)), factor)
    }

    /// Nineteen like members: the outermost are the quantiles of 1/20 and 19/20.
    #[test]
    fn nineteen_members_span_the_band_from_5_to_95_percent() {
        let values: Vec<f64> = (1..=19).map(f64::from).collect();
        let band = equal(&values, 1.0).unwrap();
        let close = |[a, b, c]: [f64; 3]| (a - 1.0).abs() < 1e-9 && (b - 10.0).abs() < 1e-9 && (c - 19.0).abs() < 1e-9;
        assert!(close(band.quantiles), "{band:?}");
        let wider = equal(&values, 2.0).unwrap();
        assert!((wider.quantiles[0] + 8.0).abs() < 1e-9 && (wider.quantiles[2] - 28.0).abs() < 1e-9);
        // Two members of half a weight each are one.
        let halves = values.iter().flat_map(|value| [(0.5, *value), (0.5, *value)]);
        assert!((Band::of(halves, 1.0).unwrap().quantiles[1] - 10.0).abs() < 1e-9);
    }

    #[test]
    fn fewer_than_eight_have_no_band_and_ten_one_that_is_extended() {
        assert_eq!(equal(&[1.0; 7], 1.0), None);
        let mut values: Vec<f64> = (0..10).map(f64::from).collect();
        let band = equal(&values, 1.0).unwrap();
        assert!(
            band.extended && band.quantiles[0] < 0.0 && band.quantiles[2] > 9.0,
            "{band:?}"
        );
        values.extend([f64::NAN, f64::INFINITY]);
        assert_eq!(equal(&values, 1.0), Some(band), "what is not a number is no member");
    }

    /// Bands of members and a truth that are all drawn alike hold the truth nine times of ten, whatever the distribution:
    /// of 20 000 within four standard deviations of a binomial, with enough members that no tail is extrapolated.
    #[test]
    fn bands_hold_what_is_drawn_like_the_members() {
        let mut random = fastrand::Rng::with_seed(5);
        let shapes: [fn(f64) -> f64; 2] = [|u| -(1.0 - u).ln(), |u| (6.0 * u).sin()];
        for shape in shapes {
            let (mut held, trials) = (0_u32, 20_000_u32);
            for _ in 0..trials {
                let values: Vec<f64> = (0..39).map(|_| shape(random.f64())).collect();
                let truth = shape(random.f64());
                let [low, _, high] = equal(&values, 1.0).unwrap().quantiles;
                held += u32::from((low..=high).contains(&truth));
            }
            let expected = 0.9 * f64::from(trials);
            let most = 4.0 * (0.09 * f64::from(trials)).sqrt();
            assert!((f64::from(held) - expected).abs() < most, "{held} of {trials}");
        }
    }
}
