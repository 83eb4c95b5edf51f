//! Weights of members, and how many members they amount to.

/// Weights of members by the logarithms of their likelihoods; their sum is 1. A member whose likelihood is not known (NaN) has
/// none. Where none is known all are alike.
pub fn weights(log_likelihoods: &[f64]) -> Vec<f64> {
    let largest = log_likelihoods.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !largest.is_finite() {
        return vec![1.0 / log_likelihoods.len() as f64; log_likelihoods.len()];
    }
    // Less than the largest, so that no exponential overflows.
    let relative = |log: &f64| if log.is_nan() { 0.0 } else { (log - largest).exp() };
    let unscaled: Vec<f64> = log_likelihoods.iter().map(relative).collect();
    let sum: f64 = unscaled.iter().sum();
    unscaled.iter().map(|weight| weight / sum).collect()
}

/// The effective number 1 / sum w^2 of members with these weights: their count where all are alike, 1 where one has all.
pub fn effective_number(weights: &[f64]) -> f64 {
    let sum: f64 = weights.iter().sum();
    let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
    if squares > 0.0 { sum * sum / squares } else { 0.0 }
}

/// The largest power from 0 to 1 of weights with these logarithms that leaves at least `least` members alike. The effective
/// number falls with the power, since its logarithm is 2 K(a) - K(2 a) of the convex K(a) = ln sum w^a. Fewer members than
/// `least` have the power 0, which makes all alike.
pub fn tempering(logs: &[f64], least: f64) -> f64 {
    // Halvings of 1 to the last bit, the same on every machine.
    const HALVINGS: i32 = 52;
    let enough = |power: f64| {
        let tempered: Vec<f64> = logs.iter().map(|log| power * log).collect();
        effective_number(&weights(&tempered)) >= least
    };
    if enough(1.0) {
        return 1.0;
    }
    let mut power = 0.0;
    for halving in 1..=HALVINGS {
        let larger = power + 0.5_f64.powi(halving);
        if enough(larger) {
            power = larger;
        }
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tempering_leaves_as_many_members_as_asked_for() {
        let mut random = fastrand::Rng::with_seed(5);
        for spread in [0.1, 3.0, 500.0] {
            let logs: Vec<f64> = (0..20).map(|_| -spread * random.f64()).chain([f64::NAN]).collect();
            let of = |power: f64| effective_number(&weights(&logs.iter().map(|log| power * log).collect::<Vec<_>>()));
            for least in [8.0, 10.0, 19.9] {
                let power = tempering(&logs, least);
                assert!(of(power) >= least);
                // The largest such power: a little more of it leaves fewer.
                assert!(
                    power == 1.0 || of(power + 1e-12) < least + 1e-6,
                    "{spread} {least} {power}"
                );
                assert!(power == 1.0 || (of(power) - least).abs() < 1e-3);
            }
            assert_eq!(tempering(&logs, 20.5), 0.0);
            assert!((of(0.0) - 20.0).abs() < 1e-9);
        }
        // Of two members at e^-L and 1 the effective number (1 + e^-aL)^2 / (1 + e^-2aL) is 1.6 where e^-aL is 1/3.
        let power = tempering(&[-5.0, 0.0], 1.6);
        assert!((power - 3.0_f64.ln() / 5.0).abs() < 1e-12, "{power}");
        assert_eq!(tempering(&[], 8.0), 0.0);
    }

    #[test]
    fn weights_are_shares_whatever_the_likelihoods() {
        let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(&weights(&[0.0, 0.0, 0.0, 0.0]), &[0.25; 4]));
        assert!(close(&weights(&[-5000.0, -5000.0 + 3.0_f64.ln()]), &[0.25, 0.75]));
        assert!(close(&weights(&[f64::NAN, 2.0]), &[0.0, 1.0]));
        assert!(close(&weights(&[f64::NAN, f64::NAN]), &[0.5, 0.5]));
        assert!(close(&weights(&[f64::NEG_INFINITY, 1.0, 1.0]), &[0.0, 0.5, 0.5]));
        assert!(weights(&[]).is_empty());
    }

    #[test]
    fn the_effective_number_is_between_one_and_all() {
        assert!((effective_number(&[0.25; 4]) - 4.0).abs() < 1e-12);
        assert!((effective_number(&[1.0, 0.0, 0.0]) - 1.0).abs() < 1e-12);
        assert!((effective_number(&[0.5, 0.5, 0.0]) - 2.0).abs() < 1e-12);
        assert!(effective_number(&[]).abs() < 1e-12);
    }
}
