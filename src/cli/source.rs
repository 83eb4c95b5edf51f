//! Inputs with times from a bag or a field log, for `rig` and `replay`.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::Args;

use super::TimedInput;
use crate::bag::{self, BagError};
use crate::inputs::InputKind;
use crate::messages::Message;
use crate::messages::std_msgs::Float64;

/// Which part of a source is used, and how its columns are read.
#[derive(Debug, Args)]
pub(super) struct SourceArgs {
    /// Mapping of a field log's columns (YAML).
    #[arg(long, value_name = "FILE")]
    mapping: Option<PathBuf>,
    /// Begin so many seconds after the first sample.
    #[arg(long, value_name = "SECONDS")]
    from: Option<f64>,
    /// End so many seconds after the first sample.
    #[arg(long, value_name = "SECONDS")]
    to: Option<f64>,
}

/// Whether a path is a bag, not a text file.
///
/// # Errors
/// When it cannot be read.
pub(super) fn is_bag(path: &Path) -> anyhow::Result<bool> {
    match bag::open(path) {
        Ok(_) => Ok(true),
        Err(BagError::NotABag { .. }) if path.is_file() => Ok(false),
        Err(error) => Err(error.into()),
    }
}

impl SourceArgs {
    /// Whether any of them was given.
    pub(super) fn is_given(&self) -> bool {
        self.mapping.is_some() || self.from.is_some() || self.to.is_some()
    }

    /// The samples in the order of their times.
    ///
    /// # Errors
    /// When the source cannot be read or holds none.
    pub(super) fn read(&self, path: &Path) -> anyhow::Result<Vec<TimedInput>> {
        let mut samples = if is_bag(path)? {
            from_bag(path)?
        } else {
            self.from_log(path)?
        };
        // Stable: samples of one instant stay in the order of the source.
        samples.sort_by_key(|sample| sample.time);
        let Some(first) = samples.first().map(|sample| sample.time) else {
            bail!("{}: no sample of rotary speed or weight on bit in it", path.display());
        };
        let seconds = |sample: &TimedInput| (sample.time - first) as f64 * 1e-9;
        let (from, to) = (self.from.unwrap_or(0.0), self.to.unwrap_or(f64::INFINITY));
        let all = samples.last().map(seconds).unwrap_or_default();
        samples.retain(|sample| (from..=to).contains(&seconds(sample)));
        if samples.is_empty() {
            bail!(
                "{}: no sample between --from {from} s and --to {to} s; it is {all:.1} s long",
                path.display()
            );
        }
        Ok(samples)
    }

    fn from_log(&self, path: &Path) -> anyhow::Result<Vec<TimedInput>> {
        let _ = &self.mapping;
        bail!("{}: this is not a bag (MCAP, SQLite or their folder)", path.display())
    }
}

fn from_bag(path: &Path) -> anyhow::Result<Vec<TimedInput>> {
    let mut bag = bag::open(path)?;
    let names: Vec<String> = InputKind::ALL
        .iter()
        .map(|kind| bag.topic(kind.topic()).map(|topic| topic.name.clone()))
        .collect::<Result<_, _>>()
        .with_context(|| format!("{}: a rig's bag has both inputs", path.display()))?;
    bag.select(|topic| topic.ros_type == Float64::ROS_TYPE && names.contains(&topic.name));
    let mut samples = Vec::new();
    for message in bag.by_ref() {
        let message = message?;
        let kind = if message.topic.name == names[0] {
            InputKind::RotarySpeed
        } else {
            InputKind::WeightOnBit
        };
        samples.push(TimedInput {
            time: message.log_time,
            kind,
            value: message.decode::<Float64>()?.data,
        });
    }
    for cut in bag.cuts() {
        eprintln!(
            "{} was cut short ({}); what is there is used",
            cut.path.display(),
            cut.reason
        );
    }
    Ok(samples)
}
