//! Random numbers that are a function of their seed.

/// Parts of the draws of a member, so that an entry more in one part changes no number of another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    /// Values of keys.
    Keys = 1,
    /// Errors of sensors.
    Sensors = 2,
    /// What is taken of a posterior's sample.
    Sample = 3,
}

/// A generator of numbers.
#[derive(Debug, Clone)]
pub(crate) struct Random(fastrand::Rng);

/// Mixes the bits of a number so that neighbours have nothing in common (SplitMix64: Steele, Lea and Flood, OOPSLA 2014).
fn mixed(number: u64) -> u64 {
    let mut bits = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

impl Random {
    /// The generator of a part of a member.
    pub(crate) fn new(seed: u64, member: u64, part: Part) -> Self {
        Self(fastrand::Rng::with_seed(mixed(
            mixed(mixed(seed) ^ member) ^ part as u64,
        )))
    }

    /// The next 64 bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0.u64(..)
    }

    /// Uniform between 0 and 1, which are both left out: a quantile at either is infinite.
    pub(crate) fn uniform(&mut self) -> f64 {
        /// Half of the distance between two of the 2^52 numbers.
        const HALF: f64 = 1.0 / (1u64 << 53) as f64;
        (self.0.u64(..) >> 12) as f64 * (2.0 * HALF) + HALF
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_parts_and_seeds_have_numbers_of_their_own() {
        let first = |seed, member, part| Random::new(seed, member, part).uniform();
        let mut all = Vec::new();
        for seed in 0..10 {
            for member in 0..100 {
                all.extend([Part::Keys, Part::Sensors].map(|part| first(seed, member, part)));
            }
        }
        assert!(all.iter().all(|number| *number > 0.0 && *number < 1.0));
        all.sort_by(f64::total_cmp);
        all.dedup();
        assert_eq!(all.len(), 2000);
    }
}
