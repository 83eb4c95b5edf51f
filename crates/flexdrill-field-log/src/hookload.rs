//! Weight on bit from the hookload: the bit carries the weight that the hook no longer carries.

use crate::mapping::Hookload;
use crate::report::{IssueKind, Issues, Tare};
use crate::table::{Numbering, Row};
use flexdrill_core::inputs::InputKind;

const SPEED: usize = InputKind::RotarySpeed.index();
const WEIGHT: usize = InputKind::WeightOnBit.index();

/// Converts hookloads to weights on bit, in place and before scaling. Returns the tares that it used.
pub(crate) fn weigh(
    rows: &mut [Row],
    mapping: &Hookload,
    max_gap: f64,
    numbering: Numbering,
    issues: &mut Issues,
) -> Vec<Tare> {
    let mut tares: Vec<Tare> = Vec::new();
    // First row of the current interval off bottom and rotating.
    let mut interval_start: Option<usize> = None;
    for index in 0..rows.len() {
        let row = rows[index];
        let follows = index > 0 && row.time - rows[index - 1].time <= max_gap;
        let off_bottom_and_rotating = row.off_bottom == Some(true)
            && row.drilling == Some(false)
            && row.values[WEIGHT].is_some()
            && row.values[SPEED].is_some_and(|speed| speed > mapping.rotating_above_rpm);
        if let Some(start) = interval_start
            && (!off_bottom_and_rotating || !follows)
        {
            tares.extend(tare(&rows[start..index], mapping));
            interval_start = None;
        }
        if off_bottom_and_rotating && interval_start.is_none() {
            interval_start = Some(index);
        }
    }
    // A second pass is needed because the first reads the hookloads that this one overwrites.
    let mut next_tare = 0;
    for row in rows.iter_mut() {
        while tares.get(next_tare).is_some_and(|tare| tare.last_row < row.number) {
            next_tare += 1;
        }
        let last_tare = next_tare.checked_sub(1).and_then(|index| tares.get(index));
        row.values[WEIGHT] = weight(row, last_tare, mapping, numbering, issues);
    }
    tares
}

fn weight(
    row: &Row,
    tare: Option<&Tare>,
    mapping: &Hookload,
    numbering: Numbering,
    issues: &mut Issues,
) -> Option<f64> {
    let (hookload, drilling) = (row.values[WEIGHT]?, row.drilling?);
    if !drilling {
        return Some(0.0);
    }
    let Some(tare) = tare else {
        issues.add(IssueKind::NoTare, &mapping.column, row.number, || {
            "drilling before any interval off bottom and rotating".to_string()
        });
        return None;
    };
    let weight = tare.hookload_kn - hookload;
    if weight >= 0.0 {
        return Some(weight);
    }
    if weight < -mapping.negative_band_kn {
        issues.add(IssueKind::NegativeWeight, &mapping.column, row.number, || {
            format!("{weight:.1} kN with the tare of row {}", numbering.swap(tare.last_row))
        });
        return None;
    }
    issues.add(IssueKind::TareNoise, &mapping.column, row.number, || {
        format!("{weight:.1} kN")
    });
    Some(0.0)
}

/// The tare of an interval; `None` when the interval has too few rows.
fn tare(interval: &[Row], mapping: &Hookload) -> Option<Tare> {
    let last = interval.last()?;
    if interval.len() < mapping.tare_min_rows {
        return None;
    }
    let window = interval
        .iter()
        .filter(|row| last.time - row.time <= mapping.tare_window);
    let first_row = window.clone().next()?.number;
    let mut hookloads: Vec<f64> = window.filter_map(|row| row.values[WEIGHT]).collect();
    hookloads.sort_by(f64::total_cmp);
    Some(Tare {
        first_row,
        last_row: last.number,
        hookload_kn: *hookloads.get(hookloads.len() / 2)?,
        spread_kn: hookloads.last()? - hookloads.first()?,
    })
}
