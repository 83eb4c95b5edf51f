//! Frames that are written: the twin's figures back to a rig, and a rig's values for a demonstration.

use std::collections::BTreeMap;

use jiff::Timestamp;
use jiff::tz::Offset;

use super::item::ItemCode;
use super::mapping::{ItemMapping, Mapping, WriteMapping};
use crate::{Quantity, TwinFigures};

/// Longest text of a header (bytes), as the format has it.
const LONGEST_TEXT: usize = 16;
/// Sequence numbers return to 1 after this: the format gives them four bytes, and readers show ten digits.
const LAST_SEQUENCE: u64 = 2_147_483_647;

/// Writes frames with their headers.
#[derive(Debug, Clone)]
pub struct FrameWriter {
    well: String,
    /// How far the clock of the header is ahead of UTC (s).
    utc_offset: i32,
    /// The last sequence number of each record.
    sequences: BTreeMap<u8, u64>,
}

impl FrameWriter {
    /// A writer that has written nothing. `well` is cut at 16 characters; what the line cannot carry becomes `?`.
    pub fn new(well: &str, utc_offset: i32) -> Self {
        let mut shown: String = well
            .chars()
            .map(|letter| {
                if letter.is_ascii_graphic() || letter == ' ' {
                    letter
                } else {
                    '?'
                }
            })
            .collect();
        shown.truncate(LONGEST_TEXT);
        Self {
            well: shown,
            utc_offset,
            sequences: BTreeMap::new(),
        }
    }

    /// A frame with these items at an instant (ns since 1970), each value with its digits after the point. Each record
    /// has its own header. Without items the frame is empty.
    pub fn frame(&mut self, at: i64, items: &[(ItemCode, f64, u8)]) -> Vec<u8> {
        let mut sorted = items.to_vec();
        sorted.sort_by_key(|(code, ..)| *code);
        let mut text = String::from("&&\r\n");
        let mut record = None;
        for (code, value, decimals) in sorted {
            if record != Some(code.record) {
                record = Some(code.record);
                self.header(&mut text, code.record, at);
            }
            text += &format!("{code}{value:.*}\r\n", usize::from(decimals));
        }
        text += "!!\r\n";
        text.into_bytes()
    }

    fn header(&mut self, text: &mut String, record: u8, at: i64) {
        let sequence = self.sequences.entry(record).or_default();
        *sequence = if *sequence >= LAST_SEQUENCE { 1 } else { *sequence + 1 };
        let instant = Timestamp::from_nanosecond(at.into()).unwrap_or_default();
        let offset = Offset::from_seconds(self.utc_offset).unwrap_or(Offset::UTC);
        let local = offset.to_datetime(instant);
        if !self.well.is_empty() {
            *text += &format!("{record:02}01{}\r\n", self.well);
        }
        *text += &format!("{record:02}03{record}\r\n{record:02}04{sequence}\r\n");
        *text += &format!(
            "{record:02}05{}\r\n{record:02}06{}\r\n",
            local.strftime("%y%m%d"),
            local.strftime("%H%M%S")
        );
    }
}

/// Writes the twin's figures as the site wants them.
#[derive(Debug, Clone)]
pub struct TwinFrames {
    mapping: WriteMapping,
    writer: FrameWriter,
}

impl TwinFrames {
    /// Frames after a mapping.
    pub fn new(mapping: &WriteMapping, utc_offset: i32) -> Self {
        Self {
            writer: FrameWriter::new(&mapping.well, utc_offset),
            mapping: mapping.clone(),
        }
    }

    /// Time between two frames (s).
    pub fn interval(&self) -> f64 {
        self.mapping.every_s
    }

    /// The frame of the newest figures at an instant (ns since 1970); `None` while the twin has sent none of them. A figure
    /// that the twin does not have is left out.
    pub fn frame(&mut self, twin: &TwinFigures, at: i64) -> Option<Vec<u8>> {
        let given = self.mapping.items.iter().filter_map(|(code, item)| {
            let value = item.unit.from_si(twin.value(item.figure)?);
            Some((*code, value, item.decimals))
        });
        let items: Vec<_> = given.collect();
        (!items.is_empty()).then(|| self.writer.frame(at, &items))
    }
}

/// Writes the values of a rig, with the items and units of a mapping.
#[derive(Debug, Clone)]
pub struct RigFrames {
    items: Vec<(ItemCode, ItemMapping)>,
    writer: FrameWriter,
}

/// Digits after the point of a rig's values: 10 N of a weight in kdaN, a pascal of a pressure in kPa.
const RIG_DECIMALS: u8 = 3;

impl RigFrames {
    /// Frames of a rig that sends what `mapping` reads: the first item of each quantity that is no fallback.
    pub fn new(mapping: &Mapping, well: &str) -> Self {
        let mut items: Vec<(ItemCode, ItemMapping)> = Vec::new();
        for (code, item) in mapping.table() {
            let known = items.iter().any(|(_, known)| known.quantity == item.quantity);
            if !item.fallback && !known {
                items.push((code, item));
            }
        }
        Self {
            items,
            writer: FrameWriter::new(well, mapping.utc_offset()),
        }
    }

