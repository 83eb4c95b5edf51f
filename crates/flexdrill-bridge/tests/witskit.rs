//! What we write, read by witskit (PyPI), a reader of WITS by others: the same items with the same units and values.
//! SKIPPED without Python or the package. It has no writer, so that our reader has no foreign line to read here.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use flexdrill_bridge::Quantity;
use flexdrill_bridge::wits::{Mapping, RigFrames};
use flexdrill_core::inputs::MeasuredKind;
use serde_json::Value;

/// 2023-11-14 22:13:20 UTC.
const AT: i64 = 1_700_000_000_000_000_000;

/// Code, description, value, and unit in metric and in field units.
type Item = (String, String, Value, [String; 2]);

/// What witskit reads; `None`, with a line that says so, where there is no Python or no package.
fn foreign(frame: &[u8]) -> Option<Vec<Item>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let given = std::env::var_os("FLEXDRILL_PYTHON").map(PathBuf::from);
    let mut pythons = given.into_iter().chain([root.join(".venv/bin/python")]);
    let Some(python) = pythons.find(|python| python.exists()) else {
        eprintln!("SKIPPED: no Python; run launch_scripts/test.sh or set FLEXDRILL_PYTHON");
        return None;
    };
    let mut child = Command::new(python)
        .arg(root.join("tests/python/wits_reader.py"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // A script without its packages ends before it reads.
    let _ = child.stdin.take().unwrap().write_all(frame);
    let output = child.wait_with_output().unwrap();
    if output.status.code() == Some(77) {
        eprintln!("SKIPPED: {}", String::from_utf8_lossy(&output.stdout).trim());
        return None;
    }
    assert!(output.status.success());
    let read: Vec<(String, String, Value, String, String)> = serde_json::from_slice(&output.stdout).unwrap();
    let read = read.into_iter();
    Some(
        read.map(|(code, text, value, metric, field)| (code, text, value, [metric, field]))
            .collect(),
    )
}

/// A unit of witskit in SI. KDN is a thousand decanewtons; a pound of force is 4.4482216152605 N, a foot 0.3048 m.
fn si(unit: &str) -> f64 {
    match unit {
        "M" | "----" => 1.0,
        "F" => 0.3048,
        "M/HR" => 1.0 / 3600.0,
        "F/HR" => 0.3048 / 3600.0,
        "KDN" => 1e4,
        "KLB" => 4_448.221_615_260_5,
        "KNM" => 1e3,
        "KFLB" => 4_448.221_615_260_5 * 0.3048,
        "RPM" => std::f64::consts::TAU / 60.0,
        "KPA" => 1e3,
        "PSI" => 4.448_221_615_260_5 / (0.0254 * 0.0254),
        _ => panic!("unknown unit {unit}"),
    }
}

/// A value of each quantity, none like another.
fn sent(quantity: Quantity) -> Option<f64> {
    match quantity {
        // 60 r/min: the format has whole numbers here, to which witskit cuts.
        Quantity::RotarySpeed => Some(std::f64::consts::TAU),
        Quantity::WeightOnBit => Some(25e3),
        Quantity::Measured(MeasuredKind::BitDepth) => Some(2510.25),
        Quantity::Measured(MeasuredKind::HoleDepth) => Some(2511.5),
        Quantity::Measured(MeasuredKind::RateOfPenetration) => Some(2e-3),
        Quantity::Measured(MeasuredKind::HookLoad) => Some(412e3),
        Quantity::Measured(MeasuredKind::SurfaceTorque) => Some(1750.0),
        Quantity::Measured(MeasuredKind::StandpipePressure) => Some(12.5e6),
        Quantity::Measured(MeasuredKind::DownholeWeightOnBit) => Some(17e3),
        Quantity::Measured(MeasuredKind::DownholeTorque) => Some(640.0),
        Quantity::Measured(_) | Quantity::Survey(_) => None,
    }
}

/// How witskit describes the item of a quantity.
fn description(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::RotarySpeed => "Rotary Speed (surf,avg)",
        Quantity::WeightOnBit => "Weight-on-Bit (surf,avg)",
        Quantity::Measured(MeasuredKind::BitDepth) => "Depth Bit (meas)",
        Quantity::Measured(MeasuredKind::HoleDepth) => "Depth Hole (meas)",
        Quantity::Measured(MeasuredKind::RateOfPenetration) => "Rate of Penetration (avg)",
        Quantity::Measured(MeasuredKind::HookLoad) => "Hookload (avg)",
        Quantity::Measured(MeasuredKind::SurfaceTorque) => "Rotary Torque (surf,avg)",
        Quantity::Measured(MeasuredKind::StandpipePressure) => "Standpipe Pressure (avg)",
        Quantity::Measured(MeasuredKind::DownholeWeightOnBit) => "Downhole Wt-on-Bit (avg)",
        Quantity::Measured(MeasuredKind::DownholeTorque) => "Downhole Torque (avg)",
        Quantity::Measured(_) | Quantity::Survey(_) => "",
    }
}

#[test]
fn interop_witskit_reads_the_items_with_our_units_and_values() {
    for (units, text) in [(0, ""), (1, "units: field\n")] {
        let mapping = Mapping::from_text("site.yaml", text).unwrap();
        let frame = RigFrames::new(&mapping, "A-7").frame(AT, sent).unwrap();
        let Some(read) = foreign(&frame) else { return };
        for quantity in Quantity::all() {
            let Some(expected) = sent(quantity) else { continue };
            let found: Vec<_> = read
                .iter()
                .filter(|(_, text, ..)| text == description(quantity))
                .collect();
            let [(code, _, value, unit)] = found.as_slice() else {
                panic!("{quantity}: {found:?} in {read:?}");
            };
            let si = si(&unit[units]);
            // Half a unit of the last of three digits.
            let error = (value.as_f64().unwrap() * si - expected).abs();
            assert!(
                error <= 0.5001e-3 * si,
                "{quantity}, item {code}: {value} {}, {expected}",
                unit[units]
            );
        }
        let named = |code: &str| {
            read.iter()
                .find(|(of, ..)| of == code)
                .map(|(_, _, value, _)| value.to_string())
        };
        assert_eq!(named("0101").as_deref(), Some("\"A-7\""));
        assert_eq!(named("0104").as_deref(), Some("1"));
    }
}
