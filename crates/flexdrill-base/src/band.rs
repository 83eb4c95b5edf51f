//! A number that is known with a range.

/// Median of a number and the ends of 90 %, in the unit of the number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// 5 % of the values are below.
    pub low: f64,
    /// Half of the values are below.
    pub median: f64,
    /// 5 % of the values are above.
    pub high: f64,
}

impl Band {
    /// Fewest values of a band. Quantile q of n values is their number q (n + 1), so that the next value is below it with
    /// the chance q: 5 % of fewer would be below the first of them.
    pub const LEAST: usize = 19;

    /// Of known values; none of fewer than [`Band::LEAST`].
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        if values.len() < Self::LEAST {
            return None;
        }
        values.sort_by(f64::total_cmp);
        let last = values.len() - 1;
        let quantile = |share: f64| {
            let at = (share * (values.len() + 1) as f64 - 1.0).clamp(0.0, last as f64);
            let below = (at.floor() as usize).min(last);
            let above = (below + 1).min(last);
            values[below] + (at - below as f64) * (values[above] - values[below])
        };
        Some(Self {
            low: quantile(0.05),
            median: quantile(0.5),
            high: quantile(0.95),
        })
    }

    /// Of a log-normal number: its median, and the factor from there to either end (1 or more).
    pub fn within_factor(median: f64, factor: f64) -> Self {
        Self {
            low: median / factor,
            median,
            high: median * factor,
        }
    }

    /// Half of its width.
    pub fn half(&self) -> f64 {
        0.5 * (self.high - self.low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_has_ninety_per_cent_between_its_ends() {
        // The next of 19 equally likely values is below the first, or above the last, once in twenty times.
        let of = |count: u32| Band::of((1..=count).rev().map(f64::from).collect());
        let band = of(19).unwrap();
        let near = |value: f64, expected: f64| (value - expected).abs() < 1e-9;
        assert!(
            near(band.low, 1.0) && near(band.median, 10.0) && near(band.high, 19.0),
            "{band:?}"
        );
        let band = of(99).unwrap();
        assert!(
            near(band.low, 5.0) && near(band.median, 50.0) && near(band.high, 95.0),
            "{band:?}"
        );
        assert!(near(band.half(), 45.0));
        assert_eq!(of(18), None);
    }

    #[test]
    fn a_factor_reaches_as_far_to_either_end() {
        let band = Band::within_factor(0.4, 4.0);
        assert_eq!([band.low, band.median, band.high], [0.1, 0.4, 1.6]);
    }
}
