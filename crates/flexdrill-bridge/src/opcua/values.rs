//! Values of a rig's nodes as messages for the twin.

use std::collections::BTreeMap;
use std::fmt;

use ::opcua::types::{StatusCode, Variant};
use flexdrill_core::inputs::Unit;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::{RigInputs, RigMeasured, RigSurvey};

use super::mapping::{NodeMapping, StampSource};
use crate::{Quantity, messages};

/// A source timestamp further from the time of arrival (ns) is not used: the server keeps that of the last change, or its
/// clock is wrong.
const STAMP_TOLERANCE: i64 = 10_000_000_000;

/// Depth, inclination and azimuth of a survey are three nodes, which change one after the other: a survey is one whose nodes
/// have not changed for so long (ns).
const SETTLED: i64 = 2_000_000_000;

/// A value as it came.
#[derive(Debug, Clone)]
pub struct RawValue {
    /// Which node, in the order of the mapping.
    pub node: usize,
    /// The value, if there is one.
    pub value: Option<Variant>,
    /// Its status.
    pub status: StatusCode,
    /// The source timestamp (ns since 1970), if there is one.
    pub source_time: Option<i64>,
    /// When it came (ns since 1970).
    pub arrived: i64,
}

/// Counts of values.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ValueCounts {
    /// Values that came.
    pub received: u64,
    /// Of these, with a status that is neither good nor uncertain.
    pub bad: u64,
    /// Of these, with an uncertain status.
    pub uncertain: u64,
    /// That are no number.
    pub no_number: u64,
    /// Outside their range.
    pub out_of_range: u64,
    /// Whose source timestamp was not used.
    pub stamps_replaced: u64,
}

/// Why a value is not used.
#[derive(Debug, Clone, PartialEq)]
pub enum ValueFault {
    /// It is no number.
    NoNumber {
        /// The node.
        node: String,
        /// Its type in words.
        kind: String,
    },
    /// It is outside its range.
    OutOfRange {
        /// The node.
        node: String,
        /// The value.
        value: f64,
        /// The range.
        range: [f64; 2],
        /// The unit of all three.
        unit: Unit,
    },
    /// Its status is bad.
    Bad {
        /// The node.
        node: String,
        /// The status in words.
        status: String,
    },
}

impl ValueFault {
    /// The kind of fault.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::NoNumber { .. } => "no number",
            Self::OutOfRange { .. } => "out of range",
            Self::Bad { .. } => "bad status",
        }
    }
}

impl fmt::Display for ValueFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNumber { node, kind } => write!(f, "node {node}: its value is no number but {kind}"),
            Self::OutOfRange {
                node,
                value,
                range: [least, most],
                unit,
            } => write!(
                f,
                "node {node}: {value} {unit} is outside {least} to {most} {unit} and is not used"
            ),
            Self::Bad { node, status } => write!(f, "node {node}: its server calls it {status}"),
        }
    }
}

struct Item {
    id: String,
    quantity: Quantity,
    unit: Unit,
    /// In the unit.
    range: [f64; 2],
}

#[derive(Debug, Clone, Copy)]
struct Held {
    value: f64,
    quality: u8,
    stamp: i64,
    /// When it came (ns since 1970).
    arrived: i64,
    /// Stamp of the newest message with it.
    sent: i64,
    /// When that was sent.
    sent_at: i64,
    fresh: bool,
}

/// What becomes of the values: the newest of each node, and when it is due to be sent.
pub struct Collector {
    items: Vec<Item>,
    held: Vec<Option<Held>>,
    last_value: Vec<Option<f64>>,
    stamp: StampSource,
    repeat: i64,
    source: String,
    /// Counts since the beginning.
    pub counts: ValueCounts,
}

/// Messages for the twin with one stamp and one quality.
pub type Messages = (Option<RigInputs>, Option<RigMeasured>);

impl Collector {
    /// A collector; `peer` names the server, for the source of the messages.
    pub fn new(mapping: &NodeMapping, peer: &str) -> Self {
        let items: Vec<Item> = mapping
            .nodes
            .iter()
            .map(|(id, item)| {
                let plausible = item.quantity.plausible().map(|bound| item.unit.from_si(bound));
                Item {
                    id: id.clone(),
                    quantity: item.quantity,
                    unit: item.unit,
                    range: item.valid.unwrap_or(plausible),
                }
            })
            .collect();
        Self {
            held: vec![None; items.len()],
            last_value: vec![None; items.len()],
            items,
            stamp: mapping.stamp,
            repeat: (mapping.repeat_s * 1e9) as i64,
            source: format!("opcua {peer}").chars().take(64).collect(),
            counts: ValueCounts::default(),
        }
    }

