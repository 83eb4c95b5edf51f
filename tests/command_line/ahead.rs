//! `flexdrill ahead`: figures of another program through a configuration file, bounds in closed form, plans, and refusals.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program::{flexdrill, number, text};

/// The tool of `tests/data/ahead.yaml` with some of its text replaced, in a folder.
pub fn configuration(folder: &Path, changes: &[(&str, &str)]) -> PathBuf {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/ahead.yaml");
    let mut yaml = std::fs::read_to_string(file).unwrap();
    for (from, to) in changes {
        assert!(yaml.contains(from), "{from}");
        yaml = yaml.replace(from, to);
    }
    let path = folder.join("tool.yaml");
    std::fs::write(&path, yaml).unwrap();
    path
}

/// Words and table of a prediction.
pub fn ahead(config: &Path, out: &Path, more: &[&str]) -> (String, Vec<BTreeMap<String, String>>) {
    let fixed = ["ahead", config.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let output = flexdrill(&[&fixed, more].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut reader = csv::Reader::from_path(out.join("ahead.csv")).unwrap();
    let rows = reader.deserialize().map(Result::unwrap).collect();
    (text(&output.stdout), rows)
}

/// Inclinations at some metres ahead of a program of finite differences with chords of 10 mm, which is not part of this
/// repository: hole of 20.16 deg below a vertical one, radius and guide of 3.2 m, 0.05 of a tube's stiffness, 10 kN.
#[test]
fn inclinations_ahead_are_those_of_another_program() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), &[]);
    let (_, rows) = ahead(&config, &folder.path().join("out"), &["--members=1", "--metres=4"]);
    assert_eq!(rows.len(), 17);
    for (metres, expected) in [
        (0.0, 19.64),
        (0.5, 28.04),
        (1.0, 36.92),
        (2.0, 55.28),
        (3.0, 73.60),
        (4.0, 91.90),
    ] {
        let row = &rows[(metres / 0.25) as usize];
        assert_eq!(number(row, "ahead_m"), metres);
        let found = number(row, "inclination_deg");
        assert!(
            (found - expected).abs() < 0.1,
            "{metres} m: {found}, not {expected} deg"
        );
    }
    // The way from the bit to the end after 4.021 m is 3.0947 m along and 2.1232 m down; 21 mm before it is less.
    let [start, end] = [&rows[0], &rows[16]].map(|row| ["x_m", "y_m", "z_m"].map(|column| number(row, column)));
    assert!((end[0] - start[0] - (3.0947 - 0.021)).abs() < 5e-3, "{end:?}");
    assert!((end[2] - start[2] - 2.1232).abs() < 5e-3, "{end:?}");
    // The pipe's torque of 92 N m pushes the bit to the right by T/R = 29 N, 0.013 deg/m in a level hole.
    assert!(end[1] > 0.0 && end[1] < 0.01, "{end:?}");
}

/// At 3 m ahead, of the same program with chords of 40 mm.
#[test]
fn other_bits_and_guides_are_those_of_another_program() {
    let folder = tempfile::tempdir().unwrap();
    for (change, weight, expected) in [
        (("lateral_resistance: 20", "lateral_resistance: 5"), "10", 69.09),
        (("lateral_resistance: 20", "lateral_resistance: 100"), "10", 76.64),
        (("lateral_resistance: 20", "lateral_resistance: 20"), "8", 73.15),
        (("lateral_resistance: 20", "lateral_resistance: 20"), "20", 75.73),
        (("free_curvature: 0.3125", "free_curvature: 0.3333333"), "10", 77.33),
        (("bending_factor: 0.05", "bending_factor: 0.03"), "10", 75.00),
        (("hole_diameter: 0.118", "hole_diameter: 0.122"), "10", 73.69),
    ] {
        let config = configuration(folder.path(), &[change]);
        let more = ["--members=1", "--metres=3", "--weight", weight];
        let (_, rows) = ahead(&config, &folder.path().join("out"), &more);
        let found = number(&rows[12], "inclination_deg");
        assert!(
            (found - expected).abs() < 0.3,
            "{change:?}, {weight} kN: {found}, not {expected} deg"
        );
    }
}

