//! The mapping file: the meaning, unit and quality limits of a log's columns.

mod numbers;
mod units;

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

pub use numbers::Decimal;
pub(crate) use numbers::{Notation, plain_blanks};
pub use units::{PressureUnit, RateUnit, SpeedUnit, TorqueUnit, WeightUnit};

use crate::{Condition, TimeFormat};
use flexdrill_config::ConfigError;
use flexdrill_config::checker::{Bound, Checker};
use flexdrill_config::reading;
use flexdrill_core::inputs::{Dimension, MeasuredKind, Unit};

/// The meaning of a log's columns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mapping {
    /// For people. Default empty.
    #[serde(default)]
    pub title: String,
    /// One character between fields; a blank stands for any blanks and tabs. A log that names its separator in a first
    /// line such as `sep=;` overrules it. Default a comma.
    #[serde(default = "comma")]
    pub separator: char,
    /// `point` or `comma`, in numbers. Default point.
    #[serde(default)]
    pub decimal: Decimal,
    /// The separator of thousands in numbers, such as a comma. Default none: thousands are read where only one reading is
    /// possible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thousands: Option<char>,
    /// Row of the header, as an editor numbers it. Default none: the first row, or the first one with the columns of this
    /// mapping.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub header_row: Option<u64>,
    /// Values that mean "no value", in addition to an empty field. Default none.
    #[serde(default)]
    pub missing: Vec<f64>,
    /// Required.
    pub columns: Columns,
    /// Limits beyond which a sample is reported.
    #[serde(default)]
    pub quality: Quality,
}

fn comma() -> char {
    ','
}

/// The columns.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Columns {
    /// Required.
    pub time: TimeColumn,
    /// Required.
    pub rotary_speed: RotarySpeedColumn,
    /// `direct: {...}` or `hookload: {...}`. Required.
    pub weight_on_bit: WeightOnBitColumn,
    /// Torque of the drive, for the report only: the model has its own. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<TorqueColumn>,
    /// Advance of the tool along the hole. Default none: the configured constant is assumed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_of_penetration: Option<RateColumn>,
    /// Pressure inside minus outside at the tool's top. Default none: the configured constant is assumed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standpipe_pressure: Option<PressureColumn>,
    /// What the rig measures besides the inputs, by quantity. Torque, rate, pressure and hookload of the other columns
    /// are measured quantities too, unless this list has them. Default none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub measured: BTreeMap<MeasuredKind, MeasuredColumn>,
    /// Surveys of the hole: rows with a depth and an inclination have one. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surveys: Option<SurveyColumns>,
}

/// Surveys of the hole.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurveyColumns {
    /// Measured depth of the survey, from the rig's own zero. Required.
    pub measured_depth: MeasuredColumn,
    /// Inclination. Required.
    pub inclination: MeasuredColumn,
    /// Azimuth. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub azimuth: Option<MeasuredColumn>,
}

/// A measured quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredColumn {
    /// Name in the header.
    pub column: String,
    /// Required.
    #[serde(deserialize_with = "flexdrill_config::units::spelled")]
    pub unit: Unit,
}

/// Rate of penetration, negative while the tool is pulled back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RateColumn {
    /// Name in the header.
    pub column: String,
    /// Required.
    pub unit: RateUnit,
}

/// Standpipe pressure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PressureColumn {
    /// Name in the header.
    pub column: String,
    /// Required.
    pub unit: PressureUnit,
}

/// Torque of the drive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorqueColumn {
    /// Name in the header.
    pub column: String,
    /// Required.
    pub unit: TorqueUnit,
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

/// Speed of the top drive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotarySpeedColumn {
    /// Name in the header.
    pub column: String,
    /// Required.
    pub unit: SpeedUnit,
    /// Factor to the tool's range. Default 1.
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

/// Where the weight on bit comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WeightOnBitColumn {
    /// The log has it.
    Direct(Direct),
    /// It is the tare minus the hookload while drilling.
    Hookload(Hookload),
}

/// A column of weight on bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Direct {
    /// Name in the header.
    pub column: String,
    /// Required.
    pub unit: WeightUnit,
    /// Factor to the tool's range. Default 1.
    #[serde(default = "one")]
    pub scale: f64,
}

