//! The open frame: reduces the values of a second to one, as each column requires.

use super::columns::{COLUMNS, Column, Layout, Reduction};
use flexdrill_messages::WhirlWarning;

#[derive(Debug, Clone)]
pub(super) struct OpenFrame {
    /// Number of the period since 1970.
    pub period: i64,
    pub values: Vec<f32>,
    /// Number of values in each mean.
    counts: Vec<u32>,
}

impl OpenFrame {
    /// A frame without values.
    pub fn new(period: i64, layout: &Layout) -> Self {
        Self {
            period,
            values: vec![f32::NAN; layout.stride],
            counts: vec![0; COLUMNS.len()],
        }
    }
}

/// Writes values into the open frame.
pub(super) struct FrameWriter<'a> {
    pub layout: &'a Layout,
    pub open: &'a mut OpenFrame,
}

impl FrameWriter<'_> {
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
        let (Some((_, _, reduction, values_of)), Some(&offset), Some(count)) = (
            COLUMNS.get(number),
            self.layout.offsets.get(number),
            self.open.counts.get_mut(number),
        ) else {
            return;
        };
        let length = self.layout.length(*values_of);
        let Some(kept) = self.open.values.get_mut(offset..offset + length) else {
            return;
        };
        *count += 1;
        for (kept, value) in kept.iter_mut().zip(values) {
            let value = value as f32;
            *kept = match reduction {
                Reduction::Last | Reduction::Held => value,
                Reduction::Most => kept.max(value),
                Reduction::Least => kept.min(value),
                Reduction::Mean if *count == 1 => value,
                Reduction::Mean => *kept + (value - *kept) / *count as f32,
            };
        }
    }
}
