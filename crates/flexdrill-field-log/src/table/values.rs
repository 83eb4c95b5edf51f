//! The fields of a row as text and as numbers.

use crate::mapping::Notation;
use crate::report::{IssueKind, Issues};

/// Largest value accepted (in the log's unit): far above any measurement, and finite after any unit and scale.
const LARGEST: f64 = 1e15;

/// Longest text of a field in a message (characters).
const LONGEST_QUOTE: usize = 60;

/// A field in quotes for a message, cut at [`LONGEST_QUOTE`].
pub(super) fn quoted(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{:?}...", &text[..end]),
        None => format!("{text:?}"),
    }
}

/// The text of a field; none where it is not UTF-8, or not there.
pub(super) fn text(record: &csv::ByteRecord, index: usize) -> Option<&str> {
    record.get(index).and_then(|bytes| std::str::from_utf8(bytes).ok())
}

/// Numbers that recorders write for no value: -999.25 of LAS and its relatives, those of WITS, and the smallest whole
/// number of 16 bits. No input of a rig has them.
pub(crate) const MISSING_CODES: [f64; 9] = [
    -999.25, -999.0, -9999.0, -9999.25, -99_999.0, -999_999.0, -8888.0, -32_768.0, -999.99,
];

/// The fields of a row as numbers.
pub(super) struct Values<'a> {
    pub(super) record: &'a csv::ByteRecord,
    pub(super) number: u64,
    pub(super) notation: Notation,
    pub(super) missing: &'a [f64],
}

impl Values<'_> {
    /// The number of a field that most rows do not have: any other text is none.
    pub(super) fn rare(&self, index: usize) -> Option<f64> {
        let value = self.notation.parse(text(self.record, index)?)?;
        let is_missing = self.missing.contains(&value) || MISSING_CODES.contains(&value);
        (!is_missing && value.abs() <= LARGEST).then_some(value)
    }

    /// The number of a field. Each problem is reported by its kind, with the column and the row.
    pub(super) fn value(&self, index: usize, column: &str, issues: &mut Issues) -> Option<f64> {
        let number = self.number;
        let Some(text) = text(self.record, index) else {
            issues.add(IssueKind::Unreadable, column, number, || "not text".to_string());
            return None;
        };
        // Empty is missing and not zero.
        if text.is_empty() {
            issues.add(IssueKind::Missing, column, number, || "empty".to_string());
            return None;
        }
        match self.notation.parse(text) {
            // Rigs write numbers such as -999.25 for a missing value; the mapping lists them.
            Some(value) if self.missing.contains(&value) => {
                issues.add(IssueKind::Missing, column, number, || text.to_string());
                None
            }
            Some(value) if MISSING_CODES.contains(&value) => {
                issues.add(IssueKind::MissingCode, column, number, || {
                    format!("{text} stands for no value in many recorders: add `missing: [{value}]` to the mapping")
                });
                None
            }
            // Beyond any sensor is a fault of the log, and such a number would hide the rest in a chart.
            Some(value) if value.abs() <= LARGEST => Some(value),
            Some(value) if value.is_finite() => {
                issues.add(IssueKind::Unreadable, column, number, || {
                    format!("{} is beyond {LARGEST:e}, more than any sensor measures", quoted(text))
                });
                None
            }
            _ => {
                issues.add(IssueKind::Unreadable, column, number, || {
                    format!("{} is not a number{}", quoted(text), self.notation.decimal.hint(text))
                });
                None
            }
        }
    }
}
