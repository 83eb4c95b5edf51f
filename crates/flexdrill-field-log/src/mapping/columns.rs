//! The columns of a log, each with its meaning and its unit.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::{Condition, TimeFormat};
use flexdrill_config::checker::{Bound, Checker};
use flexdrill_core::inputs::{Dimension, MeasuredKind, Unit};

/// The columns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Columns {
    /// Required.
    pub time: TimeColumn,
    /// Required.
    pub rotary_speed: ScaledColumn,
    /// `direct: {...}` or `hookload: {...}`. Required.
    pub weight_on_bit: WeightOnBitColumn,
    /// Torque of the drive, for the report only: the model has its own. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Column>,
    /// Advance of the tool along the hole. Default none: the configured constant is assumed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_of_penetration: Option<Column>,
    /// Pressure inside minus outside at the tool's top. Default none: the configured constant is assumed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standpipe_pressure: Option<Column>,
    /// What the rig measures besides the inputs, by quantity. Torque, rate, pressure and hookload of the other columns
    /// are measured quantities too, unless this list has them. Default none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub measured: BTreeMap<MeasuredKind, Column>,
    /// Surveys of the hole: rows with a depth and an inclination have one. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surveys: Option<SurveyColumns>,
}

/// Surveys of the hole.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurveyColumns {
    /// Measured depth of the survey, from the rig's own zero. Required.
    pub measured_depth: Column,
    /// Inclination. Required.
    pub inclination: Column,
    /// Azimuth. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub azimuth: Option<Column>,
}

/// A column of numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Column {
    /// Name in the header.
    pub column: String,
    /// Required.
    #[serde(deserialize_with = "flexdrill_config::units::spelled")]
    pub unit: Unit,
}

/// A column whose values are brought to the tool's range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScaledColumn {
    /// Name in the header.
    pub column: String,
    /// Required.
    #[serde(deserialize_with = "flexdrill_config::units::spelled")]
    pub unit: Unit,
    /// Factor to the tool's range. Default 1.
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

/// Time: `{column: COLUMN}`, or `{date: COLUMN, clock: COLUMN}` where the log has date and clock in two columns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimeColumn {
    /// Name in the header; empty where `date` and `clock` are given.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub column: String,
    /// Name of the column of dates. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// Name of the column of clock times. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock: Option<String>,
    /// `seconds`, `milliseconds`, `microseconds`, `nanoseconds`, `minutes`, `hours`, `excel_days`, `iso8601`,
    /// `time_of_day`, or a pattern of strftime such as `"%d/%m/%Y %H:%M:%S"`. With `date` and `clock` it is of both texts
    /// with a blank between. Default seconds, and `iso8601` with `date` and `clock`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub format: Option<TimeFormat>,
}

impl TimeColumn {
    /// The format, or its default.
    pub fn format(&self) -> TimeFormat {
        let default = if self.date.is_some() {
            TimeFormat::Iso8601
        } else {
            TimeFormat::Seconds
        };
        self.format.clone().unwrap_or(default)
    }

    /// The name of the column, or of both.
    pub fn name(&self) -> String {
        match (&self.date, &self.clock) {
            (Some(date), Some(clock)) => format!("{date} {clock}"),
            _ => self.column.clone(),
        }
    }

    fn check(&self, c: &mut Checker) {
        let both = self.date.is_some() && self.clock.is_some();
        let neither = self.date.is_none() && self.clock.is_none();
        if self.column.is_empty() && neither {
            c.require(
                false,
                "column",
                "nothing",
                "",
                "given, or date and clock",
                "it has no default",
            );
        } else {
            c.require(
                if self.column.is_empty() { both } else { neither },
                "",
                "a mixture",
                "",
                "either column, or date and clock",
                "date and clock are two columns that are read as one text",
            );
        }
        let format = self.format();
        if let Some(fault) = format.fault() {
            c.wrong(
                "format",
                format.name(),
                "",
                "a pattern of strftime with hour and minute",
                &fault,
            );
        }
        c.require(
            !both || format.has_dates() && format.seconds_in_one().is_none(),
            "format",
            format.name(),
            "",
            "iso8601, or a pattern of strftime with a date",
            "it is the format of both texts with a blank between",
        );
    }
}

/// Where the weight on bit comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WeightOnBitColumn {
    /// The log has it.
    Direct(ScaledColumn),
    /// It is the tare minus the hookload while drilling.
    Hookload(Hookload),
}

