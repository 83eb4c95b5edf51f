//! `well.sections.*.drilled`: read and written, lengths and angles, and what is refused.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::{Config, ConfigError, Drilled, Interval, Section};
use flexdrill_core::tool::{Course, HoleInterval, WellPath, WellSection};

fn config(sections: &str) -> Result<Config, ConfigError> {
    let text = format!(
        "
well:
  start_inclination_deg: 30
  sections: [{sections}]
  hole_diameter: 0.118
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

/// `count` points of the curvatures (build, right) (1/m).
fn drilled(count: usize, [build, right]: [f64; 2]) -> String {
    let points = vec![format!("[{build}, {right}]"); count].join(", ");
    format!("{{drilled: {{points: [{points}]}}}}")
}

#[test]
fn points_are_read_written_and_described() {
    let text = format!(
        "{{straight: {{length: 4.0}}}}, {}, {{drilled: {{spacing: 0.1, points: [[-0.2, 0.0]], interval: after_arc}}}}",
        drilled(50, [0.3, 0.0])
    );
    let config = config(&text).unwrap();
    assert_eq!(
        Config::from_text("written", &config.to_yaml().unwrap()).unwrap(),
        config
    );
    let well = &config.well;
    // 50 points of 20 mm turn by 0.3 rad, and the last one back by 0.02 rad.
    assert!((well.length() - 5.1).abs() < 1e-12);
    assert!((well.end_inclination_deg() - (30.0 + 0.28_f64.to_degrees())).abs() < 1e-9);
    assert!((well.smallest_radius() - 1.0 / 0.3).abs() < 1e-12 && !well.is_straight());
    assert!((well.sections[1].turn(0.51) - 0.153).abs() < 1e-12);
    let tool = config.tool();
    let WellSection::Drilled {
        spacing,
        build,
        interval,
    } = &tool.well.sections[2]
    else {
        panic!("{:?}", tool.well.sections[2])
    };
    assert_eq!(
        (*spacing, build.as_slice(), *interval),
        (0.1, &[-0.2][..], HoleInterval::AfterArc)
    );
    // In the plane the course of the configuration and the core's path end at the same point.
    let (course, path) = (well.course(), WellPath::new(&tool.well));
    assert!((course.position - path.position(path.length())).norm() < 1e-12);
}

#[test]
fn a_part_of_a_section_is_the_same_hole() {
    let section = config(&drilled(250, [0.25, 0.0])).unwrap().well.sections[0].clone();
    // Cut within points 5 and 200.
    let parts: Vec<Section> = [(0.0, 0.113), (0.113, 4.0151), (4.0151, 5.0)]
        .into_iter()
        .flat_map(|(top, bottom)| section.between(top, bottom))
        .collect();
    let end = |sections: &[Section]| {
        let mut course = Course::begin(0.5, 0.0);
        sections.iter().for_each(|section| section.extend(&mut course));
        course
    };
    let (whole, cut) = (end(&[section]), end(&parts));
    assert!((whole.position - cut.position).norm() < 1e-12 && (whole.depth - cut.depth).abs() < 1e-12);
    let Section::Drilled(Drilled {
        spacing,
        points,
        interval,
    }) = &parts[0]
    else {
        panic!("{parts:?}")
    };
    assert_eq!((*spacing, points.len(), *interval), (0.02, 5, Interval::Arc));
    assert_eq!(parts.len(), 2 + 3 + 2);
    // A copy of the tool with fewer links ends earlier in the same hole.
    let sized = config(&drilled(250, [0.25, 0.0])).unwrap().with_links(10).unwrap();
    assert!((sized.well.length() - 50.0 / 33.0).abs() < 1e-12);
}

#[test]
fn what_cannot_be_is_refused_with_its_bound() {
    for (text, expected) in [
        ("{drilled: {points: []}}".to_owned(), "at least one pair of curvatures"),
        (drilled(3, [2.5, 0.0]), "-2 to 2 1/m"),
        (drilled(3, [f64::NAN, 0.0]).replace("NaN", ".nan"), "-2 to 2 1/m"),
        (
            "{drilled: {spacing: 0, points: [[0.3, 0.0]]}}".to_owned(),
            "0.0005 to 1 m",
        ),
        // 30 deg less 1.0 rad is beyond the vertical, although the end of both sections is not.
        (
            format!("{}, {}", drilled(100, [-0.5, 0.0]), drilled(100, [0.5, 0.0])),
            "an inclination within 0 and 180 deg all along",
        ),
        // 0.05 1/m to the right over 5 m: 5^2/8 * 0.05 = 0.16 m off the line through both ends.
        (drilled(250, [0.3, 0.05]), "at most 1 mm"),
    ] {
        let error = config(&text).unwrap_err().to_string();
        assert!(error.contains(expected), "{text:.80}: {error}");
    }
    // 0.0003 1/m to the right are up to 0.9 mm off the plane: the torque of 10 kN makes 0.00023 1/m.
    assert!(config(&drilled(250, [0.3, 0.0003])).is_ok());
}

/// The hole of a tool that has drilled on is the old one with the points below it, without as much at its top.
#[test]
fn a_rebased_hole_ends_with_what_was_drilled() {
    let before = config("{straight: {length: 1.0}}, {arc: {radius: 3.2, build_angle_deg: 70}}").unwrap();
    let length = before.well.length();
    let points: Vec<[f64; 2]> = (0..80).map(|point| [0.28 + 0.001 * f64::from(point), 0.0]).collect();
    let (first, rest) = points.split_at(30);
    // All points at once, and in two runs, the first of which ends within the straight section.
    let at_once = before.rebased(&points, 0.02).unwrap();
    let in_two = before.rebased(first, 0.02).unwrap().rebased(rest, 0.02).unwrap();
    assert!((in_two.well.sections[0].length() - at_once.well.sections[0].length()).abs() < 1e-12);
    let mut whole = before.well.course();
    points.iter().for_each(|point| whole.advance(0.02, *point));
    for rebased in [&at_once, &in_two] {
        let course = rebased.well.course();
        assert!((rebased.well.length() - length).abs() < 1e-12);
        assert!((course.inclination() - whole.inclination()).abs() < 1e-12);
        // The new top lies 1.6 m down the old hole: 1 m of straight hole at 30 deg, then 0.6 m of arc.
        let mut top = Course::begin(30_f64.to_radians(), 0.0);
        top.advance(1.0, [0.0, 0.0]);
        top.advance(0.6, [1.0 / 3.2, 0.0]);
        assert!((course.position + top.position - whole.position).norm() < 1e-12);
        let Some(Section::Drilled(Drilled { points: last, .. })) = rebased.well.sections.last() else {
            panic!("{:?}", rebased.well.sections)
        };
        assert_eq!(*last, points);
        assert_eq!(
            Config::from_text("written", &rebased.to_yaml().unwrap()).unwrap(),
            *rebased
        );
    }
    // A tool that has drilled more than its own length lies in its own hole alone.
    let far = before.rebased(&[[0.1, 0.0]; 300], 0.02).unwrap();
    assert!((far.well.length() - length).abs() < 1e-9);
    assert!(
        far.well
            .sections
            .iter()
            .all(|section| matches!(section, Section::Drilled(_)))
    );
    // What leaves the plane is refused with the reason.
    let error = before.rebased(&[[0.3, 0.05]; 100], 0.02).unwrap_err().to_string();
    assert!(error.contains("one vertical plane"), "{error}");
}
