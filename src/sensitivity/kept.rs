//! Runs that are done, kept in a folder: an interrupted study continues with them.
//!
//! A file is named after what its run is a function of, and has the version and the whole hash too: a run of anything else
//! counts as absent and is made again.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Found, Point};

/// A run cannot be kept.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", path.display())]
pub struct KeepError {
    path: PathBuf,
    source: std::io::Error,
}

/// The folder.
#[derive(Debug)]
pub struct Kept {
    folder: PathBuf,
}

/// What a file has. Numbers are written as text, which reads back to the bit, also where they are none.
#[derive(Serialize, Deserialize)]
struct Part {
    version: String,
    config: String,
    found: Result<Vec<String>, String>,
}

fn written(found: &Found) -> Vec<String> {
    found.iter().map(f64::to_string).collect()
}

fn read(figures: &[String]) -> Option<Found> {
    let figures: Vec<f64> = figures
        .iter()
        .map(|figure| figure.parse())
        .collect::<Result<_, _>>()
        .ok()?;
    figures.try_into().ok()
}

impl Kept {
    /// Runs in `folder`, which is created if necessary.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub fn open(folder: &Path) -> Result<Self, KeepError> {
        std::fs::create_dir_all(folder).map_err(|source| KeepError {
            path: folder.to_owned(),
            source,
        })?;
        Ok(Self {
            folder: folder.to_owned(),
        })
    }

    /// The result of `point`, if it is there.
    pub(super) fn read(&self, point: &Point) -> Option<Result<Found, String>> {
        let hash = point.config.hash();
        let text = std::fs::read_to_string(self.path(point, &hash)).ok()?;
        let part: Part = serde_json::from_str(&text).ok()?;
        if part.version != env!("CARGO_PKG_VERSION") || part.config != hash {
            return None;
        }
        match part.found {
            Ok(figures) => read(&figures).map(Ok),
            Err(cause) => Some(Err(cause)),
        }
    }

    /// Writes the result of `point`, under a temporary name first, so that no file is ever incomplete.
    pub(super) fn write(&self, point: &Point, found: &Result<Found, String>) -> Result<(), KeepError> {
        let config = point.config.hash();
        let path = self.path(point, &config);
        let part = Part {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            config,
            found: found.as_ref().map(written).map_err(Clone::clone),
        };
        let temporary = path.with_extension("part");
        serde_json::to_string(&part)
            .map_err(std::io::Error::from)
            .and_then(|text| std::fs::write(&temporary, text))
            .and_then(|()| std::fs::rename(&temporary, &path))
            .map_err(|source| KeepError { path, source })
    }

    /// The weight is part of the configuration; speed and time are not.
    fn path(&self, point: &Point, hash: &str) -> PathBuf {
        let [speed, seconds] = [point.load.speed, point.load.seconds].map(f64::to_bits);
        self.folder.join(format!("{hash:.16}_{speed:016x}_{seconds:016x}.json"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_read_back_to_the_bit() {
        let found = [0.1 + 0.2, 1e-300, -1.0 / 3.0, f64::MIN_POSITIVE, 0.0, 1e300, f64::NAN];
        let again = read(&written(&found)).unwrap();
        assert!(
            again
                .iter()
                .zip(&found)
                .all(|(a, b)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()))
        );
        assert_eq!(read(&written(&found)[1..]), None);
    }
}
