//! From a file to a checked value, with errors that name key path, value and place.

use std::path::Path;

use serde::de::DeserializeOwned;

use super::checker::Checker;
use super::error::ConfigError;
use super::lines::Lines;
use super::yaml_place as place;
use super::yaml_words::words;

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
    let is_missing = matches!(error.without_snippet(), serde_saphyr::Error::SerdeMissingField { .. });
    // A key that seems to be missing may be one that the reader did not reach, because the text before it is no YAML.
    let fault = if is_missing { Lines::fault(text) } else { None };
    let error = fault.as_ref().unwrap_or(error);
    let (mut line, mut column) = error.location().map_or((0, 0), |place| (place.line(), place.column()));
    let mut key = lines.key_at(line, column).to_string();
    let mut message = words(error);
    match error.without_snippet() {
        // The reader notices a missing key only at the end of its parent, or later.
        serde_saphyr::Error::SerdeMissingField { field, .. } => {
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
        }
        serde_saphyr::Error::InvalidScalar { .. } => {
            let value = place::scalar_at(text, line, column);
            if place::has_decimal_comma(&value) {
                message += "; decimals follow a point, not a comma";
            }
            key = format!("{key} = {value}");
        }
        serde_saphyr::Error::SerdeUnknownField { field, .. }
            if place::follows_decimal_comma(text, line, column, field) =>
        {
            message = format!("unknown field `{field}`; in a number, decimals follow a point, not a comma");
        }
        serde_saphyr::Error::SerdeUnknownField { .. } | serde_saphyr::Error::SerdeUnknownVariant { .. } => {}
        // A tab has other consequences further down, which the library then names.
        _ => {
            if let Some((tab_line, tab_column)) = place::tab_before_key(text, line) {
                (line, column) = (tab_line, tab_column);
                key = String::new();
                message = "a tab stands before this key; YAML indents with spaces".to_string();
            }
        }
    }
    ConfigError::Syntax {
        file: name.to_string(),
        line,
        column,
        key,
        message,
    }
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
