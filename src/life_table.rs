//! The table of `flexdrill life` on the disk: read whole, replaced whole, by one program at a time.

use std::fs::File;
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use flexdrill_config::Config;
use flexdrill_life::{LifeError, Lives, MOST_BYTES, RunLife};

use crate::state_file::replace;

/// Why a table is not read or written.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The disk refuses.
    #[error("cannot {what} {}: {source}", path.display())]
    Disk {
        /// What was to be done.
        what: &'static str,
        /// The table or its folder.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// It is no table of lives, or refuses a run.
    #[error(transparent)]
    Life(#[from] LifeError),
}

impl TableError {
    fn disk(what: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Disk { what, path, source }
    }
}

/// Reads a table; none where there is no file.
///
/// # Errors
/// When it cannot be read, or is no table of lives.
pub fn read(file: &Path) -> Result<Option<Lives>, TableError> {
    let mut bytes = Vec::new();
    let read = File::open(file).and_then(|opened| opened.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    match read {
        Ok(_) => Ok(Some(Lives::from_csv(&file.display().to_string(), &bytes)?)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(TableError::disk("read", file)(error)),
    }
}

/// Writes a table as a whole: a program that ends in the middle leaves the older one.
///
/// # Errors
/// When the disk refuses.
pub fn write(file: &Path, lives: &Lives) -> Result<(), TableError> {
    replace(file, lives.to_csv().as_bytes()).map_err(TableError::disk("write", file))
}

/// The folder of a file.
fn folder(file: &Path) -> &Path {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.unwrap_or(Path::new("."))
}

/// Locks the folder of a table until the result is dropped: another program that adds to it waits. On a disk without locks
/// nothing is locked.
///
/// # Errors
/// When the folder cannot be opened or locked.
pub fn locked(file: &Path) -> Result<File, TableError> {
    let folder = folder(file);
    let opened = File::open(folder).map_err(TableError::disk("open", folder))?;
    match opened.lock() {
        Err(error) if error.kind() != ErrorKind::Unsupported => Err(TableError::disk("lock", folder)(error)),
        _ => Ok(opened),
    }
}

/// The table with a run, which makes it where it is missing. Joints that it does not have must be among `new`. The file is not
/// written.
///
/// # Errors
/// When it cannot be read or refuses the run.
pub fn with_run(file: &Path, run: &RunLife, new: &[String]) -> Result<Lives, TableError> {
    let lives = read(file)?;
    let mut lives = lives.unwrap_or_else(|| Lives::new(&file.display().to_string(), run.kind.clone()));
    lives.add(run, new, false)?;
    Ok(lives)
}

/// Checks, before a run, that a table will take it.
///
/// # Errors
/// When the configuration states no class or no serial numbers, counts nothing, or has joints that the table does not take.
pub fn check(file: &Path, config: &Config, start: i64, new: &[String]) -> Result<(), TableError> {
    with_run(file, &RunLife::begun(config, start)?, new).map(drop)
}
