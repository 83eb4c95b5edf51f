//! The mapping file: which item is which quantity, in which unit, and which figures of the twin are sent back.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use flexdrill_config::ConfigError;
use flexdrill_config::checker::{Bound, Checker};
use flexdrill_config::reading;
use flexdrill_core::inputs::{MeasuredKind, Unit};
use serde::{Deserialize, Serialize};

use super::frame::LONGEST_LINE;
use super::header::LAST_HEADER_ITEM;
use super::item::ItemCode;
use crate::lines::Ask;
use crate::quantity::check_unit_and_range;
use crate::{Figure, Quantity, SurveyKind};

/// The units of the items that a mapping does not name.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UnitSystem {
    /// m, m/h, kdaN (thousand decanewtons, 10 kN, which WITS writes KDN), kN m, kPa.
    #[default]
    Metric,
    /// ft, ft/h, klbf, kft.lbf, psi.
    Field,
}

/// Where the stamp of a frame comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StampSource {
    /// The time of arrival, on this machine's clock.
    #[default]
    Arrival,
    /// Date and time in the frame (items 05 and 06), which are whole seconds on the source's clock; the time of arrival
    /// where a frame has none.
    Header,
}

/// What the sequence numbers of a source (item 04) are good for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SequenceUse {
    /// Repeated and late records are not used, missing ones are counted, until the numbers prove not to count.
    #[default]
    Use,
    /// Every record is used, whatever its number.
    Ignore,
}

/// The meaning of the items of a site.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Mapping {
    /// For people. Default empty.
    pub title: String,
    /// Units of the default items. Default metric.
    pub units: UnitSystem,
    /// Values that mean "no value". Default -9999, -8888 and -999.25.
    pub nulls: Vec<f64>,
    /// Where the stamp comes from. Default the time of arrival.
    pub stamp: StampSource,
    /// How far the source's clock is ahead of UTC (h), for stamps from the header and for frames that are written. Default 0.
    pub utc_offset_h: f64,
    /// Whether the numbers in item 04 decide which records are used. Default use.
    pub sequence: SequenceUse,
    /// Requests to a recorder that sends in answer only. Default: a connection that is silent for 10 s is asked once, and
    /// on if that helped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ask: Option<AskMapping>,
    /// Items in addition to the defaults or in their place; an empty one removes a default.
    pub items: BTreeMap<ItemCode, Option<ItemMapping>>,
    /// Figures of the twin that are sent back over the same connection. Default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub write: Option<WriteMapping>,
}

impl Default for Mapping {
    fn default() -> Self {
        Self {
            title: String::new(),
            units: UnitSystem::default(),
            nulls: vec![-9999.0, -8888.0, -999.25],
            stamp: StampSource::default(),
            utc_offset_h: 0.0,
            sequence: SequenceUse::default(),
            ask: None,
            items: BTreeMap::new(),
            write: None,
        }
    }
}

/// The meaning of an item.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ItemMapping {
    /// Required.
    pub quantity: Quantity,
    /// Required. A KDN is a kdaN: 10 kN.
    #[serde(deserialize_with = "flexdrill_config::units::spelled")]
    pub unit: Unit,
    /// Smallest and largest valid value, in the unit. Default: what a rig can have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub valid: Option<[f64; 2]>,
    /// Used only where no other item of the frame has the quantity, and then marked as doubtful: for maxima next to
    /// means. Default false.
    #[serde(default)]
    pub fallback: bool,
}

/// Requests to a recorder that sends in answer only.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AskMapping {
    /// Time between two requests (s). Default 30.
    pub every_s: f64,
    /// The request, with its marks. Default `&&`, `0111-9999`, `!!`. Without any the bridge never asks.
    pub lines: Vec<String>,
}

impl Default for AskMapping {
    fn default() -> Self {
        Self {
            every_s: 30.0,
            // A valid packet without a value: item 11 with the null value.
            lines: ["&&", "0111-9999", "!!"].map(str::to_owned).to_vec(),
        }
    }
}

/// Silence after which a connection is asked although the mapping does not say so. Rigs send every few seconds.
const ASKED_AFTER: Duration = Duration::from_secs(10);
/// A silent serial line is asked again after so long, as a TCP connection is by being made again.
const ASKED_AGAIN: Duration = Duration::from_secs(60);

/// What is sent back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WriteMapping {
    /// Time between two frames (s). Default 1.
    #[serde(default = "one")]
    pub every_s: f64,
    /// Name of the well in the header. Default empty.
    #[serde(default)]
    pub well: String,
    /// Required; of one or more records of the site's choice.
    pub items: BTreeMap<ItemCode, WriteItem>,
}

