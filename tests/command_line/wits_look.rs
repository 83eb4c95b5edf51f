//! `flexdrill bridge wits --look` over loopback: the table, and the mapping that it writes.

use std::io::Write as _;
use std::net::TcpListener;
use std::path::Path;
use std::process::{Command, Output};

use flexdrill_bridge::Quantity;
use flexdrill_bridge::wits::Mapping;
use flexdrill_core::inputs::{MeasuredKind, Unit};

use crate::program::unwrapped;

/// Runs the command in a folder against a rig that sends three frames, made by hand after the layout of WITS level 0: each
/// line is record, item and value.
fn look(folder: &Path, more: &[&str]) -> Output {
    let rig = TcpListener::bind("127.0.0.1:0").unwrap();
    let place = rig.local_addr().unwrap().to_string();
    let sender = std::thread::spawn(move || {
        let (mut line, _) = rig.accept().unwrap();
        for number in 1..=3 {
            let frame = format!("&&\r\n0104{number}\r\n01082500.{number}\r\n01160.81\r\n012041\r\n01441180\r\n!!\r\n");
            line.write_all(frame.as_bytes()).unwrap();
        }
        // The connection ends with the command.
        let _ = std::io::copy(&mut line, &mut std::io::sink());
    });
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["bridge", "wits", "--look", "1", "--connect", &place])
        .args(more)
        .current_dir(folder)
        .output()
        .unwrap();
    sender.join().unwrap();
    output
}

#[test]
fn what_a_line_carries_is_shown_and_written_as_a_mapping() {
    let folder = tempfile::tempdir().unwrap();
    let output = look(folder.path(), &[]);
    let said = unwrapped(&output.stdout);
    assert!(output.status.success(), "{said}{}", unwrapped(&output.stderr));
    // A kdaN is 10 kN.
    for row in [
        "3 frames",
        "0108 bit_depth 2500.1 m = 2500.1 m 2500.1 to 2500.3, only rises",
        "0116 weight_on_bit 0.81 kdaN = 8.1 kN constant",
        "0120 rotary_speed 41 r/min = 41 r/min constant",
        "not read: 0144 (1180)",
        "site.yaml has these items",
    ] {
        assert!(said.contains(row), "{row}\n{said}");
    }
    let site = folder.path().join("site.yaml");
    let mapping = Mapping::load(&site).unwrap();
    let items: Vec<_> = mapping
        .items
        .iter()
        .map(|(code, item)| (code.to_string(), item.unwrap().quantity, item.unwrap().unit))
        .collect();
    assert_eq!(
        items,
        [
            (
                "0108".to_owned(),
                Quantity::Measured(MeasuredKind::BitDepth),
                Unit::Metre
            ),
            ("0116".to_owned(), Quantity::WeightOnBit, Unit::Kilodecanewton),
            ("0120".to_owned(), Quantity::RotarySpeed, Unit::TurnPerMinute),
        ]
    );
    // The command reads it, corrected with a unit as people write it, and leaves it as it is.
    let corrected = std::fs::read_to_string(&site)
        .unwrap()
        .replace("unit: kdaN", "unit: klbs");
    std::fs::write(&site, &corrected).unwrap();
    let output = look(folder.path(), &["--map", "site.yaml"]);
    let said = unwrapped(&output.stdout);
    // 0.81 klbf are 3.60306 kN (NIST SP 811: 1 lbf = 4.448222 N).
    assert!(said.contains("0116 weight_on_bit 0.81 klbf = 3.60306 kN"), "{said}");
    assert!(said.contains("exists and is left as it is"), "{said}");
    assert_eq!(std::fs::read_to_string(&site).unwrap(), corrected);
}

#[test]
fn a_place_that_no_waiting_reaches_is_refused_at_once() {
    for (place, words) in [("nohost", "no port"), ("rig:0", "1 to 65535")] {
        let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
            .args(["bridge", "wits", "--connect", place])
            .output()
            .unwrap();
        let said = unwrapped(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(words) && said.contains("HOST:PORT"), "{said}");
    }
}
