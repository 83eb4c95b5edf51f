//! A part of a log.

use std::fmt;
use std::str::FromStr;

use crate::FieldLogError;

/// A position in a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Position {
    /// As an editor numbers rows, the header being row 1. Written `row:6345`.
    Row(u64),
    /// Seconds since the log's first row. Written `90` or `90s`.
    Time(f64),
}

impl FromStr for Position {
    type Err = FieldLogError;

    fn from_str(text: &str) -> Result<Self, FieldLogError> {
        let error = || FieldLogError::Position { text: text.to_string() };
        if let Some(row) = text.strip_prefix("row:") {
            return row.parse().map(Self::Row).map_err(|_| error());
        }
        let seconds: f64 = text.strip_suffix('s').unwrap_or(text).parse().map_err(|_| error())?;
        // NaN fails both comparisons; a time so close to 0, yet not 0, is a typing error.
        if seconds == 0.0 || (1e-9..=1e10).contains(&seconds) {
            Ok(Self::Time(seconds))
        } else {
            Err(error())
        }
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Row(row) => write!(f, "row {row}"),
            Self::Time(time) => write!(f, "{time} s"),
        }
    }
}

/// An interval of a log, ends included; `None` is the log's begin or end.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Range {
    /// First.
    pub from: Option<Position>,
    /// Last.
    pub to: Option<Position>,
}

impl Range {
    /// The whole log.
    pub const ALL: Self = Self { from: None, to: None };

    /// The row, clamped to the range's row numbers.
    pub(crate) fn nearest_row(&self, row: u64) -> u64 {
        let first = match self.from {
            Some(Position::Row(first)) => first,
            _ => 0,
        };
        let last = match self.to {
            Some(Position::Row(last)) => last,
            _ => u64::MAX,
        };
        row.min(last).max(first)
    }

    pub(crate) fn contains(&self, row: u64, time: f64) -> bool {
        let after = self.from.is_none_or(|from| match from {
            Position::Row(first) => row >= first,
            Position::Time(first) => time >= first,
        });
        let before = self.to.is_none_or(|to| match to {
            Position::Row(last) => row <= last,
            Position::Time(last) => time <= last,
        });
        after && before
    }
}
