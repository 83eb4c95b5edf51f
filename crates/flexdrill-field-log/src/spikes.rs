//! Spikes (single implausible samples) and frozen values.

use crate::report::{IssueKind, Issues};
use crate::table::Row;
use flexdrill_core::inputs::InputKind;

/// Removes single samples that are further than `limit` from both neighbours, on the same side. Longer excursions
/// are kept, as they may be real.
pub(crate) fn remove_spikes(
    rows: &mut [Row],
    kind: InputKind,
    limit: f64,
    max_gap: f64,
    column: &str,
    issues: &mut Issues,
) {
    for middle in 1..rows.len().saturating_sub(1) {
        let near = rows[middle + 1].time - rows[middle - 1].time <= 2.0 * max_gap;
        let of = |index: usize| rows[index].values[kind.index()];
        let (Some(before), Some(value), Some(after)) = (of(middle - 1), of(middle), of(middle + 1)) else {
            continue;
        };
        let (rise, fall) = (value - before, value - after);
        if near && rise.abs() > limit && fall.abs() > limit && rise.signum() == fall.signum() {
            issues.add(IssueKind::Spike, column, rows[middle].number, || {
                format!("{value:.1} {} between {before:.1} and {after:.1}", kind.unit())
            });
            rows[middle].values[kind.index()] = None;
        }
    }
}

/// Reports non-zero values that do not change for longer than `after` (s). They are kept: some values are steady.
pub(crate) fn report_frozen(rows: &[Row], kind: InputKind, after: f64, column: &str, issues: &mut Issues) {
    let alike = |a: &Row, b: &Row| a.values[kind.index()] == b.values[kind.index()];
    for run in rows.chunk_by(alike) {
        let ([from, ..], [.., to]) = (run, run) else {
            continue;
        };
        let length = to.time - from.time;
        if let Some(value) = from.values[kind.index()]
            && value != 0.0
            && length > after
        {
            let count = run.len() as u64;
            issues.add_span(IssueKind::Frozen, column, from.number, to.number, count, || {
                format!("{value} {} for {length:.0} s", kind.unit())
            });
        }
    }
}
