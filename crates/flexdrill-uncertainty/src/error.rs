//! Why a configuration has no priors, or a member cannot be drawn.

use flexdrill_config::ConfigError;

use crate::posterior::PosteriorError;

/// Why a configuration has no priors, or a member cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UncertaintyError {
    /// A key that an entry names has no value that could be replaced.
    #[error("uncertainty: {key} has a value that cannot be changed by its name; leave it out of uncertainty.keys")]
    Fixed {
        /// Dotted path.
        key: String,
    },
    /// The distribution has no values within the limits of its keys.
    #[error("uncertainty: the distribution of {key} has no values from {low} to {high}, the limits of its keys")]
    Empty {
        /// Dotted path of the first key.
        key: String,
        /// Smallest draw that the limits of all keys allow.
        low: f64,
        /// Largest.
        high: f64,
    },
    /// The correlations are not those of any set of values.
    #[error("uncertainty.correlated: the correlations of all pairs are not positive definite")]
    Correlation,
    /// What a calibration has found cannot be used.
    #[error(transparent)]
    Posterior(#[from] PosteriorError),
    /// The configuration does not allow a value.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The configuration names a posterior, and its file was not read.
    #[error("ensemble.from: {file}: the posterior is needed to draw plausible tools, and was not given")]
    NotGiven {
        /// The file that it names.
        file: String,
    },
    /// A factor is given for a figure that has no band.
    #[error("ensemble.band_factors: {figure} is no figure of twin/bands; did you mean {nearest}?")]
    Figure {
        /// The name that is given.
        figure: String,
        /// The nearest one that there is.
        nearest: String,
    },
    /// The configuration refuses every draw of a member.
    #[error("uncertainty: {attempts} draws of member {member} were refused; the last one because of {reason}")]
    Refused {
        /// Number of the member.
        member: u64,
        /// Draws.
        attempts: u32,
        /// Why the last one was refused.
        reason: Box<ConfigError>,
    },
}
