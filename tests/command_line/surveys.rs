//! `flexdrill ahead --surveys`: what two inclinations do to the forecast, and what is refused.

use std::path::{Path, PathBuf};

use crate::ahead::{ahead, configuration};
use crate::program::{flexdrill, number, text};

/// Measured depth at which the arc begins (m).
const START: f64 = 1.0265548;

/// The tool of `tests/data/ahead.yaml` after 4 m of an arc of 3 m: 19.1 deg/m, where this tool drills 18.2 deg/m.
fn drilled(folder: &Path) -> PathBuf {
    configuration(
        folder,
        &[(
            "    - straight: {length: 3.900601}\n    - arc: {radius: 3.2, build_angle_deg: 20.16}\n",
            "    - straight: {length: 1.0265548}\n    - arc: {radius: 3.0, build_angle_deg: 76.394373}\n",
        )],
    )
}

/// Width of 90 % of the inclination at the last station (deg).
fn width(rows: &[std::collections::BTreeMap<String, String>]) -> f64 {
    let last = rows.last().unwrap();
    number(last, "inclination_high_deg") - number(last, "inclination_low_deg")
}

/// A table of surveys.
fn table(folder: &Path, rows: &[(f64, f64)]) -> String {
    let rows: Vec<String> = rows
        .iter()
        .map(|(depth, inclination)| format!("{depth},{inclination},137"))
        .collect();
    let path = folder.join("surveys.csv");
    let text = format!("measured_depth_m,inclination_deg,azimuth_deg\n{}\n", rows.join("\n"));
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The arc of 3 m at a depth below its start (deg).
fn arc(below: f64) -> f64 {
    f64::to_degrees(below / 3.0)
}

#[test]
fn two_inclinations_narrow_the_cone_and_correct_the_curvature() {
    let folder = tempfile::tempdir().unwrap();
    let config = drilled(folder.path());
    let out = folder.path().join("out");
    let (_, before) = ahead(&config, &out, &["--members=99", "--metres=4"]);
    assert!(!out.join("surveys.csv").exists());
    // In the order in which they come, which need not be that of the depths.
    let surveys = table(folder.path(), &[(5.02, arc(5.02 - START)), (3.02, arc(3.02 - START))]);
    let more = ["--metres=4", "--surveys", surveys.as_str()];
    let (words, after) = ahead(&config, &out, &more);
    // Half widths of some 6 and 3.5 deg.
    let (wide, narrow) = (width(&before), width(&after));
    assert!(narrow < 0.8 * wide, "{narrow} {wide}");
    // The tool as configured drills 3.14 m, 18.2 deg/m; the measured hole has 19.1 deg/m over its last 2 m.
    let slope = |rows: &[std::collections::BTreeMap<String, String>]| {
        number(&rows[16], "inclination_deg") - number(&rows[0], "inclination_deg")
    };
    let more_build = (slope(&after) - slope(&before)) / 4.0;
    assert!((0.3..1.5).contains(&more_build), "{more_build}");
    // Without a plan the hole lies in the plane of the surveys. Near the casing each azimuth has 5 deg, which
    // two of them do not halve: 90 % are more than 8 deg wide.
    let last = after.last().unwrap();
    assert!((number(last, "azimuth_deg") - 137.0).abs() < 0.5, "{last:?}");
    assert!(
        number(last, "azimuth_high_deg") - number(last, "azimuth_low_deg") > 8.0,
        "{last:?}"
    );
    // The same seed gives the same bytes.
    assert_eq!(ahead(&config, &out, &more).1, after);
    for part in [
        "in brackets 90 % by 2 surveys",
        "2 surveys from 3.02 to 5.02 m, in the hole drilled since 1.03 m: inclination at the bit 76.",
        " more than as configured; the forecast has this correction.",
    ] {
        assert!(words.contains(part), "{part}: {words}");
    }
    let kept = std::fs::read_to_string(out.join("surveys.csv")).unwrap();
    assert_eq!(kept.lines().count(), 3, "{kept}");
    assert!(
        kept.lines()
            .skip(1)
            .all(|line| line.ends_with("direction and curvature")),
        "{kept}"
    );
    let svg = std::fs::read_to_string(out.join("ahead.svg")).unwrap();
    for part in ["surveys", "90 % by the surveys", "ahead, by the surveys"] {
        assert!(svg.contains(part), "{part}");
    }
}

#[test]
fn surveys_near_the_start_of_a_run_correct_the_direction_alone() {
    let folder = tempfile::tempdir().unwrap();
    let config = drilled(folder.path());
    let out = folder.path().join("out");
    // At the bit, a metre below where this tool began to drill, and one in the hole of the last tool.
    let surveys = table(folder.path(), &[(5.02, arc(5.02 - START) - 5.0), (2.0, 20.0)]);
    let more = [
        "--metres=1",
        // A plausible tool or two have a bit that cuts nothing across the hole, and a range needs nineteen.
        "--members=24",
        "--surveys",
        surveys.as_str(),
        "--drilled-from=4.0",
    ];
    let (words, rows) = ahead(&config, &out, &more);
    for part in [
        "in brackets 90 % of ",
        "They correct the direction at the bit alone: a curvature needs a survey 1.5 m or more below the start of the run.",
        "1 survey above 4.00 m, in the hole of another tool: not used.",
        " deg steeper than well.sections has it: correct well.sections",
    ] {
        assert!(words.contains(part), "{part}: {words}");
    }
    // The direction of the configured forecast turns with the survey: 5 deg, less what the start of the run weighs.
    let (_, configured) = ahead(&config, &out, &["--metres=1", "--members=1"]);
    let turned = number(&configured[0], "inclination_deg") - number(&rows[0], "inclination_deg");
    assert!((4.0..5.0).contains(&turned), "{turned}");
    let kept = std::fs::read_to_string(out.join("surveys.csv")).unwrap();
    assert!(kept.contains(",nothing\n") && kept.contains(",direction\n"), "{kept}");
}

#[test]
fn surveys_that_cannot_be_are_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let config = drilled(folder.path());
    let out = folder.path().join("out");
    let refused = |rows: &[(f64, f64)], more: &[&str]| {
        let surveys = table(folder.path(), rows);
        let fixed = [
            "ahead",
            config.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
            "--surveys",
            surveys.as_str(),
        ];
        let output = flexdrill(&[&fixed[..], more].concat());
        assert!(!output.status.success());
        text(&output.stderr)
    };
    // Depths and inclinations, more options, and what is said.
    type Case<'a> = (&'a [(f64, f64)], &'a [&'a str], &'a str);
    let cases: [Case<'_>; 6] = [
        (
            &[(5.1, 20.0)],
            &[],
            "measured_depth_m = 5.1: must be 0 m, the kick-off, to 5.027 m",
        ),
        (&[(-1.0, 20.0)], &[], "measured_depth_m = -1: must be 0 m, the kick-off"),
        (&[(4.0, 190.0)], &[], "inclination_deg = 190: must be 0 to 180 deg"),
        (&[(4.0, f64::NAN)], &[], "inclination_deg = NaN: must be 0 to 180 deg"),
        (&[], &[], "0 rows: must be 1 to"),
        (
            &[(4.0, 20.0)],
            &["--drilled-from=6"],
            "--drilled-from 6 m: must be above the bit, less than 5.027 m",
        ),
    ];
    for (rows, more, said) in cases {
        let words = refused(rows, more);
        assert!(words.contains(said), "{said}: {words}");
        assert!(!out.join("surveys.csv").exists());
    }
}
