//! `well.plan`: read and written, refused in words, and without an effect on files that lack it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::{Config, ConfigError};

/// A short tool in a hole of 5.027 m with a plan.
fn config(plan: &str) -> Result<Config, ConfigError> {
    let text = format!(
        "
well:
  sections: [{{arc: {{radius: 3.2, build_angle_deg: 90}}}}]
  hole_diameter: 0.118
{plan}
tool:
  links: 33
  pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}
  guide: {{outer_diameter: 0.102, inner_diameter: 0.080}}
  joint: {{limit_deg: 6}}
  bit: {{diameter: 0.118}}
"
    );
    Config::from_text("rig.yaml", &text)
}

const STATIONS: &str = "  plan:
    stations:
      - {measured_depth: 0, inclination_deg: 0, azimuth_deg: 30}
      - {measured_depth: 5.0265, inclination_deg: 90, azimuth_deg: 30}
      - {measured_depth: 10, inclination_deg: 92, azimuth_deg: 33}";

#[test]
fn a_file_without_a_plan_has_no_trace_of_it() {
    let plain = config("").unwrap();
    assert!(plain.well.plan.is_none());
    let tree = plain.to_tree();
    let keys: Vec<&String> = tree["well"].as_object().unwrap().keys().collect();
    assert_eq!(keys, ["start_inclination_deg", "sections", "hole_diameter"]);
}

#[test]
fn stations_and_files_are_read_and_written() {
    let with = config(STATIONS).unwrap();
    let plan = with.well.plan.as_ref().unwrap();
    assert_eq!((plan.stations.len(), plan.target, plan.file.as_deref()), (3, 0.5, None));
    let last = plan.stations[2];
    assert_eq!(
        (last.measured_depth, last.inclination_deg, last.azimuth_deg),
        (10.0, 92.0, 33.0)
    );
    assert_eq!(Config::from_text("written", &with.to_yaml().unwrap()).unwrap(), with);
    let with = config("  plan: {file: plan.csv, target: 0.3}").unwrap();
    let plan = with.well.plan.as_ref().unwrap();
    assert_eq!((plan.stations.len(), plan.target), (0, 0.3));
    assert_eq!(plan.file.as_deref(), Some("plan.csv"));
    assert_eq!(Config::from_text("written", &with.to_yaml().unwrap()).unwrap(), with);
}

#[test]
fn what_makes_no_sense_is_refused_with_its_place_and_bound() {
    let station = |depth: f64, inclination: f64, azimuth: f64| {
        format!("{{measured_depth: {depth}, inclination_deg: {inclination}, azimuth_deg: {azimuth}}}")
    };
    let stations = |list: &[String]| format!("  plan: {{stations: [{}]}}", list.join(", "));
    let good = station(0.0, 0.0, 0.0);
    for (plan, expected) in [
        (
            "  plan: {}".to_owned(),
            "well.plan.stations = 0 (the default): must be 2 to 1000",
        ),
        (
            stations(std::slice::from_ref(&good)),
            "rig.yaml:5: well.plan.stations = 1: must be 2 to 1000",
        ),
        (
            stations(&[good.clone(), station(4.0, 60.0, 0.0), station(4.0, 70.0, 0.0)]),
            "well.plan.stations.2.measured_depth = 4 m: must be above 4 m, the station before",
        ),
        (
            stations(&[good.clone(), station(9.0, 60.0, 0.0), station(8.0, 70.0, 0.0)]),
            "well.plan.stations.2.measured_depth = 8 m: must be above 9 m, the station before",
        ),
        (
            stations(&[station(5.5, 60.0, 0.0), station(8.0, 70.0, 0.0)]),
            "well.plan.stations.0.measured_depth = 5.5 m: must be at most 5.027 m, the end of well.sections",
        ),
        (
            stations(&[station(-1.0, 60.0, 0.0), station(8.0, 70.0, 0.0)]),
            "well.plan.stations.0.measured_depth = -1 m: must be 0 to 100000 m",
        ),
        (
            stations(&[good.clone(), station(8.0, 181.0, 0.0)]),
            "well.plan.stations.1.inclination_deg = 181 deg: must be 0 to 180 deg",
        ),
        (
            stations(&[good.clone(), station(8.0, 80.0, -361.0)]),
            "well.plan.stations.1.azimuth_deg = -361 deg: must be -360 to 360 deg",
        ),
        (
            stations(&[
                good.clone(),
                "{measured_depth: 8, inclination_deg: .nan, azimuth_deg: 0}".to_owned(),
            ]),
            "well.plan.stations.1.inclination_deg = NaN deg: must be 0 to 180 deg",
        ),
        (
            "  plan: {file: '  '}".to_owned(),
            "well.plan.file = an empty name: must be the name of a table",
        ),
        (
            format!("{STATIONS}\n    file: plan.csv"),
            "well.plan.file = plan.csv: must be left out with well.plan.stations",
        ),
        (
            "  plan: {file: plan.csv, target: 0}".to_owned(),
            "well.plan.target = 0 m: must be 0.01 to 100 m",
        ),
        (
            stations(&[good.clone(), "{measured_depth: 8}".to_owned()]),
            "inclination_deg",
        ),
        ("  plan: {file: plan.csv, radius: 3}".to_owned(), "radius"),
    ] {
        let said = config(&plan).unwrap_err().to_string();
        assert!(said.contains(expected), "{plan}: {said}");
    }
}

/// A longer or shorter tool is another hole, of which the plan says nothing.
#[test]
fn a_tool_of_another_size_has_no_plan() {
    let short = config(
        "  plan: {stations: [{measured_depth: 4, inclination_deg: 70, azimuth_deg: 0}, {measured_depth: 9, inclination_deg: 90, azimuth_deg: 0}]}",
    );
    assert!(short.unwrap().with_links(8).unwrap().well.plan.is_none());
}
