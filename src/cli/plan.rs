//! The planned hole: a table that a command names, or `well.plan` of a configuration.

use std::io::Read;
use std::path::Path;

use anyhow::Context;

use crate::drilling::plan::{Row, read};
use flexdrill_config::{Config, PlannedStation};

/// Largest file of a table (bytes).
const LARGEST: u64 = 4 << 20;
/// How far below the bit a plan is of use to a run (m): farther than any forecast.
const BELOW_BIT: f64 = 30.0;

/// Name and text of a table.
///
/// # Errors
/// When it cannot be read, or is too large: `give` says what to give instead.
pub(super) fn read_table(path: &Path, give: &str) -> anyhow::Result<(String, String)> {
    let name = path.display().to_string();
    let file = std::fs::File::open(path).with_context(|| format!("cannot read {name}"))?;
    let mut text = String::new();
    // One byte more than allowed shows that the file is longer.
    file.take(LARGEST + 1)
        .read_to_string(&mut text)
        .with_context(|| format!("cannot read {name}"))?;
    anyhow::ensure!(
        text.len() as u64 <= LARGEST,
        "{name}: must be at most {} MB: give {give}",
        LARGEST >> 20
    );
    Ok((name, text))
}

/// A configuration with the stations of its plan in place of the table that it names (`well.plan.file`), down to 30 m below the
/// bit: a run reads no file, and its recording has them. `name` and `path` are those of the configuration.
///
/// # Errors
/// When the table cannot be read, is no plan, or does not begin on the hole.
pub(super) fn with_stations(config: Config, name: &str, path: &Path) -> anyhow::Result<Config> {
    if config.well.plan.as_ref().is_none_or(|plan| plan.file.is_none()) {
        return Ok(config);
    }
    let Some(Planned { name, rows, .. }) = Planned::of(&config, name, path)? else {
        return Ok(config);
    };
    let below = config.well.length() + BELOW_BIT;
    let used = rows.partition_point(|row| row.depth < below) + 1;
    let stations = rows.iter().take(used).map(PlannedStation::from).collect();
    Ok(config.with_planned(&name, stations)?)
}

/// A planned hole.
pub(super) struct Planned {
    /// Where it stands, for errors.
    pub name: String,
    /// Its stations.
    pub rows: Vec<Row>,
    /// Where it begins, from the point of the hole at the depth of the first (m).
    #[cfg_attr(
        not(feature = "sweep"),
        expect(dead_code, reason = "what lays a plan is a part of the feature sweep")
    )]
    pub offset: [f64; 3],
}

impl Planned {
    /// A table.
    ///
    /// # Errors
    /// When it cannot be read, or is no plan.
    pub fn at(path: &Path) -> anyhow::Result<Self> {
        let (name, text) = read_table(path, "the stations of the plan around the bit")?;
        let rows = read(&name, &text)?;
        Ok(Self {
            name,
            rows,
            offset: [0.0; 3],
        })
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
            return Ok(Some(Self {
                offset: plan.offset,
                ..table
            }));
        }
        Ok(Some(Self {
            name: format!("{name}: well.plan.stations"),
            rows: plan.stations.iter().map(Row::from).collect(),
            offset: plan.offset,
        }))
    }
}
