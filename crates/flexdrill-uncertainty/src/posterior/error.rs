//! Why a posterior's sample is not used.

use std::path::PathBuf;

use flexdrill_config::checker::number;

/// Why a posterior's sample is not used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PosteriorError {
    /// The file cannot be read.
    #[error("{}: the posterior named by ensemble.from cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A line is not what `flexdrill calibrate` writes.
    #[error("{file}:{line}: no posterior of `flexdrill calibrate`: {reason}")]
    Line {
        /// The file.
        file: String,
        /// Its line, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// A value is out of bounds.
    #[error(
        "{file}:{line}: {key}: {}{}: must be {rule}",
        number(*value), unit_after(unit)
    )]
    Value {
        /// The file.
        file: String,
        /// Its line, from 1.
        line: usize,
        /// The key.
        key: String,
        /// Its value.
        value: f64,
        /// Of the value; empty if dimensionless.
        unit: &'static str,
        /// What is allowed, and why.
        rule: String,
    },
    /// A column that is no number of the configuration.
    #[error(
        "{file}: {key}: must be the name of a number of this configuration{}",
        meant.as_ref().map_or_else(String::new, |meant| format!("; did you mean {meant}?"))
    )]
    UnknownKey {
        /// The file.
        file: String,
        /// The name of the column.
        key: String,
        /// The nearest name that is known.
        meant: Option<String>,
    },
    /// A column without a distribution, in which renewed members would have no scale.
    #[error(
        "{file}: {key}: must be in uncertainty.keys, or the factor or tare of a sensor with a range in uncertainty.sensors or \
         calibration: members near it are drawn by its distribution. 90 % of its values are {low} to {high}; state a distribution that is wider"
    )]
    NoPrior {
        /// The file.
        file: String,
        /// The name of the column.
        key: String,
        /// 5 % of the sample are below.
        low: String,
        /// 5 % of the sample are above.
        high: String,
    },
    /// The effective number of members is too small.
    #[error("{file}: its weights amount to {} members alike: must be at least {}", number((*effective * 10.0).round() / 10.0), number(*least))]
    TooFew {
        /// The file.
        file: String,
        /// Square of the sum of the weights over the sum of their squares.
        effective: f64,
        /// What is needed.
        least: f64,
    },
    /// The calibration is not to be used.
    #[error("{file}: this calibration is not to be used: {why}")]
    NotToBeUsed {
        /// The file.
        file: String,
        /// The objections of the calibration.
        why: String,
    },
    /// It was fitted to another tool.
    #[error(
        "{file}: a posterior of another tool or hole (log \"{log}\", tool {}): this configuration has {} without the fitted \
         keys; calibrate again with this configuration",
        short(found),
        short(own)
    )]
    OtherTool {
        /// The file.
        file: String,
        /// The log that it was fitted to.
        log: String,
        /// Hash of its tool.
        found: String,
        /// Hash of the configuration's tool.
        own: String,
    },
    /// Another file than the configuration names.
    #[error(
        "{file}: its SHA-256 is {}: must be {}, ensemble.posterior_sha256, for the same plausible tools",
        short(found),
        short(wanted)
    )]
    OtherFile {
        /// The file.
        file: String,
        /// Its SHA-256.
        found: String,
        /// That of the configuration.
        wanted: String,
    },
}

/// A unit with the space before it.
fn unit_after(unit: &str) -> String {
    match unit {
        "" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// The first digits of a hash, enough to compare by eye.
fn short(hash: &str) -> String {
    hash.chars().take(12).collect()
}
