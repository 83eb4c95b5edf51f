//! Inputs with times from a bag or a field log, for `rig` and `replay`.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::Args;

use super::WrongUse;
use crate::bag::{self, BagError};
use crate::cli::output::{tell, tell_text};
use crate::field_log::{self, InputSequence, Mapping, Position};
use crate::messages::std_msgs::Float64;
use crate::messages::{Message, RigInputs, topics};
use crate::rig_inputs::stamped;
use flexdrill_core::inputs::{InputKind, Stamp};

/// A timed sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// ns since 1970; of a field log, since its first row.
    pub(super) time: i64,
    /// The input that it belongs to.
    pub(super) kind: InputKind,
    /// In the unit of the input's topic.
    pub(super) value: f64,
    /// Stamp and quality of a sample of `rig/inputs`; the configuration sets the allowed skew.
    pub(super) stamp: Option<Stamp>,
}

impl Sample {
    /// Time since another sample (s).
    pub(super) fn since(&self, first: &Self) -> f64 {
        (self.time - first.time) as f64 * 1e-9
    }
}

/// The part of a source to use, and the mapping of its columns.
#[derive(Debug, Args)]
pub(super) struct SourceArgs {
    /// Mapping of a field log's columns (YAML). Default: the only YAML file in the log's folder.
    #[arg(long, value_name = "FILE")]
    mapping: Option<PathBuf>,
    /// Begin this many seconds after the start, or at a row of a field log (row:6345, as an editor numbers it).
    #[arg(long, value_name = "POSITION")]
    from: Option<Position>,
    /// End at this position, given in the same form.
    #[arg(long, value_name = "POSITION")]
    to: Option<Position>,
}

/// Whether a path is a bag and not a text file.
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
    /// Whether any option was given.
    pub(super) fn is_given(&self) -> bool {
        self.mapping.is_some() || self.from.is_some() || self.to.is_some()
    }

    /// The samples in the order of time. The report of a field log is printed on standard error.
    ///
    /// # Errors
    /// When the source cannot be read or has no sample.
    pub(super) fn read(&self, path: &Path) -> anyhow::Result<Vec<Sample>> {
        let mut samples = if is_bag(path)? {
            self.part_of_bag(path, from_bag(path)?)?
        } else {
            self.log_samples(path)?
        };
        if samples.is_empty() {
            bail!("{}: it has no sample of rotary speed or weight on bit", path.display());
        }
        // The sort is stable: samples of the same time keep the order of the source.
        samples.sort_by_key(|sample| sample.time);
        Ok(samples)
    }

    /// The samples between --from and --to.
    fn part_of_bag(&self, path: &Path, mut samples: Vec<Sample>) -> anyhow::Result<Vec<Sample>> {
        let seconds_of = |position: Option<Position>, default: f64| match position {
            None => Ok(default),
            Some(Position::Time(seconds)) => Ok(seconds),
            Some(Position::Row(row)) => Err(WrongUse::new(format!("row:{row}: a bag has no rows; give seconds"))),
        };
        let (from, to) = (seconds_of(self.from, 0.0)?, seconds_of(self.to, f64::INFINITY)?);
        let Some(first) = samples.iter().min_by_key(|sample| sample.time).copied() else {
            return Ok(samples);
        };
        let seconds = |sample: &Sample| sample.since(&first);
        let all = samples.iter().map(seconds).fold(0.0, f64::max);
        samples.retain(|sample| (from..=to).contains(&seconds(sample)));
        if samples.is_empty() {
            bail!(
                "{}: no sample between --from {from} s and --to {to} s; it is {all:.1} s long",
                path.display()
            );
        }
        Ok(samples)
    }

    /// The rows of a field log. Its report is printed on standard error.
    ///
    /// # Errors
    /// When log or mapping cannot be read.
    pub(super) fn log(&self, path: &Path) -> anyhow::Result<InputSequence> {
        let mapping_file = match &self.mapping {
            Some(file) => file.clone(),
            None => only_mapping_in_folder_of(path)?,
        };
        let mapping = Mapping::load(&mapping_file)?;
        let range = field_log::Range {
            from: self.from,
            to: self.to,
        };
        let (sequence, report) = field_log::read_range(path, &mapping, &range)?;
        tell_text!("{report}");
        Ok(sequence)
    }

    fn log_samples(&self, path: &Path) -> anyhow::Result<Vec<Sample>> {
        let sequence = self.log(path)?;
        let samples = sequence.inputs.iter().map(|input| Sample {
            // Times of a log begin at 0 and span some years at most, so they fit.
            time: (input.time * 1e9).round() as i64,
            kind: input.kind,
            value: input.value,
            stamp: None,
        });
        Ok(samples.collect())
    }
}