/// kf -+ sqrt(2 p c/EI) with p = W kb + q, solved here by repeated substitution, at 10 kN.
#[test]
fn the_range_of_radii_is_that_of_the_closed_form() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), &[]);
    let text = std::fs::read_to_string(&config).unwrap() + "inputs: {weight_on_bit: {max_kn: 10}}\n";
    std::fs::write(&config, text).unwrap();
    let (words, _) = ahead(&config, &folder.path().join("out"), &["--members=1", "--metres=1"]);
    let tube = |power: i32| 0.102_f64.powi(power) - 0.080_f64.powi(power);
    let stiffness = 0.05 * 206e9 * std::f64::consts::PI / 64.0 * tube(4);
    let areas = std::f64::consts::PI / 4.0 * (tube(2) + 0.063_f64.powi(2) - 0.032_f64.powi(2));
    let weight = 7850.0 * areas * 9.81 * 0.86;
    let radius = |sign: f64| {
        let mut kb: f64 = 0.3125;
        for _ in 0..200 {
            kb = 0.3125 + sign * (2.0 * (10e3 * kb + weight) * 0.008 / stiffness).sqrt();
        }
        1.0 / kb
    };
    let expected = format!(
        "outside {:.2} m to {:.2} m in a long arc at 10.0 kN",
        radius(1.0),
        radius(-1.0)
    );
    assert!(words.contains(&expected), "{expected}: {words}");
    // The closed form leaves out the thrust on the deflected span: 0.319 1/m are 3.13 m.
    assert!(
        words.contains("a radius of 3.14 m") && words.contains("does not ripple"),
        "{words}"
    );
}

/// The command is killed after its first tools, and continues: the files are those of a whole run. A file of another
/// tool counts as absent, one of the same tool is taken without drilling.
#[test]
fn an_interrupted_command_continues_with_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), &[]);
    let [whole, parts] = ["a", "b"].map(|name| folder.path().join(name));
    let fixed = ["--members=40", "--metres=1", "--radius=3.2"];
    let resume = [&fixed[..], &["--resume"]].concat();
    let tools = parts.join("tools");
    let done = || std::fs::read_dir(&tools).map_or(0, |files| files.flatten().filter(is_json).count());
    let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["ahead", config.to_str().unwrap(), "--out", parts.to_str().unwrap()])
        .args(&resume)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    // A minute: a tool takes some milliseconds, and a busy machine some hundred times that.
    let until = std::time::Instant::now() + std::time::Duration::from_secs(60);
    while done() < 3 && std::time::Instant::now() < until {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    command.kill().unwrap();
    command.wait().unwrap();
    let before = done();
    assert!(before >= 3, "{before} tools are kept");
    ahead(&config, &whole, &fixed);
    ahead(&config, &parts, &resume);
    assert_eq!(done(), 40);
    for name in ["ahead.csv", "ahead.svg"] {
        let [a, b] = [&whole, &parts].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(a == b, "{name}");
    }
    // A kept tool that is said to have failed is unknown: it did not drill again.
    let first = tools.join("00000.json");
    let kept = std::fs::read_to_string(&first).unwrap();
    let mut part: serde_json::Value = serde_json::from_str(&kept).unwrap();
    part["found"] = serde_json::json!({"Err": "marked"});
    std::fs::write(&first, part.to_string()).unwrap();
    let (said, _) = ahead(&config, &parts, &resume);
    assert!(said.contains("Unknown for 1 plausible tool: marked"), "{said}");
    // Of another tool the same file is none.
    let softer = configuration(folder.path(), &[("bending_factor: 0.05", "bending_factor: 0.04")]);
    let (said, _) = ahead(&softer, &parts, &resume);
    assert!(!said.contains("marked"), "{said}");
}