/// Weight on bit = (tare - hookload) x scale while drilling, 0 otherwise. The tare is the median hookload over the last
/// `tare_window` of the last interval off bottom and rotating.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hookload {
    /// Name in the header.
    pub column: String,
    /// Required.
    #[serde(deserialize_with = "flexdrill_config::units::spelled")]
    pub unit: Unit,
    /// When the bit is on bottom and drills. Required.
    pub drilling: Condition,
    /// When the bit is off bottom. Required.
    pub off_bottom: Condition,
    /// Faster than this counts as rotating. Default 10.
    #[serde(default = "ten")]
    pub rotating_above_rpm: f64,
    /// Tare window (s). Default 30.
    #[serde(default = "thirty")]
    pub tare_window: f64,
    /// An interval with fewer rows gives no tare. Default 20.
    #[serde(default = "twenty")]
    pub tare_min_rows: usize,
    /// A weight down to this far below zero counts as zero; a lower one is left out. Before scaling. Default 5.
    #[serde(default = "five")]
    pub negative_band_kn: f64,
    /// Factor to the tool's range. Default 1.
    #[serde(default = "one")]
    pub scale: f64,
}

fn five() -> f64 {
    5.0
}

fn ten() -> f64 {
    10.0
}

fn thirty() -> f64 {
    30.0
}

fn twenty() -> usize {
    20
}

/// A value of a column with this unit, in the unit in which people know it (kN, kN m, MPa, m/h, r/min).
pub(crate) fn known(unit: Unit, value: f64) -> f64 {
    // By one factor, so that a value in that unit keeps its bits.
    value * unit.dimension().known_in().from_si(unit.to_si(1.0))
}

fn check_unit(c: &mut Checker, unit: Unit, dimension: Dimension) {
    c.require(
        unit.dimension() == dimension,
        "unit",
        unit.name(),
        "",
        format!("one of {}", dimension.units()),
        "the unit belongs to another quantity",
    );
}

impl Column {
    fn check(&self, c: &mut Checker, dimension: Dimension) {
        check_unit(c, self.unit, dimension);
    }
}

impl ScaledColumn {
    fn check(&self, c: &mut Checker, dimension: Dimension) {
        check_unit(c, self.unit, dimension);
        check_scale(c, self.scale);
    }
}

fn check_scale(c: &mut Checker, scale: f64) {
    let reason = "a factor to the tool's range; 1 leaves the log's values unchanged";
    c.number("scale", scale, Bound::above(0.0, 1e3), "", reason);
}

impl Hookload {
    fn check(&self, c: &mut Checker) {
        check_unit(c, self.unit, Dimension::Force);
        check_scale(c, self.scale);
        c.below("drilling", |c| self.drilling.check(c));
        c.below("off_bottom", |c| self.off_bottom.check(c));
        let reason = "the hookload of a string that does not rotate includes friction";
        c.number(
            "rotating_above_rpm",
            self.rotating_above_rpm,
            Bound::within(0.0, 1000.0),
            "r/min",
            reason,
        );
        let reason = "long enough for a median, short enough to belong to one connection";
        c.number("tare_window", self.tare_window, Bound::above(0.0, 3600.0), "s", reason);
        c.count(
            "tare_min_rows",
            self.tare_min_rows,
            Bound::within(1.0, 100_000.0),
            "a median of too few rows is chance",
        );
        let reason = "the noise of a hookload";
        c.number(
            "negative_band_kn",
            self.negative_band_kn,
            Bound::within(0.0, 1000.0),
            "kN",
            reason,
        );
    }
}

impl Columns {
    /// The names of all columns.
    pub(crate) fn names(&self) -> Vec<&str> {
        let mut names = match (&self.time.date, &self.time.clock) {
            (Some(date), Some(clock)) => vec![date.as_str(), clock],
            _ => vec![self.time.column.as_str()],
        };
        names.extend(self.units().into_iter().map(|(name, _)| name));
        if let WeightOnBitColumn::Hookload(hookload) = &self.weight_on_bit {
            names.extend([&*hookload.drilling.column, &hookload.off_bottom.column]);
        }
        names
    }

