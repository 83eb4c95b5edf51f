//! The chance of an outcome over plausible tools.

use super::weights::effective_number;

/// Standard normal quantile of a two-sided interval of 95 %.
const Z: f64 = 1.959_963_984_540_054;

/// The share of plausible tools in which something comes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chance {
    /// Sum of the weights of the members in which it comes, over those that ended; NaN without any.
    pub probability: f64,
    /// Lower and upper end of the 95 % interval after Wilson (J. Am. Stat. Assoc. 22, 1927, 209), by the effective number of
    /// members; 0 and 1 without any.
    pub interval: [f64; 2],
    /// Effective number of members.
    pub of: f64,
}

impl Chance {
    /// Of members with these weights, and whether it comes in each; `None` for a member that failed, which is unknown and
    /// counts for neither.
    pub fn of(members: impl IntoIterator<Item = (f64, Option<bool>)>) -> Self {
        let (mut with, mut ended) = (0.0, Vec::new());
        for (weight, comes) in members {
            let Some(comes) = comes else { continue };
            ended.push(weight);
            with += if comes { weight } else { 0.0 };
        }
        let (n, sum) = (effective_number(&ended), ended.iter().sum::<f64>());
        if n <= 0.0 {
            return Self {
                probability: f64::NAN,
                interval: [0.0, 1.0],
                of: 0.0,
            };
        }
        let p = (with / sum).clamp(0.0, 1.0);
        let (centre, half) = (
            p + Z * Z / (2.0 * n),
            Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt(),
        );
        let scale = 1.0 + Z * Z / n;
        Self {
            probability: p,
            interval: [(centre - half) / scale, (centre + half) / scale].map(|end| end.clamp(0.0, 1.0)),
            of: n,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Figures of Wilson's interval for 0, 7 and 10 of 10, from Newcombe (Stat. Med. 17, 1998, 857, method 3).
    #[test]
    fn equal_weights_give_wilsons_interval() {
        for (seen, low, high) in [(0, 0.0, 0.2775), (7, 0.3968, 0.8922), (10, 0.7225, 1.0)] {
            let chance = Chance::of((0..10).map(|k| (0.1, Some(k < seen))));
            assert!((chance.probability - f64::from(seen) / 10.0).abs() < 1e-12);
            let [a, b] = chance.interval;
            assert!((a - low).abs() < 1e-3 && (b - high).abs() < 1e-3, "{seen}: {a} {b}");
            assert!((chance.of - 10.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_failed_member_is_neither_and_none_is_no_chance() {
        let chance = Chance::of([(0.5, None), (0.25, Some(true)), (0.25, Some(false))]);
        assert!((chance.probability - 0.5).abs() < 1e-12 && (chance.of - 2.0).abs() < 1e-9);
        let chance = Chance::of([(1.0, None)]);
        assert!(chance.probability.is_nan() && chance.interval == [0.0, 1.0]);
    }
}
