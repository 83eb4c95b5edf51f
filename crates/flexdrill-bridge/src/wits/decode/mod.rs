//! What a frame means: records with their sequence, items as quantities, everything else reported.

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::std_msgs::Header as RosHeader;
use flexdrill_messages::{RigInputs, RigMeasured, RigSurvey};

use super::frame::RawFrame;
use super::header::{Header, LAST_HEADER_ITEM};
use super::item::{ItemCode, is_null, number};
use super::mapping::{ItemMapping, Mapping, SequenceUse, StampSource};
use super::report::{FrameUse, ItemFault, ItemFaultKind, NotUsed};
use super::sequence::{Numbered, Sequence, SequenceDefect, SequenceWatch};
use super::shown;
use crate::{Quantity, messages};

/// The item of a header that has the sequence number.
const SEQUENCE_ITEM: u8 = 4;
/// Faults of one frame that are described; more are counted.
const MOST_FAULTS: usize = 16;
/// Bytes of a fault that are shown.
const SHOWN: usize = 40;
/// Longest source in a message (characters).
const LONGEST_SOURCE: usize = 64;

/// A record in a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordSeen {
    /// Its number.
    pub record: u8,
    /// Its header.
    pub header: Header,
    /// What its sequence number says.
    pub sequence: Sequence,
    /// A defect of the numbers that this one reveals.
    pub defect: Option<SequenceDefect>,
    /// Records counted as missing before, by numbers that do not count.
    pub retracted: u64,
}

/// The source's clock differs from this machine's by whole quarters of an hour: it shows another time zone than the
/// mapping says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockOffset {
    /// How far it is ahead of UTC (h); the value for `utc_offset_h`.
    pub utc_offset_h: f64,
}

/// What a frame means.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Its records, in the order of their numbers.
    pub records: Vec<RecordSeen>,
    /// Values for `rig/inputs`, if it has any.
    pub inputs: Option<RigInputs>,
    /// Values for `rig/measured`, if it has any.
    pub measured: Option<RigMeasured>,
    /// A survey for `rig/survey`, if it has one.
    pub survey: Option<RigSurvey>,
    /// What became of it.
    pub outcome: FrameUse,
    /// Items that mean "no value".
    pub nulls: u32,
    /// Items that the mapping does not name.
    pub unmapped: u32,
    /// Lines and items that could not be used.
    pub faults: Vec<ItemFault>,
    /// Faults beyond those.
    pub more_faults: u32,
    /// The time zone of the source's clock, once per connection where stamps depend on it and it is not that of the mapping.
    pub clock: Option<ClockOffset>,
}

/// Reads the frames of one connection.
#[derive(Debug)]
pub struct Decoder {
    table: BTreeMap<ItemCode, ItemMapping>,
    nulls: Vec<f64>,
    stamp: StampSource,
    utc_offset: i32,
    /// The other end of the line, for the source of the messages.
    peer: String,
    /// The well that the newest header with a name gave: the source is the same for all frames of a connection, also where
    /// some of them have no name.
    well: String,
    /// How the numbers of each record behave; none where the mapping ignores them.
    sequences: Option<BTreeMap<u8, SequenceWatch>>,
    /// Items of headers whose fault was reported: they would be in every frame.
    reported: BTreeSet<ItemCode>,
    clock: ClockWatch,
}

/// Looks for a clock in another time zone.
#[derive(Debug, Clone, Copy, Default)]
struct ClockWatch {
    /// Quarters of an hour by which the newest frame was ahead.
    quarters: i64,
    was_reported: bool,
}

/// A quarter of an hour (ns): the unit of time zones.
const QUARTER: i64 = 900_000_000_000;
/// Largest difference from whole quarters (ns): whole seconds in the header, and the time that a frame needs.
const CLOCK_TOLERANCE: i64 = 2_000_000_000;
/// Most quarters of an hour of a time zone.
const MOST_QUARTERS: i64 = 14 * 4;

