//! Keys of the bit that `flexdrill ahead` reads: defaults, bounds, and hashes that do not change without them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::{BitAxis, Config, ConfigError};

/// A short tool with more keys of its bit.
fn config(bit: &str) -> Result<Config, ConfigError> {
    let text = format!(
        "
well: {{sections: [{{arc: {{radius: 3.2, build_angle_deg: 90}}}}], hole_diameter: 0.118}}
tool:
  links: 33
  pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}
  guide: {{outer_diameter: 0.102, inner_diameter: 0.080}}
  joint: {{limit_deg: 6}}
  bit: {{diameter: 0.118{bit}}}
"
    );
    Config::from_text("rig.yaml", &text)
}

#[test]
fn what_is_left_out_has_the_usual_values_and_no_place_in_the_file() {
    let plain = config("").unwrap();
    let bit = &plain.tool.bit;
    assert_eq!(
        (bit.lateral_resistance(), bit.walk_angle_deg(), bit.axis()),
        (20.0, 0.0, BitAxis::Guide)
    );
    assert_eq!(bit.lateral_resistance_range(), [5.0, 100.0]);
    // A recording of an earlier version has the hash that it had.
    let tree = plain.to_tree();
    let keys: Vec<&String> = tree["tool"]["bit"].as_object().unwrap().keys().collect();
    assert_eq!(keys, ["diameter", "friction_factor", "slip_rate", "inertia"]);
    assert!(plain.has("tool.bit.axis"));
}

#[test]
fn what_is_given_is_read_and_written() {
    let given = ", lateral_resistance: 40, lateral_resistance_range: [10, 80], walk_angle_deg: -12, axis: link";
    let config = config(given).unwrap();
    let bit = &config.tool.bit;
    assert_eq!(
        (bit.lateral_resistance(), bit.walk_angle_deg(), bit.axis()),
        (40.0, -12.0, BitAxis::Link)
    );
    assert_eq!(bit.lateral_resistance_range(), [10.0, 80.0]);
    let again = Config::from_text("written", &config.to_yaml().unwrap()).unwrap();
    assert_eq!(again, config);
}

#[test]
fn what_makes_no_sense_is_refused_with_its_bound() {
    for (given, expected) in [
        (
            ", lateral_resistance: 1",
            "rig.yaml:8: tool.bit.lateral_resistance = 1: must be 2 to 1000",
        ),
        (
            ", walk_angle_deg: 90",
            "tool.bit.walk_angle_deg = 90 deg: must be -60 to 60 deg",
        ),
        (
            ", lateral_resistance_range: [100, 5]",
            "tool.bit.lateral_resistance_range = [100, 5]: must be two numbers within 1.1 to 10000",
        ),
        (
            ", lateral_resistance_range: [30, 100]",
            "must be a range around tool.bit.lateral_resistance, 20",
        ),
        (", axis: bearing", "axis"),
    ] {
        let said = config(given).unwrap_err().to_string();
        assert!(said.contains(expected), "{given}: {said}");
    }
}
