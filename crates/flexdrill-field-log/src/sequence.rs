//! The timed inputs of a log.

use crate::{MeasuredSequence, SurveyRow};
use flexdrill_core::inputs::InputKind;

/// One sample, as the input's topic would carry it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedInput {
    /// Since the first row of the range that was read (s).
    pub time: f64,
    /// The input that it belongs to.
    pub kind: InputKind,
    /// r/min or kN, in the unit of the input's topic.
    pub value: f64,
    /// Row in the log, as an editor numbers it.
    pub row: u64,
}

/// The time of a row as the log gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct RowTime {
    /// Row in the log, as an editor numbers it.
    pub row: u64,
    /// Since the first row of the range that was read (s).
    pub time: f64,
    /// What the row's time column says, with the column's name; empty where [`InputSequence::start`] is known and says the
    /// same.
    pub own_time: String,
}

/// Samples in the order of time, rotary speed before weight on bit of the same row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct InputSequence {
    /// The samples.
    pub inputs: Vec<TimedInput>,
    /// What the log measures besides.
    pub measured: MeasuredSequence,
    /// Surveys of the hole.
    pub surveys: Vec<SurveyRow>,
    /// The time of each row.
    pub rows: Vec<RowTime>,
    /// The instant of the first row that was read (s since 1970, UTC), where the log has dates.
    pub start: Option<f64>,
    /// Time from the first to the last row that was read (s), samples or not.
    pub duration: f64,
}
