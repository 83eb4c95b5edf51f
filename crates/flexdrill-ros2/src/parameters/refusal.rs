//! Reasons for the refusal of a parameter change.

use ros2_client::parameters::ParameterType;

/// Why a change is refused, with parameter, value, limit and remedy.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    /// No such parameter.
    #[error("there is no parameter '{name}'; {hint}")]
    Unknown {
        /// Name, as it was given.
        name: String,
        /// Similar names.
        hint: String,
    },
    /// The parameter is fixed at the start.
    #[error("'{name}' cannot change while the twin runs: {why}")]
    ReadOnly {
        /// Dotted name of the parameter.
        name: String,
        /// The reason, and the remedy.
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
    /// What the parameters configure is not valid with the value.
    #[error(transparent)]
    Invalid(Box<dyn std::error::Error + Send + Sync>),
    /// The solver's queue of commands is full.
    #[error("the values are fine but cannot be passed on: {why}; nothing was changed, set them again")]
    NotPassedOn {
        /// The reason.
        why: String,
    },
}
