//! From counts of members to probabilities, and when a count decides.

use statrs::statistics::{Data, OrderStatistics as _};

/// Standard normal quantile of a two-sided interval of 95 %.
const Z: f64 = 1.959_963_984_540_054;
/// The hypotheses of the test: a chance that counts as excluded, and one that counts as certain enough to act on.
const RARE: f64 = 0.1;
const FREQUENT: f64 = 0.5;
/// Probability of either error of the test.
const RISK: f64 = 0.05;

/// How often something was seen in members.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chance {
    /// Members in which it was seen.
    pub seen: u32,
    /// Members that ended.
    pub of: u32,
    /// Share; NaN without members.
    pub probability: f64,
    /// Lower and upper end of the 95 % interval after Wilson (J. Am. Stat. Assoc. 22, 1927, 209); 0 and 1 without members.
    pub interval: [f64; 2],
}

impl Chance {
    /// Of `seen` in `of` members.
    pub fn new(seen: u32, of: u32) -> Self {
        let (n, p) = (f64::from(of), f64::from(seen) / f64::from(of));
        let interval = if of == 0 {
            [0.0, 1.0]
        } else {
            let (centre, half) = (
                p + Z * Z / (2.0 * n),
                Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt(),
            );
            // At its ends the interval is closed; rounding must not open it.
            let scale = 1.0 + Z * Z / n;
            [
                if seen == 0 { 0.0 } else { (centre - half) / scale },
                if seen == of { 1.0 } else { (centre + half) / scale },
            ]
        };
        Self {
            seen,
            of,
            probability: p,
            interval,
        }
    }

    /// Whether the members decide, by Wald's sequential probability ratio test (Ann. Math. Stat. 16, 1945, 117), between
    /// a chance of a tenth or less and one of a half or more, with a risk of 5 % for either error: `Some(true)` for the
    /// latter.
    pub fn decided(&self) -> Option<bool> {
        let (seen, not) = (f64::from(self.seen), f64::from(self.of - self.seen));
        let ratio = seen * (FREQUENT / RARE).ln() + not * ((1.0 - FREQUENT) / (1.0 - RARE)).ln();
        let bound = ((1.0 - RISK) / RISK).ln();
        if ratio >= bound {
            Some(true)
        } else if ratio <= -bound {
            Some(false)
        } else {
            None
        }
    }
}

/// A figure over members.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Quantiles at 5, 50 and 95 %; NaN without values.
    pub quantiles: [f64; 3],
}

impl Band {
    /// Of the values that are numbers.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let quantiles = if values.is_empty() {
            [f64::NAN; 3]
        } else {
            let mut data = Data::new(values);
            [0.05, 0.5, 0.95].map(|share| data.quantile(share))
        };
        Self { quantiles }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Newcombe (Stat. Med. 17, 1998, 857), table I: 81 of 263 and 15 of 148, 0 of 20 and 1 of 29, method 3.
    #[test]
    fn intervals_are_the_published_ones() {
        for (seen, of, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let [found_low, found_high] = Chance::new(seen, of).interval;
            // The table has four digits.
            assert!(
                (found_low - low).abs() < 5.1e-5 && (found_high - high).abs() < 5.1e-5,
                "{seen} of {of}"
            );
        }
        assert_eq!(Chance::new(7, 7).interval[1], 1.0);
        assert_eq!(Chance::new(0, 0).interval, [0.0, 1.0]);
        assert!(Chance::new(0, 0).probability.is_nan());
    }

    #[test]
    fn two_sightings_decide_and_so_do_six_members_without() {
        let decided = |seen, of| Chance::new(seen, of).decided();
        assert_eq!([decided(0, 0), decided(1, 1), decided(0, 5)], [None; 3]);
        assert_eq!(decided(2, 2), Some(true));
        assert_eq!(decided(0, 6), Some(false));
        assert_eq!([decided(1, 6), decided(1, 7), decided(1, 8)], [None; 3]);
        assert_eq!(decided(1, 9), Some(false));
    }

    #[test]
    fn bands_leave_out_what_is_no_number() {
        let band = Band::of([1.0, f64::NAN, 3.0, 2.0].into_iter());
        assert_eq!(band.quantiles[1], 2.0);
        assert!(Band::of([f64::NAN].into_iter()).quantiles.iter().all(|q| q.is_nan()));
    }
}
