//! Inputs and measured values with times from a bag, a field log or a capture of a WITS line, for `rig` and `replay`.

mod bags;
mod guess;
#[cfg(feature = "bridge")]
mod wits;
#[cfg(not(feature = "bridge"))]
#[path = "no_wits.rs"]
mod wits;

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::Args;

use super::WrongUse;
use super::built_in::DemoLog;
use crate::bag;
use crate::cli::output::{tell, tell_text};
use crate::field_log::{self, InputSequence, Mapping, Position};
use crate::messages::builtin_interfaces::Time;
use crate::messages::std_msgs::Header;
use crate::messages::{RigInputs, RigMeasured, RigSurvey};
use flexdrill_core::inputs::{InputKind, Stamp};
use flexdrill_outputs::{InputValues as _, MeasuredValues as _};

/// End of the seconds in a stamp of ROS, which have 32 bits (s since 1970).
const LATEST_STAMP: f64 = i32::MAX as f64;

/// A timed sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// ns since 1970; of a field log without dates, since its first row.
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
        self.time.saturating_sub(first.time) as f64 * 1e-9
    }
}

/// What the rig measured besides its inputs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MeasuredSample {
    /// ns since 1970; of a field log without dates, since its first row.
    pub(super) time: i64,
    pub(super) message: RigMeasured,
}

/// A survey of the hole.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SurveySample {
    /// ns since 1970; of a field log without dates, since its first row.
    pub(super) time: i64,
    pub(super) message: RigSurvey,
}

/// What a source has, each part in the order of time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Samples {
    pub(super) inputs: Vec<Sample>,
    pub(super) measured: Vec<MeasuredSample>,
    pub(super) surveys: Vec<SurveySample>,
    /// The rows of a field log by their times, as sources of messages: see [`crate::field_log::row_source`].
    pub(super) rows: Vec<(i64, String)>,
}

/// What the rig sent, with the times of arrival, each part in the order of time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct FromRig {
    /// The inputs (time in ns since 1970).
    pub(super) inputs: Vec<(i64, RigInputs)>,
    pub(super) measured: Vec<MeasuredSample>,
    pub(super) surveys: Vec<SurveySample>,
}

impl Samples {
    /// The inputs as messages, one for the samples of one time; the source of each is its row of a field log.
    pub(super) fn messages(&self) -> Vec<(i64, RigInputs)> {
        let of_one_time = self.inputs.chunk_by(|before, after| before.time == after.time);
        let message = |samples: &[Sample]| {
            let time = samples.first()?.time;
            let mut values = [None; InputKind::COUNT];
            for sample in samples {
                values[sample.kind.index()] = Some(sample.value);
            }
            let row = self.rows.binary_search_by_key(&time, |(time, _)| *time);
            let source = row.ok().and_then(|index| self.rows.get(index));
            let header = Header {
                stamp: Time::from_nanoseconds(time),
                ..Header::default()
            };
            let source = source.map_or_else(String::new, |(_, source)| source.clone());
            Some((time, RigInputs::of(header, values, RigInputs::GOOD, source)))
        };
        of_one_time.filter_map(message).collect()
    }

    /// In the order of time. The sorts are stable: samples of the same time keep the order of the source.
    fn sorted(mut self) -> Self {
        self.inputs.sort_by_key(|sample| sample.time);
        self.measured.sort_by_key(|sample| sample.time);
        self.surveys.sort_by_key(|sample| sample.time);
        self
    }
}

/// The part of a source to use, and the mapping of its columns.
#[derive(Debug, Args)]
pub(super) struct SourceArgs {
    /// Mapping of a field log's columns (YAML), or of a capture's items. Default: of a log, the only YAML file in its
    /// folder; of a capture, the usual items in metric units.
    #[arg(long, value_name = "FILE")]
    mapping: Option<PathBuf>,
    /// Begin this many seconds after the start, or at a row of a field log (row:6345, as an editor numbers it).
    #[arg(long, value_name = "POSITION")]
    from: Option<Position>,
    /// End at this position, given in the same form.
    #[arg(long, value_name = "POSITION")]
    to: Option<Position>,
    #[command(flatten)]
    guess: guess::GuessArgs,
}

/// Whether a path is a bag and not a text file.
///
/// # Errors
/// When it cannot be read.
pub(super) fn is_bag(path: &Path) -> anyhow::Result<bool> {
    if DemoLog::at(path).is_some() {
        return Ok(false);
    }
    Ok(bag::is_bag(path)?)
}

impl SourceArgs {
    /// Whether any option was given.
    pub(super) fn is_given(&self) -> bool {
        self.mapping.is_some() || self.from.is_some() || self.to.is_some() || self.guess.is_given()
    }

    /// Proposes the mapping of a field log where --guess asks for it. True where the command ends with that: without --yes.
    ///
    /// # Errors
    /// When the source is no field log, or cannot be read, or the mapping cannot be written.
    pub(super) fn ends_with_guess(&self, path: &Path) -> anyhow::Result<bool> {
        if self.guess.is_given() && (wits::is_capture(path) || is_bag(path)?) {
            return Err(WrongUse::new(format!(
                "{}: --guess proposes the mapping of a field log, and this is none; the items of a WITS line are shown by \
                 flexdrill bridge wits --look",
                path.display()
            ))
            .into());
        }
        self.guess.ends_the_command(path)
    }

    /// The samples of a bag, a field log or a capture. The report of a log or a capture is printed on standard error.
    ///
    /// # Errors
    /// When the source cannot be read or has no sample of an input.
    pub(super) fn read(&self, path: &Path) -> anyhow::Result<Samples> {
        if wits::is_capture(path) {
            return self.read_wits(path);
        }
        let samples = if is_bag(path)? {
            self.part(path, bags::read(path)?)?
        } else {
            self.log_samples(path)?
        };
        with_inputs(path, samples)
    }

