//! What is wrong with a configuration, in words that name the place.

use std::fmt;
use std::path::PathBuf;

/// Why a configuration was refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// The file could not be read.
    #[error("{}: cannot be read: {reason}", path.display())]
    Read {
        /// File or folder that it is about.
        path: PathBuf,
        /// The system's reason.
        reason: std::io::Error,
    },
    /// Not YAML, an unknown or missing key, or a value of the wrong type.
    #[error("{file}:{line}:{column}: {}{message}", prefix(key))]
    Syntax {
        /// Name of the file.
        file: String,
        /// 1-based; 0 if unknown.
        line: u64,
        /// 1-based; 0 if unknown.
        column: u64,
        /// Dotted path of the key or its parent; empty if unknown.
        key: String,
        /// What is wrong.
        message: String,
    },
    /// It reads well but does not make sense; every problem found, in the order of the schema.
    #[error("{}", lines(problems))]
    Invalid {
        /// At least one.
        problems: Vec<Problem>,
    },
    /// A key asked for by name (a parameter, a command line override) does not exist.
    #[error("{key}: no such key in the configuration{}", meant.as_ref().map_or_else(String::new, |meant| format!("; did you mean {meant}?")))]
    UnknownKey {
        /// Dotted path.
        key: String,
        /// Dotted path of the key that was probably meant, if one is similar.
        meant: Option<String>,
    },
    /// A value set by name has the wrong type.
    #[error("{key} = {value}: {message}")]
    WrongType {
        /// Dotted path.
        key: String,
        /// Value, as it was given.
        value: String,
        /// What is wrong.
        message: String,
    },
}

/// One value that is out of its bounds or contradicts another.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Problem {
    /// Name of the file.
    pub file: String,
    /// Line of the value, or of the nearest enclosing key if the value is a default; `None` without a file.
    pub line: Option<u64>,
    /// Whether the value is a default, not written in the file.
    pub is_default: bool,
    /// Dotted path, list positions counted from 0: `loads.0.at`.
    pub key: String,
    /// The value as written.
    pub value: String,
    /// Unit of value and bound; empty if dimensionless.
    pub unit: &'static str,
    /// What it must be.
    pub bound: String,
    /// Why, or what to do.
    pub reason: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        let space = if self.unit.is_empty() { "" } else { " " };
        write!(f, ": {} = {}{space}{}", self.key, self.value, self.unit)?;
        if self.is_default {
            write!(f, " (the default)")?;
        }
        write!(f, ": must be {}", self.bound)?;
        if !self.reason.is_empty() {
            write!(f, " ({})", self.reason)?;
        }
        Ok(())
    }
}

fn prefix(key: &str) -> String {
    if key.is_empty() {
        String::new()
    } else {
        format!("{key}: ")
    }
}

fn lines(problems: &[Problem]) -> String {
    problems.iter().map(Problem::to_string).collect::<Vec<_>>().join("\n")
}
