//! Recorders and their habits: lines as public programs, manuals and captures show them, two minutes at one frame per
//! second. Each is used, or refused in words. The table in docs/rig_inputs.md names these tests.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::collections::BTreeSet;

use flexdrill_bridge::wits::{Counts, Line, LineEvent, Mapping, SequenceDefect};
use flexdrill_messages::RigInputs;

/// Frames of each line.
const FRAMES: u64 = 120;
/// 2026-09-25 08:37:24 UTC.
const FIRST: i64 = 1_790_325_444;

/// The sequence number of a frame, if it has one.
type Number = fn(u64) -> Option<String>;

/// A recorder's frame, line by line.
struct Shape {
    sequence: Number,
    date: fn(u64) -> Vec<String>,
    values: fn(u64) -> Vec<String>,
}

/// A header with date and time, a number that counts, and seven values.
const PLAIN: Shape = Shape {
    sequence: |k| Some((k + 1).to_string()),
    date: clock,
    values,
};

fn time(k: u64) -> (u64, u64, u64) {
    let second = 8 * 3600 + 37 * 60 + 24 + k;
    (second / 3600, second / 60 % 60, second % 60)
}

fn clock(k: u64) -> Vec<String> {
    let (hour, minute, second) = time(k);
    vec!["0105260925".to_owned(), format!("0106{hour:02}{minute:02}{second:02}")]
}

fn values(k: u64) -> Vec<String> {
    vec![
        format!("0108{:.3}", 2500.0 + k as f64 * 1e-3),
        "01102510.0".to_owned(),
        "01133.0".to_owned(),
        format!("0116{:.2}", 0.8 + 0.01 * (k % 7) as f64),
        "01180.30".to_owned(),
        format!("0120{}", 40 + k % 3),
        "01215000".to_owned(),
    ]
}

impl Shape {
    fn lines(&self, k: u64) -> Vec<String> {
        let mut lines = vec!["0101W".to_owned(), "01031".to_owned()];
        lines.extend((self.sequence)(k).map(|number| format!("0104{number}")));
        lines.extend((self.date)(k));
        lines.extend((self.values)(k));
        lines
    }

    /// Two minutes of it.
    fn bytes(&self) -> Vec<u8> {
        joined("\r\n", |k| self.lines(k))
    }
}

fn joined(end: &str, lines: impl Fn(u64) -> Vec<String>) -> Vec<u8> {
    let frame = |k| format!("&&{end}{}{end}!!{end}", lines(k).join(end));
    (0..FRAMES).map(frame).collect::<String>().into_bytes()
}

/// A line's replacement for some text.
fn with(bytes: &[u8], from: &str, to: &str) -> Vec<u8> {
    String::from_utf8_lossy(bytes).replace(from, to).into_bytes()
}

/// What the bridge makes of a line.
struct Read {
    counts: Counts,
    /// What it says, each once.
    faults: BTreeSet<String>,
    defects: Vec<SequenceDefect>,
    qualities: BTreeSet<u8>,
}

fn read_with(mapping: &str, bytes: &[u8]) -> Read {
    let mapping = Mapping::from_text("site.yaml", mapping).unwrap();
    let mut line = Line::new(&mapping, "rig");
    let mut read = Read {
        counts: Counts::default(),
        faults: BTreeSet::new(),
        defects: Vec::new(),
        qualities: BTreeSet::new(),
    };
    let Read {
        counts,
        faults,
        defects,
        qualities,
    } = &mut read;
    let mut take = |event| {
        let LineEvent::Frame(_, reading) = event else { return };
        faults.extend(reading.faults.iter().map(ToString::to_string));
        defects.extend(reading.records.iter().filter_map(|seen| seen.defect));
        qualities.extend(reading.inputs.map(|inputs| inputs.quality));
    };
    for piece in bytes.chunks(100) {
        line.push(piece, FIRST * 1_000_000_000, counts, &mut take);
    }
    line.finish(FIRST * 1_000_000_000, counts, &mut take);
    read
}

fn read(bytes: &[u8]) -> Read {
    read_with("", bytes)
}

/// Every frame is used with all its values, and nothing is said.
fn is_read_whole(name: &str, bytes: &[u8], values: u64) {
    let Read {
        counts,
        faults,
        defects,
        ..
    } = read(bytes);
    let found = (counts.used, counts.values, counts.missing, counts.all_faults());
    assert_eq!(found, (FRAMES, FRAMES * values, 0, 0), "{name}: {faults:?}");
    assert!(defects.is_empty(), "{name}: {defects:?}");
}