    /// The columns with a unit, by name.
    pub(crate) fn units(&self) -> Vec<(&str, Unit)> {
        let weight = match &self.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => (&*direct.column, direct.unit),
            WeightOnBitColumn::Hookload(hookload) => (&*hookload.column, hookload.unit),
        };
        let optional = [&self.torque, &self.rate_of_penetration, &self.standpipe_pressure];
        let surveys = self.surveys.iter().flat_map(SurveyColumns::columns);
        let others = optional.into_iter().flatten();
        let others = others
            .chain(self.measured.values())
            .chain(surveys.map(|(_, column)| column));
        let mut units = vec![(&*self.rotary_speed.column, self.rotary_speed.unit), weight];
        units.extend(others.map(|column| (&*column.column, column.unit)));
        units
    }

    pub(super) fn check(&self, c: &mut Checker) {
        c.below("time", |c| self.time.check(c));
        c.below("rotary_speed", |c| self.rotary_speed.check(c, Dimension::RotarySpeed));
        c.below("weight_on_bit", |c| match &self.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => c.below("direct", |c| direct.check(c, Dimension::Force)),
            WeightOnBitColumn::Hookload(hookload) => c.below("hookload", |c| hookload.check(c)),
        });
        for (key, column, dimension) in [
            ("torque", &self.torque, Dimension::Torque),
            ("rate_of_penetration", &self.rate_of_penetration, Dimension::Speed),
            ("standpipe_pressure", &self.standpipe_pressure, Dimension::Pressure),
        ] {
            if let Some(column) = column {
                c.below(key, |c| column.check(c, dimension));
            }
        }
        c.below("measured", |c| {
            for (kind, column) in &self.measured {
                c.below(kind.name(), |c| column.check(c, kind.dimension()));
            }
        });
        c.below("surveys", |c| {
            for (key, column) in self.surveys.iter().flat_map(SurveyColumns::columns) {
                let dimension = match key {
                    "measured_depth" => Dimension::Length,
                    _ => Dimension::Angle,
                };
                c.below(key, |c| column.check(c, dimension));
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measured_quantities_are_read_in_the_shared_spellings() {
        let text = |unit: &str| {
            format!(
                "columns:\n  time: {{column: t, format: seconds}}\n  rotary_speed: {{column: n, unit: RPM}}\n  \
                 weight_on_bit: {{direct: {{column: w, unit: kip}}}}\n  measured: {{hook_load: {{column: h, unit: {unit}}}}}\n"
            )
        };
        let read = |unit: &str| crate::Mapping::from_text("m.yaml", &text(unit));
        for (spelling, unit) in [
            ("klbs", Unit::Kilopound),
            ("tonne", Unit::TonneForce),
            ("KDN", Unit::Kilodecanewton),
        ] {
            let mapping = read(spelling).unwrap_or_else(|error| panic!("{error}"));
            assert!(
                mapping.columns.measured.values().all(|column| column.unit == unit),
                "{spelling}"
            );
        }
        let error = read("ton").unwrap_err().to_string();
        assert!(
            error.contains("m.yaml:5") && error.contains("write tf for a tonne"),
            "{error}"
        );
    }

    #[test]
    fn units_of_columns_are_read_in_the_shared_spellings() {
        let text = |speed: &str, weight: &str, others: &str| {
            format!(
                "columns:\n  time: {{column: t, format: seconds}}\n  rotary_speed: {{column: n, unit: {speed}}}\n  \
                 weight_on_bit: {{direct: {{column: w, unit: {weight}}}}}\n{others}"
            )
        };
        let read = |text: &str| crate::Mapping::from_text("m.yaml", text);
        for (weight, unit) in [
            ("klbs", Unit::Kilopound),
            ("KDN", Unit::Kilodecanewton),
            ("tonne", Unit::TonneForce),
        ] {
            let columns = read(&text("RPM", weight, "")).unwrap().columns;
            assert_eq!(columns.rotary_speed.unit, Unit::TurnPerMinute);
            assert!(matches!(columns.weight_on_bit, WeightOnBitColumn::Direct(direct) if direct.unit == unit));
        }
        let others = "  torque: {column: m, unit: ft-lbf}\n  rate_of_penetration: {column: r, unit: FT/HR}\n  \
                      standpipe_pressure: {column: p, unit: PSI}\n";
        let columns = read(&text("r/min", "kN", others)).unwrap().columns;
        let optional = [columns.torque, columns.rate_of_penetration, columns.standpipe_pressure];
        let found = optional.map(|column| column.unwrap().unit);
        assert_eq!(found, [Unit::FootPound, Unit::FootPerHour, Unit::Psi]);
        let ambiguous = read(&text("r/min", "ton", "")).unwrap_err().to_string();
        assert!(ambiguous.contains("write tf"), "{ambiguous}");
        let wrong = text("klbf", "kN", &others.replace("PSI", "m/h"));
        let error = read(&wrong).unwrap_err().to_string();
        for key in ["columns.rotary_speed.unit", "columns.standpipe_pressure.unit"] {
            assert!(error.contains(key), "{key} is not in {error}");
        }
        assert!(error.contains("must be one of rad/s, r/min, Hz"), "{error}");
        assert!((known(Unit::Decanewton, 100.0) - 1.0).abs() < 1e-15);
        assert!((known(Unit::FootPerMinute, 1.0) - 18.288).abs() < 1e-12);
    }
}