    /// Takes a value.
    ///
    /// # Errors
    /// When it cannot be used. A bad value is not used as a number, but sent on as bad.
    pub fn take(&mut self, raw: &RawValue) -> Result<(), ValueFault> {
        // The handle comes from the server, so it may be any number.
        let Some(item) = self.items.get(raw.node) else {
            return Ok(());
        };
        self.counts.received += 1;
        let quality = if raw.status.is_good() {
            RigInputs::GOOD
        } else if raw.status.is_uncertain() {
            self.counts.uncertain += 1;
            RigInputs::SUSPECT
        } else {
            self.counts.bad += 1;
            RigInputs::BAD
        };
        // The source's time is that of the measurement. Too far from the arrival it is a clock that is wrong, or the
        // time of a change long ago.
        let stamp = match (self.stamp, raw.source_time) {
            (StampSource::Source, Some(time)) if time.abs_diff(raw.arrived) <= STAMP_TOLERANCE.unsigned_abs() => time,
            (StampSource::Source, _) => {
                self.counts.stamps_replaced += 1;
                raw.arrived
            }
            (StampSource::Arrival, _) => raw.arrived,
        };
        // What is held is taken out first: a value that is refused below must not be repeated as if it were present.
        let before = self.held[raw.node].take();
        let hold = |value: f64| Held {
            value,
            quality,
            stamp,
            arrived: raw.arrived,
            // The last stamp that was sent is kept, because stamps of a quantity must not fall back.
            sent: before.map_or(i64::MIN, |held| held.sent),
            sent_at: i64::MIN,
            fresh: true,
        };
        let number = raw.value.as_ref().and_then(number);
        if quality == RigInputs::BAD {
            // The message says that the quantity is bad, with the last number.
            self.held[raw.node] = number
                .map(|value| item.unit.to_si(value))
                .or(self.last_value[raw.node])
                .map(hold);
            return Err(ValueFault::Bad {
                node: item.id.clone(),
                status: raw.status.to_string(),
            });
        }
        // The quality may be good and the value none, such as a text: then the mapping names a wrong node.
        let Some(value) = number else {
            self.counts.no_number += 1;
            let kind = raw
                .value
                .as_ref()
                .map_or_else(|| "empty".to_owned(), |value| format!("{:?}", value.type_id()));
            return Err(ValueFault::NoNumber {
                node: item.id.clone(),
                kind,
            });
        };
        let [least, most] = item.range;
        // The range is that of the mapping, in its unit. NaN is in no range.
        if !(least..=most).contains(&value) {
            self.counts.out_of_range += 1;
            return Err(ValueFault::OutOfRange {
                node: item.id.clone(),
                value,
                range: item.range,
                unit: item.unit,
            });
        }
        // SI from here on.
        let value = item.unit.to_si(value);
        self.last_value[raw.node] = Some(value);
        self.held[raw.node] = Some(hold(value));
        Ok(())
    }

    /// The connection is lost: nothing is repeated until its values come again.
    pub fn forget(&mut self) {
        self.held.fill(None);
    }

    /// The messages that are due at `now` (ns since 1970): new values, and those that did not change for the time of
    /// repetition, which by the contract of a subscription are the present ones.
    pub fn due(&mut self, now: i64, alive: bool) -> Vec<Messages> {
        let mut groups: BTreeMap<(i64, u8), BTreeMap<Quantity, f64>> = BTreeMap::new();
        for (item, held) in self.items.iter().zip(&mut self.held) {
            let Some(held) = held else { continue };
            // A survey is of the time when it was made, and is not repeated.
            if matches!(item.quantity, Quantity::Survey(_)) {
                continue;
            }
            let stamp = if held.fresh {
                held.stamp
            } else if alive && now.saturating_sub(held.sent_at) >= self.repeat {
                now
            } else {
                continue;
            };
            // Stamps of a quantity never fall back: the twin would refuse the value.
            let stamp = stamp.max(held.sent.saturating_add(1));
            (held.sent, held.sent_at, held.fresh) = (stamp, now, false);
            groups
                .entry((stamp, held.quality))
                .or_default()
                .insert(item.quantity, held.value);
        }
        groups
            .into_iter()
            .map(|((stamp, quality), values)| {
                let header = Header {
                    stamp: Time::from_nanoseconds(stamp),
                    ..Header::default()
                };
                let value = |quantity: Quantity| values.get(&quantity).copied();
                (
                    messages::rig_inputs(value, header.clone(), quality, &self.source),
                    messages::rig_measured(value, header, quality, &self.source),
                )
            })
            .collect()
    }
}

