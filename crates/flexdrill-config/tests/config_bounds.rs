//! The bounds in the JSON Schema are those of the checks.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::collections::BTreeSet;

use flexdrill_config::{Config, ConfigError, Schema, json_schema};
use serde::Deserialize;
use serde_json::Value;

const EVERY_NUMBER: &str = include_str!("data/every_number.yaml");

/// The configurations of the repository, and one that uses every form of load, mass and section.
fn configurations() -> Vec<(String, Config)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config");
    let mut configurations = vec![(
        "every_number".to_owned(),
        Config::from_text("every_number", EVERY_NUMBER).unwrap(),
    )];
    for folder in [folder.to_owned(), format!("{folder}/verify")] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "yaml") {
                configurations.push((path.display().to_string(), Config::load(&path).unwrap()));
            }
        }
    }
    configurations
}

/// Whether the check refuses `value` at `key` of a configuration.
fn is_refused(tree: &Value, key: &str, value: f64) -> bool {
    let mut tree = tree.clone();
    let node = tree.pointer_mut(&pointer(key)).unwrap();
    *node = if node.is_f64() {
        value.into()
    } else {
        (value as i64).into()
    };
    let Ok(schema) = Schema::deserialize(&tree) else {
        // A count below zero is not even read.
        return true;
    };
    match Config::from_schema("changed", schema) {
        Ok(_) => false,
        Err(ConfigError::Invalid { problems }) => problems.iter().any(|problem| problem.key == key),
        Err(other) => panic!("{key} = {value}: {other}"),
    }
}

fn pointer(key: &str) -> String {
    format!("/{}", key.replace('.', "/"))
}

/// Dotted paths of all numbers in `value`.
fn numbers(value: &Value, path: &str, into: &mut Vec<String>) {
    let below = |key: &str| match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    };
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| numbers(value, &below(key), into)),
        Value::Array(items) => {
            for (index, value) in items.iter().enumerate() {
                numbers(value, &below(&index.to_string()), into);
            }
        }
        Value::Number(_) => into.push(path.to_owned()),
        _ => {}
    }
}

/// Where the schema describes a key, as a JSON pointer.
fn place_of(schema: &Value, key: &str) -> Option<String> {
    let mut place = String::new();
    for part in key.split('.') {
        place = step(schema, &resolved(schema, place)?, part)?;
    }
    resolved(schema, place)
}

/// Follows references.
fn resolved(schema: &Value, mut place: String) -> Option<String> {
    while let Some(reference) = schema.pointer(&place)?.get("$ref").and_then(Value::as_str) {
        place = reference.strip_prefix('#')?.to_owned();
    }
    Some(place)
}

/// The place of a key, or of an item of a list, below a place.
fn step(schema: &Value, place: &str, part: &str) -> Option<String> {
    let node = schema.pointer(place)?;
    let has = |list: &str| node.get(list).is_some_and(|list| list.get(part).is_some());
    if has("properties") {
        return Some(format!("{place}/properties/{part}"));
    }
    if let Ok(index) = part.parse::<usize>() {
        if node.get("prefixItems").is_some_and(|items| items.get(index).is_some()) {
            return Some(format!("{place}/prefixItems/{index}"));
        }
        if node.get("items").is_some() {
            return Some(format!("{place}/items"));
        }
    }
    // One of several forms: the one that has it.
    ["oneOf", "anyOf"].into_iter().find_map(|choice| {
        let count = node.get(choice)?.as_array()?.len();
        (0..count).find_map(|index| {
            let place = resolved(schema, format!("{place}/{choice}/{index}"))?;
            step(schema, &place, part)
        })
    })
}

fn bound(node: &Value, name: &str) -> Option<f64> {
    node.get(name).and_then(Value::as_f64)
}

/// In every configuration: what the schema refuses the check refuses too, and a count that the schema allows the check
/// allows.
#[test]
fn every_bound_of_the_schema_is_that_of_the_check() {
    let root = json_schema();
    let mut bounded = BTreeSet::new();
    for (name, config) in configurations() {
        let tree = config.to_tree();
        let mut keys = Vec::new();
        numbers(&tree, "", &mut keys);
        for key in keys {
            let place = place_of(&root, &key).unwrap_or_else(|| panic!("{name}: the schema has no place for {key}"));
            let node = root.pointer(&place).unwrap();
            let is_count = node["type"] == "integer";
            let next = |value: f64, down: bool| match (is_count, down) {
                (true, true) => value - 1.0,
                (true, false) => value + 1.0,
                (false, true) => value.next_down(),
                (false, false) => value.next_up(),
            };
            if let Some(low) = bound(node, "minimum") {
                assert!(is_refused(&tree, &key, next(low, true)), "{name}: {key} below {low}");
                assert!(!is_count || !is_refused(&tree, &key, low), "{name}: {key} at {low}");
            }
            if let Some(low) = bound(node, "exclusiveMinimum") {
                assert!(is_refused(&tree, &key, low), "{name}: {key} at {low}");
            }
            if let Some(high) = bound(node, "maximum") {
                assert!(is_refused(&tree, &key, next(high, false)), "{name}: {key} above {high}");
                assert!(!is_count || !is_refused(&tree, &key, high), "{name}: {key} at {high}");
                bounded.insert(place);
            }
        }
    }
    assert!(bounded.len() > 100, "{} keys have a maximum", bounded.len());
}