    /// The frame of these values (SI) at an instant (ns since 1970); `None` without a value that the mapping has.
    pub fn frame(&mut self, at: i64, values: impl Fn(Quantity) -> Option<f64>) -> Option<Vec<u8>> {
        let given = self.items.iter().filter_map(|(code, item)| {
            let value = values(item.quantity).filter(|value| value.is_finite())?;
            Some((*code, item.unit.from_si(value), RIG_DECIMALS))
        });
        let items: Vec<_> = given.collect();
        (!items.is_empty()).then(|| self.writer.frame(at, &items))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wits::{Decoder, FrameReader, FrameUse, Piece, Sequence};
    use flexdrill_core::inputs::MeasuredKind;
    use flexdrill_messages::{BitState, HoleAhead, to_cdr_body, topics};

    const AT: i64 = 1_700_000_000_000_000_000;

    fn frames(bytes: &[u8]) -> Vec<crate::wits::RawFrame> {
        let (mut reader, mut frames) = (FrameReader::new(), Vec::new());
        let mut take = |piece| match piece {
            Piece::Frame(frame) => frames.push(frame),
            Piece::Discarded(discarded) => panic!("{discarded:?}"),
        };
        reader.push(bytes, &mut take);
        reader.finish(&mut take);
        frames
    }

    #[test]
    fn what_a_rig_sends_is_what_the_decoder_reads() {
        for text in ["", "units: field\nutc_offset_h: -5\nstamp: header\n"] {
            let mapping = Mapping::from_text("site.yaml", text).unwrap();
            let mut rig = RigFrames::new(&mapping, "A-7\u{1b}&&");
            let sent = |quantity: Quantity| match quantity {
                Quantity::RotarySpeed => Some(6.0),
                Quantity::WeightOnBit => Some(25e3),
                Quantity::Measured(MeasuredKind::HookLoad) => Some(412_345.0),
                Quantity::Measured(MeasuredKind::DownholeTorque) => Some(1234.5),
                Quantity::Measured(_) | Quantity::Survey(_) => None,
            };
            let mut decoder = Decoder::new(&mapping, "rig");
            for expected in [Sequence::First, Sequence::Next] {
                let bytes = rig.frame(AT, sent).unwrap();
                let frames = frames(&bytes);
                assert_eq!(frames.len(), 1);
                let reading = decoder.decode(&frames[0], AT + 1);
                assert_eq!(
                    (reading.outcome, reading.faults.len()),
                    (FrameUse::Used { values: 4 }, 0)
                );
                assert!(reading.records.iter().all(|seen| seen.sequence == expected));
                assert_eq!(reading.records[0].header.instant(mapping.utc_offset()), Some(AT));
                let inputs = reading.inputs.unwrap();
                // Half a unit of the last digit: 5 N in kdaN, 2.3 N in klbf.
                assert!(
                    (inputs.weight_on_bit_kn - 25.0).abs() < 5.1e-3,
                    "{}",
                    inputs.weight_on_bit_kn
                );
                assert!(inputs.source.contains("A-7?&&"));
                let measured = reading.measured.unwrap();
                assert!((measured.hook_load - 412_345.0).abs() < 5.1);
                assert!((measured.downhole_torque - 1234.5).abs() < 0.7);
            }
            assert!(rig.frame(AT, |_| None).is_none());
        }
    }

    #[test]
    fn the_twins_figures_are_a_record_of_the_sites_choice() {
        let text = "write:\n  well: B-2\n  items:\n    \"4008\": {figure: bit_torque, unit: kN.m, decimals: 3}\n    \"4109\": \
                    {figure: stick_slip_index, unit: \"1\"}\n    \"4110\": {figure: hook_load, unit: kN}\n";
        let mapping = Mapping::from_text("site.yaml", text).unwrap();
        let mut frames = TwinFrames::new(mapping.write.as_ref().unwrap(), 0);
        let mut twin = TwinFigures::default();
        assert_eq!(frames.frame(&twin, AT), None);
        let bit = BitState {
            torque: 350.0,
            stick_slip_index: 1.5,
            ..BitState::default()
        };
        twin.take(topics::BIT_STATE.name, &to_cdr_body(&bit).unwrap()).unwrap();
        let text = String::from_utf8(frames.frame(&twin, AT).unwrap()).unwrap();
        assert_eq!(
            text,
            "&&\r\n4001B-2\r\n400340\r\n40041\r\n4005231114\r\n4006221320\r\n40080.350\r\n4101B-2\r\n410341\r\n41041\r\n\
             4105231114\r\n4106221320\r\n41091.50\r\n!!\r\n"
        );
    }

    /// 17.9 deg/m of an arc of 3.2 m are 537 deg/30m, whatever the rig's unit is.
    #[test]
    fn the_hole_ahead_is_sent_in_the_sites_units() {
        let text = "write:\n  items:\n    \"4008\": {figure: hole_radius, unit: ft}\n    \"4009\": {figure: hole_build_rate, \
                    unit: deg/30m}\n    \"4010\": {figure: hole_plan_weight, unit: kN}\n";
        let mapping = Mapping::from_text("site.yaml", text).unwrap();
        let mut frames = TwinFrames::new(mapping.write.as_ref().unwrap(), 0);
        let mut twin = TwinFigures::default();
        let hole = HoleAhead {
            known: true,
            radius: 3.2,
            build_rate: 1.0 / 3.2,
            plan_weight: f64::NAN,
            ..HoleAhead::default()
        };
        twin.take(topics::HOLE_AHEAD.name, &to_cdr_body(&hole).unwrap())
            .unwrap();
        let text = String::from_utf8(frames.frame(&twin, AT).unwrap()).unwrap();
        // No weight is needed, so that the frame has none.
        assert!(
            text.contains("400810.50\r\n4009537.15\r\n!!") && !text.contains("4010"),
            "{text}"
        );
    }
}
