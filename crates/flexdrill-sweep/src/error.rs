//! What is wrong with a sweep's directory.

use std::path::PathBuf;

use flexdrill_config::ConfigError;

use crate::plan::{FORMAT, Problem};

/// Why a sweep cannot be planned, worked on or collected.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// A file or folder cannot be read.
    #[error("{}: cannot be read: {reason}", path.display())]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        reason: std::io::Error,
    },
    /// A file or folder cannot be written.
    #[error("{}: cannot be written: {reason}; the other results stay, and the same command goes on", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        reason: std::io::Error,
    },
    /// The file system cannot confirm that a file is on the disk.
    #[error(
        "{}: cannot be synced to the disk: {reason}. This file system does not support it; choose a directory on another \
         one. The other results stay", path.display()
    )]
    NotSynced {
        /// The folder of the file.
        path: PathBuf,
        /// The system's reason.
        reason: std::io::Error,
    },
    /// A folder of the directory is a link to another place.
    #[error(
        "{}: is a link: results are read and written within the directory only. Move the folder here, or make the whole \
         directory where the link leads to", path.display()
    )]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// The directory has no plan.
    #[error("{}: no sweep: it has no sweep.json; make one with flexdrill sweep plan SPEC DIR", path.display())]
    NoPlan {
        /// The directory.
        path: PathBuf,
    },
    /// The plan is damaged, or too large.
    #[error("{}: not the plan of a sweep, or damaged: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The plan has another format.
    #[error("{}: a plan of format {found}; this program reads format {FORMAT}: plan again in a new directory", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: u32,
    },
    /// The directory has another plan.
    #[error("{}: the directory has another plan, which differs in {what}; nothing was changed: choose a new directory", path.display())]
    AnotherPlan {
        /// The plan that is there.
        path: PathBuf,
        /// The first difference.
        what: &'static str,
    },
    /// The plan is another program's.
    #[error(
        "{}: planned by {found}, and this is {here}: results of two programs are not mixed; continue with {found}, or \
         plan again in a new directory", path.display()
    )]
    AnotherProgram {
        /// The plan.
        path: PathBuf,
        /// The program that planned.
        found: String,
        /// The program that runs.
        here: String,
    },
    /// A number of the plan is out of bounds.
    #[error("{name}: {problem}")]
    Plan {
        /// The specification or the plan.
        name: String,
        /// The number.
        problem: Problem,
    },
    /// A file of the configuration's kind is refused.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A row of values is refused by the configuration.
    #[error("{name}: row {row} of the values: {reason}")]
    Row {
        /// The specification.
        name: String,
        /// Number of the row, from 1.
        row: usize,
        /// What the configuration says.
        reason: ConfigError,
    },
    /// Points have no result yet.
    #[error("{}: {missing} of {points} points have no result; run flexdrill sweep work, or collect with --partial", path.display())]
    Incomplete {
        /// The directory.
        path: PathBuf,
        /// Points without a result.
        missing: usize,
        /// All points.
        points: usize,
    },
    /// A point's file is damaged.
    #[error(
        "{}: {reason}; it was left alone. Remove it, and run the same command again ({damaged} damaged in all)",
        path.display()
    )]
    DamagedPoint {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
        /// Damaged files in all.
        damaged: usize,
    },
    /// A result cannot be written as JSON.
    #[error("the result of point {point}: {reason}")]
    NoJson {
        /// Its name.
        point: String,
        /// Why.
        reason: String,
    },
}