/// The only YAML file in the folder of a log.
fn only_mapping_in_folder_of(log: &Path) -> anyhow::Result<PathBuf> {
    let folder = match log.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| format!("{}", folder.display()))? {
        let path = entry.with_context(|| format!("{}", folder.display()))?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "yaml" || extension == "yml")
        {
            found.push(path);
        }
    }
    match found.as_slice() {
        [only] => Ok(only.clone()),
        _ => Err(WrongUse::new(format!(
            "{}: its folder has {} YAML files, so the mapping is not clear; name it with --mapping FILE \
             (config/field_logs/rig_1hz.yaml is an example)",
            log.display(),
            found.len()
        ))
        .into()),
    }
}

fn from_bag(path: &Path) -> anyhow::Result<Vec<Sample>> {
    let mut bag = bag::open(path)?;
    let plain = InputKind::ALL.map(|kind| bag.topic(kind.topic()).map(|topic| topic.name.clone()));
    let stamped = bag.topic(topics::RIG_INPUTS.name).map(|topic| topic.name.clone());
    let [speed, weight, advance, pressure] = plain;
    // The optional inputs may be missing.
    let [advance, pressure] = [advance.ok(), pressure.ok()];
    let names: [Option<String>; InputKind::COUNT + 1] = match (speed, weight, stamped) {
        (Ok(speed), Ok(weight), stamped) => [Some(speed), Some(weight), advance, pressure, stamped.ok()],
        // Without the plain topics, the stamped topic has the inputs.
        (speed, weight, Ok(stamped)) => [speed.ok(), weight.ok(), advance, pressure, Some(stamped)],
        (speed, weight, Err(_)) => {
            let error = speed.and(weight).err().map(anyhow::Error::from);
            let missing = error.unwrap_or_else(|| anyhow::anyhow!("no inputs"));
            return Err(missing.context(format!(
                "{}: the bag needs rotary speed and weight on bit",
                path.display()
            )));
        }
    };
    let role = |name: &str, ros_type: &str| {
        names.iter().enumerate().position(|(index, known)| {
            let wanted = if index < InputKind::COUNT {
                Float64::ROS_TYPE
            } else {
                RigInputs::ROS_TYPE
            };
            known.as_deref() == Some(name) && wanted == ros_type
        })
    };
    bag.select(|topic| role(&topic.name, &topic.ros_type).is_some());
    let mut samples = Vec::new();
    for message in bag.by_ref() {
        let message = message?;
        let time = message.log_time;
        let mut add = |kind, value, stamp| {
            samples.push(Sample {
                time,
                kind,
                value,
                stamp,
            });
        };
        let kind = role(&message.topic.name, &message.topic.ros_type).and_then(|index| InputKind::ALL.get(index));
        match kind {
            Some(kind) => add(*kind, message.decode::<Float64>()?.data, None),
            None => {
                let given = stamped::values(&message.decode::<RigInputs>()?, time, 0.0);
                for (kind, given) in InputKind::ALL.into_iter().zip(given) {
                    if let Some((value, stamp)) = given {
                        add(kind, value, Some(stamp));
                    }
                }
            }
        }
    }
    for cut in bag.cuts() {
        tell!(
            "{} was cut short ({}); the samples up to there are used",
            cut.path.display(),
            cut.reason
        );
    }
    Ok(samples)
}