impl ClockWatch {
    /// Quarters of an hour by which the clock is ahead, if two frames in succession agree; once.
    fn look(&mut self, ahead: i64) -> Option<i64> {
        let quarters = ahead.saturating_add(QUARTER / 2).div_euclid(QUARTER);
        let is_whole = (ahead - quarters * QUARTER).abs() <= CLOCK_TOLERANCE;
        let before = std::mem::replace(&mut self.quarters, if is_whole { quarters } else { 0 });
        let agrees = is_whole && quarters != 0 && before == quarters && quarters.abs() <= MOST_QUARTERS;
        let is_new = agrees && !self.was_reported;
        self.was_reported |= agrees;
        is_new.then_some(quarters)
    }
}

/// A value of a frame (SI).
#[derive(Debug, Clone, Copy)]
struct Value {
    value: f64,
    fallback: bool,
}

/// A frame while it is read.
#[derive(Default)]
struct Draft {
    values: BTreeMap<Quantity, Value>,
    faults: Vec<ItemFault>,
    more_faults: u32,
    nulls: u32,
    unmapped: u32,
    mapped: u32,
    /// Two sources share the line.
    disputed: bool,
}

impl Draft {
    fn value(&self, quantity: Quantity) -> Option<f64> {
        self.values.get(&quantity).map(|value| value.value)
    }

    fn any_fallback(&self, of: impl Fn(Quantity) -> bool) -> bool {
        self.values
            .iter()
            .any(|(&quantity, value)| of(quantity) && value.fallback)
    }

    fn fault(&mut self, kind: ItemFaultKind, code: Option<ItemCode>, text: &[u8], wanted: impl FnOnce() -> String) {
        if self.faults.len() >= MOST_FAULTS {
            self.more_faults += 1;
            return;
        }
        self.faults.push(ItemFault {
            kind,
            code,
            text: shown(&text[..text.len().min(SHOWN)]),
            wanted: wanted(),
        });
    }
}

impl Decoder {
    /// A decoder at the beginning of a connection. `peer` names the other end of the line.
    pub fn new(mapping: &Mapping, peer: &str) -> Self {
        Self {
            table: mapping.table(),
            nulls: mapping.nulls.clone(),
            stamp: mapping.stamp,
            utc_offset: mapping.utc_offset(),
            peer: peer.to_owned(),
            well: String::new(),
            sequences: (mapping.sequence == SequenceUse::Use).then(BTreeMap::new),
            reported: BTreeSet::new(),
            clock: ClockWatch::default(),
        }
    }

    /// Reads a frame that arrived at `arrived` (ns since 1970).
    pub fn decode(&mut self, frame: &RawFrame, arrived: i64) -> Reading {
        let mut draft = Draft::default();
        // Sorted by code, so that the items of a record follow each other, whatever their order in the frame.
        let mut items: BTreeMap<ItemCode, &[u8]> = BTreeMap::new();
        for line in &frame.lines {
            match ItemCode::of_line(line) {
                // If the second silently replaced the first, the order of lines
                // would decide; so it is a fault of the frame.
                Some((code, value)) if items.contains_key(&code) => {
                    draft.fault(ItemFaultKind::Twice, Some(code), value, || {
                        "the first is used".to_owned()
                    });
                }
                Some((code, value)) => {
                    items.insert(code, value);
                }
                // A line that is no item is a fault of that line; the rest of the frame is of use.
                None => draft.fault(ItemFaultKind::NoItem, None, line, || {
                    "a line needs four digits and a value, such as 0108 1234.5".to_owned()
                }),
            }
        }
        draft.more_faults += frame.long_lines;
        // Headers before values: the sequence number decides whether a record is new at all.
        let records = self.records(&items, &mut draft);
        let newest: Vec<u8> = records
            .iter()
            .filter(|seen| seen.sequence.is_newest())
            .map(|seen| seen.record)
            .collect();
        // Items of the header describe the record and are no quantities.
        for (&code, &value) in items.iter().filter(|(code, _)| code.item > LAST_HEADER_ITEM) {
            if newest.contains(&code.record) {
                self.item(code, value, &mut draft);
            }
        }
        // The outcome counts frames for `/diagnostics`: a line that sends and brings nothing has its reason there.
        let outcome = outcome(&records, &newest, &draft);
        let (stamp, clock) = self.stamp(&records, arrived);
        // One stamp for both messages: the values come from one instant.
        let header = RosHeader {
            stamp: Time::from_nanoseconds(stamp),
            ..RosHeader::default()
        };
        let source = self.source(&records);
        Reading {
            inputs: rig_inputs(&draft, header.clone(), &source),
            measured: rig_measured(&draft, header.clone(), &source),
            survey: rig_survey(&draft, header, &source),
            records,
            outcome,
            nulls: draft.nulls,
            unmapped: draft.unmapped,
            faults: draft.faults,
            more_faults: draft.more_faults,
            clock,
        }
    }

