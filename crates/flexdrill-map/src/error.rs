//! What is wrong with a map.

use super::{FORMAT, MOST_BYTES};

/// Why a map was refused.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// The file could not be read.
    #[error("{file}: cannot be read: {reason}")]
    Read {
        /// Path of the file, for the message.
        file: String,
        /// The system's reason.
        reason: std::io::Error,
    },
    /// The file is too large.
    #[error("{file}: more than {MOST_BYTES} bytes: no map is that large")]
    Large {
        /// Path of the file, for the message.
        file: String,
    },
    /// It is not the JSON of a map.
    #[error("{file}: not a map of flexdrill, or damaged: {reason}")]
    NoMap {
        /// Path of the file, for the message.
        file: String,
        /// With line and column.
        reason: String,
    },
    /// Another version's.
    #[error(
        "{file}: a map of format {found}; this program reads format {FORMAT}: make the map again with this program"
    )]
    Format {
        /// Path of the file, for the message.
        file: String,
        /// Its format.
        found: u32,
    },
    /// It contradicts itself.
    #[error("{file}: damaged: {what} = {value}: must be {bound}")]
    Damaged {
        /// Path of the file, for the message.
        file: String,
        /// Path of the value.
        what: String,
        /// The value.
        value: String,
        /// What it must be.
        bound: String,
    },
}
