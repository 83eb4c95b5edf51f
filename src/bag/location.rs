//! Where the files of a recording go.
//!
//! `run.mcap` is a file with `metadata.yaml` beside it; any other path is a folder as rosbag2 makes one, `run/` with
//! `run_0.mcap` and `metadata.yaml`.

use std::path::{Path, PathBuf};

use super::BagError;

/// Name of rosbag2's metadata file.
pub(super) const METADATA: &str = "metadata.yaml";

/// Paths of one recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Location {
    /// The MCAP file.
    pub file: PathBuf,
    /// The metadata.yaml.
    pub metadata: PathBuf,
}

impl Location {
    /// Settles the paths and makes the folders that are missing.
    ///
    /// # Errors
    /// When a file of the recording exists already, or a folder cannot be made.
    pub fn prepare(path: &Path) -> Result<Self, BagError> {
        let is_file = path.extension().is_some_and(|extension| extension == "mcap");
        let (folder, file) = if is_file {
            let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty());
            (folder.unwrap_or(Path::new(".")).to_owned(), path.to_owned())
        } else {
            let name = path.file_name().ok_or_else(|| BagError::NotABag {
                path: path.to_owned(),
                problem: "a recording needs a name".to_owned(),
            })?;
            (path.to_owned(), path.join(format!("{}_0.mcap", name.to_string_lossy())))
        };
        let metadata = folder.join(METADATA);
        if file.exists() {
            return Err(BagError::Exists { path: file });
        }
        if metadata.exists() {
            return Err(BagError::OtherMetadata { path: metadata });
        }
        std::fs::create_dir_all(&folder).map_err(BagError::io("make the folder", &folder))?;
        Ok(Self { file, metadata })
    }
}