impl Collector {
    /// The survey that is due at `now` (ns since 1970): one whose nodes have changed and then settled.
    pub fn survey_due(&mut self, now: i64) -> Option<RigSurvey> {
        let nodes = self.items.iter().zip(&mut self.held);
        let mut nodes: Vec<(Quantity, &mut Held)> = nodes
            .filter_map(|(item, held)| Some((item.quantity, held.as_mut()?)))
            .filter(|(quantity, _)| matches!(quantity, Quantity::Survey(_)))
            .collect();
        let is_fresh = nodes.iter().any(|(_, held)| held.fresh);
        let settled = nodes
            .iter()
            .all(|(_, held)| now.saturating_sub(held.arrived) >= SETTLED);
        if !(is_fresh && settled) {
            return None;
        }
        let stamp = nodes.iter().map(|(_, held)| held.stamp).max()?;
        // One doubtful value makes a doubtful survey.
        let quality = nodes.iter().map(|(_, held)| held.quality).max()?;
        nodes.iter_mut().for_each(|(_, held)| held.fresh = false);
        let header = Header {
            stamp: Time::from_nanoseconds(stamp),
            ..Header::default()
        };
        let value = |quantity: Quantity| nodes.iter().find(|(of, _)| *of == quantity).map(|(_, held)| held.value);
        messages::rig_survey(value, header, quality, &self.source)
    }
}

