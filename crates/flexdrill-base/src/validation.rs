//! Checks of descriptions and settings: one error type and a few kinds of bounds.
//!
//! The bounds here are those that the mechanics needs to compute at all: a mass above zero, a step above zero, lists of
//! the right length. The YAML schema has the narrower bounds of sensible practice.

use crate::Location;

/// A description, settings or parameters that the mechanics cannot compute with.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ValidationError {
    /// A number out of its bounds, NaN and infinity included.
    #[error("{field} = {value}{}{unit}: must be {bound}", if unit.is_empty() { "" } else { " " })]
    Value {
        /// Path of the field, such as `guide_section.outer_diameter`.
        field: String,
        /// The value found.
        value: f64,
        /// Its SI unit; empty if dimensionless.
        unit: &'static str,
        /// The bound, in the same unit.
        bound: String,
    },
    /// A list that does not fit the mesh, or is empty.
    #[error("{field}: {got} entries, must be {expected}")]
    Length {
        /// Path of the list.
        field: String,
        /// Entries found.
        got: usize,
        /// Entries needed.
        expected: String,
    },
    /// A location outside the tool.
    #[error(
        "{field} = {location:?}: not on the tool, which has stations 0 to {last_station} and {joints} joints, \
         counted from 0"
    )]
    Location {
        /// Path of the field.
        field: String,
        /// The location found.
        location: Location,
        /// Last station.
        last_station: usize,
        /// Number of joints.
        joints: usize,
    },
    /// Two values that exclude each other.
    #[error("{field}: {conflict}")]
    Contradiction {
        /// Path of the field to change.
        field: String,
        /// The contradiction, and the remedy.
        conflict: &'static str,
    },
}

/// Bounds of a number; all of them exclude NaN and infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// Any finite number.
    Finite,
    /// Above 0.
    Positive,
    /// 0 or more.
    NotNegative,
    /// Between two numbers, both allowed.
    Within(f64, f64),
    /// Between two numbers, the first not allowed.
    Above(f64, f64),
    /// Above another value.
    Over(f64),
}

impl Bound {
    fn holds(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Finite => true,
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::Within(low, high) => (low..=high).contains(&value),
                Self::Above(low, high) => value > low && value <= high,
                Self::Over(low) => value > low,
            }
    }

    fn words(self) -> String {
        match self {
            Self::Finite => "finite".to_owned(),
            Self::Positive => "finite and above 0".to_owned(),
            Self::NotNegative => "finite and at least 0".to_owned(),
            Self::Within(low, high) => format!("{low} to {high}"),
            Self::Above(low, high) => format!("above {low}, at most {high}"),
            Self::Over(low) => format!("finite and above {low}"),
        }
    }

    /// Checks the value of `field`.
    ///
    /// # Errors
    /// [`ValidationError::Value`].
    pub fn check(self, field: &str, value: f64, unit: &'static str) -> Result<(), ValidationError> {
        if self.holds(value) {
            Ok(())
        } else {
            Err(ValidationError::Value {
                field: field.to_owned(),
                value,
                unit,
                bound: self.words(),
            })
        }
    }

    /// The same for several fields `under.name` of one unit.
    ///
    /// # Errors
    /// As [`Bound::check`].
    pub fn check_all(self, under: &str, fields: &[(&str, f64)], unit: &'static str) -> Result<(), ValidationError> {
        fields
            .iter()
            .try_for_each(|(name, value)| self.check(&format!("{under}.{name}"), *value, unit))
    }
}

/// Checks a count against its limits, both allowed.
///
/// # Errors
/// [`ValidationError::Value`].
pub fn count(field: &str, value: usize, least: usize, most: usize) -> Result<(), ValidationError> {
    Bound::Within(least as f64, most as f64).check(field, value as f64, "")
}

/// Checks the length of a list.
///
/// # Errors
/// [`ValidationError::Length`].
pub fn length(field: &str, got: usize, expected: usize, why: &str) -> Result<(), ValidationError> {
    if got == expected {
        Ok(())
    } else {
        Err(ValidationError::Length {
            field: field.to_owned(),
            got,
            expected: format!("{expected}, {why}"),
        })
    }
}

/// Refuses values that exclude each other.
///
/// # Errors
/// [`ValidationError::Contradiction`].
pub fn require(holds: bool, field: &str, conflict: &'static str) -> Result<(), ValidationError> {
    if holds {
        Ok(())
    } else {
        Err(ValidationError::Contradiction {
            field: field.to_owned(),
            conflict,
        })
    }
}
