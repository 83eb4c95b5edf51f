//! Order of rows in time: detects jumps of the log's clock and leaves out the rows that they spoil.

use flexdrill_text::six_digits;

use crate::TimeFormat;
use crate::report::{IssueKind, Issues};
use crate::time_format::DAY;

/// A clock that stays set back for more rows than this was restarted; fewer rows are outliers.
const FEW_ROWS: usize = 5;
/// Time between two parts, in multiples of the longest time between two rows: long enough to count as a gap, across
/// which no values are joined.
pub(crate) const SEAM_IN_GAPS: f64 = 2.0;

/// A row with a readable time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Timed {
    /// As an editor numbers it.
    pub(crate) number: u64,
    /// Time since the first row used (s); before [`order`], the time that the log gives.
    pub(crate) time: f64,
}

/// How the log gives time.
pub(crate) struct TimeAxis<'a> {
    pub(crate) format: &'a TimeFormat,
    /// Name of the time column.
    pub(crate) column: &'a str,
    pub(crate) max_gap: f64,
}

/// Removes and reports the rows whose time does not advance, in place. Returns the number of the first row of each
/// part.
pub(crate) fn order(rows: &mut Vec<Timed>, axis: &TimeAxis<'_>, issues: &mut Issues) -> Vec<u64> {
    // Only accepted rows are compared with: after an outlier the next row is judged by the last good one.
    let mut parts = Vec::new();
    let mut kept: Vec<Timed> = Vec::with_capacity(rows.len());
    // Added to the log's times, so that they begin at 0 and advance over midnights and from part to part.
    let mut shift = 0.0;
    for (index, row) in rows.iter().enumerate() {
        let Some(last) = kept.last().copied() else {
            shift = -row.time;
            parts.push(row.number);
            kept.push(Timed { time: 0.0, ..*row });
            continue;
        };
        let mut time = row.time + shift;
        // A time of day falls back by almost a day at midnight only.
        if axis.format.restarts_daily() && last.time - time > DAY / 2.0 {
            shift += DAY;
            time += DAY;
        }
        let step = time - last.time;
        // Looking ahead one row distinguishes a wrong time from a pause: after a pause the next row is beyond it too.
        if step > axis.max_gap && jumps_ahead(&rows[index + 1..], shift, last.time, time) {
            issues.add(IssueKind::TimeJumps, axis.column, row.number, || {
                format!("{step:.1} s ahead of the row before, and the next row is back")
            });
            continue;
        }
        // A clock that was set back continues from there, an outlier returns. Only the rows after it show which.
        if step < 0.0 && continues(&rows[index + 1..], shift, time, last.time) {
            issues.add(IssueKind::TimeRestarts, axis.column, row.number, || {
                format!(
                    "{:.2} s before the row before, and the time continues from there",
                    -step
                )
            });
            // The new part begins after a gap that no value is held across,
            // because the log does not say how long the pause was.
            shift += SEAM_IN_GAPS * axis.max_gap - step;
            time = row.time + shift;
            parts.push(row.number);
        // Rows that stand or fall back would have two values for one instant.
        } else if step <= 0.0 {
            if step < 0.0 {
                issues.add(IssueKind::TimeBackwards, axis.column, row.number, || {
                    format!("by {} s", six_digits(-step))
                });
            } else {
                issues.add(IssueKind::TimeRepeats, axis.column, row.number, || {
                    "that of the row before".to_owned()
                });
            }
            continue;
        // A gap is reported and kept: the samples on both sides are good.
        } else if step > axis.max_gap {
            issues.add(IssueKind::Gap, "", row.number, || {
                format!("{step:.1} s since the row before")
            });
        }
        kept.push(Timed { time, ..*row });
    }
    *rows = kept;
    parts
}

/// Whether the row at `time` alone is ahead: the next row lies between `last` and it.
fn jumps_ahead(next: &[Timed], shift: f64, last: f64, time: f64) -> bool {
    next.first()
        .is_some_and(|next| (last..time).contains(&(next.time + shift)))
}

/// Whether the clock continues from `time`, which is before `last`, for more than a few rows.
fn continues(next: &[Timed], shift: f64, mut time: f64, last: f64) -> bool {
    for row in next.iter().take(FEW_ROWS) {
        let at = row.time + shift;
        if at >= last {
            return false;
        }
        // A second jump back belongs to the same restart.
        time = time.max(at);
    }
    next.len() >= FEW_ROWS && time < last
}
