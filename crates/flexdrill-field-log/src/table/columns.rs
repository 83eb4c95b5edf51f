//! The columns that a mapping names, found in the header of a log, and a row by them.

use std::borrow::Cow;

use super::Row;
use super::values::{Values, text};
use crate::layout::Layout;
use crate::mapping::{Column, Mapping, WeightOnBitColumn, known};
use crate::measured::{self, Shared, Source};
use crate::parts::Timed;
use crate::report::Issues;
use crate::surveys::SurveyIndices;
use crate::{Condition, FieldLogError};
use flexdrill_core::inputs::MeasuredKind;

/// Indices of the mapped columns in the header.
pub(super) struct ColumnIndices {
    /// Of time, or of the date alone.
    pub(super) time: usize,
    /// Of the clock where it has its own column.
    clock: Option<usize>,
    speed: usize,
    weight: usize,
    drilling: Option<usize>,
    off_bottom: Option<usize>,
    torque: Option<usize>,
    rate: Option<usize>,
    pressure: Option<usize>,
    pub(super) measured: Vec<(MeasuredKind, Source)>,
    pub(super) surveys: Option<SurveyIndices>,
}

/// The separator that the header seems to use, when it differs from the mapping's.
fn other_separator(layout: &Layout<'_>) -> String {
    let Some(only) = layout.header.get(0).filter(|_| layout.header.len() == 1) else {
        return String::new();
    };
    let found = [';', '\t', ',', '|'].into_iter().find(|separator| {
        *separator != layout.separator && only.contains(&u8::try_from(*separator).unwrap_or_default())
    });
    found.map_or_else(String::new, |separator| {
        let written = separator.escape_default();
        format!("; the fields seem to have another separator: set `separator: \"{written}\"` in the mapping")
    })
}

/// Longest list of column names in an error (characters).
const NAMES: usize = 2000;

/// The names of a header, for an error.
fn names(header: &csv::ByteRecord) -> String {
    let all = header
        .iter()
        .map(String::from_utf8_lossy)
        .collect::<Vec<_>>()
        .join(", ");
    match all.char_indices().nth(NAMES) {
        Some((end, _)) => format!("{} ... ({} columns)", &all[..end], header.len()),
        None => all,
    }
}

