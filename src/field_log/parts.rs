//! Rows in the order of time: what the clock of a log does, and which rows are left out for it.

use super::TimeFormat;
use super::report::{IssueKind, Issues};
use super::time_format::DAY;

/// A clock that is found set back for more rows than this runs on from there; fewer rows are wrong themselves.
const FEW_ROWS: usize = 5;
/// A part begins this many times the longest time between two rows after the one before: that is a gap, over which
/// nothing is joined.
pub(super) const SEAM_IN_GAPS: f64 = 2.0;

/// A row with a readable time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Timed {
    /// As an editor numbers it.
    pub(super) number: u64,
    /// Since the first row that is used (s); before [`order`], as the log writes it.
    pub(super) time: f64,
}

/// What of the clock of a log is known.
pub(super) struct Clock<'a> {
    pub(super) format: TimeFormat,
    /// Name of its column.
    pub(super) column: &'a str,
    pub(super) max_gap: f64,
}

/// Puts the rows in order, in place: what does not advance is taken out and reported. The first rows of the parts.
pub(super) fn order(rows: &mut Vec<Timed>, clock: &Clock<'_>, issues: &mut Issues) -> Vec<u64> {
    let mut parts = Vec::new();
    let mut kept: Vec<Timed> = Vec::with_capacity(rows.len());
    // What is added to the times of the log: to begin at 0, over midnights and over the seams of parts.
    let mut shift = 0.0;
    for (index, row) in rows.iter().enumerate() {
        let Some(last) = kept.last().copied() else {
            shift = -row.time;
            parts.push(row.number);
            kept.push(Timed { time: 0.0, ..*row });
            continue;
        };
        let mut time = row.time + shift;
        if clock.format == TimeFormat::TimeOfDay && last.time - time > DAY / 2.0 {
            shift += DAY;
            time += DAY;
        }
        let step = time - last.time;
        if step > clock.max_gap && jumps_ahead(&rows[index + 1..], shift, last.time, time) {
            issues.add(IssueKind::TimeJumps, clock.column, row.number, || {
                format!("{step:.1} s ahead of the row before, and back in the next")
            });
            continue;
        }
        if step < 0.0 && runs_on(&rows[index + 1..], shift, time, last.time) {
            issues.add(IssueKind::TimeStartsAnew, clock.column, row.number, || {
                format!("{:.2} s before the row before, and runs on from there", -step)
            });
            shift += SEAM_IN_GAPS * clock.max_gap - step;
            time = row.time + shift;
            parts.push(row.number);
        } else if step <= 0.0 {
            let kind = if step < 0.0 {
                IssueKind::TimeBackwards
            } else {
                IssueKind::TimeStandsStill
            };
            issues.add(kind, clock.column, row.number, || format!("by {:.2} s", -step));
            continue;
        } else if step > clock.max_gap {
            issues.add(IssueKind::Gap, "", row.number, || {
                format!("{step:.1} s since the row before")
            });
        }
        kept.push(Timed { time, ..*row });
    }
    *rows = kept;
    parts
}

/// Whether the row at `time` is alone ahead: the next one is between it and `last`.
fn jumps_ahead(next: &[Timed], shift: f64, last: f64, time: f64) -> bool {
    next.first()
        .is_some_and(|next| (last..time).contains(&(next.time + shift)))
}

/// Whether the clock runs on from `time`, which is before `last`, for more than a few rows.
fn runs_on(next: &[Timed], shift: f64, mut time: f64, last: f64) -> bool {
    for row in next.iter().take(FEW_ROWS) {
        let at = row.time + shift;
        if at >= last {
            return false;
        }
        // A second jump back is one more of the same.
        time = time.max(at);
    }
    next.len() >= FEW_ROWS && time < last
}
