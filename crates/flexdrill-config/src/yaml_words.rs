//! Errors of the YAML library in words for a person who writes a file: no name of a type or of a function.

use serde_saphyr::{Error, MessageFormatter as _, UserMessageFormatter};

use crate::reading::nearest;

/// What is wrong with a text, without its place.
pub fn words(error: &Error) -> String {
    match error.without_snippet() {
        Error::SerdeUnknownField { field, expected, .. } => unknown("field", field, expected),
        Error::SerdeUnknownVariant { variant, expected, .. } => unknown("variant", variant, expected),
        Error::SerdeMissingField { field, .. } => format!("`{field}` must be given"),
        Error::InvalidScalar { ty, .. } => wanted(ty).map_or_else(|| format!("must be {ty}"), str::to_owned),
        Error::DuplicateMappingKey { key: Some(key), .. } => format!("`{key}` is given twice; keep one of them"),
        Error::DuplicateMappingKey { key: None, .. } => "this key is given twice; keep one of them".to_owned(),
        Error::MultipleDocuments { .. } => "a second document begins here, after `---`; a file has one".to_owned(),
        Error::NullIntoString { .. } => "has no value".to_owned(),
        Error::Unexpected { expected, .. } => match *expected {
            "mapping start" => "must be a group of keys".to_owned(),
            "sequence start" => "must be a list".to_owned(),
            "scalar" | "string scalar" => "must be one value, not a list or a group of keys".to_owned(),
            other => format!("expected {other}"),
        },
        Error::SerdeInvalidType {
            unexpected, expected, ..
        } => format!("must be {}, and is {}", kind(expected), kind(unexpected)),
        Error::ExternalMessage { msg, .. } => of_parser(msg),
        Error::AliasError { error, .. } => words(error),
        // The other messages for users name no function of the library.
        other => UserMessageFormatter.format_message(other).into_owned(),
    }
}

/// What a scalar of this type must be; `None` for a type whose name is in no file of ours.
fn wanted(ty: &str) -> Option<&'static str> {
    match ty {
        ty if ty.starts_with("floating") => Some("must be a number"),
        ty if ty.starts_with('u') => Some("must be a whole number, 0 or more"),
        ty if ty.starts_with('i') => Some("must be a whole number"),
        ty if ty.starts_with("bool") => Some("must be true or false"),
        _ => None,
    }
}

/// The message on a key or a word that is unknown, with the nearest known one.
fn unknown(what: &str, word: &str, expected: &[&'static str]) -> String {
    match nearest(word, expected.iter().copied()) {
        Some(near) => format!(
            "unknown {what} `{word}`; did you mean `{near}`? Expected one of {}",
            expected.join(", ")
        ),
        None => format!("unknown {what} `{word}`, expected one of {}", expected.join(", ")),
    }
}

/// The library's word for a kind of value, in words for files.
fn kind(word: &str) -> String {
    match word {
        "a map" | "map" => "a group of keys".to_owned(),
        "a sequence" | "sequence" => "a list".to_owned(),
        "a string" => "a text".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "unit" | "unit value" => "empty".to_owned(),
        word if word.starts_with("struct ") => "a group of keys".to_owned(),
        word if word.starts_with("f64") || word.starts_with("f32") => "a number".to_owned(),
        word => match word.strip_prefix("string ") {
            Some(text) => format!("the text {text}"),
            None => word.to_owned(),
        },
    }
}

/// The message of the parser, whose terms are those of the YAML specification.
fn of_parser(message: &str) -> String {
    /// Parts of messages with what a person is to look for.
    const MEANINGS: [(&str, &str); 7] = [
        ("tab", "a tab stands here; YAML indents with spaces"),
        ("expected ',' or '}'", "a `,` or `}` is missing before this place"),
        ("expected ',' or ']'", "a `,` or `]` is missing before this place"),
        (
            "mapping values are not allowed",
            "a second `: ` in one line, or an indentation that no other line has; a text with `: ` needs quotation marks",
        ),
        (
            "did not find expected key",
            "a key is expected here; is the line indented as those around it?",
        ),
        ("simple key", "a key needs a `: ` and a value behind it"),
        ("EOF", "the file ends before a bracket is closed"),
    ];
    let found = MEANINGS.iter().find(|(part, _)| message.contains(part));
    found.map_or_else(|| format!("not YAML: {message}"), |(_, meaning)| (*meaning).to_owned())
}
