//! A second that is being filled: its values become one, each in its column's way.

use super::columns::{COLUMNS, Column, How, Layout};
use crate::messages::WhirlWarning;

/// A second that is being filled.
#[derive(Debug, Clone)]
pub(super) struct Open {
    /// Number of the period since 1970.
    pub period: i64,
    pub values: Vec<f32>,
    /// Values in the means.
    counts: Vec<u32>,
}

impl Open {
    /// Nothing has come in it.
    pub fn new(period: i64, layout: &Layout) -> Self {
        Self {
            period,
            values: vec![f32::NAN; layout.stride],
            counts: vec![0; COLUMNS.len()],
        }
    }
}

/// Puts values into the frame that is being filled.
pub(super) struct Put<'a> {
    pub layout: &'a Layout,
    pub open: &'a mut Open,
}

impl Put<'_> {
    pub fn warning(&mut self, message: &WhirlWarning) {
        self.one(Column::WarningSeverity, f64::from(message.severity));
        self.one(Column::WarningKind, f64::from(message.kind));
        self.one(Column::WarningBody, f64::from(message.body));
        self.one(Column::WarningDepth, message.measured_depth);
    }

    pub fn one(&mut self, column: Column, value: f64) {
        self.all(column, std::iter::once(value));
    }

    pub fn all(&mut self, column: Column, values: impl Iterator<Item = f64>) {
        let number = column as usize;
        let (Some((_, _, how, many)), Some(&offset), Some(count)) = (
            COLUMNS.get(number),
            self.layout.offsets.get(number),
            self.open.counts.get_mut(number),
        ) else {
            return;
        };
        let length = self.layout.length(*many);
        let Some(kept) = self.open.values.get_mut(offset..offset + length) else {
            return;
        };
        *count += 1;
        for (kept, value) in kept.iter_mut().zip(values) {
            let value = value as f32;
            *kept = match how {
                How::Last | How::Held => value,
                How::Most => kept.max(value),
                How::Least => kept.min(value),
                How::Mean if *count == 1 => value,
                How::Mean => *kept + (value - *kept) / *count as f32,
            };
        }
    }
}
