//! Names of a recording's files.
//!
//! `run.mcap` is a file with `metadata.yaml` in the same folder; any other path is a folder as rosbag2 creates it,
//! `run/` with `run_0.mcap` and `metadata.yaml`. Further files of a recording are `run_1.mcap`, `run_2.mcap` and so on.

use std::path::{Path, PathBuf};

use crate::BagError;
use crate::storage::sync_folder;

/// Name of rosbag2's metadata file.
pub(crate) const METADATA: &str = "metadata.yaml";

/// Paths of one recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Location {
    /// The first MCAP file.
    pub file: PathBuf,
    /// The metadata.yaml.
    pub metadata: PathBuf,
    /// The folder of both.
    pub folder: PathBuf,
    /// The files' name without number and extension.
    stem: String,
}

impl Location {
    /// Derives the paths and creates the missing folders.
    ///
    /// # Errors
    /// When a file of the recording exists already, or a folder cannot be created.
    pub fn prepare(path: &Path) -> Result<Self, BagError> {
        let is_file = path.extension().is_some_and(|extension| extension == "mcap");
        let name = |name: Option<&std::ffi::OsStr>| {
            let name = name.ok_or_else(|| BagError::NotABag {
                path: path.to_owned(),
                problem: "the path has no file name; a recording needs one".to_owned(),
            })?;
            Ok::<_, BagError>(name.to_string_lossy().into_owned())
        };
        let location = if is_file {
            let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty());
            let folder = folder.unwrap_or(Path::new(".")).to_owned();
            Self {
                file: path.to_owned(),
                metadata: folder.join(METADATA),
                folder,
                stem: name(path.file_stem())?,
            }
        } else {
            let stem = name(path.file_name())?;
            Self {
                file: path.join(format!("{stem}_0.mcap")),
                metadata: path.join(METADATA),
                folder: path.to_owned(),
                stem,
            }
        };
        if location.file.exists() {
            return Err(BagError::Exists { path: location.file });
        }
        if location.metadata.exists() {
            return Err(BagError::OtherMetadata {
                path: location.metadata,
            });
        }
        std::fs::create_dir_all(&location.folder).map_err(BagError::io("create the folder", &location.folder))?;
        sync_folder(&location.folder);
        Ok(location)
    }

    /// The file with this number, counted from 0.
    pub fn part(&self, number: usize) -> PathBuf {
        match number {
            0 => self.file.clone(),
            _ => self.folder.join(format!("{}_{number}.mcap", self.stem)),
        }
    }
}
