//! A rig's line of WITS, captures of one, and the mapping of its items.

use flexdrill_bridge::wits::capture::CaptureReader;
use flexdrill_bridge::wits::{Counts, FrameUse, Line, LineEvent, Look, Mapping};

use crate::engine::Target;
use crate::{folder, is_mapping, says_why};

/// 2023-11-14, a time of arrival (ns since 1970).
const NOW: i64 = 1_700_000_000_000_000_000;

const WITS: &[&str] = &[
    "&&",
    "!!",
    "\r\n",
    "\n",
    "\r",
    "1984PASON/EDR\r\n",
    "0101",
    "01047\r\n",
    "0105260925\r\n",
    "0106083724\r\n",
    "0116",
    "0120",
    "-9999",
    "-8888.00",
    "1e308",
    "NaN",
    " +8.0E-01 ",
    "\u{2}",
    "\u{3}",
    "\0",
    "\u{feff}",
    "99999999999999999999",
];

/// Frames with a header and one after another, as recorders of several habits send them.
fn lines() -> Vec<Vec<u8>> {
    let frame = |head: &str, number: u32| {
        format!("&&\r\n{head}0108250{number}.1\r\n01160.8{number}\r\n01204{number}\r\n!!\r\n")
    };
    let of = |head: &dyn Fn(u32) -> String| -> Vec<u8> {
        (0..8)
            .map(|number| frame(&head(number), number))
            .collect::<String>()
            .into_bytes()
    };
    vec![
        of(&|number| format!("0101W\r\n01031\r\n0104{number}\r\n0105231114\r\n010622132{number}\r\n")),
        of(&|_| "1984PASON/EDR\r\n".to_owned()),
        of(&|number| format!("01042023111422132{number}\r\n0801W\r\n0804{number}\r\n")),
    ]
}

/// Every frame is used or reported, what is given is a number, and a mapping that `--look` proposes is one.
#[test]
fn wits_line() {
    let mappings = [
        "",
        "stamp: header\nutc_offset_h: 1\n",
        "units: field\nsequence: ignore\n",
    ];
    let mappings = mappings.map(|text| Mapping::from_text("mapping", text).unwrap());
    let seeds = lines().into_iter().enumerate();
    Target {
        name: "wits_line",
        seeds: seeds.map(|(kind, line)| [&[kind as u8], &line[..]].concat()).collect(),
        words: WITS,
        run: &mut |bytes| {
            let (kind, content) = bytes.split_first().unwrap_or((&0, bytes));
            let mapping = &mappings[usize::from(*kind) % mappings.len()];
            let (mut line, mut counts, mut look) = (Line::new(mapping, "rig"), Counts::default(), Look::new(mapping));
            let mut given = false;
            let mut take = |event: LineEvent| {
                let LineEvent::Frame(frame, reading) = event else {
                    return;
                };
                look.frame(&frame);
                let inputs = reading.inputs.iter();
                let values = inputs.flat_map(|inputs| [inputs.rotary_speed_rpm, inputs.weight_on_bit_kn]);
                assert!(values.into_iter().all(|value| !value.is_infinite()));
                let has = reading.inputs.is_some() || reading.measured.is_some();
                assert_eq!(has, matches!(reading.outcome, FrameUse::Used { .. }));
                given |= has;
            };
            for piece in content.chunks(1 + usize::from(*kind)) {
                line.push(piece, NOW, &mut counts, &mut take);
            }
            line.finish(NOW, &mut counts, &mut take);
            assert_eq!(counts.frames, counts.used + counts.frames_not_used());
            assert!(
                !look
                    .table()
                    .contains(|letter: char| letter.is_control() && letter != '\n')
            );
            let site = look.site_file("rig");
            Mapping::from_text("site.yaml", &site).unwrap_or_else(|error| panic!("{error}\n{site}"));
            given
        },
    }
    .fuzz();
}

/// A capture is read to its end or refused in words; a file that is none is the bytes of a line.
#[test]
fn wits_capture() {
    let folder = folder();
    let path = folder.path().join("line.wits");
    let mut writer = flexdrill_bridge::wits::capture::CaptureWriter::create(&path).unwrap();
    for (connection, line) in lines().iter().enumerate() {
        for piece in line.chunks(50) {
            writer.write(NOW, connection as u64 + 1, piece).unwrap();
        }
        writer.write(NOW, connection as u64 + 1, &[]).unwrap();
    }
    drop(writer);
    let mut seeds = vec![std::fs::read(&path).unwrap()];
    seeds.extend(lines());
    Target {
        name: "wits_capture",
        seeds,
        words: WITS,
        run: &mut |bytes| {
            std::fs::write(&path, bytes).unwrap();
            let reader = match CaptureReader::open(&path) {
                Ok(reader) => reader,
                Err(error) => return says_why(&error),
            };
            let mut size = 0;
            for block in reader {
                match block {
                    Ok(block) => size += block.bytes.len(),
                    Err(error) => return says_why(&error),
                }
            }
            assert!(size <= bytes.len());
            true
        },
    }
    .fuzz();
}

/// What is accepted and written again reads as the same.
#[test]
fn wits_mapping() {
    let site = "title: Rig 7\nunits: field\nnulls: [-9999]\nask: {every_s: 30}\nitems:\n  0120: {quantity: rotary_speed, \
                unit: r/min, valid: [0, 200]}\n  0117:\n";
    Target {
        name: "wits_mapping",
        seeds: vec![b"title: Rig 7\nstamp: header\n".to_vec(), site.into()],
        words: &[
            ": ",
            "- ",
            "[",
            "]",
            "{",
            "}",
            "\n",
            "  ",
            "items",
            "0116",
            "fallback: true",
            "sequence: ignore",
            "1e9",
            "&a ",
            "*a",
            "~",
            "\t",
        ],
        run: &mut |bytes| is_mapping(bytes, Mapping::from_text),
    }
    .fuzz();
}
