//! Damaged lines: nothing panics, and every byte and frame is used or reported.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use flexdrill_bridge::wits::{Counts, FrameUse, Line, LineEvent, Mapping, RawFrame, Reading, RigFrames};
use flexdrill_bridge::{Quantity, wits};
use flexdrill_core::inputs::MeasuredKind;

/// Captures that are mutated.
const CAPTURES: u64 = 10_000;

/// A pseudo-random sequence that is the same on every machine (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.next() % bound.max(1) as u64).unwrap()
    }
}

/// Some frames of a rig, one a second.
fn capture() -> Vec<u8> {
    let mut rig = RigFrames::new(&Mapping::default(), "Well 7");
    let mut bytes = Vec::new();
    for second in 0..6_i64 {
        let value = |quantity: Quantity| match quantity {
            Quantity::RotarySpeed => Some(6.0 + second as f64),
            Quantity::WeightOnBit => Some(25e3),
            Quantity::Survey(_) | Quantity::Measured(MeasuredKind::AxialShock | MeasuredKind::LateralShock) => None,
            Quantity::Measured(_) => Some(1.5),
        };
        bytes.extend(
            rig.frame(1_700_000_000_000_000_000 + second * 1_000_000_000, value)
                .unwrap(),
        );
    }
    bytes
}

fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    const WORDS: [&[u8]; 12] = [
        b"&&",
        b"!!",
        b"\r\n",
        b"\r",
        b"-9999",
        b"1e308",
        b"0104",
        b"\0",
        b"\xff",
        b"99999999999999999999",
        b"NaN",
        b"0120",
    ];
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len());
        match random.below(6) {
            0 => bytes[at] = random.next() as u8,
            1 => bytes[at] ^= 1 << random.below(8),
            2 => drop(bytes.drain(at..(at + random.below(40)).min(bytes.len()))),
            3 => drop(bytes.splice(at..at, WORDS[random.below(WORDS.len())].iter().copied())),
            4 => {
                let copy = bytes[at..(at + random.below(60)).min(bytes.len())].to_vec();
                let to = random.below(bytes.len());
                drop(bytes.splice(to..to, copy));
            }
            _ => bytes.truncate(at.max(1)),
        }
        if bytes.is_empty() {
            bytes.push(b'&');
        }
    }
}

/// A value of a message, the items of the default mapping that may be its source, its unit per theirs, and the range that
/// a rig can have, in the message's unit.
type Believed = (f64, &'static [&'static str], f64, [f64; 2]);

/// The values of a reading that are given. Units and ranges are written out here, as the page on bridges has them.
fn believed(reading: &Reading) -> Vec<Believed> {
    let mut all: Vec<Believed> = Vec::new();
    if let Some(inputs) = &reading.inputs {
        all.extend([
            (inputs.rotary_speed_rpm, &["0120"][..], 1.0, [-2865.0, 2865.0]),
            (inputs.weight_on_bit_kn, &["0116", "0117"], 10.0, [-1000.0, 1000.0]),
            (inputs.rate_of_penetration_m_per_h, &["0113"], 1.0, [-36e3, 36e3]),
            (inputs.standpipe_pressure_mpa, &["0121"], 1e-3, [-1.0, 200.0]),
        ] as [Believed; 4]);
    }
    if let Some(measured) = &reading.measured {
        all.extend([
            (measured.hook_load, &["0114", "0115"][..], 1e4, [-1e6, 3e7]),
            (measured.surface_torque, &["0118", "0119"], 1e3, [-1e6, 1e6]),
            (measured.bit_depth, &["0108", "0910"], 1.0, [-1e3, 3e4]),
            (measured.hole_depth, &["0110"], 1.0, [-1e3, 3e4]),
            (measured.downhole_weight_on_bit, &["0915"], 1e4, [-1e7, 1e7]),
            (measured.downhole_torque, &["0917"], 1e3, [-1e6, 1e6]),
        ] as [Believed; 6]);
    }
    all.retain(|(value, ..)| !value.is_nan());
    all
}

