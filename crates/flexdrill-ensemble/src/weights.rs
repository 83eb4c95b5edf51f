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

#[cfg(test)]
mod tests {
    use super::*;

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