fn number(value: &Variant) -> Option<f64> {
    let number = match value {
        Variant::SByte(value) => f64::from(*value),
        Variant::Byte(value) => f64::from(*value),
        Variant::Int16(value) => f64::from(*value),
        Variant::UInt16(value) => f64::from(*value),
        Variant::Int32(value) => f64::from(*value),
        Variant::UInt32(value) => f64::from(*value),
        Variant::Int64(value) => *value as f64,
        Variant::UInt64(value) => *value as f64,
        Variant::Float(value) => f64::from(*value),
        Variant::Double(value) => *value,
        _ => return None,
    };
    number.is_finite().then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT: i64 = 1_700_000_000_000_000_000;
    const SECOND: i64 = 1_000_000_000;

    fn collector() -> Collector {
        let text = "nodes:\n  \"ns=2;s=a\": {quantity: rotary_speed, unit: r/min, valid: [0, 200]}\n  \"ns=2;s=b\": \
                    {quantity: hook_load, unit: kN}\n";
        Collector::new(&NodeMapping::from_text("site.yaml", text).unwrap(), "rig:4840")
    }

    fn raw(node: usize, value: impl Into<Variant>, status: StatusCode, source_time: i64, arrived: i64) -> RawValue {
        RawValue {
            node,
            value: Some(value.into()),
            status,
            source_time: Some(source_time),
            arrived,
        }
    }

    #[test]
    fn values_are_sent_with_stamp_and_quality_and_again_while_the_server_lives() {
        let mut collector = collector();
        let good = StatusCode::Good;
        collector.take(&raw(0, 90.0, good, AT - 1000, AT)).unwrap();
        collector.take(&raw(1, 412_i32, good, AT - 1000, AT)).unwrap();
        let sent = collector.due(AT, true);
        let [(Some(inputs), Some(measured))] = sent.as_slice() else {
            panic!("{sent:?}");
        };
        assert!((inputs.rotary_speed_rpm - 90.0).abs() < 1e-12);
        assert_eq!(inputs.header.stamp.to_nanoseconds(), AT - 1000);
        assert_eq!((measured.hook_load, inputs.source.as_str()), (412e3, "opcua rig:4840"));
        assert!(collector.due(AT + SECOND / 2, true).is_empty());
        // A server that shows no life says nothing about the present.
        assert!(collector.due(AT + 2 * SECOND, false).is_empty());
        let again = collector.due(AT + 2 * SECOND, true);
        assert_eq!(
            again[0].0.as_ref().unwrap().header.stamp.to_nanoseconds(),
            AT + 2 * SECOND
        );
        // Sampled before the repetition: its stamp does not fall behind it.
        let uncertain = StatusCode::UncertainLastUsableValue;
        collector
            .take(&raw(0, 91.0, uncertain, AT + 2 * SECOND - 1000, AT + 2 * SECOND))
            .unwrap();
        let sent = collector.due(AT + 2 * SECOND, true);
        let inputs = sent[0].0.as_ref().unwrap();
        assert_eq!(inputs.quality, RigInputs::SUSPECT);
        assert_eq!(inputs.header.stamp.to_nanoseconds(), AT + 2 * SECOND + 1);
        collector.forget();
        assert!(collector.due(AT + 9 * SECOND, true).is_empty());
    }

    #[test]
    fn a_survey_waits_for_its_nodes_and_is_sent_once() {
        let text = "nodes:\n  \"ns=2;s=a\": {quantity: survey_depth, unit: m}\n  \"ns=2;s=b\": {quantity: survey_inclination, \
                    unit: deg}\n  \"ns=2;s=c\": {quantity: survey_azimuth, unit: deg}\n";
        let mut collector = Collector::new(&NodeMapping::from_text("site.yaml", text).unwrap(), "rig:4840");
        let good = StatusCode::Good;
        collector.take(&raw(0, 2004.5, good, AT, AT)).unwrap();
        assert_eq!(collector.survey_due(AT + 9 * SECOND), None, "no inclination");
        collector.take(&raw(0, 2004.5, good, AT, AT)).unwrap();
        collector.take(&raw(1, 57.3, good, AT + SECOND, AT + SECOND)).unwrap();
        collector.take(&raw(2, 15.5, good, AT, AT)).unwrap();
        // The inclination has changed a second after the depth: another node may follow.
        assert_eq!(collector.survey_due(AT + 2 * SECOND), None);
        let survey = collector.survey_due(AT + 3 * SECOND).unwrap();
        assert_eq!((survey.measured_depth, survey.quality), (2004.5, RigSurvey::GOOD));
        assert!((survey.inclination - 57.3_f64.to_radians()).abs() < 1e-12);
        assert_eq!(survey.header.stamp.to_nanoseconds(), AT + SECOND);
        // Neither it nor its values come again, whatever the time of repetition.
        assert_eq!(collector.survey_due(AT + 99 * SECOND), None);
        assert!(collector.due(AT + 99 * SECOND, true).is_empty());
        let uncertain = StatusCode::UncertainLastUsableValue;
        collector
            .take(&raw(1, 57.4, uncertain, AT + 100 * SECOND, AT + 100 * SECOND))
            .unwrap();
        assert_eq!(
            collector.survey_due(AT + 102 * SECOND).unwrap().quality,
            RigSurvey::SUSPECT
        );
    }

    #[test]
    fn what_cannot_be_used_is_said_and_not_repeated() {
        let mut collector = collector();
        let good = StatusCode::Good;
        collector.take(&raw(0, 90.0, good, AT, AT)).unwrap();
        let fault = collector.take(&raw(0, 900.0, good, AT, AT)).unwrap_err();
        assert_eq!(
            fault.to_string(),
            "node ns=2;s=a: 900 r/min is outside 0 to 200 r/min and is not used"
        );
        assert!(collector.due(AT, true).is_empty());
        for value in [Variant::from("90"), Variant::from(f64::NAN), Variant::from(true)] {
            assert_eq!(
                collector.take(&raw(0, value, good, AT, AT)).unwrap_err().name(),
                "no number"
            );
        }
        // A bad value is sent as bad, with the last number.
        let bad = RawValue {
            value: None,
            ..raw(0, 0.0, StatusCode::BadSensorFailure, AT - 60 * SECOND, AT)
        };
        assert!(
            collector
                .take(&bad)
                .unwrap_err()
                .to_string()
                .contains("BadSensorFailure")
        );
        let sent = collector.due(AT, true);
        let inputs = sent[0].0.as_ref().unwrap();
        assert_eq!(inputs.quality, RigInputs::BAD);
        assert!((inputs.rotary_speed_rpm - 90.0).abs() < 1e-12);
        assert_eq!(inputs.header.stamp.to_nanoseconds(), AT);
        assert_eq!(collector.counts.stamps_replaced, 1);
        assert_eq!((collector.counts.bad, collector.counts.no_number), (1, 3));
    }
}
