//! `uncertainty`: what is not known of the tool and the rig, as distributions of keys and errors of sensors.
//!
//! The section states distributions; nothing of it acts on a run of the configuration itself.

mod check;
mod sensors;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::section::section;

pub use sensors::{DownholeTorque, DownholeWeight, Factor, Sensors, SpeedSensor, WeightIndicator};

section! {
    /// What is not known. A set of values drawn from it is a plausible tool; a run of the configuration itself has the values
    /// of the file.
    pub struct Uncertainty(this) {
        /// Keys whose values are not known, each with its distribution and the source of it. Default none.
        keys: Vec<UncertainKey> = Vec::new();
        /// Groups of these keys whose values are correlated. Default none.
        correlated: Vec<Correlated> = Vec::new();
        /// Errors of the rig's sensors that `calibration` does not state.
        sensors: Sensors = Sensors::default(), below;
    }
}

/// A key whose value is not known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UncertainKey {
    /// Name of the key, a number of this file, such as `contact.inner.stiffness`. Required.
    pub key: String,
    /// Names of further keys that have the same draw. Default none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<String>,
    /// Distribution of the value, cut off at the limits of the key. Required.
    pub distribution: Distribution,
    /// What is drawn: the `value` of the key, a `factor` on the value in this file, or an `offset` added to it. Default
    /// value.
    #[serde(default)]
    pub form: Form,
    /// Where the distribution comes from: a publication, a drawing, a measurement, or that it is an assumption. Required.
    pub source: String,
}

section! {
    /// Keys whose values are correlated.
    pub struct Correlated(this) {
        /// Names of the keys, at least two. Each is in `uncertainty.keys`. Required.
        keys: Vec<String>;
        /// Correlation of each pair: that of the normal distributions which the values are drawn through. Required.
        correlation: f64, within(-0.999, 0.999), "", "values of a correlation of 1 are one value: use `also`";
    }
}

/// What is drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// The value of the key, in its unit.
    #[default]
    Value,
    /// A factor on the configured value.
    Factor,
    /// An offset to the configured value, in its unit.
    Offset,
}

/// Distribution of a value that is not known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Distribution {
    /// `normal: {low: -0.5, high: 0.5}`: normal, with 90 % of the values between `low` and `high`.
    Normal {
        /// 5 % of the values are below.
        low: f64,
        /// 5 % of the values are above.
        high: f64,
    },
    /// `log_normal: {low: 0.2, high: 0.4}`: the logarithm is normal, with 90 % of the values between `low` and `high`.
    LogNormal {
        /// 5 % of the values are below; above 0.
        low: f64,
        /// 5 % of the values are above.
        high: f64,
    },
    /// `uniform: {low: 0, high: 1}`: every value between `low` and `high` is as likely.
    Uniform {
        /// The smallest value.
        low: f64,
        /// The largest value.
        high: f64,
    },
    /// `triangular: {low: 0, mode: 0.2, high: 1}`: most likely at `mode`, less and less likely towards `low` and `high`.
    Triangular {
        /// The smallest value.
        low: f64,
        /// The likeliest value.
        mode: f64,
        /// The largest value.
        high: f64,
    },
}

impl Distribution {
    /// Its name in a file.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Normal { .. } => "normal",
            Self::LogNormal { .. } => "log_normal",
            Self::Uniform { .. } => "uniform",
            Self::Triangular { .. } => "triangular",
        }
    }

    /// `low` and `high` as the file states them: the ends of 90 % of the values, or of all.
    pub const fn ends(&self) -> [f64; 2] {
        match *self {
            Self::Normal { low, high }
            | Self::LogNormal { low, high }
            | Self::Uniform { low, high }
            | Self::Triangular { low, high, .. } => [low, high],
        }
    }
}

impl UncertainKey {
    /// All keys that the draw acts on.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.key).chain(&self.also).map(String::as_str)
    }
}

impl Form {
    /// The value of a key for a draw, where the file has `configured`.
    pub fn value(self, draw: f64, configured: f64) -> f64 {
        match self {
            Self::Value => draw,
            Self::Factor => configured * draw,
            Self::Offset => configured + draw,
        }
    }

    /// The draw that gives a key this value; not finite for a factor on 0.
    pub fn draw(self, value: f64, configured: f64) -> f64 {
        match self {
            Self::Value => value,
            Self::Factor => value / configured,
            Self::Offset => value - configured,
        }
    }
}

impl Uncertainty {
    /// The place in `keys` of the entry that has this key.
    pub fn position(&self, key: &str) -> Option<usize> {
        self.keys.iter().position(|entry| entry.names().any(|name| name == key))
    }

    /// Pairs of places in `keys` with their correlation; keys that are in no entry are left out.
    pub fn correlations(&self) -> Vec<(usize, usize, f64)> {
        let mut pairs = Vec::new();
        for group in &self.correlated {
            let places: Vec<usize> = group.keys.iter().filter_map(|key| self.position(key)).collect();
            for (at, &first) in places.iter().enumerate() {
                pairs.extend(
                    places[at + 1..]
                        .iter()
                        .map(|&second| (first, second, group.correlation)),
                );
            }
        }
        pairs
    }
}