    /// The records of a frame, each with its header and what its sequence number says.
    fn records(&mut self, items: &BTreeMap<ItemCode, &[u8]>, draft: &mut Draft) -> Vec<RecordSeen> {
        let mut records: Vec<RecordSeen> = Vec::new();
        for (code, value) in items {
            if records.last().is_none_or(|seen| seen.record != code.record) {
                records.push(RecordSeen {
                    record: code.record,
                    header: Header::default(),
                    sequence: Sequence::Unnumbered,
                    defect: None,
                    retracted: 0,
                });
            }
            if let Some(seen) = records.last_mut().filter(|_| code.item <= LAST_HEADER_ITEM) {
                let before = seen.header.unreadable.len();
                // A header item may be null like any other.
                if !is_null(value, &self.nulls) {
                    seen.header.add(code.item, value);
                }
                // A header that cannot be read is so in every frame; nothing depends on it but its own use.
                let is_ignored = code.item == SEQUENCE_ITEM && self.sequences.is_none();
                if seen.header.unreadable.len() > before && !is_ignored && self.reported.insert(*code) {
                    draft.fault(ItemFaultKind::Header, Some(*code), value, || {
                        "sequence, date YYMMDD, time HHMMSS and activity are whole numbers".to_owned()
                    });
                }
            }
        }
        let Some(sequences) = &mut self.sequences else {
            return records;
        };
        for seen in &mut records {
            let item = |item: u8| {
                let code = ItemCode {
                    record: seen.record,
                    item,
                };
                items.get(&code).copied()
            };
            seen.header.look_at_sequence([item(5), item(6)]);
            let Some(number) = seen.header.sequence else { continue };
            let next = Numbered {
                number,
                contents: contents(items, seen.record),
                instant: seen.header.instant(self.utc_offset),
                is_clock: seen.header.is_clock,
            };
            let watch = sequences.entry(seen.record).or_default();
            let classified = watch.classify(next);
            seen.sequence = classified.sequence;
            seen.defect = classified.found;
            seen.retracted = classified.retracted;
            // Which of two sources is the rig is unknown, so that neither is fully believed.
            draft.disputed |= watch.defect() == Some(SequenceDefect::TwoCounters);
        }
        records
    }

    fn item(&self, code: ItemCode, text: &[u8], draft: &mut Draft) {
        // Rigs send hundreds of items, so one that is not mapped is counted and not reported.
        let Some(mapping) = self.table.get(&code) else {
            draft.unmapped += 1;
            return;
        };
        draft.mapped += 1;
        if text.is_empty() {
            draft.nulls += 1;
            return;
        }
        // The number is read before the test for null, so that a text in a null's place is a fault.
        let Some(value) = number(text) else {
            draft.fault(ItemFaultKind::NoNumber, Some(code), text, || {
                format!("{} in {} is a number with a point", mapping.quantity, mapping.unit)
            });
            return;
        };
        // Null values such as -9999 are numbers, and would be out of range with a misleading reason.
        if is_null(text, &self.nulls) {
            draft.nulls += 1;
            return;
        }
        let si = mapping.unit.to_si(value);
        // Without a range of the mapping the physical bounds of the quantity find a wrong unit.
        let [least, most] = match mapping.valid {
            Some(valid) => valid,
            None => mapping.quantity.plausible().map(|bound| mapping.unit.from_si(bound)),
        };
        if !(least..=most).contains(&value) || !si.is_finite() {
            draft.fault(ItemFaultKind::OutOfRange, Some(code), text, || {
                let unit = mapping.unit;
                format!(
                    "{} is {least} to {most} {unit}; check the unit of the mapping",
                    mapping.quantity
                )
            });
            return;
        }
        // Several items may have the same quantity: a mean replaces the maximum that serves in its absence.
        let new = Value {
            value: si,
            fallback: mapping.fallback,
        };
        let old = draft.values.entry(mapping.quantity).or_insert(new);
        if old.fallback && !new.fallback {
            *old = new;
        }
    }