/// Weight on bit = (tare - hookload) x scale while drilling, 0 otherwise. The tare is the median hookload over the last
/// `tare_window` of the last interval off bottom and rotating.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hookload {
    /// Name in the header.
    pub column: String,
    /// Required.
    pub unit: WeightUnit,
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

/// Limits beyond which samples are reported or left out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Quality {
    /// A longer time between two rows is a gap (s). Default 5.
    pub max_gap: f64,
    /// A single sample further than this from both neighbours is a spike and is left out. Default 50.
    pub spike_rpm: f64,
    /// The same for weight or hookload. Default 100.
    pub spike_kn: f64,
    /// A value other than 0 that does not change for longer is reported as frozen (s). Default 120.
    pub frozen_after: f64,
}

impl Default for Quality {
    fn default() -> Self {
        Self {
            max_gap: 5.0,
            spike_rpm: 50.0,
            spike_kn: 100.0,
            frozen_after: 120.0,
        }
    }
}

const REQUIRED: &[&str] = &[
    "columns",
    "columns.time",
    "columns.rotary_speed",
    "columns.rotary_speed.column",
    "columns.rotary_speed.unit",
    "columns.rate_of_penetration.column",
    "columns.rate_of_penetration.unit",
    "columns.standpipe_pressure.column",
    "columns.standpipe_pressure.unit",
    "columns.torque.column",
    "columns.torque.unit",
    "columns.weight_on_bit",
    "columns.weight_on_bit.direct.column",
    "columns.weight_on_bit.direct.unit",
    "columns.weight_on_bit.hookload.column",
    "columns.weight_on_bit.hookload.unit",
    "columns.weight_on_bit.hookload.drilling",
    "columns.weight_on_bit.hookload.drilling.column",
    "columns.weight_on_bit.hookload.off_bottom",
    "columns.weight_on_bit.hookload.off_bottom.column",
];

