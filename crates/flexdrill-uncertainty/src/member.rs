//! Plausible tools, drawn.
//!
//! The draws of the keys are joined by a Gaussian copula: correlated standard normal scores z = L n, with the Cholesky
//! factor L of the correlations and independent scores n, and the quantile of each distribution at the share Phi(z).

use flexdrill_config::{Config, ConfigError};

use crate::error::UncertaintyError;
use crate::law::{standard_normal, standard_quantile};
use crate::priors::{Entry, Priors};
use crate::random::{Part, Random};
use crate::sensors::SensorError;

/// Draws of a member before it counts as one that does not exist: each has values that are allowed one by one, and only
/// keys that exclude each other refuse it.
const MOST_ATTEMPTS: u32 = 100;

/// A plausible tool on a plausible rig.
#[derive(Debug, Clone)]
pub struct Member {
    /// The configuration with the drawn values, without the section `uncertainty`.
    pub config: Config,
    /// Independent standard normal scores that all draws follow from: one per entry of [`Priors::entries`], then two per
    /// sensor of [`Priors::sensors`], for its factor and its tare.
    pub scores: Vec<f64>,
    /// The draws, by [`Priors::entries`].
    pub draws: Vec<f64>,
    /// The errors of the sensors, by [`Priors::sensors`].
    pub sensors: Vec<SensorError>,
    /// Draws before this one that the configuration refused, because keys exclude each other.
    pub refused: u32,
}

impl Priors {
    /// The member of a number, a function of configuration, posterior, seed and number. Draws that the configuration refuses as a
    /// whole are drawn again: the distribution is that of the tools which it accepts.
    ///
    /// # Errors
    /// When the configuration refuses every draw.
    pub fn member(&self, seed: u64, member: u64) -> Result<Member, UncertaintyError> {
        let mut random = Random::new(seed, member, Part::Keys);
        let mut of_sample = Random::new(seed, member, Part::Sample);
        let of_sensors = self.sensor_scores(seed, member);
        let mut refused = 0;
        loop {
            let mut scores = scores(&mut random, self.entries().len());
            scores.extend(&of_sensors);
            if let Some(sample) = &self.sample {
                // A member of the sample that the configuration refuses is replaced by any other.
                let share = match refused {
                    0 => spread_share(seed, member),
                    _ => of_sample.uniform(),
                };
                sample.draw(self.correlation_factor(), &mut scores, share, &mut of_sample);
            }
            match self.at(scores) {
                Ok(member) => return Ok(Member { refused, ..member }),
                Err(reason) => {
                    refused += 1;
                    if refused >= MOST_ATTEMPTS {
                        return Err(UncertaintyError::Refused {
                            member,
                            attempts: refused,
                            reason: Box::new(reason),
                        });
                    }
                }
            }
        }
    }

    /// The member at these scores, as in [`Member::scores`]; those that are missing are 0, the medians.
    ///
    /// # Errors
    /// When the configuration refuses its values as a whole.
    pub fn at(&self, mut scores: Vec<f64>) -> Result<Member, ConfigError> {
        let (keys, sensors) = (self.entries().len(), self.sensors().len());
        scores.resize(keys + 2 * sensors, 0.0);
        let (of_keys, of_sensors) = scores.split_at(keys);
        let draws = self.draws_at(of_keys);
        Ok(Member {
            config: self.config(&draws)?,
            draws,
            sensors: self.errors_at(of_sensors),
            refused: 0,
            scores,
        })
    }

    /// The first draws of a member from the priors, which the configuration may refuse as a whole.
    pub fn draws(&self, seed: u64, member: u64) -> Vec<f64> {
        let mut random = Random::new(seed, member, Part::Keys);
        self.draws_at(&scores(&mut random, self.entries().len()))
    }

    fn draws_at(&self, scores: &[f64]) -> Vec<f64> {
        let draw = |(entry, score): (&Entry, f64)| entry.draw(standard_normal(score));
        self.entries().iter().zip(self.correlated(scores)).map(draw).collect()
    }

    /// The configuration for draws, by [`Priors::entries`].
    ///
    /// # Errors
    /// When it refuses them as a whole.
    pub fn config(&self, draws: &[f64]) -> Result<Config, ConfigError> {
        let entries = self.entries().iter().zip(draws);
        let values = entries.flat_map(|(entry, draw)| entry.values(*draw));
        self.base.with_values("a plausible tool", values)
    }

    /// The errors of the sensors of a member, by [`Priors::sensors`].
    pub fn sensor_errors(&self, seed: u64, member: u64) -> Vec<SensorError> {
        self.errors_at(&self.sensor_scores(seed, member))
    }

    fn sensor_scores(&self, seed: u64, member: u64) -> Vec<f64> {
        scores(&mut Random::new(seed, member, Part::Sensors), 2 * self.sensors().len())
    }

    fn errors_at(&self, scores: &[f64]) -> Vec<SensorError> {
        let sensors = self.sensors().iter().zip(scores.chunks_exact(2));
        sensors
            .map(|(sensor, pair)| sensor.error([pair[0], pair[1]].map(standard_normal)))
            .collect()
    }
}

/// Shares of the weights at which members take a sample: multiples of the golden section, from a beginning that the seed
/// decides. As in systematic resampling, any number of members takes each part of the sample as often as its weight asks for;
/// and a member does not depend on how many there are.
fn spread_share(seed: u64, member: u64) -> f64 {
    /// 2^64 times the golden section.
    const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
    /// 2^-53.
    const UNIT: f64 = 1.0 / (1u64 << 53) as f64;
    let begin = Random::new(seed, u64::MAX, Part::Sample).bits();
    (begin.wrapping_add(member.wrapping_mul(GOLDEN)) >> 11) as f64 * UNIT
}

/// The next independent standard normal scores.
fn scores(random: &mut Random, count: usize) -> Vec<f64> {
    (0..count).map(|_| standard_quantile(random.uniform())).collect()
}
