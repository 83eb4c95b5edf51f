//! `flexdrill reach` on a short tool: table, picture and words agree, the number of threads does not matter, and what
//! cannot be computed is refused or unknown with its cause.

use std::path::Path;
use std::process::{Command, Output};

use crate::program::text;

fn reach(out: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["reach", "tests/data/reach.yaml", "--wob", "2", "--out"])
        .arg(out)
        .args(more)
        .output()
        .unwrap()
}

const SMALL: [&str; 4] = ["--lengths", "0.6,1.2", "--friction", "0.2,0.4"];

#[test]
fn table_picture_and_words_agree_with_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("a"), folder.path().join("b"));
    let one = reach(&first, &[&SMALL[..], &["--jobs", "1"]].concat());
    assert!(one.status.success(), "{}", text(&one.stderr));
    let two = reach(&second, &[&SMALL[..], &["--jobs", "2"]].concat());
    assert!(two.status.success(), "{}", text(&two.stderr));
    for name in ["reach.csv", "reach.svg"] {
        let [a, b] = [&first, &second].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(!a.is_empty() && a == b, "{name}");
    }
    // No temporary file stays.
    assert_eq!(std::fs::read_dir(&first).unwrap().count(), 2);
    let mut table = csv::Reader::from_path(first.join("reach.csv")).unwrap();
    let header = table.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|column| column == name).unwrap();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 8);
    let number = |row: &csv::StringRecord, name: &str| row[column(name)].parse::<f64>().unwrap();
    for row in &rows {
        assert_eq!(&row[column("state")], "steady", "{row:?}");
        // What is put in arrives at the kick-off, and not more than it at the bit but for the weight of the guide.
        assert!((number(row, "weight_at_kickoff_kn") - 2.0).abs() < 0.06, "{row:?}");
        assert!(number(row, "weight_at_bit_kn") < 2.3, "{row:?}");
        assert!(number(row, "model_time_s") <= 60.0);
        let turns = &row[column("rotates")] == "true";
        assert_eq!(number(row, "torque_at_bit_nm") > 1.0, turns, "{row:?}");
        if turns {
            // Eq. 1 at the weight that arrives.
            let by_weight = 0.235 * 0.1021 / 3.0 * 1e3 * number(row, "weight_at_bit_kn");
            assert!(
                (number(row, "torque_at_bit_nm") / by_weight - 1.0).abs() < 0.01,
                "{row:?}"
            );
            assert!(
                number(row, "torque_at_kickoff_nm") > number(row, "torque_at_bit_nm"),
                "{row:?}"
            );
        }
    }
    // The longer hole and the greater friction let less arrive.
    let at = |length: f64, friction: &str| {
        let row = rows.iter().find(|row| {
            (number(row, "length_m") - length).abs() < 0.1
                && &row[column("friction")] == friction
                && &row[column("rotates")] == "false"
        });
        number(row.unwrap(), "weight_at_bit_kn")
    };
    assert!(at(1.2, "0.4") < at(1.2, "0.2"), "{rows:?}");
    let words = text(&one.stdout);
    let shown = words.lines().filter(|line| line.contains("torque at the bit")).count();
    assert_eq!(shown, 2, "{words}");
    let torque = format!("{:.2}", number(&rows[1], "torque_at_bit_nm"));
    assert!(words.contains(&torque), "{torque}: {words}");
    let svg = std::fs::read_to_string(first.join("reach.svg")).unwrap();
    for part in [
        "<svg",
        "Weight at the bit",
        "Torque with rotation",
        "soft string",
        "</svg>",
    ] {
        assert!(svg.contains(part), "{part}");
    }
}

/// An interrupted study continues with what is there, and gives the same files; a point of another load is none.
#[test]
fn a_study_continues_from_the_points_that_are_done() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["a", "b"].map(|name| folder.path().join(name));
    let few = ["--lengths", "0.6", "--friction", "0.3"];
    let more = ["--lengths", "0.6,1.2", "--friction", "0.3"];
    let resume = |arguments: &[&str]| reach(&parts, &[arguments, &["--resume"]].concat());
    assert!(resume(&few).status.success());
    let points = || std::fs::read_dir(parts.join("points")).unwrap().count();
    assert_eq!(points(), 2);
    // A result that no run would have shows that the point is not run again.
    let point = std::fs::read_dir(parts.join("points"))
        .unwrap()
        .next()
        .unwrap()
        .unwrap()
        .path();
    let text_of = std::fs::read_to_string(&point).unwrap();
    let start = text_of.find("\"Ok\":[").unwrap();
    std::fs::write(&point, format!("{}\"Err\":\"marked\"}}}}", &text_of[..start])).unwrap();
    let marked = resume(&more);
    assert!(text(&marked.stdout).contains(": marked"), "{marked:?}");
    assert_eq!(points(), 4);
    // Another load: every point anew, in the place of the old one.
    assert!(text(&resume(&[&more[..], &["--rpm", "50"]].concat()).stdout).contains("torque at the bit"));
    let again = resume(&more);
    assert!(
        again.status.success() && !text(&again.stdout).contains("marked"),
        "{again:?}"
    );
    assert!(reach(&whole, &more).status.success());
    for name in ["reach.csv", "reach.svg"] {
        let [a, b] = [&whole, &parts].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(a == b, "{name}");
    }
}