fn one() -> f64 {
    1.0
}

/// A figure that is sent back.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WriteItem {
    /// Required.
    pub figure: Figure,
    /// Required.
    #[serde(deserialize_with = "flexdrill_config::units::spelled")]
    pub unit: Unit,
    /// Digits after the point. Default 2.
    #[serde(default = "two")]
    pub decimals: u8,
}

fn two() -> u8 {
    2
}

const REQUIRED: &[&str] = &["write.items"];

/// The default items: number, quantity, units (metric, field), whether it is a fallback.
const DEFAULTS: [(u8, u8, Quantity, [Unit; 2], bool); 17] = {
    use Quantity::{Measured, RotarySpeed, Survey, WeightOnBit};
    const DEPTH: [Unit; 2] = [Unit::Metre, Unit::Foot];
    const FORCE: [Unit; 2] = [Unit::Kilodecanewton, Unit::Kilopound];
    const ANGLE: [Unit; 2] = [Unit::Degree, Unit::Degree];
    const TORQUE: [Unit; 2] = [Unit::KilonewtonMetre, Unit::KilofootPound];
    [
        (1, 8, Measured(MeasuredKind::BitDepth), DEPTH, false),
        (1, 10, Measured(MeasuredKind::HoleDepth), DEPTH, false),
        (
            1,
            13,
            Measured(MeasuredKind::RateOfPenetration),
            [Unit::MetrePerHour, Unit::FootPerHour],
            false,
        ),
        (1, 14, Measured(MeasuredKind::HookLoad), FORCE, false),
        (1, 15, Measured(MeasuredKind::HookLoad), FORCE, true),
        (1, 16, WeightOnBit, FORCE, false),
        (1, 17, WeightOnBit, FORCE, true),
        (1, 18, Measured(MeasuredKind::SurfaceTorque), TORQUE, false),
        (1, 19, Measured(MeasuredKind::SurfaceTorque), TORQUE, true),
        (1, 20, RotarySpeed, [Unit::TurnPerMinute, Unit::TurnPerMinute], false),
        (
            1,
            21,
            Measured(MeasuredKind::StandpipePressure),
            [Unit::Kilopascal, Unit::Psi],
            false,
        ),
        (7, 8, Survey(SurveyKind::Depth), DEPTH, false),
        (7, 13, Survey(SurveyKind::Inclination), ANGLE, false),
        // Item 14 is the azimuth before it is corrected to a north.
        (7, 15, Survey(SurveyKind::Azimuth), ANGLE, false),
        (9, 15, Measured(MeasuredKind::DownholeWeightOnBit), FORCE, false),
        (9, 17, Measured(MeasuredKind::DownholeTorque), TORQUE, false),
        // Some sources repeat the depth of the bit in the record of the tool in the hole.
        (9, 10, Measured(MeasuredKind::BitDepth), DEPTH, true),
    ]
};

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

    /// All items with their meaning: the defaults, changed as the mapping says.
    pub fn table(&self) -> BTreeMap<ItemCode, ItemMapping> {
        let system = match self.units {
            UnitSystem::Metric => 0,
            UnitSystem::Field => 1,
        };
        let mut table: BTreeMap<ItemCode, ItemMapping> = DEFAULTS
            .iter()
            .map(|&(record, item, quantity, units, fallback)| {
                let mapping = ItemMapping {
                    quantity,
                    unit: units[system],
                    valid: None,
                    fallback,
                };
                (ItemCode { record, item }, mapping)
            })
            .collect();
        for (code, item) in &self.items {
            match item {
                Some(item) => {
                    table.insert(*code, *item);
                }
                None => {
                    table.remove(code);
                }
            }
        }
        table
    }

    /// The keys above the items that differ from the defaults, in YAML. Requests and figures that are sent back are left out,
    /// with a comment.
    pub(super) fn keys_in_yaml(&self) -> String {
        let default = Self::default();
        let mut text = match self.units {
            UnitSystem::Metric => "units: metric\n".to_owned(),
            UnitSystem::Field => "units: field\n".to_owned(),
        };
        if self.nulls != default.nulls {
            let nulls: Vec<String> = self.nulls.iter().map(f64::to_string).collect();
            text += &format!("nulls: [{}]\n", nulls.join(", "));
        }
        if self.stamp == StampSource::Header {
            text += "stamp: header\n";
        }
        if self.utc_offset_h != default.utc_offset_h {
            text += &format!("utc_offset_h: {}\n", self.utc_offset_h);
        }
        if self.sequence == SequenceUse::Ignore {
            text += "sequence: ignore\n";
        }
        if self.ask.is_some() || self.write.is_some() {
            text += "# ask and write of the mapping in use are to be copied here.\n";
        }
        text
    }

    /// How the line asks its other end for frames; none where the mapping says never.
    pub fn ask(&self) -> Option<Ask> {
        let default = AskMapping::default();
        let ask = self.ask.as_ref().unwrap_or(&default);
        if ask.lines.is_empty() {
            return None;
        }
        let request: String = ask.lines.iter().flat_map(|line| [line.as_str(), "\r\n"]).collect();
        Some(Ask {
            request: Arc::from(request.into_bytes()),
            every: Duration::from_secs_f64(ask.every_s),
            after: if self.ask.is_some() {
                Duration::ZERO
            } else {
                ASKED_AFTER
            },
            again: ASKED_AGAIN,
        })
    }

    /// How far the source's clock is ahead of UTC (s).
    pub fn utc_offset(&self) -> i32 {
        (self.utc_offset_h * 3600.0).round() as i32
    }

    fn check(&self, c: &mut Checker) {
        let reason = "time zones end at 14 h; the sign is that of the zone's name, +1 in Oslo in winter";
        c.number(
            "utc_offset_h",
            self.utc_offset_h,
            Bound::within(-14.0, 14.0),
            "h",
            reason,
        );
        c.below("items", |c| {
            for (code, item) in &self.items {
                let Some(item) = item else { continue };
                c.below(code.to_string(), |c| item.check(c, *code));
            }
        });
        if let Some(ask) = &self.ask {
            c.below("ask", |c| ask.check(c));
        }
        if let Some(write) = &self.write {
            c.below("write", |c| write.check(c));
        }
    }
}

