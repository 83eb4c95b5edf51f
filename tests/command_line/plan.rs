//! The planned hole of a configuration, and what `flexdrill check` says of a guide and its plan.

use std::path::Path;

use crate::ahead::{ahead, configuration};
use crate::program::{flexdrill, text};

/// The hole of `tests/data/ahead.yaml` and 5 m of its own radius: 286.48 deg over 16 m of arc.
const STATIONS: [(f64, f64); 4] = [(0.0, 0.0), (3.900601, 0.0), (5.0265548, 20.16), (10.0265548, 109.6848)];

/// The stations as a list of the configuration, and as a table.
fn stations(azimuth: f64) -> (String, String) {
    let list = STATIONS.map(|(depth, inclination)| {
        format!("{{measured_depth: {depth}, inclination_deg: {inclination}, azimuth_deg: {azimuth}}}")
    });
    let rows = STATIONS.map(|(depth, inclination)| format!("{depth},{inclination},{azimuth}"));
    (
        format!("  plan: {{stations: [{}], target: 0.05}}\n", list.join(", ")),
        format!("measured_depth_m,inclination_deg,azimuth_deg\n{}\n", rows.join("\n")),
    )
}

/// A tool with a plan.
fn planned(folder: &Path, plan: &str, changes: &[(&str, &str)]) -> std::path::PathBuf {
    let well = format!("  hole_diameter: 0.118\n{plan}");
    configuration(
        folder,
        &[&[("  hole_diameter: 0.118\n", well.as_str())], changes].concat(),
    )
}

/// What `flexdrill check` prints, with its lines joined, or what it refuses.
fn check(config: &Path) -> Result<String, String> {
    let output = flexdrill(&["check", config.to_str().unwrap()]);
    if output.status.success() {
        Ok(text(&output.stdout))
    } else {
        Err(text(&output.stderr))
    }
}

#[test]
fn a_plan_in_the_configuration_is_that_of_the_same_table() {
    let folder = tempfile::tempdir().unwrap();
    let (list, table) = stations(350.0);
    let file = folder.path().join("plan.csv");
    std::fs::write(&file, table).unwrap();
    let run = |plan: &str, out: &str, more: &[&str]| {
        let config = planned(folder.path(), plan, &[]);
        let out = folder.path().join(out);
        let (words, _) = ahead(&config, &out, &[&["--members=1", "--metres=3"], more].concat());
        let words: Vec<&str> = words.lines().filter(|line| !line.contains(" runs in ")).collect();
        (words.join("\n"), std::fs::read(out.join("ahead.csv")).unwrap())
    };
    let given = ["--plan", file.to_str().unwrap(), "--target=0.05"];
    let table = run("", "table", &given);
    assert!(table.0.contains("The plan needs a radius of 3.20 m"), "{}", table.0);
    assert!(table.0.contains("within 0.05 m"), "{}", table.0);
    assert!(table == run(&list, "stations", &[]), "stations of the configuration");
    // A relative path is relative to the folder of the configuration.
    let named = "  plan: {file: plan.csv, target: 0.05}\n";
    assert!(table == run(named, "file", &[]), "file of the configuration");
    // What the command line asks for comes first.
    let (arc, _) = run(&list, "arc", &["--radius=2.6", "--target=0.4"]);
    assert!(
        arc.contains("The plan needs a radius of 2.60 m") && arc.contains("0.4 m"),
        "{arc}"
    );
    // Without any there is none.
    assert!(!run("", "none", &[]).0.contains("The plan needs"));
}

