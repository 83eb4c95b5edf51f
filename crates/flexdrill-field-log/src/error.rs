//! Errors that prevent reading a log at all. Problems of single rows are in the [`crate::Report`].

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
        /// The log.
        path: PathBuf,
        /// The operating system's error.
        reason: String,
    },
    /// The log exceeds the size that is read into memory.
    #[error("{file}: the log has {bytes} bytes, at most {most} are read; split it")]
    TooLarge {
        /// Name of the log.
        file: String,
        /// Its size.
        bytes: u64,
        /// The largest size.
        most: u64,
    },
    /// The log is text in an encoding other than UTF-8.
    #[error(
        "{file}: the encoding is {encoding}, not UTF-8; save the log as \"CSV UTF-8\", or convert it: iconv -f {encoding} -t UTF-8"
    )]
    Encoding {
        /// Name of the log.
        file: String,
        /// Name of the encoding, as `iconv` knows it.
        encoding: &'static str,
    },
    /// The log is compressed, and its content is damaged.
    #[error("{file}: the log is compressed with {how} and damaged: {reason}; copy it again, or unpack it")]
    Compressed {
        /// Name of the log.
        file: String,
        /// The compression.
        how: &'static str,
        /// What the decoder says.
        reason: String,
    },
    /// The file is no text.
    #[error("{file}: the file is {kind}, not a text; unpack it, or save the sheet as \"CSV UTF-8\"")]
    OtherFile {
        /// Name of the log.
        file: String,
        /// What it is.
        kind: &'static str,
    },
    /// A LAS file cannot be read.
    #[error("{file}: the LAS file cannot be read: {reason}")]
    Las {
        /// Name of the log.
        file: String,
        /// Why.
        reason: String,
    },
    /// The file has no text in the row that the mapping gives for the header.
    #[error(
        "{file}: row {row}, which `header_row` of the mapping names, has no header; an editor numbers the first row 1"
    )]
    NoHeader {
        /// Name of the log.
        file: String,
        /// The row.
        row: u64,
    },
    /// No line of the log has names of columns above rows with as many fields.
    #[error(
        "{file}: no line has names of columns with rows of as many fields below it; a mapping names columns, so add a line of \
         names, and set `header_row` and `separator` in the mapping where they are unusual"
    )]
    NoColumns {
        /// Name of the log.
        file: String,
    },
    /// The times of the log cannot be right.
    #[error("{file}: the times in column `{column}` cannot be right: {found}; {cure}")]
    Times {
        /// Name of the log.
        file: String,
        /// The time column.
        column: String,
        /// What is wrong.
        found: String,
        /// The line of the mapping, or the export, that cures it.
        cure: String,
    },
    /// An input has no usable value in the whole log.
    #[error("{file}: column `{column}` has no usable value for {input} in {found}; {cure}")]
    NoValue {
        /// Name of the log.
        file: String,
        /// The column.
        column: String,
        /// Name of the input.
        input: &'static str,
        /// How many rows have a readable time, and the first problem of the column where one is known.
        found: String,
        /// The line of the mapping that cures it.
        cure: String,
    },
    /// The first line is too long for a header.
    #[error(
        "{file}: the first line has {bytes} bytes, at most {most} are read; a log has a header of column names and one \
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
         {second}; rename the one that the mapping does not mean"
    )]
    DuplicateColumn {
        /// Name of the log.
        file: String,
        /// Its name, as the mapping has it.
        column: String,
        /// Key of the mapping.
        key: String,
        /// Number of the first field with that name, counted from 1.
        first: usize,
        /// Number of the second.
        second: usize,
    },
    /// The header lacks a column that the mapping names.
    #[error("{file}: no column `{column}`, which {key} of the mapping names; the header has: {found}{hint}")]
    MissingColumn {
        /// Name of the log.
        file: String,
        /// Its name, as the mapping has it.
        column: String,
        /// Key of the mapping.
        key: String,
        /// The header.
        found: String,
        /// A likely cause in the mapping; empty when none is known.
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
        format: String,
        /// The first text that was not a time; empty when there was no row.
        hint: String,
    },
    /// The requested range is empty or outside the log.
    #[error("{file}: no row lies between {from} and {to}; the log has rows {first_row} to {last_row}, {length:.1} s")]
    EmptyRange {
        /// Name of the log.
        file: String,
        /// Begin, as requested.
        from: String,
        /// End, as requested.
        to: String,
        /// First row with a time.
        first_row: u64,
        /// Last row with a time.
        last_row: u64,
        /// Length (s).
        length: f64,
    },
    /// A position in a log could not be parsed.
    #[error(
        "`{text}` is not a position in a log: write seconds since the log's first row (90) or a row as an editor numbers it \
         (row:6345)"
    )]
    Position {
        /// The text, as given.
        text: String,
    },
}
