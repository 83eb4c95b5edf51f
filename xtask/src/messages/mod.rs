//! From `.msg` and `.srv` to Rust, schema and type hash, and to TypeScript for the rig page.
//!
//! `cargo xtask messages` writes the results to [`OUTPUT`] and [`PAGE_OUTPUT`]; a test holds the files to what would be
//! written.

pub mod catalogue;
pub mod definition;
mod emit;
mod emit_typescript;
pub mod hash;
pub mod parser;
pub mod schema;

use std::path::{Path, PathBuf};

pub use catalogue::Catalogue;

/// The generated file, from the repository's root.
pub const OUTPUT: &str = "crates/flexdrill-messages/src/generated.rs";

/// The generated file of the rig page, from the repository's root.
pub const PAGE_OUTPUT: &str = "crates/flexdrill-dashboard/web/src/messages.ts";

/// The member that ROS 2 gives a message without fields, since DDS cannot carry an empty struct.
const EMPTY_STRUCT_MEMBER: &str = "structure_needs_at_least_one_member";

/// Why no code could be generated.
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {
    /// A file or folder could not be read.
    #[error("cannot read {path}: {source}; run this from the repository's root", path = path.display())]
    Read {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The generated file could not be written.
    #[error("cannot write {path}: {source}", path = path.display())]
    Write {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A definition is not understood.
    #[error("{path}: {source}", path = path.display())]
    Parse {
        /// File.
        path: PathBuf,
        /// `msg` or `srv`.
        kind: &'static str,
        /// Line and problem.
        source: parser::ParseError,
    },
    /// A definition names a message that is nowhere.
    #[error("{used_in} uses {name}, which is defined neither in msg/ nor in crates/flexdrill-messages/external/")]
    UnknownType {
        /// The message that is missing.
        name: String,
        /// Where it is used.
        used_in: String,
    },
    /// A message contains itself.
    #[error("{0} contains itself")]
    Recursive(String),
}

/// The Rust source for all definitions of the repository at `root`.
///
/// # Errors
/// When a definition cannot be read or understood.
pub fn generate(root: &Path) -> Result<String, GenerateError> {
    emit::source(&Catalogue::read(root)?)
}

/// The TypeScript source of what the rig page reads, of the repository at `root`.
///
/// # Errors
/// When a definition cannot be read or understood.
pub fn generate_typescript(root: &Path) -> Result<String, GenerateError> {
    emit_typescript::source(&Catalogue::read(root)?)
}

/// Generates and writes [`OUTPUT`] and [`PAGE_OUTPUT`]. Returns their paths.
///
/// # Errors
/// When a definition cannot be read or understood, or a file not written.
pub fn write(root: &Path) -> Result<[PathBuf; 2], GenerateError> {
    let paths = [root.join(OUTPUT), root.join(PAGE_OUTPUT)];
    for (path, source) in paths.iter().zip([generate(root)?, generate_typescript(root)?]) {
        std::fs::write(path, source).map_err(|source| GenerateError::Write {
            path: path.clone(),
            source,
        })?;
    }
    Ok(paths)
}