#[test]
fn check_says_what_the_guide_drills_and_what_it_cannot() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = (
        "environment:\n",
        "inputs: {weight_on_bit: {max_kn: 10}}\nenvironment:\n",
    );
    let (list, _) = stations(0.0);
    let said = check(&planned(folder.path(), &list, &[inputs])).unwrap();
    for part in [
        "guide drills     In a long arc it drills a radius of 3.1",
        " m at 10.0 kN on the bit: ",
        // docs/hole_ahead.md: 2.81 to 3.65 m at 10 kN.
        "outside 2.81 m to 3.65 m in a long arc at 10.0 kN, the largest weight",
        "plan             4 stations from 0.00 to 10.03 m, inclination 0.0 to 109.7 deg, target 0.05 m",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!said.contains("this guide cannot drill"), "{said}");
    // A guide that was made straight: at 60 kN it builds a radius of 30 m at best.
    let straight = ("free_curvature: 0.3125", "free_curvature: 0");
    let said = check(&planned(folder.path(), &list, &[straight])).unwrap();
    for part in [
        "warning          well.sections: this guide cannot drill the arc of 3.2 m at any weight; change the guide",
        "warning          well.plan: this guide cannot drill the plan at any weight; change the guide",
        "the plan needs a radius of 3.20 m on the mean over 5.00 m below the bit",
        "radius shorter than 30.",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // Of a guide without a number nothing is said.
    let as_built = (", free_curvature: 0.3125", "");
    let said = check(&planned(folder.path(), "", &[as_built])).unwrap();
    assert!(
        !said.contains("guide drills") && !said.contains("cannot drill"),
        "{said}"
    );
    // Wear flats that carry the usual weight: nothing is cut.
    let worn = (
        "environment:\n",
        "rock: {law: depth_of_cut, depth_of_cut: {wear_flat_force: 12000}}\nstring: {model: line, sections: [{length: \
         100, outer_diameter: 0.073, inner_diameter: 0.0546}]}\nenvironment:\n",
    );
    let said = check(&planned(folder.path(), "", &[worn])).unwrap();
    assert!(
        said.contains("guide drills     nothing at 10.0 kN on the bit: 12.0 kN are on wear flats"),
        "{said}"
    );
}

#[test]
fn a_plan_that_is_none_is_refused_by_check_and_ahead() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let write = |name: &str, rows: &str| {
        let table = format!("measured_depth_m,inclination_deg,azimuth_deg\n{rows}\n");
        std::fs::write(folder.path().join(name), table).unwrap();
    };
    write("away.csv", "6,20,0\n12,90,0");
    write("falling.csv", "2,0,0\n1,10,0");
    write("one.csv", "2,0,0");
    for (plan, expected) in [
        ("{file: no.csv}", "well.plan.file"),
        (
            "{file: falling.csv}",
            "falling.csv:3: measured_depth_m = 1: must be above 2 m",
        ),
        ("{file: one.csv}", "1 rows: must be 2 to"),
        (
            "{file: away.csv}",
            "away.csv: measured_depth_m of the first row = 6 m: must be 0 to 5.027 m, the bit",
        ),
        (
            "{stations: [{measured_depth: 6, inclination_deg: 20, azimuth_deg: 0}, {measured_depth: 12, inclination_deg: \
             90, azimuth_deg: 0}]}",
            "well.plan.stations.0.measured_depth = 6 m: must be at most 5.027 m",
        ),
    ] {
        let config = planned(folder.path(), &format!("  plan: {plan}\n"), &[]);
        let said = check(&config).unwrap_err();
        assert!(said.contains(expected), "{plan}: {said}");
        let asked = [
            "ahead",
            config.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
            "--members=1",
        ];
        let output = flexdrill(&asked);
        let said = text(&output.stderr);
        assert!(!output.status.success() && said.contains(expected), "{plan}: {said}");
    }
    // The tool of a hole that is done is checked, and has nothing ahead to compare.
    write("done.csv", "0,0,0\n5.5,20,0");
    let config = planned(folder.path(), "  plan: {file: done.csv}\n", &[]);
    let said = check(&config).unwrap();
    assert!(
        said.contains("must be at least 6.027 m, a metre below the bit"),
        "{said}"
    );
    let output = flexdrill(&["ahead", config.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(!output.status.success() && text(&output.stderr).contains("must be at least 6.027 m"));
}
