//! Files of results that are complete whenever they are there.

use std::path::Path;

use anyhow::Context as _;

/// Writes a file under a temporary name first, so that the final name never has a part of it.
///
/// # Errors
/// When the folder is missing or the disk refuses.
pub(super) fn write(folder: &Path, name: &str, text: &str) -> anyhow::Result<()> {
    let path = folder.join(name);
    let temporary = folder.join(format!(".{name}.{}", std::process::id()));
    let written = std::fs::write(&temporary, text).and_then(|()| std::fs::rename(&temporary, &path));
    if written.is_err() {
        // The error of the write is the one to report.
        let _ = std::fs::remove_file(&temporary);
    }
    written.with_context(|| format!("cannot write {}", path.display()))
}
