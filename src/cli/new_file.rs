//! Files that a person may have corrected: they are written once and never replaced.

use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::path::Path;

use anyhow::Context as _;

/// Writes a file that does not exist yet; false where it exists, which is left as it is.
///
/// # Errors
/// When the file cannot be written; `option` names the option that gives another place.
pub(super) fn write(file: &Path, text: &str, option: &str) -> anyhow::Result<bool> {
    let written = File::create_new(file).and_then(|mut created| created.write_all(text.as_bytes()));
    match written {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Ok(false),
        Err(error) => Err(error).with_context(|| format!("{option} {}", file.display())),
    }
}
