//! Weight on bit from the hookload: what is missing on the hook lies on the bit.

use super::mapping::Hookload;
use super::report::{IssueKind, Issues, Tare};
use super::table::Row;
use flexdrill_core::inputs::InputKind;

const SPEED: usize = InputKind::RotarySpeed.index();
const WEIGHT: usize = InputKind::WeightOnBit.index();

/// Turns hookloads into weights on bit, in place and before scaling; gives the tares that were used.
pub(super) fn weigh(rows: &mut [Row], mapping: &Hookload, max_gap: f64, issues: &mut Issues) -> Vec<Tare> {
    let mut tares: Vec<Tare> = Vec::new();
    // Of the stretch that is off bottom and rotating now.
    let mut stretch_start: Option<usize> = None;
    for index in 0..rows.len() {
        let row = rows[index];
        let follows = index > 0 && row.time - rows[index - 1].time <= max_gap;
        let hangs_free = row.off_bottom == Some(true)
            && row.drilling == Some(false)
            && row.values[WEIGHT].is_some()
            && row.values[SPEED].is_some_and(|speed| speed > mapping.rotating_above_rpm);
        if let Some(start) = stretch_start
            && (!hangs_free || !follows)
        {
            tares.extend(tare(&rows[start..index], mapping));
            stretch_start = None;
        }
        if hangs_free && stretch_start.is_none() {
            stretch_start = Some(index);
        }
    }
    // A second pass, because the stretches above need the hookloads that this one overwrites.
    let mut next_tare = 0;
    for row in rows.iter_mut() {
        while tares.get(next_tare).is_some_and(|tare| tare.last_row < row.number) {
            next_tare += 1;
        }
        let last_tare = next_tare.checked_sub(1).and_then(|index| tares.get(index));
        row.values[WEIGHT] = weight(row, last_tare, mapping, issues);
    }
    tares
}

fn weight(row: &Row, tare: Option<&Tare>, mapping: &Hookload, issues: &mut Issues) -> Option<f64> {
    let (hookload, drilling) = (row.values[WEIGHT]?, row.drilling?);
    if !drilling {
        return Some(0.0);
    }
    let Some(tare) = tare else {
        issues.add(IssueKind::NoTare, &mapping.column, row.number, || {
            "drilling before any stretch off bottom and rotating".to_string()
        });
        return None;
    };
    let weight = tare.hookload_kn - hookload;
    if weight >= 0.0 {
        return Some(weight);
    }
    if weight < -mapping.negative_band_kn {
        issues.add(IssueKind::NegativeWeight, &mapping.column, row.number, || {
            format!("{weight:.1} kN with the tare of row {}", tare.last_row)
        });
        return None;
    }
    issues.add(IssueKind::TareNoise, &mapping.column, row.number, || {
        format!("{weight:.1} kN")
    });
    Some(0.0)
}

/// Of a stretch; `None` when it is too short.
fn tare(stretch: &[Row], mapping: &Hookload) -> Option<Tare> {
    let last = stretch.last()?;
    if stretch.len() < mapping.tare_min_rows {
        return None;
    }
    let window = stretch.iter().filter(|row| last.time - row.time <= mapping.tare_window);
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
