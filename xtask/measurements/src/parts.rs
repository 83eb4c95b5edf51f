//! Results of single runs in a folder, so that a set of many hours can be interrupted and resumed.
//!
//! A part is one file with the figures of one run and with what they are a function of: build, configuration, motion.
//! A part of anything else counts as absent and is written again.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use serde_json::{Value, json};

/// What the figures of a run are a function of.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    /// File name without its end.
    pub name: String,
    /// Hash of the configuration.
    pub config: String,
    /// Inputs, duration and the weight by which the start differs.
    pub motion: String,
}

/// The folder.
#[derive(Debug)]
pub(crate) struct Parts {
    folder: PathBuf,
    build: String,
}

impl Parts {
    /// Opens `folder`, created if necessary.
    ///
    /// # Errors
    /// When it cannot be created, or when the program cannot read itself.
    pub(crate) fn open(folder: &Path) -> anyhow::Result<Self> {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
        let program = std::env::current_exe().context("the program does not find itself")?;
        let bytes = std::fs::read(&program).with_context(|| format!("cannot read {}", program.display()))?;
        let mut hasher = DefaultHasher::new();
        bytes.hash(&mut hasher);
        Ok(Self {
            folder: folder.to_owned(),
            build: format!("{:016x}", hasher.finish()),
        })
    }

    /// The figures of `run`, if they are there.
    pub(crate) fn read(&self, run: &Run) -> Option<Vec<f64>> {
        let text = std::fs::read_to_string(self.path(run)).ok()?;
        let part: Value = serde_json::from_str(&text).ok()?;
        let of = self.identity(run);
        if part.get("of") != Some(&of) {
            return None;
        }
        let figures = part.get("figures")?.as_array()?;
        figures.iter().map(|figure| figure.as_str()?.parse().ok()).collect()
    }

    /// Writes the figures of `run`, under a temporary name first, so that no part is ever incomplete.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub(crate) fn write(&self, run: &Run, figures: &[f64]) -> anyhow::Result<()> {
        let (path, temporary) = (self.path(run), self.folder.join(format!(".{}", run.name)));
        // Text reads back to the bit, and has NaN.
        let figures: Vec<String> = figures.iter().map(f64::to_string).collect();
        let part = json!({"of": self.identity(run), "figures": figures});
        std::fs::write(&temporary, part.to_string())
            .and_then(|()| std::fs::rename(&temporary, &path))
            .with_context(|| format!("cannot write {}", path.display()))
    }

    fn path(&self, run: &Run) -> PathBuf {
        self.folder.join(format!("{}.json", run.name))
    }

    fn identity(&self, run: &Run) -> Value {
        json!({"build": self.build, "config": run.config, "motion": run.motion})
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests fail by panicking")]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_read_back_to_the_bit_and_only_for_what_it_is_of() {
        let folder = std::env::temp_dir().join(format!("flexdrill_parts_{}", std::process::id()));
        let parts = Parts::open(&folder).unwrap();
        let run = Run {
            name: "0_1_2".into(),
            config: "a".into(),
            motion: "40 r/min".into(),
        };
        let figures = [0.1 + 0.2, -1e-300, f64::NAN];
        parts.write(&run, &figures).unwrap();
        let back = parts.read(&run).unwrap();
        assert_eq!(back[..2], figures[..2]);
        assert!(back[2].is_nan() && back.len() == 3);
        let other = Run {
            motion: "41 r/min".into(),
            ..run.clone()
        };
        assert_eq!(parts.read(&other), None);
        let newer = Parts {
            build: "newer".into(),
            ..Parts::open(&folder).unwrap()
        };
        assert_eq!(newer.read(&run), None);
        std::fs::write(parts.path(&run), "{").unwrap();
        assert_eq!(parts.read(&run), None, "cut short");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