impl Mapping {
    /// Reads and checks a mapping file.
    ///
    /// # Errors
    /// When the file cannot be read, is not YAML of this schema, or does not make sense.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, ConfigError> {
        let (name, text) = reading::read(path.as_ref())?;
        Self::from_text(&name, &text)
    }

    /// Reads and checks a mapping; errors name it `name`.
    ///
    /// # Errors
    /// When the text is not YAML of this schema, or does not make sense.
    pub fn from_text(name: &str, text: &str) -> Result<Self, ConfigError> {
        reading::checked(name, text, REQUIRED, Self::check)
    }

    /// Factor on the log's weight on bit.
    pub fn weight_scale(&self) -> f64 {
        match &self.columns.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => direct.scale,
            WeightOnBitColumn::Hookload(hookload) => hookload.scale,
        }
    }

    /// The names of all columns that the mapping gives.
    pub(crate) fn column_names(&self) -> Vec<&str> {
        let columns = &self.columns;
        let mut names = match (&columns.time.date, &columns.time.clock) {
            (Some(date), Some(clock)) => vec![date.as_str(), clock],
            _ => vec![columns.time.column.as_str()],
        };
        names.push(&columns.rotary_speed.column);
        match &columns.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => names.push(&direct.column),
            WeightOnBitColumn::Hookload(hookload) => {
                names.extend([
                    &*hookload.column,
                    &hookload.drilling.column,
                    &hookload.off_bottom.column,
                ]);
            }
        }
        names.extend(columns.torque.iter().map(|torque| &*torque.column));
        names.extend(columns.rate_of_penetration.iter().map(|rate| &*rate.column));
        names.extend(columns.standpipe_pressure.iter().map(|pressure| &*pressure.column));
        names.extend(columns.measured.values().map(|measured| &*measured.column));
        let surveys = columns.surveys.iter().flat_map(SurveyColumns::columns);
        names.extend(surveys.map(|(_, column)| &*column.column));
        names
    }

    /// The columns with a unit, by name.
    pub(crate) fn column_units(&self) -> Vec<(&str, Unit)> {
        let columns = &self.columns;
        let weight = match &columns.weight_on_bit {
            WeightOnBitColumn::Direct(direct) => (&*direct.column, direct.unit.unit()),
            WeightOnBitColumn::Hookload(hookload) => (&*hookload.column, hookload.unit.unit()),
        };
        let mut units = vec![
            (&*columns.rotary_speed.column, columns.rotary_speed.unit.unit()),
            weight,
        ];
        units.extend(
            columns
                .torque
                .iter()
                .map(|torque| (&*torque.column, torque.unit.unit())),
        );
        units.extend(
            columns
                .rate_of_penetration
                .iter()
                .map(|rate| (&*rate.column, rate.unit.unit())),
        );
        let pressure = columns.standpipe_pressure.iter();
        units.extend(pressure.map(|pressure| (&*pressure.column, pressure.unit.unit())));
        units.extend(
            columns
                .measured
                .values()
                .map(|measured| (&*measured.column, measured.unit)),
        );
        let surveys = columns.surveys.iter().flat_map(SurveyColumns::columns);
        units.extend(surveys.map(|(_, column)| (&*column.column, column.unit)));
        units
    }

    /// How the log writes its numbers.
    pub(crate) const fn notation(&self) -> Notation {
        Notation {
            decimal: self.decimal,
            thousands: self.thousands,
        }
    }

    fn check(&self, c: &mut Checker) {
        // A digit, or the decimal separator, between thousands would change numbers without a sign of it.
        c.require(
            self.thousands.is_none_or(|separator| {
                matches!(separator, ',' | '.' | ' ' | '\'') && separator != self.decimal.mark()
            }),
            "thousands",
            format!("{:?}", self.thousands.unwrap_or_default()),
            "",
            "a comma, a point, a blank or an apostrophe, and not the decimal separator",
            "",
        );
        c.require(
            self.header_row.is_none_or(|row| row > 0),
            "header_row",
            0,
            "",
            "at least 1",
            "an editor numbers the first row 1",
        );
        c.require(
            self.separator.is_ascii() && self.separator != '"' && self.separator != '\n',
            "separator",
            format!("{:?}", self.separator),
            "",
            "one ASCII character other than a quote or a line end",
            "",
        );
        // Each key is named with its whole path, so that the error has its line in the file.
        let scale = Bound::above(0.0, 1e3);
        let scale_reason = "a factor to the tool's range; 1 leaves the log's values unchanged";
        c.below("columns", |c| {
            c.below("time", |c| self.columns.time.check(c));
            c.below("rotary_speed", |c| {
                c.number("scale", self.columns.rotary_speed.scale, scale, "", scale_reason);
            });
            c.below("weight_on_bit", |c| match &self.columns.weight_on_bit {
                WeightOnBitColumn::Direct(direct) => c.below("direct", |c| {
                    c.number("scale", direct.scale, scale, "", scale_reason);
                }),
                WeightOnBitColumn::Hookload(hookload) => c.below("hookload", |c| {
                    c.number("scale", hookload.scale, scale, "", scale_reason);
                    hookload.check(c);
                }),
            });
            c.below("measured", |c| {
                for (kind, column) in &self.columns.measured {
                    c.below(kind.name(), |c| column.check(c, kind.dimension()));
                }
            });
            c.below("surveys", |c| {
                for (key, column) in self.columns.surveys.iter().flat_map(SurveyColumns::columns) {
                    let dimension = match key {
                        "measured_depth" => Dimension::Length,
                        _ => Dimension::Angle,
                    };
                    c.below(key, |c| column.check(c, dimension));
                }
            });
        });
        c.below("quality", |c| self.quality.check(c));
    }
}

impl MeasuredColumn {
    fn check(&self, c: &mut Checker, dimension: Dimension) {
        c.require(
            self.unit.dimension() == dimension,
            "unit",
            self.unit.name(),
            "",
            format!("one of {}", dimension.units()),
            "the unit belongs to another quantity",
        );
    }
}

impl Hookload {
    fn check(&self, c: &mut Checker) {
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

impl Quality {
    fn check(&self, c: &mut Checker) {
        c.number("max_gap", self.max_gap, Bound::above(0.0, 86_400.0), "s", "a day");
        c.number(
            "spike_rpm",
            self.spike_rpm,
            Bound::above(0.0, 1e6),
            "r/min",
            "1e6 disables the check",
        );
        c.number(
            "spike_kn",
            self.spike_kn,
            Bound::above(0.0, 1e6),
            "kN",
            "1e6 disables the check",
        );
        c.number(
            "frozen_after",
            self.frozen_after,
            Bound::above(0.0, 1e9),
            "s",
            "1e9 disables the check",
        );
    }
}
