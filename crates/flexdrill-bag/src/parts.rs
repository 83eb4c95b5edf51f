//! The files of a bag: those that metadata.yaml lists, and those that it should.

use std::path::{Path, PathBuf};

use crate::location::METADATA;
use crate::{BagError, metadata};

/// Extensions of compressed files, behind that of the storage.
pub(crate) const PACKED: [&str; 2] = ["zstd", "zst"];

/// A difference between the files of a bag and its metadata.yaml.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PartFault {
    /// A part that is read although the metadata does not list it.
    #[error(
        "{path} is not listed in metadata.yaml and continues the parts that are: it is read too; the recording was probably \
         interrupted, and flexdrill recover writes a bag that lists all its parts",
        path = path.display()
    )]
    Unlisted {
        /// The file.
        path: PathBuf,
    },
    /// A bag in the folder that is not read.
    #[error(
        "{path} is not listed in metadata.yaml and is NOT read, because its name does not continue the parts that are; to read \
         it, name it alone, or move the bag into a folder without metadata.yaml",
        path = path.display()
    )]
    NotRead {
        /// The file.
        path: PathBuf,
    },
    /// A part that the metadata lists and the folder does not have.
    #[error("{path} is listed in metadata.yaml and is missing: its messages are not read; copy it into the folder", path = path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// A part that cannot be opened.
    #[error("{path} cannot be read, and its messages are missing: {why}", path = path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The cause.
        why: String,
    },
    /// A compressed file that is damaged.
    #[error("{path} is read up to byte {bytes} of its content, where its compression is damaged or cut: {why}", path = path.display())]
    PartlyUnpacked {
        /// The compressed file.
        path: PathBuf,
        /// Bytes before the damage.
        bytes: u64,
        /// The cause.
        why: String,
    },
    /// One file of a bag was named that has several.
    #[error(
        "{path} is one of {parts} parts that the metadata.yaml next to it lists: only this one is read; name the folder to read \
         all",
        path = path.display()
    )]
    OneOfSeveral {
        /// The file.
        path: PathBuf,
        /// Number of parts.
        parts: usize,
    },
}

impl PartFault {
    /// Whether messages of the bag are missing because of it.
    pub fn loses(&self) -> bool {
        matches!(
            self,
            Self::Missing { .. } | Self::Unreadable { .. } | Self::PartlyUnpacked { .. }
        )
    }
}

/// The files of a bag, and what is wrong with them.
#[derive(Debug)]
pub(crate) struct Parts {
    pub files: Vec<PathBuf>,
    pub faults: Vec<PartFault>,
}

/// The files of the bag at `path`, a file or a folder.
///
/// # Errors
/// When the folder or its metadata cannot be read, or names no file that is there.
pub(crate) fn find(path: &Path) -> Result<Parts, BagError> {
    if !path.is_dir() {
        return Ok(Parts {
            files: vec![path.to_owned()],
            faults: one_of_several(path).into_iter().collect(),
        });
    }
    let found = in_folder(path)?;
    let described = path.join(METADATA);
    let listed = if described.exists() {
        metadata::files(path, &described)?
    } else {
        Vec::new()
    };
    // The metadata of an interrupted recording may list no files.
    if listed.is_empty() {
        if found.is_empty() {
            return Err(BagError::NotABag {
                path: path.to_owned(),
                problem: "the folder holds neither .mcap nor .db3 files".to_owned(),
            });
        }
        return Ok(Parts {
            files: found,
            faults: Vec::new(),
        });
    }
    let (mut files, missing): (Vec<_>, Vec<_>) = listed.into_iter().partition(|file| file.exists());
    let mut faults: Vec<_> = missing
        .iter()
        .map(|path| PartFault::Missing { path: path.clone() })
        .collect();
    if files.is_empty() {
        return Err(BagError::NotABag {
            path: path.to_owned(),
            problem: match missing.as_slice() {
                [first, ..] => format!(
                    "of the {} files that its metadata.yaml lists none is there, the first being {}",
                    missing.len(),
                    first.display()
                ),
                [] => "its metadata.yaml lists no files".to_owned(),
            },
        });
    }
    let real = |file: &Path| file.canonicalize().unwrap_or_else(|_| file.to_owned());
    let known: Vec<_> = files.iter().map(|file| real(file)).collect();
    // A part may be in the folder twice, compressed and not: the listed one counts.
    let names: Vec<_> = files.iter().chain(&missing).map(|file| number(file)).collect();
    let mut last: Vec<(String, u64)> = names.clone();
    for file in found.into_iter().filter(|file| !known.contains(&real(file))) {
        let (name, part) = number(&file);
        if names.contains(&(name.clone(), part)) {
            continue;
        }
        // Parts are numbered without a gap. Another number is another recording.
        let continues = last
            .iter()
            .any(|(known, before)| *known == name && before.checked_add(1) == Some(part));
        if continues {
            last.push((name, part));
            faults.push(PartFault::Unlisted { path: file.clone() });
            files.push(file);
        } else {
            faults.push(PartFault::NotRead { path: file });
        }
    }
    Ok(Parts { files, faults })
}

/// The bags in a folder, by name and number.
fn in_folder(path: &Path) -> Result<Vec<PathBuf>, BagError> {
    let read = || BagError::io("read", path);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path).map_err(read())? {
        let file = entry.map_err(read())?.path();
        if unpacked_name(&file)
            .extension()
            .is_some_and(|extension| extension == "mcap" || extension == "db3")
        {
            files.push(file);
        }
    }
    files.sort_by_cached_key(|file| (number(file), file.clone()));
    Ok(files)
}

/// The name without the extension of a compressed file.
fn unpacked_name(file: &Path) -> PathBuf {
    match file.extension() {
        Some(extension) if PACKED.iter().any(|packed| extension == *packed) => file.with_extension(""),
        _ => file.to_owned(),
    }
}

/// Name and number of a part: `run_10.mcap` is number 10 of `run`, and `run.mcap` its number 0.
fn number(file: &Path) -> (String, u64) {
    let name = unpacked_name(file);
    let stem = name.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let split = stem.rsplit_once('_').and_then(|(name, number)| {
        let digits = number.bytes().all(|byte| byte.is_ascii_digit());
        Some((name.to_owned(), number.parse().ok().filter(|_| digits)?))
    });
    split.unwrap_or((stem, 0))
}

/// The fault of a file that is a part of a bag with several.
fn one_of_several(path: &Path) -> Option<PartFault> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let described = folder.join(METADATA);
    if !described.exists() {
        return None;
    }
    // A file can be read whatever the metadata next to it is.
    let listed = metadata::files(folder, &described).ok()?;
    let real = path.canonicalize().ok()?;
    let is_listed = listed
        .iter()
        .any(|file| file.canonicalize().is_ok_and(|file| file == real));
    (is_listed && listed.len() > 1).then(|| PartFault::OneOfSeveral {
        path: path.to_owned(),
        parts: listed.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_have_a_name_and_a_number() {
        for (file, name, part) in [
            ("run.mcap", "run", 0),
            ("run_10.mcap", "run", 10),
            ("run_2.mcap.zstd", "run", 2),
            ("run_+2.db3", "run_+2", 0),
            ("run_.db3", "run_", 0),
            ("night_run.mcap", "night_run", 0),
            ("run_99999999999999999999.mcap", "run_99999999999999999999", 0),
        ] {
            assert_eq!(number(Path::new(file)), (name.to_owned(), part), "{file}");
        }
    }
}
