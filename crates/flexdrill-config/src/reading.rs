//! From a file to a checked value, with errors that name key path, value and place.

use std::path::Path;

use serde::de::DeserializeOwned;

use super::checker::Checker;
use super::error::ConfigError;
use super::lines::Lines;

/// The text of a file, and its name for errors.
///
/// # Errors
/// When it cannot be read.
pub fn read(path: &Path) -> Result<(String, String), ConfigError> {
    let text = std::fs::read_to_string(path).map_err(|reason| ConfigError::Read {
        path: path.to_path_buf(),
        reason,
    })?;
    Ok((path.display().to_string(), text))
}

/// Reads `text` and checks what it says; `name` stands for the file in errors, `required` are the keys without a
/// default.
///
/// # Errors
/// When the text is not YAML of the type, or `check` finds something.
pub fn checked<T: DeserializeOwned>(
    name: &str,
    text: &str,
    required: &[&str],
    check: impl FnOnce(&T, &mut Checker),
) -> Result<T, ConfigError> {
    let lines = Lines::of(text);
    let options = serde_saphyr::options! {
        alias_limits: alias_limits(),
    };
    let value = serde_saphyr::from_str_with_options(text, options)
        .map_err(|error| syntax_error(name, text, &lines, required, &error))?;
    let mut checker = Checker::new(name, &lines);
    check(&value, &mut checker);
    checker.finish().map(|()| value)
}

/// A short text whose aliases repeat one another is not expanded without end: a configuration that is written by hand
/// needs a few of them.
pub fn alias_limits() -> serde_saphyr::options::AliasLimits {
    /// Values that aliases may repeat, in all: more than a configuration has.
    const MOST_REPEATED: usize = 10_000;
    serde_saphyr::alias_limits! {
        max_total_replayed_events: MOST_REPEATED,
    }
}

/// Words the error of reading `text`, the content of the file `name`. `required` are the keys without a default, to
/// name the one that is missing.
fn syntax_error(name: &str, text: &str, lines: &Lines, required: &[&str], error: &serde_saphyr::Error) -> ConfigError {
    let (mut line, mut column) = error.location().map_or((0, 0), |place| (place.line(), place.column()));
    let mut key = lines.key_at(line, column).to_string();
    let mut message = unknown_message(error).unwrap_or_else(|| plain_message(error));
    if let serde_saphyr::Error::SerdeMissingField { field, .. } = error.without_snippet() {
        // The reader notices a missing key only at the end of its parent, or later.
        let missing = required.iter().find(|path| {
            let (parent, name) = path.rsplit_once('.').unwrap_or(("", path));
            name == *field && !lines.has(path) && (parent.is_empty() || lines.has(parent))
        });
        if let Some(path) = missing {
            let parent = path.rsplit_once('.').map_or("", |(parent, _)| parent);
            (line, column) = lines.place(parent).unwrap_or((1, 1));
            key = (*path).to_string();
            message = "must be given, it has no default".to_string();
        }
    } else if let Some(wanted) = wanted_scalar(&message) {
        let value = scalar_at(text, line, column);
        return ConfigError::Syntax {
            file: name.to_string(),
            line,
            column,
            key: format!("{key} = {value}"),
            message: wanted.to_string(),
        };
    }
    ConfigError::Syntax {
        file: name.to_string(),
        line,
        column,
        key,
        message,
    }
}

/// The reader's message without its snippet and place, which [`ConfigError::Syntax`] says in its own way.
fn plain_message(error: &serde_saphyr::Error) -> String {
    let text = error.without_snippet().to_string();
    let end = text.find(" at line ").unwrap_or(text.len());
    text[..end].trim_end_matches([',', ':', ' ']).to_string()
}

/// The message on a key or a word that is unknown, with the nearest known one.
fn unknown_message(error: &serde_saphyr::Error) -> Option<String> {
    let (what, word, expected) = match error.without_snippet() {
        serde_saphyr::Error::SerdeUnknownField { field, expected, .. } => ("field", field, expected),
        serde_saphyr::Error::SerdeUnknownVariant { variant, expected, .. } => ("variant", variant, expected),
        _ => return None,
    };
    let near = nearest(word, expected.iter().copied())?;
    Some(format!(
        "unknown {what} `{word}`; did you mean `{near}`? Expected one of {}",
        expected.join(", ")
    ))
}

/// The known word that was probably meant; none where no word is similar.
pub fn nearest<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    /// Largest edit distance of a misspelt word, as on the command line.
    const LARGEST_DISTANCE: usize = 2;
    let (distance, near) = known
        .map(|known| (strsim::damerau_levenshtein(word, known), known))
        .min()?;
    // A short word with every letter changed is another word.
    (distance <= LARGEST_DISTANCE && distance < word.chars().count()).then_some(near)
}

fn wanted_scalar(message: &str) -> Option<&'static str> {
    let kind = message.strip_prefix("invalid ")?;
    if kind.starts_with("floating") {
        Some("must be a number")
    } else if kind.starts_with('u') {
        Some("must be a whole number, 0 or more")
    } else if kind.starts_with("bool") {
        Some("must be true or false")
    } else {
        None
    }
}

/// The plain scalar that begins at a place (1-based).
fn scalar_at(text: &str, line: u64, column: u64) -> String {
    let (Ok(line), Ok(column)) = (usize::try_from(line), usize::try_from(column)) else {
        return String::new();
    };
    let row = text.lines().nth(line.saturating_sub(1)).unwrap_or("");
    let rest: String = row.chars().skip(column.saturating_sub(1)).collect();
    let end = rest.find([',', '}', ']', '#']).unwrap_or(rest.len());
    rest[..end].trim().to_string()
}
