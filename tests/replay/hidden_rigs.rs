//! The short form of `tests/python/hidden_rigs.py`: plausible tools on a rig of another structure than the twin's.

use std::path::Path;
use std::process::Command;

use flexdrill_config::Config;
use serde_json::Value;

use crate::common::{python, root};

/// What is not known of the short rig's tool.
const NOT_KNOWN: &str = "
uncertainty:
  keys:
    - key: contact.outer.friction_tangential
      also: [contact.outer.friction_axial]
      distribution: {log_normal: {low: 0.2, high: 0.4}}
      source: test
    - key: rock.depth_of_cut.specific_energy
      form: factor
      distribution: {log_normal: {low: 0.6667, high: 1.5}}
      source: test
    - key: rock.depth_of_cut.wear_flat_force
      form: factor
      distribution: {log_normal: {low: 0.6667, high: 1.5}}
      source: test
  sensors:
    weight_indicator: {factor_error: 0.05, tare_range_kn: 2.0}
    surface_torque: {factor_error: 0.05}
";

fn scored(folder: &Path, config: &Path) -> Option<Vec<Value>> {
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    let options = [
        ("--out", text(folder)),
        ("--config", text(config)),
        ("--binary", env!("CARGO_BIN_EXE_flexdrill").to_owned()),
        ("--rigs", "1".to_owned()),
        ("--seconds", "90".to_owned()),
        ("--members", "12".to_owned()),
    ];
    let arguments: Vec<&str> = options
        .iter()
        .flat_map(|(name, value)| [*name, value.as_str()])
        .collect();
    python::run("hidden_rigs.py", &arguments, "")?;
    let rigs = (0..1).map(|number| std::fs::read_to_string(folder.join(format!("rig_{number:03}.json"))).unwrap());
    Some(rigs.map(|text| serde_json::from_str(&text).unwrap()).collect())
}

/// The bands are those of tools that are not the rig: its torque at the bit lies within them most of the time, although the
/// structure, the parameters and the sensors are others. (How often exactly is measured on many rigs, docs/measurements.md.)
#[test]
fn plausible_tools_hold_what_a_rig_of_another_structure_does() {
    let folder = tempfile::tempdir().unwrap();
    let config = folder.path().join("short.yaml");
    let base = std::fs::read_to_string(root().join("tests/data/short_rig.yaml")).unwrap();
    std::fs::write(&config, base + NOT_KNOWN).unwrap();
    let Some(rigs) = scored(folder.path(), &config) else {
        return;
    };
    let (mut inside, mut all) = (0, 0);
    for rig in &rigs {
        assert_eq!(rig["structures"].as_array().unwrap().len(), 3);
        let torque = &rig["bands"]["bit torque"];
        for factor in torque["needed"].as_array().unwrap() {
            // Null where the band has no width and the truth lies outside it.
            let factor = factor.as_f64().unwrap_or(f64::INFINITY);
            assert!(factor >= 0.0, "{factor}");
            inside += u32::from(factor <= 1.0);
            all += 1;
        }
        let [early, late] = [0, 1].map(|end: usize| torque["width"][end].as_f64().unwrap());
        assert!(early > 0.0 && late > 0.0, "{torque}");
    }
    // 30 of 90 s settle, and the bands of the last second may come after the end of the truth.
    assert!(all >= 58, "{all} seconds were judged");
    assert!(2 * inside > all, "{inside} of {all} seconds");
}