#[test]
fn a_run_that_is_not_steady_is_unknown_with_its_cause() {
    let folder = tempfile::tempdir().unwrap();
    let output = reach(
        folder.path(),
        &["--lengths", "0.6", "--friction", "0.3", "--seconds", "4"],
    );
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("no run became steady"));
    let words = text(&output.stdout);
    // In this time one mean is taken: nothing has varied, so that a variation is not the cause.
    assert!(
        words.contains("Unknown at") && words.contains("not judged after 3.0 s: 1 of the 4 means"),
        "{words}"
    );
    assert!(
        !words.contains("unknown N m") && !words.contains("unknown kN"),
        "{words}"
    );
    let table = std::fs::read_to_string(folder.path().join("reach.csv")).unwrap();
    assert_eq!(table.matches(",unknown,,,,,,,").count(), 2, "{table}");
}

#[test]
fn bad_arguments_are_refused_with_value_bound_and_unit() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, expected) in [
        (&["--lengths", "0"][..], "from 0.1 to 1000 m"),
        (&["--lengths", "5,x"], "from 0.1 to 1000 m"),
        (&["--lengths", "900"], "500 links"),
        (&["--friction", "-0.1"], "from 0 to 2"),
        (&["--friction", "nan"], "from 0 to 2"),
        (&["--rpm", "0"], "from 1 to 5000 r/min"),
        (&["--rpm", "4000"], "inputs.rotary_speed.max_rpm, 120 r/min"),
        (&["--jobs", "0"], "1..=256"),
        (&["--advance", "0"], "from 0.01 to 100 m/h"),
        (&["--seconds", "-1"], "from 0.001"),
    ] {
        let arguments: Vec<String> = arguments
            .chunks(2)
            .map(|pair| format!("{}={}", pair[0], pair[1]))
            .collect();
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let output = reach(&folder.path().join("none"), &arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
    assert!(!folder.path().join("none").exists());
}

/// Plausible tools have their own friction: 90 % of what arrives at their bits lies about what arrives at the tool of the
/// configuration, and fewer than nineteen of them have no band.
#[test]
fn plausible_tools_have_a_band() {
    let folder = tempfile::tempdir().unwrap();
    let config = folder.path().join("tool.yaml");
    let own = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/reach.yaml")).unwrap();
    let key = "contact.outer.friction_axial, distribution: {uniform: {low: 0.1, high: 0.5}}, source: a test";
    let unknown = format!("uncertainty:\n  keys:\n    - {{key: {key}}}\n");
    std::fs::write(&config, own.clone() + &unknown).unwrap();
    let study = |members: &str| {
        let out = folder.path().join(members);
        let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
            .args([
                "reach",
                config.to_str().unwrap(),
                "--wob",
                "2",
                "--lengths",
                "0.6",
                "--friction",
                "0.3",
            ])
            .args(["--plausible", "--jobs", "2", "--members", members, "--out"])
            .arg(&out)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        let table = csv::Reader::from_path(out.join("reach_plausible.csv")).unwrap();
        let rows: Vec<csv::StringRecord> = table.into_records().map(Result::unwrap).collect();
        (text(&output.stdout), rows)
    };
    let (words, rows) = study("2");
    assert!(
        words.contains("no band of fewer than 19") && words.contains("drawn from uncertainty"),
        "{words}"
    );
    assert!(rows.iter().all(|row| &row[3] == "2" && row[5].is_empty()), "{rows:?}");
    let (words, rows) = study("19");
    assert!(words.contains("In 90 % of the plausible tools"), "{words}");
    assert_eq!(rows.len(), 2);
    for row in &rows {
        assert_eq!((&row[3], &row[4]), ("19", "0"), "{row:?}");
        let [low, median, high] = [5, 6, 7].map(|at| row[at].parse::<f64>().unwrap());
        assert!(low <= median && median <= high && high < 2.3 && low > 0.5, "{row:?}");
        // Friction of 0.1 to 0.5 moves what arrives of 2 kN under rotation. Friction that acts around and along by itself, as
        // here, takes nothing of a guide that hardly advances.
        assert_eq!(low < median && median < high, &row[2] == "true", "{row:?}");
    }
    // Nothing is drawn where all is known.
    std::fs::write(&config, own).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["reach", config.to_str().unwrap(), "--wob", "2", "--plausible", "--out"])
        .arg(folder.path().join("none"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("no section uncertainty"));
}
