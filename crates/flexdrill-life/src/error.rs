//! Why a life is not kept.

use flexdrill_text::date_time;

/// Why a run was not added, or a table not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LifeError {
    /// A line of the table is wrong.
    #[error("{file}, line {line}: {reason}")]
    Line {
        /// The table, for the message.
        file: String,
        /// From 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// The configuration states no class.
    #[error(
        "the run has no tool.joint.life: without a class of the joints, such as `life: {{class: F1}}`, counted cycles are no \
         part of a life. State it, and replay the run"
    )]
    NoClass,
    /// The configuration has no serial numbers.
    #[error(
        "the run has no tool.joint.serial_numbers: list the serial numbers of its joints from the bit up, and replay the run"
    )]
    NoSerials,
    /// Nothing was counted.
    #[error("the run has no twin/ageing with time in it: record it with outputs.rates.ageing above 0")]
    NothingCounted,
    /// The counted cycles are of another class than the configuration's.
    #[error(
        "the run counted cycles with a slope of {counted}, and the class in tool.joint.life has {class}: an older version \
         recorded it. Replay it with this one"
    )]
    OtherSlope {
        /// Of the recording.
        counted: f64,
        /// Of the class.
        class: f64,
    },
    /// As many joints are not what the configuration has.
    #[error("the run has {found} joints in twin/ageing, and its configuration {expected}: the recording is damaged")]
    OtherJoints {
        /// Joints of the messages.
        found: usize,
        /// Joints of the configuration.
        expected: usize,
    },
    /// The table is of another tool or class.
    #[error(
        "{file} is of other joints: {what} is {of_file} there, and {of_run} in the run. Damages of different joints or \
         classes do not add up: use another file, or make a new one of all recordings with `flexdrill life add`"
    )]
    OtherKind {
        /// The table, for the message.
        file: String,
        /// What differs.
        what: &'static str,
        /// In the table.
        of_file: String,
        /// In the run.
        of_run: String,
    },
    /// Serial numbers that the table does not have.
    #[error(
        "{file} does not have {named}{}. A joint whose life begins with this run is added with --new {first}; a used joint \
         without a known life has no place in the table",
        meant.as_ref().map(|meant| format!(" (is it {meant}?)")).unwrap_or_default()
    )]
    UnknownSerials {
        /// The table, for the message.
        file: String,
        /// All of them with their places.
        named: String,
        /// The first of them.
        first: String,
        /// The nearest one that the table has.
        meant: Option<String>,
    },
    /// A joint would have drilled twice at once.
    #[error(
        "{file} has {serial} in another run at that time, from {} to {}: the same drilling with another configuration would \
         count twice. --replace takes that run out of the table",
        date_time(*start), date_time(*end)
    )]
    Overlap {
        /// The table, for the message.
        file: String,
        /// The joint.
        serial: String,
        /// Begin of the other run (ns).
        start: i64,
        /// Its end (ns).
        end: i64,
    },
    /// Another run has the same identity.
    #[error(
        "{file} has another run of this configuration that began at {}, with other damages: runs are distinguished by their \
         configuration and their begin. Give each run its own run.title, and replay it",
        date_time(*start)
    )]
    SameBegin {
        /// The table, for the message.
        file: String,
        /// Begin of both (ns).
        start: i64,
    },
}
