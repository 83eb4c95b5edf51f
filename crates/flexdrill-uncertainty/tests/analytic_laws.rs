//! Quantiles of distributions that are cut off, against closed forms.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::Distribution;
use flexdrill_uncertainty::Law;

const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
/// Standard normal quantiles of 75, 95 and 97.5 % (Abramowitz and Stegun, table 26.5, and the digits that follow).
const Z75: f64 = 0.674_489_750_196_081_7;
const Z95: f64 = 1.644_853_626_951_472_2;
const Z975: f64 = 1.959_963_984_540_054;

fn law(distribution: Distribution, limits: [f64; 2]) -> Law {
    Law::new(&distribution, limits).unwrap()
}

fn near(found: f64, expected: f64) {
    // The quantile function is a rational approximation to some 1e-15.
    assert!(
        (found - expected).abs() <= 1e-12 * expected.abs().max(1.0),
        "{found} {expected}"
    );
}

#[test]
fn ninety_per_cent_of_a_normal_lie_between_its_ends() {
    let whole = law(Distribution::Normal { low: 2.0, high: 6.0 }, ALL);
    near(whole.quantile(0.05), 2.0);
    near(whole.quantile(0.5), 4.0);
    near(whole.quantile(0.95), 6.0);
    near(whole.quantile(0.975), 4.0 + 2.0 * Z975 / Z95);
}

/// Half of a normal: the share p of what is left is at (1 + p) / 2 of the whole.
#[test]
fn a_normal_that_is_cut_at_its_middle() {
    let upper = law(Distribution::Normal { low: -Z95, high: Z95 }, [0.0, f64::INFINITY]);
    near(upper.quantile(0.5), Z75);
    near(upper.quantile(0.9), Z95);
    near(upper.quantile(0.95), Z975);
    near(upper.quantile(0.0), 0.0);
    // Between the quartiles: p maps to 1/4 + p/2.
    let between = law(Distribution::Normal { low: -Z95, high: Z95 }, [-Z75, Z75]);
    near(between.quantile(0.5), 0.0);
    near(between.quantile(0.0), -Z75);
    near(between.quantile(1.0), Z75);
    // Symmetric about the middle.
    near(between.quantile(0.2), -between.quantile(0.8));
}

#[test]
fn a_log_normal_is_the_exponential_of_a_normal() {
    let distribution = Distribution::LogNormal { low: 0.2, high: 0.4 };
    let whole = law(distribution, ALL);
    near(whole.quantile(0.05), 0.2);
    near(whole.quantile(0.95), 0.4);
    let median = 0.08_f64.sqrt();
    near(whole.quantile(0.5), median);
    let deviation = 0.5 * 2.0_f64.ln() / Z95;
    near(whole.quantile(0.975), median * (deviation * Z975).exp());
    // Cut at its median, as the normal at its middle.
    let lower = law(distribution, [0.0, median]);
    near(lower.quantile(0.5), median * (-deviation * Z75).exp());
    near(lower.quantile(1.0), median);
    // A limit below 0 cuts nothing off.
    near(law(distribution, [-5.0, 2.0]).quantile(0.05), whole.quantile(0.05));
}

#[test]
fn a_uniform_that_is_cut_is_uniform() {
    let cut = law(Distribution::Uniform { low: -2.0, high: 8.0 }, [0.0, 5.0]);
    for p in [0.0, 0.25, 0.5, 1.0] {
        near(cut.quantile(p), 5.0 * p);
    }
}

/// With the mode at the low end F = 1 - (1 - x)^2; cut at 1/2 it reaches 3/4.
#[test]
fn a_triangle_is_a_root() {
    let falling = Distribution::Triangular {
        low: 0.0,
        mode: 0.0,
        high: 1.0,
    };
    for p in [0.0, 0.3, 0.8, 1.0] {
        near(law(falling, ALL).quantile(p), 1.0 - (1.0 - p).sqrt());
        near(law(falling, [0.0, 0.5]).quantile(p), 1.0 - (1.0 - 0.75 * p).sqrt());
    }
    // Below the mode F = x^2 / (high mode), above it 1 - (high - x)^2 / (high (high - mode)).
    let skew = law(
        Distribution::Triangular {
            low: 0.0,
            mode: 1.0,
            high: 4.0,
        },
        ALL,
    );
    near(skew.quantile(0.16), 0.8);
    near(skew.quantile(0.25), 1.0);
    near(skew.quantile(0.75), 4.0 - 3.0_f64.sqrt());
}

#[test]
fn a_distribution_without_values_between_the_limits_is_none() {
    let uniform = Distribution::Uniform { low: 0.0, high: 1.0 };
    assert!(Law::new(&uniform, [2.0, 3.0]).is_none());
    assert!(Law::new(&uniform, [1.0, 0.0]).is_none());
    assert!(Law::new(&Distribution::Normal { low: 1.0, high: 1.0 }, ALL).is_none());
    assert!(Law::new(&Distribution::LogNormal { low: -1.0, high: 1.0 }, ALL).is_none());
}