/// A map over plausible tools, and a rig of another structure at one of its cells of each kind: the run is at a cell that the
/// map has so, with what the rig's instruments make of it. (How often an alarm comes is measured on many rigs.)
#[test]
fn a_hidden_rig_runs_at_cells_of_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let base = std::fs::read_to_string(root().join("tests/data/short_rig.yaml")).unwrap();
    std::fs::write(path("short.yaml"), base + NOT_KNOWN).unwrap();
    let map = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args([
            "map",
            &path("short.yaml"),
            "--rpm",
            "30:60",
            "--wob",
            "8:14",
            "--grid",
            "2x2",
            "--horizon",
            "10",
        ])
        .args([
            "--members",
            "2",
            "--plausible",
            "--fast",
            "--share",
            "100",
            "--out",
            &path("map"),
        ])
        .output()
        .unwrap();
    assert!(map.status.success(), "{}", String::from_utf8_lossy(&map.stderr));
    let map = path("map/map.json");
    let arguments = [
        &map,
        "--out",
        &path("cells"),
        "--config",
        &path("short.yaml"),
        "--rigs",
        "1",
        "--binary",
    ];
    let arguments = [
        &arguments.map(String::from)[..],
        &[env!("CARGO_BIN_EXE_flexdrill").to_owned()],
    ]
    .concat();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if python::run("hidden_cells.py", &arguments, "").is_none() {
        return;
    }
    let read = |file: &str| -> Value { serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap() };
    let (map, rig) = (read(&map), read(&path("cells/cell_000.json")));
    let mut ran = 0;
    for verdict in ["clear", "alarm"] {
        let cells = map["cells"].as_array().unwrap();
        let of: Vec<&Value> = cells.iter().filter(|cell| cell["verdict"] == verdict).collect();
        let Some(run) = rig.get(verdict) else {
            assert!(of.is_empty(), "{verdict}: {rig}");
            continue;
        };
        assert!(
            of.iter().any(|cell| cell["x"] == run["rpm"] && cell["y"] == run["kn"]),
            "{run}"
        );
        // An indicator of 5 % and 2 kN at most.
        let [shown, acts] = ["kn", "true_kn"].map(|key| run[key].as_f64().unwrap());
        assert!((shown - 2.0) / 1.05 <= acts && acts <= (shown + 2.0) / 0.95, "{run}");
        assert!(run["alarms"].is_array(), "{run}");
        ran += 1;
    }
    assert!(ran > 0, "{rig}");
}

/// The table in docs/measurements.md and the factors on the bands of config/rig.yaml are those of the rigs in the repository.
#[test]
fn the_measured_table_and_factors_are_those_of_the_rigs_in_the_repository() {
    let folder = tempfile::tempdir().unwrap();
    for file in std::fs::read_dir(root().join("tests/data/hidden_rigs")).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), folder.path().join(file.file_name())).unwrap();
    }
    let out = folder.path().to_str().unwrap();
    if python::run("hidden_rigs.py", &["--out", out, "--rigs", "0"], "").is_none() {
        return;
    }
    let scores = std::fs::read_to_string(folder.path().join("scores.md")).unwrap();
    let measured = std::fs::read_to_string(root().join("docs/measurements.md")).unwrap();
    let (mut rows, count) = (0, scores.split(' ').next().unwrap());
    for name in [
        "bit torque",
        "weight at the bit",
        "force of pipe on guide",
        "force of guide on wall",
        "swing",
    ] {
        let row = scores
            .lines()
            .find(|line| line.starts_with(&format!("| {name}")))
            .unwrap();
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [_, _, held, error, early, late, width, ..] = cells[..] else {
            panic!("{row}");
        };
        let row = format!("| {held} ({error}) | {early} | {late} | {width} |");
        assert!(measured.contains(&row), "{name} of {count} rigs: {row}");
        rows += 1;
    }
    assert_eq!(
        (rows, count),
        (5, "16"),
        "docs/measurements.md says how many rigs there are"
    );
    // Names and numbers: the source in the configuration is shorter, and says what has the factor of another figure.
    let found = std::fs::read_to_string(folder.path().join("factors.yaml")).unwrap();
    let found: Vec<(&str, f64)> = found
        .lines()
        .filter_map(|line| {
            let (figure, rest) = line.strip_prefix("- {figure: ")?.split_once(", factor: ")?;
            Some((figure, rest.split_once(',')?.0.parse().unwrap()))
        })
        .collect();
    let rig = Config::load(root().join("config/rig.yaml")).unwrap();
    let shipped = &rig.ensemble.as_ref().unwrap().band_factors;
    let (borrowed, measured): (Vec<_>, Vec<_>) = shipped.iter().partition(|of| of.source.starts_with("that of "));
    let measured: Vec<(&str, f64)> = measured.iter().map(|of| (of.figure.as_str(), of.factor)).collect();
    assert!(!found.is_empty());
    assert_eq!(measured, found);
    for of in borrowed {
        let from = of.source.trim_start_matches("that of ");
        assert!(measured.contains(&(from, of.factor)), "{}", of.figure);
    }
}

/// The factors on bands that the study finds, compared with populations whose quantiles are known.
#[test]
fn factors_hold_on_rigs_that_did_not_tune_them() {
    python::run("conformal.py", &[], "");
}