fn is_json(file: &std::fs::DirEntry) -> bool {
    file.path().extension().is_some_and(|extension| extension == "json")
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), &[]);
    let outs = ["a", "b", "c"].map(|name| folder.path().join(name));
    let fixed = ["--members=19", "--metres=1", "--radius=3.2"];
    let mut said = Vec::new();
    for (out, more) in outs.iter().zip([
        ["--seed=3", "--jobs=1"],
        ["--seed=3", "--jobs=2"],
        ["--seed=4", "--jobs=2"],
    ]) {
        let (words, rows) = ahead(&config, out, &[&fixed[..], &more].concat());
        assert_eq!(rows.len(), 5);
        // The last line has the time that it took.
        said.push(
            words
                .lines()
                .filter(|line| !line.contains(" runs in "))
                .collect::<Vec<_>>()
                .join("\n"),
        );
    }
    let read = |index: usize, name: &str| std::fs::read(outs[index].join(name)).unwrap();
    for name in ["ahead.csv", "ahead.svg"] {
        assert!(read(0, name) == read(1, name), "{name}");
        assert!(read(0, name) != read(2, name), "{name}");
    }
    assert_eq!(said[0], said[1]);
}

#[test]
fn a_plan_has_its_distance_its_chance_and_its_weight() {
    let folder = tempfile::tempdir().unwrap();
    let config = configuration(folder.path(), &[]);
    let out = folder.path().join("out");
    // The hole as it is, continued with its own radius. Bit at 5.0265 m and 20.16 deg, 286.48 deg over 16 m of arc.
    let plan = folder.path().join("plan.csv");
    let rows: Vec<String> = [(0.0, 0.0), (3.900601, 0.0), (5.0265548, 20.16), (10.0265548, 109.6848)]
        .iter()
        .map(|(depth, inclination)| format!("{depth},{inclination},350"))
        .collect();
    let table = format!("measured_depth_m,inclination_deg,azimuth_deg\n{}\n", rows.join("\n"));
    std::fs::write(&plan, table).unwrap();
    let more = [
        "--members=19",
        "--metres=3",
        "--plan",
        plan.to_str().unwrap(),
        "--target=0.05",
    ];
    let (words, rows) = ahead(&config, &out, &more);
    assert!(number(&rows[0], "to_plan_m") < 2e-3, "{rows:?}");
    // The plane of the plan is that of the hole.
    assert!((number(&rows[4], "azimuth_deg") + 10.0).abs() < 0.5, "{rows:?}");
    // After 3 m the plan is at 73.87 deg, and the bit at 73.59 deg.
    assert!(number(&rows[12], "to_plan_m") < 0.1, "{rows:?}");
    for part in [
        "The plan needs a radius of 3.20 m on the mean",
        "After 3 m the bit is",
        "of 19 known tools stay within",
    ] {
        assert!(words.contains(part), "{part}: {words}");
    }
    let svg = std::fs::read_to_string(out.join("ahead.svg")).unwrap();
    for part in [
        "<svg",
        "From the side",
        "From above",
        "plan",
        "90 % of the plausible tools",
        "</svg>",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    // At 60 kN the guide drills 2.4 m at best: no bit makes it drill 1.5 m.
    let (words, _) = ahead(&config, &out, &["--members=1", "--metres=1", "--radius=1.5"]);
    assert!(
        words.contains("no ranges, which need 19 plausible tools: 1 plausible tool"),
        "{words}"
    );
    assert!(
        words.contains("This guide cannot drill the plan at any weight"),
        "{words}"
    );
    assert!(words.contains("Change the guide."), "{words}");
    // A plan within the range has a weight that comes nearest.
    let (words, _) = ahead(
        &config,
        &out,
        &["--members=1", "--metres=3", "--radius=3.1", "--target=0.02"],
    );
    assert!(
        words.contains("bring the bit to") || words.contains("comes nearest"),
        "{words}"
    );
    // From 5 to 15 kN its radius changes by a tenth of a metre: a plan half a metre away is out of reach, and no larger
    // weight is proposed for it.
    let (words, _) = ahead(
        &config,
        &out,
        &["--members=1", "--metres=3", "--radius=2.6", "--target=0.02"],
    );
    assert!(words.contains("No weight from 5.0 to 15.0 kN brings"), "{words}");
}

#[test]
fn tools_without_a_result_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    // Wear flats near the weight: plausible tools with less weight cut nothing.
    let config = configuration(folder.path(), &[]);
    let worn = "rock: {law: depth_of_cut, depth_of_cut: {wear_flat_force: 9000}}\nstring: {model: line, sections: \
                [{length: 100, outer_diameter: 0.073, inner_diameter: 0.0546}]}\n";
    let text = std::fs::read_to_string(&config).unwrap() + worn;
    std::fs::write(&config, text).unwrap();
    let (words, rows) = ahead(&config, &folder.path().join("out"), &["--members=12", "--metres=0.25"]);
    assert!(words.contains("known of 12 plausible tools"), "{words}");
    assert!(words.contains("Unknown for"), "{words}");
    assert_eq!(rows.len(), 2);
}

