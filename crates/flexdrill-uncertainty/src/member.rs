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
    /// The draws, by [`Priors::entries`].
    pub draws: Vec<f64>,
    /// The errors of the sensors, by [`Priors::sensors`].
    pub sensors: Vec<SensorError>,
    /// Draws before this one that the configuration refused, because keys exclude each other.
    pub refused: u32,
}

impl Priors {
    /// The member of a number, a function of configuration, seed and number. Draws that the configuration refuses as a
    /// whole are drawn again: the distribution is that of the tools which it accepts.
    ///
    /// # Errors
    /// When the configuration refuses every draw.
    pub fn member(&self, seed: u64, member: u64) -> Result<Member, UncertaintyError> {
        let mut random = Random::new(seed, member, Part::Keys);
        let mut refused = 0;
        loop {
            let draws = self.next_draws(&mut random);
            match self.config(&draws) {
                Ok(config) => {
                    return Ok(Member {
                        config,
                        draws,
                        sensors: self.sensor_errors(seed, member),
                        refused,
                    });
                }
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

    /// The first draws of a member, which the configuration may refuse as a whole.
    pub fn draws(&self, seed: u64, member: u64) -> Vec<f64> {
        self.next_draws(&mut Random::new(seed, member, Part::Keys))
    }

    fn next_draws(&self, random: &mut Random) -> Vec<f64> {
        let entries = self.entries();
        let scores = entries.iter().map(|_| standard_quantile(random.uniform())).collect();
        let scores = self.correlated(scores);
        let draw = |(entry, score): (&Entry, f64)| entry.draw(standard_normal(score));
        entries.iter().zip(scores).map(draw).collect()
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
        let mut random = Random::new(seed, member, Part::Sensors);
        let sensors = self.sensors().iter();
        sensors
            .map(|sensor| sensor.error([random.uniform(), random.uniform()]))
            .collect()
    }
}
