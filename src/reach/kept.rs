//! Points that are done, kept in a folder: a study of hours can be interrupted and continued.
//!
//! A point is one file with its result and with what that is a function of: configuration, load, version. A point of
//! anything else counts as absent and is computed again.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Found, Load, Point};

/// A kept point cannot be written.
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
    load: String,
}

/// What a file has. Numbers are written as text, which reads back to the bit; what a tool does not have is `NaN`.
#[derive(Serialize, Deserialize)]
struct Part {
    version: String,
    config: String,
    load: String,
    found: Result<Vec<String>, String>,
}

fn written(found: &Found) -> Vec<String> {
    let [buckles, folds] = [found.guide_buckles_at, found.chain_folds_at].map(|at| at.unwrap_or(f64::NAN));
    let figures = [
        found.weight,
        found.torque,
        found.range,
        [buckles, folds],
        [found.advance, found.time],
    ];
    figures.iter().flatten().map(f64::to_string).collect()
}

fn read(figures: &[String]) -> Option<Found> {
    let figures: Vec<f64> = figures
        .iter()
        .map(|figure| figure.parse())
        .collect::<Result<_, _>>()
        .ok()?;
    let [a, b, c, d, e, f, buckles, folds, advance, time] = figures.try_into().ok()?;
    let known = |at: f64| (!at.is_nan()).then_some(at);
    Some(Found {
        weight: [a, b],
        torque: [c, d],
        range: [e, f],
        guide_buckles_at: known(buckles),
        chain_folds_at: known(folds),
        advance,
        time,
    })
}

impl Kept {
    /// Points under `load` in `folder`, which is created if necessary.
    ///
    /// # Errors
    /// When the folder cannot be created.
    pub fn open(folder: &Path, load: &Load) -> Result<Self, KeepError> {
        std::fs::create_dir_all(folder).map_err(|source| KeepError {
            path: folder.to_owned(),
            source,
        })?;
        Ok(Self {
            folder: folder.to_owned(),
            load: format!("{load:?}"),
        })
    }

    /// The result of `point`, if it is there.
    pub(super) fn read(&self, point: &Point) -> Option<Result<Found, String>> {
        let text = std::fs::read_to_string(self.path(point)).ok()?;
        let part: Part = serde_json::from_str(&text).ok()?;
        let is_of_it = part.version == env!("CARGO_PKG_VERSION") && part.config == point.config.hash();
        if !is_of_it || part.load != self.load {
            return None;
        }
        match part.found {
            Ok(figures) => read(&figures).map(Ok),
            Err(cause) => Some(Err(cause)),
        }
    }

    /// Writes the result of `point`, under a temporary name first, so that no file is ever incomplete.
    pub(super) fn write(&self, point: &Point, found: &Result<Found, String>) -> Result<(), KeepError> {
        let part = Part {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            config: point.config.hash(),
            load: self.load.clone(),
            found: found.as_ref().map(written).map_err(Clone::clone),
        };
        let path = self.path(point);
        let temporary = path.with_extension("part");
        serde_json::to_string(&part)
            .map_err(std::io::Error::from)
            .and_then(|text| std::fs::write(&temporary, text))
            .and_then(|()| std::fs::rename(&temporary, &path))
            .map_err(|source| KeepError { path, source })
    }

    fn path(&self, point: &Point) -> PathBuf {
        let rotation = if point.rotates { "with" } else { "without" };
        self.folder
            .join(format!("{}_{}_{rotation}.json", point.links, point.friction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_read_back_to_the_bit() {
        let found = Found {
            weight: [0.1 + 0.2, 1e-300],
            torque: [f64::MIN_POSITIVE, -1.0 / 3.0],
            range: [0.0, 1e300],
            guide_buckles_at: None,
            chain_folds_at: Some(0.15),
            advance: 1e-3,
            time: 33.0,
        };
        assert_eq!(read(&written(&found)), Some(found));
        assert_eq!(read(&written(&found)[1..]), None);
        assert_eq!(read(&["x"; 10].map(str::to_owned)), None);
    }
}
