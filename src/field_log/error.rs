//! Why a field log could not be read at all. What is wrong with single rows stands in the [`super::Report`].

use std::path::PathBuf;

use flexdrill_config::ConfigError;

/// Why a field log could not be read.
#[derive(Debug, thiserror::Error)]
pub enum FieldLogError {
    /// The mapping file is wrong.
    #[error(transparent)]
    Mapping(#[from] ConfigError),
    /// The log could not be opened or read.
    #[error("{}: cannot be read: {reason}", path.display())]
    Read {
        /// File or folder that it is about.
        path: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// The log is larger than a log can be.
    #[error("{file}: {bytes} bytes, at most {most} are read; split the log")]
    TooLarge {
        /// Name of the log.
        file: String,
        /// Its size.
        bytes: u64,
        /// The largest size.
        most: u64,
    },
    /// The log is text in an encoding that is not read.
    #[error(
        "{file}: it is {encoding}, not UTF-8; save it as \"CSV UTF-8\", or convert it: iconv -f {encoding} -t UTF-8"
    )]
    Encoding {
        /// Name of the log.
        file: String,
        /// Name of the encoding, as `iconv` knows it.
        encoding: &'static str,
    },
    /// The first line is too long for a header.
    #[error(
        "{file}: its first line has {bytes} bytes, at most {most} are read; a log has a header of column names, and one \
         row per line"
    )]
    LongHeader {
        /// Name of the log.
        file: String,
        /// Length of the line (bytes).
        bytes: usize,
        /// The longest that is read (bytes).
        most: usize,
    },
    /// A column that the mapping names is in the header twice.
    #[error(
        "{file}: column `{column}`, which {key} of the mapping names, is in the header twice, as field {first} and field \
         {second}; rename one of them, for only the log's author knows which is meant"
    )]
    DuplicateColumn {
        /// Name of the log.
        file: String,
        /// The column.
        column: String,
        /// Key of the mapping.
        key: String,
        /// First place in the header, counted from 1.
        first: usize,
        /// Second place.
        second: usize,
    },
    /// The header lacks a column that the mapping names.
    #[error("{file}: no column `{column}`, which {key} of the mapping names; the header has: {found}{hint}")]
    MissingColumn {
        /// Name of the log.
        file: String,
        /// The column.
        column: String,
        /// Key of the mapping.
        key: String,
        /// The header.
        found: String,
        /// What may be wrong in the mapping; empty if nothing is known.
        hint: String,
    },
    /// No row has a readable time.
    #[error("{file}: no row with a readable time in column `{column}`; the mapping says its format is {format}{hint}")]
    NoRows {
        /// Name of the log.
        file: String,
        /// The time column.
        column: String,
        /// The format of the mapping.
        format: &'static str,
        /// What was found instead; empty if there was no row.
        hint: String,
    },
    /// The range asked for is empty or outside the log.
    #[error("{file}: nothing between {from} and {to}; the log has rows {first_row} to {last_row}, {length:.1} s")]
    EmptyRange {
        /// Name of the log.
        file: String,
        /// Begin, as it was asked for.
        from: String,
        /// End, as it was asked for.
        to: String,
        /// First row with a time.
        first_row: u64,
        /// Last row with a time.
        last_row: u64,
        /// Length (s).
        length: f64,
    },
    /// A place in a log could not be understood.
    #[error(
        "`{text}` is not a place in a log: write seconds since the log's first row (90) or a row as an editor numbers it (row:6345)"
    )]
    Position {
        /// Text, as it was given.
        text: String,
    },
}