/// Items of the header carry no quantity.
fn check_number(c: &mut Checker, code: ItemCode, key: &str) {
    c.require(
        code.item > LAST_HEADER_ITEM,
        key,
        code,
        "",
        "an item above 07",
        "items 01 to 07 are the header of every record",
    );
}

impl ItemMapping {
    /// The item in YAML, on one line.
    pub(super) fn in_yaml(&self) -> String {
        let valid = self
            .valid
            .map_or_else(String::new, |[least, most]| format!(", valid: [{least}, {most}]"));
        let fallback = if self.fallback { ", fallback: true" } else { "" };
        format!("{{quantity: {}, unit: {}{valid}{fallback}}}", self.quantity, self.unit)
    }

    fn check(&self, c: &mut Checker, code: ItemCode) {
        check_number(c, code, "quantity");
        check_unit_and_range(c, self.quantity, self.unit, self.valid);
    }
}

impl AskMapping {
    fn check(&self, c: &mut Checker) {
        let reason = "a recorder answers each request with a frame";
        c.number("every_s", self.every_s, Bound::within(0.1, 3600.0), "s", reason);
        for line in &self.lines {
            c.require(
                line.len() <= LONGEST_LINE && line.bytes().all(|byte| (b' '..=b'~').contains(&byte)),
                "lines",
                format!("{line:?}"),
                "",
                "printable ASCII",
                "recorders read no other characters",
            );
        }
        c.require(
            self.lines.len() <= 100,
            "lines",
            self.lines.len(),
            "",
            "at most 100",
            "a request is one short frame",
        );
    }
}

impl WriteMapping {
    fn check(&self, c: &mut Checker) {
        let reason = "the line has to carry the frames, and the twin sends most figures at 10 Hz or more";
        c.number("every_s", self.every_s, Bound::within(0.1, 3600.0), "s", reason);
        c.require(
            !self.items.is_empty(),
            "items",
            "none",
            "",
            "at least one figure",
            "a frame without an item says nothing",
        );
        c.below("items", |c| {
            for (code, item) in &self.items {
                c.below(code.to_string(), |c| {
                    check_number(c, *code, "figure");
                    let dimension = item.figure.dimension;
                    c.require(
                        item.unit.dimension() == dimension,
                        "unit",
                        item.unit,
                        "",
                        format!("one of {}", dimension.units()),
                        "the unit belongs to another figure",
                    );
                    c.require(
                        item.decimals <= 6,
                        "decimals",
                        item.decimals,
                        "",
                        "0 to 6",
                        "sensors give no more",
                    );
                });
            }
        });
    }
}

#[cfg(test)]
mod tests;
