//! Random numbers that are a function of their seed.

use std::f64::consts::TAU;

/// A generator of uniform and normal numbers.
#[derive(Debug, Clone)]
pub(crate) struct Random(fastrand::Rng);

impl Random {
    /// A generator whose numbers are a function of the seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Uniform in [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0.f64()
    }

    /// Standard normal, by Box and Muller.
    pub(crate) fn normal(&mut self) -> f64 {
        // 1 - u is in (0, 1], so that the logarithm is finite.
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        radius * libm::cos(TAU * self.uniform())
    }

    /// The numbers 0 to `count` - 1 in random order.
    pub(crate) fn permutation(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        self.0.shuffle(&mut order);
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_their_moments() {
        let mut random = Random::new(1);
        let count = 100_000;
        let all: Vec<f64> = (0..count).map(|_| random.normal()).collect();
        let moment = |power: i32| all.iter().map(|x| x.powi(power)).sum::<f64>() / f64::from(count);
        // Five standard errors: 1, sqrt 2 and sqrt 96 over the root of the count.
        let error = 5.0 / f64::from(count).sqrt();
        assert!(moment(1).abs() < error);
        assert!((moment(2) - 1.0).abs() < 2.0_f64.sqrt() * error);
        assert!((moment(4) - 3.0).abs() < 96.0_f64.sqrt() * error);
    }
}
