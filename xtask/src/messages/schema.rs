//! The `ros2msg` schema: a message's own text, then that of every message it is made of, each behind a separator.

use super::GenerateError;
use super::catalogue::Catalogue;
use super::definition::Definition;

/// The line between two messages of a schema.
pub const SEPARATOR: &str = "================================================================================";

/// The whole schema as text.
///
/// # Errors
/// When it names a message that the catalogue does not have.
pub fn schema(definition: &Definition, catalogue: &Catalogue) -> Result<String, GenerateError> {
    let mut text = definition.text.clone();
    for dependency in catalogue.dependencies(definition)? {
        text.push_str(&head(dependency));
        text.push_str(&dependency.text);
    }
    Ok(text)
}

/// What stands before a nested message's text.
pub(super) fn head(definition: &Definition) -> String {
    format!("{SEPARATOR}\nMSG: {}\n", definition.name.short())
}
