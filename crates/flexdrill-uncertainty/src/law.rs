//! A distribution cut off at limits.
//!
//! With the distribution function F and the limits a and b, the quantile of the part between them is
//! F^-1(F(a) + p (F(b) - F(a))): exact, and without a draw that is thrown away.

use flexdrill_config::Distribution;
use statrs::distribution::{ContinuousCDF, Normal, Triangular, Uniform};

/// Standard normal quantile of 95 %: 90 % of the values lie within this many standard deviations.
pub const BAND: f64 = 1.644_853_626_951_472_7;

/// A distribution cut off at limits.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    shape: Shape,
    low: f64,
    high: f64,
    /// Share of the whole distribution below `low`.
    below: f64,
    /// Share of the whole distribution between the limits.
    share: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Normal(Normal),
    /// The logarithm is normal.
    LogNormal(Normal),
    Uniform(Uniform),
    Triangular(Triangular),
}

/// The normal distribution of which 90 % lie between two ends.
fn normal(low: f64, high: f64) -> Option<Normal> {
    Normal::new(0.5 * (low + high), 0.5 * (high - low) / BAND).ok()
}

impl Shape {
    fn new(distribution: &Distribution) -> Option<Self> {
        Some(match *distribution {
            Distribution::Normal { low, high } => Self::Normal(normal(low, high)?),
            Distribution::LogNormal { low, high } => Self::LogNormal(normal(libm::log(low), libm::log(high))?),
            Distribution::Uniform { low, high } => Self::Uniform(Uniform::new(low, high).ok()?),
            Distribution::Triangular { low, mode, high } => Self::Triangular(Triangular::new(low, high, mode).ok()?),
        })
    }

    /// Share of the values below x.
    fn below(&self, x: f64) -> f64 {
        match self {
            Self::Normal(law) => law.cdf(x),
            Self::LogNormal(_) if x <= 0.0 => 0.0,
            Self::LogNormal(law) => law.cdf(libm::log(x)),
            Self::Uniform(law) => law.cdf(x),
            Self::Triangular(law) => law.cdf(x),
        }
    }

    fn quantile(&self, p: f64) -> f64 {
        match self {
            Self::Normal(law) => law.inverse_cdf(p),
            Self::LogNormal(law) => libm::exp(law.inverse_cdf(p)),
            Self::Uniform(law) => law.inverse_cdf(p),
            Self::Triangular(law) => law.inverse_cdf(p),
        }
    }
}

impl Law {
    /// A distribution cut off at `low` and `high`, which may be infinite. None where the distribution is none, or has no
    /// values between the limits.
    pub fn new(distribution: &Distribution, [low, high]: [f64; 2]) -> Option<Self> {
        let shape = Shape::new(distribution)?;
        let below = shape.below(low);
        let share = shape.below(high) - below;
        (share > 0.0).then_some(Self {
            shape,
            low,
            high,
            below,
            share,
        })
    }

    /// The share of the values below x, from 0 to 1: the inverse of [`Law::quantile`].
    pub fn share(&self, x: f64) -> f64 {
        ((self.shape.below(x) - self.below) / self.share).clamp(0.0, 1.0)
    }

    /// The value below which a share p of the values lies, for p from 0 to 1; within the limits.
    pub fn quantile(&self, p: f64) -> f64 {
        let p = (self.below + p * self.share).clamp(0.0, 1.0);
        self.shape.quantile(p).clamp(self.low, self.high)
    }
}

/// Share of a standard normal distribution below z.
pub(crate) fn standard_normal(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

/// The standard normal quantile.
pub(crate) fn standard_quantile(p: f64) -> f64 {
    Normal::standard().inverse_cdf(p)
}