impl ColumnIndices {
    pub(super) fn find(file: &str, layout: &Layout<'_>, mapping: &Mapping) -> Result<Self, FieldLogError> {
        let header = &layout.header;
        // A name that occurs twice is refused: to take the first would be a guess.
        let find = |column: &str, key: &str| {
            let named = header.iter().enumerate();
            let mut indices = named
                .filter(|(_, name)| *name == column.as_bytes())
                .map(|(index, _)| index);
            match (indices.next(), indices.next()) {
                (Some(index), None) => Ok(index),
                (Some(first), Some(second)) => Err(FieldLogError::DuplicateColumn {
                    file: file.to_string(),
                    column: column.to_string(),
                    key: key.to_string(),
                    first: first + 1,
                    second: second + 1,
                }),
                // The text lists the columns that exist, and the separator that
                // the header seems to have: the two usual reasons.
                (None, _) => Err(FieldLogError::MissingColumn {
                    file: file.to_string(),
                    column: column.to_string(),
                    key: key.to_string(),
                    found: names(header),
                    hint: other_separator(layout),
                }),
            }
        };
        let columns = &mapping.columns;
        // Weight comes directly or from the hook load, which needs to know when the bit is on bottom.
        let (weight, drilling, off_bottom) = match &columns.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => {
                (find(&direct.column, "columns.weight_on_bit.direct.column")?, None, None)
            }
            WeightOnBitColumn::Hookload(hookload) => {
                let key = "columns.weight_on_bit.hookload";
                (
                    find(&hookload.column, &format!("{key}.column"))?,
                    Some(find(&hookload.drilling.column, &format!("{key}.drilling.column"))?),
                    Some(find(&hookload.off_bottom.column, &format!("{key}.off_bottom.column"))?),
                )
            }
        };
        let (time, clock) = match (&columns.time.date, &columns.time.clock) {
            (Some(date), Some(clock)) => {
                let date = find(date, "columns.time.date")?;
                (date, Some(find(clock, "columns.time.clock")?))
            }
            _ => (find(&columns.time.column, "columns.time.column")?, None),
        };
        // An optional column that the mapping names must exist: its absence
        // is a mistake in the mapping, not a missing input.
        let optional = |column: &Option<Column>, key: &str| {
            let found = column.as_ref().map(|column| find(&column.column, key));
            found.transpose()
        };
        Ok(Self {
            torque: optional(&columns.torque, "columns.torque.column")?,
            rate: optional(&columns.rate_of_penetration, "columns.rate_of_penetration.column")?,
            pressure: optional(&columns.standpipe_pressure, "columns.standpipe_pressure.column")?,
            time,
            clock,
            speed: find(&columns.rotary_speed.column, "columns.rotary_speed.column")?,
            weight,
            drilling,
            off_bottom,
            measured: measured::sources(mapping, find)?,
            surveys: SurveyIndices::find(mapping, find)?,
        })
    }

    /// The text of a row's time; `None` where it is not text.
    pub(super) fn time_text<'r>(&self, record: &'r csv::ByteRecord) -> Option<Cow<'r, str>> {
        let time = text(record, self.time)?;
        match self.clock {
            None => Some(Cow::Borrowed(time)),
            Some(clock) => Some(Cow::Owned(format!("{time} {}", text(record, clock)?))),
        }
    }

    /// The row of that `index`; its measured values are added to `measured`.
    pub(super) fn row(
        &self,
        values: &Values<'_>,
        Timed { number, time }: Timed,
        index: usize,
        mapping: &Mapping,
        issues: &mut Issues,
        measured: &mut Vec<f64>,
    ) -> Row {
        let mut value = |index: usize, column: &str| values.value(index, column, issues);
        let columns = &mapping.columns;
        let speed =
            value(self.speed, &columns.rotary_speed.column).map(|speed| known(columns.rotary_speed.unit, speed));
        // A condition without a value is unknown, not false: on and off bottom then both stay open.
        let mut condition = |index: Option<usize>, condition: &Condition| {
            index
                .and_then(|index| value(index, &condition.column))
                .map(|value| condition.holds(value))
        };
        // A hook load is read like a weight here. It becomes one when the tare is known, which needs all rows.
        let (weight_column, weight_unit, drilling, off_bottom) = match &columns.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => (&direct.column, direct.unit, None, None),
            WeightOnBitColumn::Hookload(hookload) => (
                &hookload.column,
                hookload.unit,
                condition(self.drilling, &hookload.drilling),
                condition(self.off_bottom, &hookload.off_bottom),
            ),
        };
        let weight = value(self.weight, weight_column).map(|weight| known(weight_unit, weight));
        let mut optional = |index: Option<usize>, column: &Option<Column>| {
            let (index, column) = index.zip(column.as_ref())?;
            value(index, &column.column).map(|value| known(column.unit, value))
        };
        let torque = optional(self.torque, &columns.torque);
        let rate = optional(self.rate, &columns.rate_of_penetration);
        let pressure = optional(self.pressure, &columns.standpipe_pressure);
        // Measured quantities may come from a column that is an input too; it
        // is read once, or its faults would be reported twice.
        let shared = Shared {
            torque_kn_m: torque,
            rate_m_per_h: rate,
            pressure_mpa: pressure,
            hookload_kn: weight,
        };
        for (kind, source) in &self.measured {
            let found = match (*source, columns.measured.get(kind)) {
                (Source::Column(index, unit), Some(column)) => {
                    value(index, &column.column).map(|value| unit.to_si(value))
                }
                (source, _) => shared.value(source),
            };
            // NaN keeps the measured values of all rows in columns of equal length.
            measured.push(found.unwrap_or(f64::NAN));
        }
        Row {
            measured: index,
            torque,
            number,
            time,
            own_time: time,
            values: [speed, weight, rate, pressure],
            drilling,
            off_bottom,
        }
    }
}
