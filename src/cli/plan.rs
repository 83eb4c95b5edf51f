//! The planned hole: a table that a command names, or `well.plan` of a configuration.

use std::io::Read;
use std::path::Path;

use anyhow::Context;

use crate::drilling::plan::{Row, read};
use flexdrill_config::Config;

/// Largest file of a plan (bytes).
const LARGEST: u64 = 4 << 20;

/// A planned hole.
pub(super) struct Planned {
    /// Where it stands, for errors.
    pub name: String,
    /// Its stations.
    pub rows: Vec<Row>,
}

impl Planned {
    /// A table.
    ///
    /// # Errors
    /// When it cannot be read, or is no plan.
    pub fn at(path: &Path) -> anyhow::Result<Self> {
        let name = path.display().to_string();
        let file = std::fs::File::open(path).with_context(|| format!("cannot read {name}"))?;
        let mut text = String::new();
        // One byte more than allowed shows that the file is longer.
        file.take(LARGEST + 1)
            .read_to_string(&mut text)
            .with_context(|| format!("cannot read {name}"))?;
        anyhow::ensure!(
            text.len() as u64 <= LARGEST,
            "{name}: must be at most {} MB: give the stations of the plan around the bit",
            LARGEST >> 20
        );
        let rows = read(&name, &text)?;
        Ok(Self { name, rows })
    }

    /// The plan of a configuration, which has this name and stands in this file; none where it has no plan.
    ///
    /// # Errors
    /// When the table that it names cannot be read, or is no plan.
    pub fn of(config: &Config, name: &str, path: &Path) -> anyhow::Result<Option<Self>> {
        let Some(plan) = &config.well.plan else {
            return Ok(None);
        };
        if let Some(file) = &plan.file {
            let path = path.parent().unwrap_or(Path::new("")).join(file);
            let table = Self::at(&path).with_context(|| format!("{name}: well.plan.file"))?;
            return Ok(Some(table));
        }
        Ok(Some(Self {
            name: format!("{name}: well.plan.stations"),
            rows: plan.stations.iter().map(Row::from).collect(),
        }))
    }
}
