//! The mapping file: the meaning, unit and quality limits of a log's columns.

mod columns;
mod numbers;

use std::path::Path;

use serde::{Deserialize, Serialize};

pub(crate) use columns::known;
pub use columns::{Column, Columns, Hookload, ScaledColumn, SurveyColumns, TimeColumn, WeightOnBitColumn};
pub use numbers::Decimal;
pub(crate) use numbers::{Notation, plain_blanks};

use flexdrill_config::ConfigError;
use flexdrill_config::checker::{Bound, Checker};
use flexdrill_config::reading;

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
        c.below("columns", |c| self.columns.check(c));
        c.below("quality", |c| self.quality.check(c));
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
