//! What is wrong with a map.

use super::{FORMAT, MOST_BYTES};

/// Why a map was refused.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// The file could not be read.
    #[error("{file}: cannot be read: {reason}")]
    Read {
        /// The file.
        file: String,
        /// The system's reason.
        reason: std::io::Error,
    },
    /// The file is too large.
    #[error("{file}: more than {MOST_BYTES} bytes: no map is that large")]
    Large {
        /// The file.
        file: String,
    },
    /// It is not the JSON of a map.
    #[error("{file}: not a map of flexdrill, or damaged: {reason}")]
    NoMap {
        /// The file.
        file: String,
        /// With line and column.
        reason: String,
    },
    /// Another version's.
    #[error(
        "{file}: a map of format {found}; this program reads format {FORMAT}: make the map again with this program"
    )]
    Format {
        /// The file.
        file: String,
        /// Its format.
        found: u32,
    },
    /// It contradicts itself.
    #[error("{file}: damaged: {what} = {value}: must be {bound}")]
    Damaged {
        /// The file.
        file: String,
        /// Path of the value.
        what: String,
        /// The value.
        value: String,
        /// What it must be.
        bound: String,
    },
}