#[test]
fn lines_of_usual_recorders_are_read_whole() {
    let plain = PLAIN.bytes();
    is_read_whole("plain", &plain, 7);
    is_read_whole("a blank after the mark of the end", &with(&plain, "!!", "!! "), 7);
    is_read_whole("a blank after the mark of the beginning", &with(&plain, "&&", "&& "), 7);
    is_read_whole("line ends of CR alone", &with(&plain, "\r\n", "\r"), 7);
    is_read_whole(
        "STX and ETX",
        &with(&with(&plain, "&&", "\u{2}&&"), "!!\r\n", "!!\r\n\u{3}"),
        7,
    );
    is_read_whole("a byte order mark", &[b"\xef\xbb\xbf".as_slice(), &plain].concat(), 7);
    let pason = joined("\r\n", |k| {
        let mut lines = vec!["1984PASON/EDR".to_owned()];
        lines.extend(values(k));
        lines.extend(["0823-9999", "071300.00"].map(str::to_owned));
        lines
    });
    // Item 0713, the inclination of a survey, is read.
    is_read_whole("Pason's header without a sequence", &pason, 8);
    let two = joined("\r\n", |k| {
        let mut lines = PLAIN.lines(k);
        lines.extend(["08031".to_owned(), format!("0804{}", k / 5), "0823-9999".to_owned()]);
        lines
    });
    // The second record repeats its number and its contents for five frames, and has no item that is read.
    is_read_whole("two records in a frame", &two, 7);
    let padded = Shape {
        values: |_| vec!["0116 +8.0E-01 ".to_owned(), "0120    40.   ".to_owned()],
        ..PLAIN
    };
    is_read_whole("exponent, plus and padding", &padded.bytes(), 2);
    let twice = Shape {
        date: |k| clock(k / 2),
        ..PLAIN
    };
    is_read_whole("the same second twice", &twice.bytes(), 7);
    let midnight = Shape {
        date: |k| {
            let second = (86_370 + k) % 86_400;
            let (hour, minute) = (second / 3600, second / 60 % 60);
            vec![
                "0105260925".to_owned(),
                format!("0106{hour:02}{minute:02}{:02}", second % 60),
            ]
        },
        ..PLAIN
    };
    is_read_whole("a clock that passes midnight before its date", &midnight.bytes(), 7);
    // What follows the mark is counted as bytes outside of frames.
    let Read { counts, .. } = read(&with(&plain, "!!", "!!*7F"));
    assert_eq!((counts.used, counts.discarded[0]), (FRAMES, FRAMES));
}

#[test]
fn numbers_that_do_not_count_are_declared_unusable_and_lose_nothing() {
    let shapes: [(&str, Number, SequenceDefect); 7] = [
        ("constant 0", |_| Some("0".to_owned()), SequenceDefect::Constant),
        ("constant 1", |_| Some("1".to_owned()), SequenceDefect::Constant),
        ("wraps at 10", |k| Some((k % 10).to_string()), SequenceDefect::NoCount),
        ("wraps at 2", |k| Some((k % 2).to_string()), SequenceDefect::NoCount),
        ("counts down", |k| Some((9999 - k).to_string()), SequenceDefect::NoCount),
        (
            "date and time",
            |k| {
                let (hour, minute, second) = time(k);
                Some(format!("20260925{hour:02}{minute:02}{second:02}"))
            },
            SequenceDefect::Clock,
        ),
        (
            "time as in item 06",
            |k| {
                let (hour, minute, second) = time(k);
                Some(format!("{hour:02}{minute:02}{second:02}"))
            },
            SequenceDefect::Clock,
        ),
    ];
    for (name, sequence, defect) in shapes {
        let bytes = Shape { sequence, ..PLAIN }.bytes();
        let found = read(&bytes);
        assert_eq!(found.defects, [defect], "{name}");
        assert_eq!((found.counts.used, found.counts.missing), (FRAMES, 0), "{name}");
        // A site that knows it says so, and hears nothing.
        let ignoring = read_with("sequence: ignore\n", &bytes);
        assert_eq!((ignoring.counts.used, ignoring.defects.len()), (FRAMES, 0), "{name}");
        if name == "time as in item 06" {
            continue;
        }
        // Without date and time two restarts look like late records.
        let undated = Shape {
            sequence,
            date: |_| Vec::new(),
            ..PLAIN
        };
        let found = read(&undated.bytes());
        assert_eq!((found.defects.len(), found.counts.missing), (1, 0), "{name}");
        assert!(found.counts.used >= FRAMES - 2, "{name}: {}", found.counts.used);
    }
}

