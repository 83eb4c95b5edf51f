//! Why a parameter does not change.

use flexdrill_config::ConfigError;
use ros2_client::parameters::ParameterType;

/// Why a change is refused: which parameter, which value, which limit, what to do.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    /// No such parameter.
    #[error("there is no parameter '{name}'; {hint}")]
    Unknown {
        /// Name, as it was given.
        name: String,
        /// Names that are like it.
        hint: String,
    },
    /// It only counts at the start.
    #[error("'{name}' cannot change while the twin runs: {why}")]
    ReadOnly {
        /// Dotted name of the parameter.
        name: String,
        /// Why not, and how else.
        why: String,
    },
    /// A value of another type than the parameter's.
    #[error("'{name}' is a {own:?}, not a {given:?} ({value})")]
    WrongType {
        /// Dotted name of the parameter.
        name: String,
        /// Its type.
        own: ParameterType,
        /// Type of the value.
        given: ParameterType,
        /// Value, as it was given.
        value: String,
    },
    /// NaN or infinite.
    #[error("'{name}' must be a finite number, not {value}")]
    NotFinite {
        /// Dotted name of the parameter.
        name: String,
        /// Value, as it was given.
        value: String,
    },
    /// The configuration does not make sense with it.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The solver takes nothing at the moment.
    #[error("the values are fine but cannot be passed on: {why}; nothing was changed, set them again")]
    NotPassedOn {
        /// What is in the way.
        why: String,
    },
}