#[test]
fn what_cannot_be_predicted_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let said = |changes: &[(&str, &str)], more: &[&str]| {
        let config = configuration(folder.path(), changes);
        let fixed = ["ahead", config.to_str().unwrap(), "--out", out.to_str().unwrap()];
        let output = flexdrill(&[&fixed, more].concat());
        (output.status.code(), text(&output.stderr))
    };
    let falling = folder.path().join("falling.csv");
    std::fs::write(
        &falling,
        "measured_depth_m,inclination_deg,azimuth_deg\n2,0,0\n1,10,0\n",
    )
    .unwrap();
    let falling = falling.to_str().unwrap();
    let link = ("lateral_resistance: 20", "lateral_resistance: 20, axis: link");
    let straight = ("    - arc: {radius: 3.2, build_angle_deg: 20.16}\n", "");
    // Only curvature keeps a guide from turning.
    let turning = (
        "environment:\n",
        "boundary: {supports: [{at: top, body: guide, fix: [psi]}]}\nenvironment:\n",
    );
    let held = ("bending_factor: 0.05, free_curvature: 0.3125", "fixed: true");
    for (changes, more, code, expected) in [
        (
            &[link][..],
            &[][..],
            1,
            &["tool.yaml: tool.bit.axis = link: must be guide", "drawing"][..],
        ),
        (
            &[straight, turning],
            &[],
            1,
            &["well.sections", "must have an arc", "Add the arc"],
        ),
        (&[held], &[], 1, &["tool.guide.fixed = true: must be false"]),
        (
            &[],
            &["--weight=0"],
            2,
            &[
                "--weight 0 kN: must be above 0 kN",
                "0 to 60 kN",
                "give the weight at the bit",
            ],
        ),
        (&[], &["--weight=61"], 2, &["within inputs.weight_on_bit, 0 to 60 kN"]),
        (&[], &["--weight=nan"], 2, &["0 to 2000 kN"]),
        (&[], &["--metres=0"], 2, &["from 0.25 to 20 m"]),
        (&[], &["--members=0"], 2, &["1..=10000"]),
        (&[], &["--radius=3", "--plan", falling], 2, &["cannot be used with"]),
        (
            &[],
            &["--plan", falling],
            1,
            &[
                "falling.csv:3: measured_depth_m = 1: must be above 2 m, the row before",
                "correct the line",
            ],
        ),
        (
            &[],
            &["--plan", "/does/not/exist.csv"],
            1,
            &["cannot read /does/not/exist.csv"],
        ),
    ] {
        let (found, words) = said(changes, more);
        assert_eq!(found, Some(code), "{more:?}: {words}");
        for part in expected {
            assert!(words.contains(part), "{part}: {words}");
        }
    }
}
