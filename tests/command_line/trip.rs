//! `flexdrill trip`: table, words and picture agree, threads do not matter, and the loads are those of closed forms.

use std::path::Path;

use crate::program::{flexdrill, number, text};

/// The arguments of a trip of the rig's example with a few plausible tools.
fn trip(config: &str, out: &Path, more: &[&str]) -> (String, Vec<std::collections::BTreeMap<String, String>>) {
    let fixed = ["trip", config, "--out", out.to_str().unwrap()];
    let output = flexdrill(&[&fixed, more].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut reader = csv::Reader::from_path(out.join("trip.csv")).unwrap();
    let rows = reader.deserialize().map(Result::unwrap).collect();
    (text(&output.stdout), rows)
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
fn a_largest_pull_has_what_reaches_the_stuck_tool() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["--every", "5", "--members", "1", "--max-pull", "150"];
    let (words, rows) = trip("rig", folder.path(), &more);
    let read = |name: &str| -> Vec<std::collections::BTreeMap<String, String>> {
        let mut reader = csv::Reader::from_path(folder.path().join(name)).unwrap();
        reader.deserialize().map(Result::unwrap).collect()
    };
    let stuck = &read("stuck.csv")[0];
    let at_bit = number(stuck, "pull_at_bit_kn");
    // More than what is pulled beyond the hook load of pulling out cannot arrive, and the arc of 90 deg takes from it.
    let beyond = 150.0 - number(&rows[0], "hook_out_kn");
    assert!(at_bit > 0.3 * beyond && at_bit < beyond, "{at_bit} of {beyond} kN");
    assert!(stuck["holds_at_m"].is_empty(), "{stuck:?}");
    // The string hangs vertically: no friction of its few metres of tool takes 26 kN.
    assert!(stuck["critical_friction_factor"].is_empty(), "{stuck:?}");
    assert!(
        words.contains("the largest that was computed, does not take this pull"),
        "{words}"
    );
    let reached = read("reached.csv");
    let last = reached.last().unwrap();
    // The tension above the bit has the friction of the bit in it.
    assert!(
        (number(last, "pull_kn") - at_bit).abs() < 0.1 * at_bit,
        "{last:?} {at_bit}"
    );
    assert!(
        (number(&reached[0], "pull_kn") - 150.0).abs() < 0.01,
        "{:?}",
        reached[0]
    );
    // One plausible tool has no range.
    assert!(reached.iter().all(|row| row["pull_low_kn"].is_empty()), "{last:?}");
    assert!(words.contains(&format!("{at_bit:.1} kN pull at the bit")), "{words}");
    assert!(
        std::fs::read_to_string(folder.path().join("stuck.svg"))
            .unwrap()
            .contains("Along the tool")
    );
    // Less than what hangs frees nothing.
    let weak = folder.path().join("weak");
    let (words, _) = trip("rig", &weak, &["--every", "5", "--members", "1", "--max-pull", "20"]);
    assert!(
        words.contains("does not reach the bit") && words.contains("Even without friction"),
        "{words}"
    );
}

/// The band of each depth is that of the plausible tools there: it holds the tool as configured, and a pull of little more than
/// that of pulling out does not reach the bit of some. So is that of each station with the bit on the bottom.
#[test]
fn what_reaches_a_stuck_tool_has_a_range_at_each_depth_and_station() {
    let folder = tempfile::tempdir().unwrap();
    let rows = |pull: &str, name: &str| {
        let out = folder.path().join(name);
        let more = ["--every", "2.5", "--members", "19", "--max-pull", pull];
        trip("rig", &out, &more);
        ["stuck.csv", "reached.csv"].map(|table| -> Vec<std::collections::BTreeMap<String, String>> {
            let mut reader = csv::Reader::from_path(out.join(table)).unwrap();
            reader.deserialize().map(Result::unwrap).collect()
        })
    };
    let [strong, along] = rows("150", "strong");
    assert_eq!(strong.len(), 4);
    for row in &strong {
        let [low, at, high] =
            ["pull_at_bit_low_kn", "pull_at_bit_kn", "pull_at_bit_high_kn"].map(|column| number(row, column));
        assert!(0.0 < low && low < at && at < high, "{row:?}");
        let [low, at, high] =
            ["torque_at_bit_low_nm", "torque_at_bit_nm", "torque_at_bit_high_nm"].map(|column| number(row, column));
        // Nothing of the tool takes much of a torque that is not lost in the string: the configured tool has less friction than
        // most plausible ones, and is off their band by a ten-thousandth.
        assert!(low <= high && 0.999 * low <= at && at <= 1.001 * high, "{row:?}");
        assert_eq!(
            (row["tools_not_reached"].as_str(), row["tools_unknown"].as_str()),
            ("0", "0")
        );
    }
    for row in &along {
        for figure in ["pull", "overpull"] {
            let [low, median, high] = ["low", "median", "high"].map(|end| number(row, &format!("{figure}_{end}_kn")));
            assert!(low <= median && median <= high, "{figure}: {row:?}");
        }
        assert_eq!(row["tools_unknown"], "0");
    }
    // At the rig all tools have the pull, to the accuracy to which it is found, and what is beyond their load of pulling out.
    let [rig, bit] = [along.first().unwrap(), along.last().unwrap()];
    for end in ["low", "median", "high"] {
        assert!((number(rig, &format!("pull_{end}_kn")) - 150.0).abs() < 0.01, "{rig:?}");
    }
    for row in [rig, bit] {
        let [low, at, high] = ["overpull_low_kn", "overpull_kn", "overpull_high_kn"].map(|column| number(row, column));
        assert!(low < at && at < high, "{row:?}");
    }
    // At the bit the torque is that of the other table; on the way there the pipe's friction is known as a whole.
    for end in ["low", "high"] {
        assert_eq!(
            bit[&format!("torque_{end}_nm")],
            strong[0][&format!("torque_at_bit_{end}_nm")]
        );
    }
    let above_bit = &along[along.len() - 2];
    assert!(
        above_bit["torque_nm"].is_empty() && above_bit["torque_low_nm"].is_empty(),
        "{above_bit:?}"
    );
    let [weak, _] = rows("20", "weak");
    assert!(weak.iter().all(|row| row["tools_not_reached"] == "19"), "{weak:?}");
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
        ("--max-pull=0", "from 0.1 to 20000 kN"),
        ("--max-torque=-1", "from 1 to 1000000 N m"),
    ] {
        let out = folder.path().join("none");
        let output = flexdrill(&["trip", "rig", "--out", out.to_str().unwrap(), argument]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{argument}: {said}");
        assert!(said.contains(expected), "{argument}: {said}");
        assert!(!out.exists());
    }
}
