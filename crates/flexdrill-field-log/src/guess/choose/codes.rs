//! The column of a rig's activities, for the reader of a mapping that needs its codes.

use std::collections::BTreeMap;

use super::Candidate;
use crate::guess::names::{Meaning, meaning};
use crate::guess::numbers::quantile;
use crate::guess::sheet::{Column, Sheet};
use crate::guess::{Codes, Quantity};
use flexdrill_text::{counted, six_digits};

/// A column with more different numbers than this is no code of an activity.
const MOST_CODES: usize = 20;

/// The column of activities, with what the other columns have in each of its codes.
pub(crate) fn codes(sheet: &Sheet, proposals: &[Candidate]) -> Option<Codes> {
    let is_code = |column: &&Column| {
        let is_named = matches!(meaning(&column.name, "").0, Meaning::Other("a code of an activity"));
        is_named && column.is_number && column.has_own_name
    };
    let column = sheet.columns.iter().find(is_code)?;
    let mut rows: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (row, value) in column.values.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
        // A code is a small whole number.
        if value.fract() != 0.0 || value.abs() > 1e6 || rows.len() > MOST_CODES {
            return None;
        }
        rows.entry(*value as i64).or_default().push(row);
    }
    let shown = [Quantity::HookLoad, Quantity::RotarySpeed, Quantity::Torque];
    let lines = rows.iter().map(|(code, rows)| {
        let mut line = format!("{code}: {}", counted(rows.len() as u64, "row"));
        for one in proposals.iter().filter(|one| shown.contains(&one.quantity)) {
            let values = sheet.columns.get(one.index).map_or(&[][..], |column| &column.values);
            let median = quantile(rows.iter().filter_map(|row| values.get(*row).copied()), 0.5);
            if median.is_finite() {
                line.push_str(&format!(
                    ", median {} {} {}",
                    one.quantity.name(),
                    six_digits(median),
                    one.unit
                ));
            }
        }
        line
    });
    Some(Codes {
        column: column.name.clone(),
        lines: lines.collect(),
    })
}
