//! `flexdrill trip`: table, words and picture agree, threads do not matter, and the loads are those of closed forms.

use std::path::Path;

use super::ahead::{flexdrill, text};

/// The arguments of a trip of the rig's example with a few plausible tools.
fn trip(config: &str, out: &Path, more: &[&str]) -> (String, Vec<std::collections::BTreeMap<String, String>>) {
    let fixed = ["trip", config, "--out", out.to_str().unwrap()];
    let output = flexdrill(&[&fixed, more].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut reader = csv::Reader::from_path(out.join("trip.csv")).unwrap();
    let rows = reader.deserialize().map(Result::unwrap).collect();
    (text(&output.stdout), rows)
}

fn number(row: &std::collections::BTreeMap<String, String>, column: &str) -> f64 {
    row[column]
        .parse()
        .unwrap_or_else(|_| panic!("{column}: {}", row[column]))
}

#[test]
fn the_rigs_trip_has_the_weight_between_its_loads_and_bands_that_hold_them() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["a", "b"].map(|name| folder.path().join(name));
    let more = ["--every", "2.5", "--members", "19", "--jobs"];
    let (words, rows) = trip("rig", &first, &[&more[..], &["1"]].concat());
    trip("rig", &second, &[&more[..], &["2"]].concat());
    for name in ["trip.csv", "trip.svg"] {
        let [a, b] = [&first, &second].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(!a.is_empty() && a == b, "{name}");
    }
    // The bottom of the arc of 3.2 m, two steps above it, and the kick-off.
    let depths: Vec<f64> = rows.iter().map(|row| number(row, "bit_depth_m")).collect();
    let bottom = 3.2 * std::f64::consts::FRAC_PI_2;
    assert!(
        (depths[0] - bottom).abs() < 1e-4 && depths.len() == 4 && depths[3] == 0.0,
        "{depths:?}"
    );
    // 1000 m of pipe of 73 and 54.6 mm in a vertical hole, from which the tool's own weight hangs with its height of 3.2 m.
    let area = std::f64::consts::PI / 4.0;
    let steel = 7850.0 * 9.81 * 0.86 * area / 1e3;
    let string = steel * (0.073_f64.powi(2) - 0.0546_f64.powi(2)) * 1000.0;
    let tool = steel * (0.102_f64.powi(2) - 0.080_f64.powi(2) + 0.063_f64.powi(2) - 0.032_f64.powi(2));
    let weight = number(&rows[0], "weight_kn");
    assert!((weight - string - tool * 3.2).abs() < 1e-3, "{weight} kN");
    for row in &rows {
        let [out, into, weight] = ["hook_out_kn", "hook_in_kn", "weight_kn"].map(|column| number(row, column));
        assert!(into < weight && weight < out, "{row:?}");
        // The string hangs free in its vertical hole and the guide does not turn, so that rotation changes nothing.
        assert_eq!(row["hook_out_kn"], row["hook_out_rotating_kn"]);
        let [low, median, high] = ["low", "median", "high"].map(|end| number(row, &format!("hook_out_{end}_kn")));
        assert!(low < median && median < high, "{row:?}");
        assert!(low < out && out < high, "{row:?}");
        assert_eq!(row["tools_unknown"], "0");
    }
    let svg = std::fs::read_to_string(first.join("trip.svg")).unwrap();
    for part in ["<svg", "Without rotation", "With rotation", "Torque", "</svg>"] {
        assert!(svg.contains(part), "{part}");
    }
    let at_bottom = format!("pulling out {:.1}", number(&rows[0], "hook_out_kn"));
    assert!(words.contains(&at_bottom), "{at_bottom}: {words}");
    assert!(words.contains("differential sticking"), "{words}");
}

#[test]
fn bad_arguments_are_refused_with_value_bound_and_unit() {
    let folder = tempfile::tempdir().unwrap();
    for (argument, expected) in [
        ("--every=0", "from 0.01 to 100 m"),
        ("--every=nan", "from 0.01 to 100 m"),
        ("--speed=0", "from 0.001 to 10 m/s"),
        ("--rpm=4000", "inputs.rotary_speed.max_rpm"),
        ("--members=0", "1..=10000"),
    ] {
        let out = folder.path().join("none");
        let output = flexdrill(&["trip", "rig", "--out", out.to_str().unwrap(), argument]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{argument}: {said}");
        assert!(said.contains(expected), "{argument}: {said}");
        assert!(!out.exists());
    }
}