    /// The stamp of the messages (ns since 1970), and the time zone of the source's clock where it is another.
    fn stamp(&mut self, records: &[RecordSeen], arrived: i64) -> (i64, Option<ClockOffset>) {
        if self.stamp == StampSource::Arrival {
            return (arrived, None);
        }
        let of_header = records
            .iter()
            .filter_map(|seen| seen.header.instant(self.utc_offset))
            .max();
        let Some(stamp) = of_header else {
            return (arrived, None);
        };
        let quarters = self.clock.look(stamp.saturating_sub(arrived));
        let clock = quarters.map(|quarters| ClockOffset {
            utc_offset_h: f64::from(self.utc_offset) / 3600.0 + quarters as f64 / 4.0,
        });
        (stamp, clock.filter(|clock| clock.utc_offset_h.abs() <= 14.0))
    }

    /// The source of the messages: the line and the well.
    fn source(&mut self, records: &[RecordSeen]) -> String {
        let mut wells = records.iter().map(|seen| shown(&seen.header.well));
        if let Some(well) = wells.find(|well| !well.is_empty()) {
            self.well = well;
        }
        let text = match self.well.as_str() {
            "" => format!("wits {}", self.peer),
            well => format!("wits {}, well {well}", self.peer),
        };
        text.chars().take(LONGEST_SOURCE).collect()
    }
}

/// A hash of a record's items without its sequence number: records of one number with other contents are no repeats.
fn contents(items: &BTreeMap<ItemCode, &[u8]>, record: u8) -> u64 {
    let mut hasher = DefaultHasher::new();
    for (code, value) in items {
        if code.record == record && code.item != SEQUENCE_ITEM {
            (code, value).hash(&mut hasher);
        }
    }
    hasher.finish()
}

fn outcome(records: &[RecordSeen], newest: &[u8], draft: &Draft) -> FrameUse {
    let values = u32::try_from(draft.values.len()).unwrap_or(u32::MAX);
    FrameUse::NotUsed(if values > 0 {
        return FrameUse::Used { values };
    } else if records.is_empty() {
        NotUsed::Empty
    } else if newest.is_empty() {
        let any = |is: fn(Sequence) -> bool| records.iter().any(|seen| is(seen.sequence));
        if any(|sequence| matches!(sequence, Sequence::Jump { .. })) {
            NotUsed::Jumped
        } else if any(|sequence| matches!(sequence, Sequence::OutOfOrder { .. })) {
            NotUsed::Late
        } else {
            NotUsed::Repeated
        }
    } else if draft.mapped == 0 {
        NotUsed::NothingMapped
    } else {
        NotUsed::NoGoodValue
    })
}

fn rig_inputs(draft: &Draft, header: RosHeader, source: &str) -> Option<RigInputs> {
    let doubtful = draft.disputed || draft.any_fallback(|quantity| quantity.input().is_some());
    messages::rig_inputs(|quantity| draft.value(quantity), header, quality(doubtful), source)
}

fn rig_measured(draft: &Draft, header: RosHeader, source: &str) -> Option<RigMeasured> {
    let doubtful = draft.disputed || draft.any_fallback(|quantity| matches!(quantity, Quantity::Measured(_)));
    messages::rig_measured(|quantity| draft.value(quantity), header, quality(doubtful), source)
}

fn rig_survey(draft: &Draft, header: RosHeader, source: &str) -> Option<RigSurvey> {
    let doubtful = draft.disputed || draft.any_fallback(|quantity| matches!(quantity, Quantity::Survey(_)));
    messages::rig_survey(|quantity| draft.value(quantity), header, quality(doubtful), source)
}

/// The codes of all messages are the same.
const fn quality(doubtful: bool) -> u8 {
    if doubtful { RigInputs::SUSPECT } else { RigInputs::GOOD }
}

#[cfg(test)]
mod tests;
