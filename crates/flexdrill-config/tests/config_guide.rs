//! `tool.guide.free_curvature` in pieces from the bit up.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::Config;

/// The paper's soft guide below a straight hole of 3.9 m, in an arc of 3.2 m and 20.16 deg, 1.126 m long.
fn config(free_curvature: &str) -> Result<Config, String> {
    let yaml = include_str!("../../../tests/data/ahead.yaml");
    let yaml = yaml.replace("free_curvature: 0.3125", &format!("free_curvature: {free_curvature}"));
    Config::from_text("tool.yaml", &yaml).map_err(|error| error.to_string())
}

#[test]
fn pieces_count_from_the_bit_up() {
    let config = config("[{length: 1.126, curvature: 0.3125}, {length: 9, curvature: 0}]").unwrap();
    let tool = config.tool();
    assert_eq!(tool.guide_free_curvature.unwrap().curvature, 0.3125);
    let [change] = tool.guide_bends.changes() else {
        panic!("{:?}", tool.guide_bends)
    };
    assert_eq!((change.from, change.curvature), (1.126, 0.0));
    // A value of a piece is a key like any other.
    let changed = config
        .with_value("tool.guide.free_curvature.0.curvature", 0.25)
        .unwrap();
    assert_eq!(changed.tool().guide_free_curvature.unwrap().curvature, 0.25);
}

/// Strain is half of the diameter, 51 mm, times the change of curvature. A number has 0.3125 1/m in the straight hole.
/// A straight upper piece has been in the straight hole alone; the piece at the bit has been bent straight above the arc.
#[test]
fn each_piece_is_strained_by_the_hole_that_it_has_been_in() {
    let strain = |free: &str| config(free).unwrap().guide_bending_strain();
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
    near(strain("0.3125"), 0.051 * 0.3125);
    near(
        strain("[{length: 1.2, curvature: 0.3125}, {length: 1, curvature: 0}]"),
        0.051 * 0.3125,
    );
    near(
        strain("[{length: 1.2, curvature: 0.2}, {length: 1, curvature: 0}]"),
        0.051 * 0.2,
    );
    // The upper piece is in the arc where the one at the bit is shorter than the arc.
    near(
        strain("[{length: 0.5, curvature: 0.2}, {length: 1, curvature: 0}]"),
        0.051 * 0.3125,
    );
    let moment = |free: &str| config(free).unwrap().guide_preload_moment();
    near(
        moment("[{length: 0.5, curvature: 0.2}, {length: 1, curvature: 0.2}]"),
        moment("0.2"),
    );
    // Made as the hole is, to the millimetre: without stress in it. A guide of one curvature is bent in the straight hole.
    for length in [1.1255, 1.1259468, 1.1264] {
        let as_made = format!("[{{length: {length}, curvature: 0.3125}}, {{length: 9, curvature: 0}}]");
        near(moment(&as_made), 0.0);
    }
    assert!(moment("0.3125") > 1e4);
}

#[test]
fn pieces_that_cannot_be_are_refused() {
    for (free, expected) in [
        ("[]", "tool.guide.free_curvature = 0 pieces"),
        (
            "[{length: 0, curvature: 0.1}]",
            "tool.guide.free_curvature.0.length = 0 m",
        ),
        (
            "[{length: 1, curvature: 0.1}, {length: 1, curvature: -1}]",
            "tool.guide.free_curvature.1.curvature = -1 1/m",
        ),
        (
            "[{length: 1, curvature: 0.1}], fixed: true",
            "as_built while tool.guide.fixed is true",
        ),
    ] {
        let error = config(free).unwrap_err();
        assert!(error.contains(expected), "{free}: {error}");
    }
}

/// A guide that is slotted on one side, its spine 40 mm off the axis on the low side, where thrust bends it with the build. The
/// fibre that is strained most lies on the other side of the tube, 51 + 40 mm from the neutral line, where it is not given.
#[test]
fn a_spine_off_the_axis_bends_towards_the_other_side() {
    let with = |spine: &str| config(&format!("0.1, spine_offset: 0.04{spine}")).unwrap();
    let plain = with("");
    let spine = plain.tool().guide_spine.unwrap();
    assert_eq!((spine.offset, spine.phase), (0.04, 0.0));
    assert!((plain.guide_bending_strain() - 0.091 * 0.2125).abs() < 1e-12);
    let given = with(", outer_fibre: 0.009");
    assert!((given.guide_bending_strain() - 0.009 * 0.2125).abs() < 1e-12);
    // One turn back it is the same side, to the bit.
    assert_eq!(with(", spine_toolface_deg: -180").tool().guide_spine, Some(spine));
    assert_eq!(config("0.1").unwrap().tool().guide_spine, None);
    // It is a number like any other: a prior may draw it.
    let prior = "\nuncertainty: {keys: [{key: tool.guide.spine_offset, form: factor, source: a test, distribution: {normal: \
                 {low: 0.9, high: 1.1}}}]}\n";
    let yaml = include_str!("../../../tests/data/ahead.yaml");
    let yaml = yaml.replace("free_curvature: 0.3125", "free_curvature: 0.3, spine_offset: 0.04");
    let uncertain = Config::from_text("tool.yaml", &(yaml + prior)).unwrap();
    assert!(
        uncertain
            .uncertainty
            .as_ref()
            .unwrap()
            .position("tool.guide.spine_offset")
            .is_some()
    );
}