/// The schema is never narrower than the check, and has both limits of every number whose limits no other key moves.
#[test]
fn numbers_without_a_bound_are_those_that_depend_on_other_keys() {
    let root = json_schema();
    let (mut without_low, mut without_high) = (BTreeSet::new(), BTreeSet::new());
    for (name, config) in configurations() {
        for number in config.numbers() {
            let node = root.pointer(&place_of(&root, &number.key).unwrap()).unwrap();
            let low = bound(node, "minimum").or(bound(node, "exclusiveMinimum"));
            let high = bound(node, "maximum");
            let key = number.key.clone();
            assert!(
                low.is_none_or(|low| low <= number.low),
                "{name}: {key} from {} on",
                number.low
            );
            assert!(
                high.is_none_or(|high| high >= number.high),
                "{name}: {key} up to {}",
                number.high
            );
            let key: Vec<&str> = key.split('.').filter(|part| part.parse::<u32>().is_err()).collect();
            let key = key.join(".");
            if low.is_none() {
                without_low.insert(key.clone());
            }
            if high.is_none() {
                without_high.insert(key);
            }
        }
    }
    let of = |keys: &[&str]| keys.iter().map(|key| (*key).to_owned()).collect::<BTreeSet<_>>();
    let between = [
        "inputs.rate_of_penetration.assumed_m_per_h",
        "inputs.rate_of_penetration.safe_m_per_h",
        "inputs.rotary_speed.initial_rpm",
        "inputs.rotary_speed.safe_rpm",
        "inputs.standpipe_pressure.assumed_mpa",
        "inputs.standpipe_pressure.safe_mpa",
        "inputs.weight_on_bit.initial_kn",
        "inputs.weight_on_bit.safe_kn",
    ];
    // The upper end of a range is above its lower end.
    let ranges = [
        "calibration.bit.high",
        "calibration.cutter_inclination.high",
        "calibration.follow_limits.high",
        "calibration.friction.high",
        "calibration.joint_friction.high",
        "calibration.specific_energy.high",
        "calibration.wear_flat_force.high",
    ];
    // Of a list the bounds of each number are in its text.
    let lists = ["well.plan.offset"];
    assert_eq!(without_low, of(&[&between[..], &ranges, &lists].concat()));
    let below_another = [
        "environment.pressure.drop_per_metre",
        "inputs.hard_limits.min_m_per_h",
        "inputs.hard_limits.min_mpa",
        "inputs.hard_limits.min_rpm",
        "inputs.rate_of_penetration.min_m_per_h",
        "inputs.rate_of_penetration.slow_age",
        "inputs.standpipe_pressure.min_mpa",
        "inputs.standpipe_pressure.slow_age",
        "inputs.rotary_speed.min_rpm",
        "inputs.rotary_speed.slow_age",
        "inputs.weight_on_bit.min_kn",
        "inputs.weight_on_bit.slow_age",
        "loads.at.measured_depth",
    ];
    assert_eq!(without_high, of(&[&between[..], &below_another, &lists].concat()));
}

#[test]
fn bounds_of_one_key_are_there_and_those_of_several_are_not() {
    let root = json_schema();
    let node = |key: &str| root.pointer(&place_of(&root, key).unwrap()).unwrap();
    let of = |key: &str| ["minimum", "exclusiveMinimum", "maximum"].map(|name| bound(node(key), name));
    assert_eq!(of("solver.time_step"), [Some(1e-7), None, Some(0.01)]);
    assert_eq!(of("solver.rho_infinity"), [Some(0.0), None, Some(1.0)]);
    assert_eq!(of("solver.max_iterations"), [Some(2.0), None, Some(100.0)]);
    assert_eq!(of("inputs.weight_on_bit.max_age"), [None, Some(0.0), Some(3600.0)]);
    assert_eq!(
        of("inputs.rotary_speed.min_rpm"),
        [Some(-5000.0), None, None],
        "not above max_rpm"
    );
    assert_eq!(of("inputs.rotary_speed.initial_rpm"), [None, None, None]);
}