/// Whether a value is that of a line of its frame, within its range.
fn is_of_its_line(frame: &RawFrame, (value, items, factor, [least, most]): &Believed) -> bool {
    let of_line = |line: &Vec<u8>| {
        let text = std::str::from_utf8(line).ok()?;
        let item = items.iter().find_map(|item| text.trim_start().strip_prefix(item))?;
        item.trim().parse::<f64>().ok()
    };
    // Conversion to SI and back rounds twice; a relative error of 1e-12 is several thousand times that.
    let is_near = |sent: f64| (sent * factor - value).abs() <= 1e-12 * value.abs();
    (*least..=*most).contains(value) && frame.lines.iter().filter_map(of_line).any(is_near)
}

/// The counts and the events of a line that comes in pieces.
fn read(bytes: &[u8], random: &mut Random) -> (Counts, Vec<LineEvent>) {
    let mapping = Mapping::default();
    let (mut line, mut counts, mut events) = (Line::new(&mapping, "rig"), Counts::default(), Vec::new());
    let mut rest = bytes;
    while !rest.is_empty() {
        let (piece, after) = rest.split_at(rest.len().min(1 + random.below(64)));
        line.push(piece, 1_700_000_000_000_000_000, &mut counts, |event| {
            events.push(event)
        });
        rest = after;
    }
    line.finish(1_700_000_000_000_000_000, &mut counts, |event| events.push(event));
    (counts, events)
}

#[test]
fn every_frame_of_ten_thousand_damaged_captures_is_used_or_reported() {
    let whole = capture();
    let (counts, _) = read(&whole, &mut Random(1));
    assert_eq!((counts.frames, counts.used, counts.discarded_bytes), (6, 6, 0));
    let (mut used, mut reported, mut values) = (0, 0, 0_u64);
    for seed in 0..CAPTURES {
        let mut random = Random(seed);
        let mut bytes = whole.clone();
        mutate(&mut bytes, &mut random);
        let (counts, events) = read(&bytes, &mut random);
        assert_eq!(counts.frames, counts.used + counts.frames_not_used(), "seed {seed}");
        // Bytes of neither kind are blanks, control characters or a byte order mark between frames.
        let is_padding = |byte: &&u8| matches!(byte, b' ' | 0xef | 0xbb | 0xbf) || byte.is_ascii_control();
        let blanks = bytes.iter().filter(is_padding).count() as u64;
        let unseen = (bytes.len() as u64).checked_sub(counts.frame_bytes + counts.discarded_bytes);
        assert!(
            unseen.is_some_and(|unseen| unseen <= blanks),
            "seed {seed}: {unseen:?} of {}",
            bytes.len()
        );
        for event in &events {
            let LineEvent::Frame(frame, reading) = event else {
                continue;
            };
            let given = u32::from(reading.inputs.is_some()) + u32::from(reading.measured.is_some());
            match reading.outcome {
                FrameUse::Used { values } => assert!(values > 0 && given > 0, "seed {seed}"),
                FrameUse::NotUsed(_) => assert_eq!(given, 0, "seed {seed}"),
            }
            // None is believed that its line does not have, and none outside of what a rig can have.
            for value in believed(reading) {
                assert!(is_of_its_line(frame, &value), "seed {seed}: {value:?} of {frame:?}");
                values += 1;
            }
            // Every line is an item with a meaning, or counted.
            assert!(
                reading.faults.len() <= frame.lines.len() + usize::from(frame.long_lines > 0),
                "seed {seed}"
            );
            for fault in &reading.faults {
                assert!(
                    fault.to_string().is_ascii() && !fault.to_string().contains(char::is_control),
                    "seed {seed}"
                );
            }
        }
        used += counts.used;
        reported += counts.frames_not_used() + counts.discarded.iter().sum::<u64>();
    }
    // Each whole frame has ten values.
    assert!(values > 10 * CAPTURES, "{values}");
    // The mutations reach both ends: of six frames most survive, and every second capture loses one.
    assert!(
        used > 2 * CAPTURES && reported > CAPTURES / 2,
        "{used} used, {reported} reported"
    );
}

#[test]
fn foreign_text_is_shown_escaped() {
    assert_eq!(
        wits::shown(b"a\x1b[2J\xe2\x80\xae \"x\"\n"),
        "a\\x1b[2J\\xe2\\x80\\xae \"x\"\\n"
    );
}
