//! Units in files: every spelling that logs have is read in every file.

use serde::de::Error as _;
use serde::de::value::StrDeserializer;
use serde::{Deserialize as _, Deserializer};

use flexdrill_core::inputs::Unit;

/// Reads a unit by any of its spellings, for `#[serde(deserialize_with)]`.
///
/// # Errors
/// When the text is no unit, or means several; the error then says what to write.
pub fn spelled<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Unit, D::Error> {
    let text = String::deserialize(deserializer)?;
    match (Unit::of_spelling(&text), Unit::ambiguous_spelling(&text)) {
        (Some(unit), _) => Ok(unit),
        (None, Some(words)) => Err(D::Error::custom(words)),
        // The derived function words the error of an unknown unit.
        (None, None) => Unit::deserialize(StrDeserializer::<D::Error>::new(&text)),
    }
}
