//! The priors of a configuration.

use std::collections::BTreeMap;

use flexdrill_config::{Config, Distribution, Form, NumberKey, UncertainKey};
use nalgebra::{DMatrix, DVector};

use crate::error::UncertaintyError;
use crate::law::{Law, standard_normal};
use crate::posterior::{Posterior, PosteriorError, Sample};
use crate::sensors::{Sensor, sensors};

/// What is not known of a tool and its rig.
#[derive(Debug, Clone)]
pub struct Priors {
    /// The configuration without the section, whose values are replaced.
    pub(crate) base: Config,
    /// In the order of the file.
    entries: Vec<Entry>,
    /// The errors of the sensors, by [`crate::Channel`].
    sensors: Vec<Sensor>,
    /// Lower Cholesky factor of the correlations of the normal scores.
    factor: DMatrix<f64>,
    /// What members are drawn from instead, where a calibration has found it.
    pub(crate) sample: Option<Sample>,
}

/// A draw with its distribution, and the keys that it acts on.
#[derive(Debug, Clone)]
pub struct Entry {
    keys: Vec<Key>,
    /// The distribution as stated.
    pub distribution: Distribution,
    /// What is drawn.
    pub form: Form,
    /// Source of the distribution.
    pub source: String,
    law: Law,
}

/// A key with what is configured.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// Dotted path.
    pub name: String,
    /// The value in the file.
    pub configured: f64,
    /// Empty if dimensionless.
    pub unit: &'static str,
    /// Smallest and largest value that the key may have.
    limits: [f64; 2],
}

impl Key {
    fn of(number: &NumberKey) -> Self {
        // A limit that is itself not allowed ends at the next number.
        let low = if number.low_is_in {
            number.low
        } else {
            number.low.next_up()
        };
        Self {
            name: number.key.clone(),
            configured: number.value,
            unit: number.unit,
            limits: [low, number.high],
        }
    }

    /// The value for a draw; limits are held to the bit.
    fn value(&self, form: Form, draw: f64) -> f64 {
        form.value(draw, self.configured).clamp(self.limits[0], self.limits[1])
    }
}

impl Entry {
    fn of(entry: &UncertainKey, numbers: &BTreeMap<String, NumberKey>) -> Result<Self, UncertaintyError> {
        let mut keys = Vec::new();
        for name in entry.names() {
            let number = numbers
                .get(name)
                .ok_or_else(|| UncertaintyError::Fixed { key: name.to_owned() })?;
            keys.push(Key::of(number));
        }
        // One draw acts on all keys, so that it has the limits of all.
        let [low, high] = keys
            .iter()
            .fold([f64::NEG_INFINITY, f64::INFINITY], |[low, high], key| {
                let [a, b] = key.limits.map(|limit| entry.form.draw(limit, key.configured));
                [low.max(a.min(b)), high.min(a.max(b))]
            });
        let law = Law::new(&entry.distribution, [low, high]).ok_or_else(|| UncertaintyError::Empty {
            key: entry.key.clone(),
            low,
            high,
        })?;
        Ok(Self {
            keys,
            distribution: entry.distribution,
            form: entry.form,
            source: entry.source.clone(),
            law,
        })
    }

    /// The key that the entry is named after.
    pub fn name(&self) -> &str {
        self.keys.first().map_or("", |key| &key.name)
    }

    /// All keys.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// Its distribution, cut off at the limits of its keys.
    pub(crate) fn law(&self) -> &Law {
        &self.law
    }

    /// The draw below which a share p of the draws lies, for p from 0 to 1.
    pub fn draw(&self, p: f64) -> f64 {
        self.law.quantile(p)
    }

    /// Every key with its value for a draw.
    pub fn values(&self, draw: f64) -> impl Iterator<Item = (&str, f64)> {
        self.keys
            .iter()
            .map(move |key| (key.name.as_str(), key.value(self.form, draw)))
    }
}

impl Priors {
    /// The priors of a configuration; without the section `uncertainty` there are none, and nothing is drawn.
    ///
    /// # Errors
    /// When a key cannot be changed by its name, or the correlations are none, which the check of a configuration finds
    /// too.
    pub fn of(config: &Config) -> Result<Self, UncertaintyError> {
        let base = config.without_uncertainty();
        let Some(stated) = &config.uncertainty else {
            return Ok(Self {
                base,
                entries: Vec::new(),
                sensors: Vec::new(),
                factor: DMatrix::zeros(0, 0),
                sample: None,
            });
        };
        let numbers: BTreeMap<String, NumberKey> = base
            .numbers()
            .into_iter()
            .map(|number| (number.key.clone(), number))
            .collect();
        let mut entries = Vec::new();
        for entry in &stated.keys {
            entries.push(Entry::of(entry, &numbers)?);
        }
        // Some numbers have names of the check alone; they are found here, and not at the first draw.
        let fixed = entries.iter().flat_map(Entry::keys).find(|key| !base.has(&key.name));
        if let Some(key) = fixed {
            return Err(UncertaintyError::Fixed { key: key.name.clone() });
        }
        let mut correlations = DMatrix::identity(entries.len(), entries.len());
        for (row, column, correlation) in stated.correlations() {
            correlations[(row, column)] = correlation;
            correlations[(column, row)] = correlation;
        }
        let factor = correlations.cholesky().ok_or(UncertaintyError::Correlation)?.unpack();
        Ok(Self {
            sensors: sensors(config, stated),
            base,
            entries,
            factor,
            sample: None,
        })
    }

    /// The same with members that are drawn from what a calibration has found: jointly from its sample where it has a key,
    /// from the priors given those where it has none. A score of a member means the same as without it.
    ///
    /// # Errors
    /// When a key of the sample has no distribution, or one without a value of the sample.
    pub fn drawn_from(self, posterior: &Posterior) -> Result<Self, PosteriorError> {
        let sample = Sample::of(&self, posterior, true)?;
        Ok(self.with_sample(sample))
    }

    /// The same for a configuration that was changed while members run: keys of the sample that have lost their
    /// distribution keep their configured values, and values beyond one are held at its ends.
    #[must_use]
    pub fn drawn_from_what_holds(self, posterior: &Posterior) -> Self {
        match Sample::of(&self, posterior, false) {
            Ok(sample) => self.with_sample(sample),
            Err(_) => self,
        }
    }

    fn with_sample(self, sample: Sample) -> Self {
        Self {
            sample: (!sample.is_empty()).then_some(sample),
            ..self
        }
    }

    /// Lower Cholesky factor of the correlations of the normal scores.
    pub(crate) fn correlation_factor(&self) -> &DMatrix<f64> {
        &self.factor
    }

    /// The draw of an entry below which a share p of the draws lies, whatever the others are: of the sample where it decides the
    /// entry, of its distribution elsewhere.
    pub fn draw(&self, entry: usize, p: f64) -> f64 {
        let of_sample = self.sample.as_ref().and_then(|sample| sample.score(entry, p));
        let share = of_sample.map_or(p, standard_normal);
        self.entries.get(entry).map_or(f64::NAN, |entry| entry.draw(share))
    }

    /// All entries, in the order of the file.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The sensors that are not known, with their errors.
    pub fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    /// The configuration without the section.
    pub fn base(&self) -> &Config {
        &self.base
    }

    /// Whether nothing is drawn.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty() && self.sensors.is_empty()
    }

    /// Correlated normal scores from independent ones.
    pub(crate) fn correlated(&self, independent: &[f64]) -> Vec<f64> {
        let scores = &self.factor * DVector::from_column_slice(independent);
        scores.iter().copied().collect()
    }
}