    /// The samples of a capture, or of a file with the bytes of a WITS line alone.
    ///
    /// # Errors
    /// As [`SourceArgs::read`].
    pub(super) fn read_wits(&self, path: &Path) -> anyhow::Result<Samples> {
        let samples = wits::read(path, self.mapping.as_deref())?;
        with_inputs(path, self.part(path, samples)?)
    }

    /// The samples between --from and --to, counted from the first input.
    fn part(&self, path: &Path, samples: Samples) -> anyhow::Result<Samples> {
        let seconds_of = |position: Option<Position>, default: f64| match position {
            None => Ok(default),
            Some(Position::Time(seconds)) => Ok(seconds),
            Some(Position::Row(row)) => Err(WrongUse::new(format!(
                "row:{row}: only a field log has rows; give seconds"
            ))),
        };
        let (from, to) = (seconds_of(self.from, 0.0)?, seconds_of(self.to, f64::INFINITY)?);
        let mut samples = samples.sorted();
        let Some(first) = samples.inputs.first().copied() else {
            return Ok(samples);
        };
        let seconds = |time: i64| time.saturating_sub(first.time) as f64 * 1e-9;
        let all = samples.inputs.last().map_or(0.0, |last| seconds(last.time));
        samples
            .inputs
            .retain(|sample| (from..=to).contains(&seconds(sample.time)));
        samples
            .measured
            .retain(|sample| (from..=to).contains(&seconds(sample.time)));
        samples
            .surveys
            .retain(|sample| (from..=to).contains(&seconds(sample.time)));
        if samples.inputs.is_empty() {
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
        let demo = DemoLog::at(path);
        let mapping = match (&self.mapping, self.guess.mapping(path)?, &demo) {
            (Some(file), _, _) => Mapping::load(file)?,
            (None, Some(guess), _) => guess,
            (None, None, Some(demo)) => demo.mapping()?,
            (None, None, None) => Mapping::load(only_mapping_in_folder_of(path)?)?,
        };
        let range = field_log::Range {
            from: self.from,
            to: self.to,
        };
        let (sequence, report) = match demo {
            Some(demo) => {
                tell!(
                    "{} is no file here: the built-in demonstration log is used",
                    path.display()
                );
                field_log::read_bytes(demo.name(), demo.content(), &mapping, &range)?
            }
            None => field_log::read_range(path, &mapping, &range)?,
        };
        tell_text!("{report}");
        Ok(sequence)
    }

    fn log_samples(&self, path: &Path) -> anyhow::Result<Samples> {
        let sequence = self.log(path)?;
        // A stamp of ROS ends in 2038: dates beyond it are left out, as is a log that has none.
        let start = sequence.start.filter(|start| start + sequence.duration < LATEST_STAMP);
        let start = (start.unwrap_or(0.0) * 1e9).round() as i64;
        // Times within a log span some years at most, so they fit.
        let nanoseconds = |seconds: f64| start + (seconds * 1e9).round() as i64;
        let file = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let rows = sequence.rows.iter().map(|row| {
            let source = crate::field_log::row_source(row.row, &row.own_time, &file);
            (nanoseconds(row.time), source)
        });
        let inputs = sequence.inputs.iter().map(|input| Sample {
            time: nanoseconds(input.time),
            kind: input.kind,
            value: input.value,
            stamp: None,
        });
        let measured = sequence.measured.rows().map(|row| {
            let header = Header {
                stamp: Time::from_nanoseconds(nanoseconds(row.time)),
                ..Header::default()
            };
            let mut message = RigMeasured::not_given(header, RigMeasured::GOOD, "field log".to_owned());
            for (kind, value) in row.values() {
                message.set(kind, value);
            }
            MeasuredSample {
                time: nanoseconds(row.time),
                message,
            }
        });
        let surveys = sequence.surveys.iter().map(|row| SurveySample {
            time: nanoseconds(row.time),
            message: RigSurvey {
                header: Header {
                    stamp: Time::from_nanoseconds(nanoseconds(row.time)),
                    ..Header::default()
                },
                measured_depth: row.measured_depth,
                inclination: row.inclination,
                azimuth: row.azimuth,
                inclination_deviation: f64::NAN,
                azimuth_deviation: f64::NAN,
                quality: RigSurvey::GOOD,
                source: "field log".to_owned(),
            },
        });
        let samples = Samples {
            inputs: inputs.collect(),
            measured: measured.collect(),
            surveys: surveys.collect(),
            rows: rows.collect(),
        };
        Ok(samples.sorted())
    }
}

fn with_inputs(path: &Path, samples: Samples) -> anyhow::Result<Samples> {
    if samples.inputs.is_empty() {
        bail!("{}: it has no sample of rotary speed or weight on bit", path.display());
    }
    Ok(samples)
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
        [only] => {
            // A guess in the folder of its log is no mapping until a person names it.
            let text = std::fs::read_to_string(only).unwrap_or_default();
            if field_log::is_proposed(&text) {
                return Err(WrongUse::new(format!(
                    "{}: {} was proposed by flexdrill and not compared: compare it, and name it with --mapping or remove its first line",
                    log.display(),
                    only.display()
                ))
                .into());
            }
            Ok(only.clone())
        }
        _ => Err(WrongUse::new(format!(
            "{}: its folder has {} YAML files, so the mapping is not clear; name it with --mapping FILE \
             (config/field_logs/rig_1hz.yaml is an example), or let --guess propose one",
            log.display(),
            found.len()
        ))
        .into()),
    }
}