#[test]
fn a_sequence_that_cannot_be_read_is_reported_once() {
    let text = Shape {
        sequence: |k| {
            let (hour, minute, second) = time(k);
            Some(format!("2026-09-25 {hour:02}:{minute:02}:{second:02}"))
        },
        ..PLAIN
    };
    let found = read(&text.bytes());
    assert_eq!((found.counts.used, found.counts.all_faults()), (FRAMES, 1));
    assert!(
        found
            .faults
            .iter()
            .any(|fault| fault.starts_with("item 0104: unreadable")),
        "{:?}",
        found.faults
    );
}

#[test]
fn two_sources_in_turn_on_one_line_are_suspect_and_nothing_is_missing() {
    let two = Shape {
        sequence: |k| Some(if k % 2 == 1 { 1000 + k } else { 5 + k }.to_string()),
        ..PLAIN
    };
    let found = read(&two.bytes());
    assert_eq!(
        (found.defects.as_slice(), found.counts.missing),
        ([SequenceDefect::TwoCounters].as_slice(), 0)
    );
    assert!(found.counts.used < 64, "{}", found.counts.used);
    assert!(found.qualities.contains(&RigInputs::SUSPECT));
}

#[test]
fn values_that_are_no_plain_numbers_are_refused_in_words_and_never_guessed() {
    let comma = Shape {
        values: |k| values(k).into_iter().map(|line| line.replace('.', ",")).collect(),
        ..PLAIN
    };
    let found = read(&comma.bytes());
    assert!(
        found
            .faults
            .iter()
            .any(|fault| fault.contains("0116: no number: \"0,8")),
        "{:?}",
        found.faults
    );
    let units = Shape {
        values: |k| values(k).into_iter().map(|line| format!("{line} m")).collect(),
        ..PLAIN
    };
    let found = read(&units.bytes());
    assert_eq!(found.counts.used, 0);
    assert!(
        found
            .faults
            .iter()
            .any(|fault| fault.contains("0116: no number: \"0.80 m\"")),
        "{:?}",
        found.faults
    );
    let letters = Shape {
        values: |_| vec!["010A0.9".to_owned(), "0120 40".to_owned()],
        ..PLAIN
    };
    let found = read(&letters.bytes());
    assert_eq!((found.counts.used, found.counts.all_faults()), (FRAMES, FRAMES));
    let null = Shape {
        values: |k| {
            let weight = if k % 3 == 0 { "01160.85" } else { "0116-9999.00" };
            vec![weight.to_owned(), format!("0120{}", 40 + k % 3)]
        },
        ..PLAIN
    };
    let found = read(&null.bytes());
    assert_eq!((found.counts.used, found.counts.nulls), (FRAMES, 80));
    // A maximum without its mean is used and suspect.
    let most = Shape {
        values: |_| vec!["01170.90".to_owned(), "012040".to_owned()],
        ..PLAIN
    };
    let found = read(&most.bytes());
    assert_eq!(
        (found.counts.used, found.qualities),
        (FRAMES, BTreeSet::from([RigInputs::SUSPECT]))
    );
}

/// The values are used with the time of arrival; the header is reported once and not in every frame.
#[test]
fn dates_and_times_of_other_notations_are_reported_once() {
    let colons = Shape {
        date: |k| {
            let (hour, minute, second) = time(k);
            vec![
                "010526/09/25".to_owned(),
                format!("0106{hour:02}:{minute:02}:{second:02}"),
            ]
        },
        ..PLAIN
    };
    let found = read(&colons.bytes());
    assert_eq!((found.counts.used, found.counts.all_faults()), (FRAMES, 2));
    let fractions = Shape {
        date: |k| {
            clock(k)
                .into_iter()
                .map(|line| line.replace("0106", "0106 ") + ".50")
                .collect()
        },
        ..PLAIN
    };
    let found = read(&fractions.bytes());
    assert_eq!((found.counts.used, found.counts.all_faults()), (FRAMES, 2));
}

#[test]
fn a_frame_on_one_line_is_no_frame_and_is_said_so() {
    let bytes = joined(",", |k| PLAIN.lines(k));
    let found = read(&with(&bytes, "!!,", "!!\r\n"));
    assert_eq!(
        (found.counts.frames, found.counts.discarded.iter().sum::<u64>()),
        (0, FRAMES)
    );
}
