//! What a log measures besides the inputs, by row.

use flexdrill_core::inputs::{MeasuredKind, Unit};
use flexdrill_core::units::{kn_to_n, m_per_h_to_m_per_s, mpa_to_pa};

use crate::mapping::{Mapping, WeightOnBitColumn};

/// Where a measured quantity comes from.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Source {
    /// A column that only this quantity uses, by its index in the header.
    Column(usize, Unit),
    /// The column of the drive's torque.
    Torque,
    /// The column of the rate of penetration.
    Rate,
    /// The column of the standpipe pressure.
    Pressure,
    /// The column of the hookload, before it becomes a weight on bit.
    Hookload,
}

/// A row's values in the columns that are not of measured quantities alone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shared {
    pub(crate) torque_kn_m: Option<f64>,
    pub(crate) rate_m_per_h: Option<f64>,
    pub(crate) pressure_mpa: Option<f64>,
    pub(crate) hookload_kn: Option<f64>,
}

impl Shared {
    /// In SI.
    pub(crate) fn value(self, source: Source) -> Option<f64> {
        match source {
            Source::Torque => self.torque_kn_m.map(kn_to_n),
            Source::Rate => self.rate_m_per_h.map(m_per_h_to_m_per_s),
            Source::Pressure => self.pressure_mpa.map(mpa_to_pa),
            Source::Hookload => self.hookload_kn.map(kn_to_n),
            Source::Column(..) => None,
        }
    }
}

/// The measured quantities of a mapping in the order of [`MeasuredKind::ALL`], each with its source.
pub(crate) fn sources<E>(
    mapping: &Mapping,
    find: impl Fn(&str, &str) -> Result<usize, E>,
) -> Result<Vec<(MeasuredKind, Source)>, E> {
    let columns = &mapping.columns;
    let mut sources = Vec::new();
    for kind in MeasuredKind::ALL {
        if let Some(column) = columns.measured.get(&kind) {
            let index = find(&column.column, &format!("columns.measured.{kind}.column"))?;
            sources.push((kind, Source::Column(index, column.unit)));
            continue;
        }
        let source = match kind {
            MeasuredKind::SurfaceTorque => columns.torque.as_ref().map(|_| Source::Torque),
            MeasuredKind::RateOfPenetration => columns.rate_of_penetration.as_ref().map(|_| Source::Rate),
            MeasuredKind::StandpipePressure => columns.standpipe_pressure.as_ref().map(|_| Source::Pressure),
            MeasuredKind::HookLoad => {
                matches!(columns.weight_on_bit, WeightOnBitColumn::Hookload(_)).then_some(Source::Hookload)
            }
            _ => None,
        };
        sources.extend(source.map(|source| (kind, source)));
    }
    Ok(sources)
}

/// The measured values of a log, by row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeasuredSequence {
    kinds: Vec<MeasuredKind>,
    rows: Vec<(f64, u64)>,
    /// One per row and quantity, NaN where the row has none.
    values: Vec<f64>,
}

impl MeasuredSequence {
    pub(crate) fn new(kinds: Vec<MeasuredKind>) -> Self {
        Self {
            kinds,
            ..Self::default()
        }
    }

    /// Adds a row; `values` has an entry per quantity. A row without any value is left out.
    pub(crate) fn push(&mut self, time: f64, row: u64, values: &[f64]) {
        if values.iter().any(|value| !value.is_nan()) {
            self.rows.push((time, row));
            self.values.extend(values);
        }
    }

    /// The quantities that the mapping names, in the order of [`MeasuredKind::ALL`].
    pub fn kinds(&self) -> &[MeasuredKind] {
        &self.kinds
    }

    /// Number of rows with a value.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether no row has a value.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The rows in the order of time.
    pub fn rows(&self) -> impl Iterator<Item = MeasuredRow<'_>> {
        let values = self.values.chunks_exact(self.kinds.len().max(1));
        self.rows.iter().zip(values).map(|(&(time, row), values)| MeasuredRow {
            time,
            row,
            kinds: &self.kinds,
            values,
        })
    }
}

/// The measured values of a row.
#[derive(Debug, Clone, Copy)]
pub struct MeasuredRow<'a> {
    /// Since the first row of the range that was read (s).
    pub time: f64,
    /// Row in the log, as an editor numbers it.
    pub row: u64,
    kinds: &'a [MeasuredKind],
    values: &'a [f64],
}

impl<'a> MeasuredRow<'a> {
    /// The quantities that the row gives, with their values (SI).
    pub fn values(&self) -> impl Iterator<Item = (MeasuredKind, f64)> + use<'a> {
        let values = self.kinds.iter().copied().zip(self.values.iter().copied());
        values.filter(|(_, value)| !value.is_nan())
    }
}
