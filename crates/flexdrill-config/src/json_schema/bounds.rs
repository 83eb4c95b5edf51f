//! `minimum` and `maximum` of the JSON Schema, from the checks of the configuration themselves.
//!
//! The checks are asked for the limits that they hold each number against, again and again while one other key after
//! the other is changed. A limit that stays is one of the key alone and goes into the schema; what moves depends on
//! other keys, which a schema cannot say.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::{Number, Value};

use crate::Schema;
use crate::checker::{Checker, Limit};
use crate::lines::Lines;

/// A configuration with something at every place where numbers can stand.
const SAMPLE: &str = include_str!("sample.yaml");

/// Puts the bounds into `schema`.
pub(super) fn add(schema: &mut Value) {
    let Ok(sample) = serde_saphyr::from_str::<Schema>(SAMPLE) else {
        return;
    };
    let mut places: BTreeMap<String, Vec<Sides>> = BTreeMap::new();
    for (key, sides) in constant(&sample, schema) {
        if let Some(place) = place_of(schema, &key) {
            places.entry(place).or_default().push(sides);
        }
    }
    for (place, sides) in places {
        let Some(node) = schema.pointer_mut(&place).and_then(Value::as_object_mut) else {
            continue;
        };
        let is_integer = node.get("type").is_some_and(|kind| kind.as_str() == Some("integer"));
        let number = |value: f64| {
            if is_integer {
                Some(Number::from(value as i64))
            } else {
                Number::from_f64(value)
            }
        };
        // What several keys share may be no narrower than the widest of them.
        let low = sides.iter().map(|sides| sides.low).reduce(wider(f64::lt));
        if let Some(Some((low, is_in))) = low
            && let Some(low) = number(low)
        {
            node.remove("minimum");
            node.insert(
                if is_in { "minimum" } else { "exclusiveMinimum" }.to_owned(),
                low.into(),
            );
        }
        let high = sides.iter().map(|sides| sides.high).reduce(wider(f64::gt));
        if let Some(Some((high, _))) = high
            && let Some(high) = number(high)
        {
            node.insert("maximum".to_owned(), high.into());
        }
    }
}

/// A bound and whether it is allowed itself; `None` where it depends on other keys.
type Side = Option<(f64, bool)>;

/// What is constant of a key's limits.
#[derive(Clone, Copy)]
struct Sides {
    low: Side,
    high: Side,
}

/// The wider of two bounds of the same side; `beyond` says which number is further out.
fn wider(beyond: impl Fn(&f64, &f64) -> bool) -> impl FnMut(Side, Side) -> Side {
    move |a, b| {
        let ((x, x_in), (y, y_in)) = (a?, b?);
        Some(if beyond(&x, &y) {
            (x, x_in)
        } else if beyond(&y, &x) {
            (y, y_in)
        } else {
            (x, x_in || y_in)
        })
    }
}

fn limits(schema: &Schema) -> BTreeMap<String, Limit> {
    let lines = Lines::default();
    let mut checker = Checker::new("", &lines);
    schema.check(&mut checker);
    let limits = std::mem::take(&mut checker.limits);
    limits.into_iter().map(|limit| (limit.key.clone(), limit)).collect()
}

/// The limits of the sample's numbers that no other key moves.
fn constant(sample: &Schema, schema: &Value) -> BTreeMap<String, Sides> {
    let as_given = limits(sample);
    let mut found: BTreeMap<String, Sides> = as_given
        .iter()
        .map(|(key, limit)| {
            let low = Some((limit.low, limit.low_is_in));
            let high = Some((limit.high, true));
            (key.clone(), Sides { low, high })
        })
        .collect();
    // Plain data: it does not fail, and nothing to change would only mean that nothing is found to move.
    let tree = serde_json::to_value(sample).unwrap_or_default();
    let mut leaves = Vec::new();
    collect_leaves(&tree, String::new(), &mut leaves);
    for leaf in leaves {
        let pointer = format!("/{}", leaf.replace('.', "/"));
        for other in others(&tree, &pointer, &leaf, &as_given, schema) {
            let mut changed = tree.clone();
            if let Some(place) = changed.pointer_mut(&pointer) {
                *place = other;
            }
            // Words of one variant are none of another.
            let Ok(changed) = Schema::deserialize(&changed) else {
                continue;
            };
            let moved = limits(&changed);
            for (key, sides) in &mut found {
                let (Some(before), Some(now)) = (as_given.get(key), moved.get(key)) else {
                    continue;
                };
                if (before.low, before.low_is_in) != (now.low, now.low_is_in) {
                    sides.low = None;
                }
                if before.high != now.high {
                    sides.high = None;
                }
            }
        }
    }
    found
}

/// Dotted paths of all numbers, words and switches.
fn collect_leaves(value: &Value, path: String, into: &mut Vec<String>) {
    let below = |key: &str| {
        if path.is_empty() {
            key.to_owned()
        } else {
            format!("{path}.{key}")
        }
    };
    match value {
        Value::Object(map) => map
            .iter()
            .for_each(|(key, value)| collect_leaves(value, below(key), into)),
        Value::Array(items) => {
            for (index, value) in items.iter().enumerate() {
                collect_leaves(value, below(&index.to_string()), into);
            }
        }
        Value::Null => {}
        Value::Bool(_) | Value::Number(_) | Value::String(_) => into.push(path),
    }
}

/// Other values of a key: both limits and a number between, the other words, the other position.
fn others(tree: &Value, pointer: &str, leaf: &str, limits: &BTreeMap<String, Limit>, schema: &Value) -> Vec<Value> {
    match tree.pointer(pointer) {
        Some(Value::Bool(flag)) => vec![(!flag).into()],
        Some(Value::Number(number)) => {
            let is_float = number.is_f64();
            let as_value = |value: f64| {
                if is_float {
                    Value::from(value)
                } else {
                    Value::from(value as i64)
                }
            };
            let (low, high) = limits.get(leaf).map_or((0.0, 1.0), |limit| (limit.low, limit.high));
            let now = number.as_f64().unwrap_or_default();
            [low, high, 0.5 * (low + now), 0.5 * (now + high)]
                .into_iter()
                .map(as_value)
                .collect()
        }
        Some(Value::String(_)) => {
            let place = place_of(schema, leaf);
            let words = place.and_then(|place| schema.pointer(&place)?.get("oneOf")?.as_array());
            words
                .into_iter()
                .flatten()
                .filter_map(|word| word.get("const").cloned())
                .collect()
        }
        _ => Vec::new(),
    }
}

/// Where the schema describes a key, as a JSON pointer; `None` where it says nothing of the place.
fn place_of(schema: &Value, key: &str) -> Option<String> {
    let mut place = String::new();
    for part in key.split('.') {
        place = step(schema, &resolved(schema, place)?, part)?;
    }
    let place = resolved(schema, place)?;
    // A number or nothing.
    let node = schema.pointer(&place)?;
    let choices = node.get("anyOf").and_then(Value::as_array);
    let number = choices.and_then(|choices| choices.iter().position(|choice| choice["type"] == "number"));
    Some(number.map_or(place.clone(), |index| format!("{place}/anyOf/{index}")))
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
    if node.get("properties").is_some_and(|keys| keys.get(part).is_some()) {
        return Some(format!("{place}/properties/{part}"));
    }
    if part.parse::<usize>().is_ok() {
        if node
            .get("prefixItems")
            .is_some_and(|items| items.get(part.parse::<usize>().unwrap_or_default()).is_some())
        {
            return Some(format!("{place}/prefixItems/{part}"));
        }
        if node.get("items").is_some() {
            return Some(format!("{place}/items"));
        }
    }
    // One of several shapes: the one that has it.
    ["oneOf", "anyOf"].into_iter().find_map(|choice| {
        let count = node.get(choice)?.as_array()?.len();
        (0..count).find_map(|index| {
            let place = resolved(schema, format!("{place}/{choice}/{index}"))?;
            step(schema, &place, part)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json_schema;

    fn bound(node: &Value, name: &str) -> Option<f64> {
        node.get(name).and_then(Value::as_f64)
    }

    /// What the check says of a key when it has this value.
    fn is_refused(tree: &Value, key: &str, value: f64) -> bool {
        let mut tree = tree.clone();
        let place = tree.pointer_mut(&format!("/{}", key.replace('.', "/"))).unwrap();
        *place = if place.is_f64() {
            value.into()
        } else {
            (value as i64).into()
        };
        let Ok(schema) = Schema::deserialize(&tree) else {
            // A count below zero is no count.
            return true;
        };
        let lines = Lines::default();
        let mut checker = Checker::new("", &lines);
        schema.check(&mut checker);
        let limit = checker.limits.iter().find(|limit| limit.key == key).unwrap();
        let holds = value <= limit.high && (value > limit.low || (limit.low_is_in && value == limit.low));
        let told = checker
            .finish()
            .is_err_and(|error| error.to_string().contains(&format!(": {key} = ")));
        assert!(holds || told, "{key} = {value} is beyond its limits and not refused");
        !holds
    }

    /// The sample and every configuration of the repository.
    fn configurations() -> Vec<(String, Schema)> {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config");
        let mut texts = vec![("sample".to_owned(), SAMPLE.to_owned())];
        for folder in [folder.to_owned(), format!("{folder}/verify")] {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.extension().is_some_and(|extension| extension == "yaml") {
                    texts.push((path.display().to_string(), std::fs::read_to_string(&path).unwrap()));
                }
            }
        }
        texts
            .into_iter()
            .map(|(name, text)| (name, serde_saphyr::from_str(&text).unwrap()))
            .collect()
    }

    #[test]
    fn the_sample_makes_sense() {
        crate::Config::from_text("sample", SAMPLE).unwrap();
    }

    /// In every configuration: what the schema refuses the check refuses, and at the schema's bound it does not.
    #[test]
    fn every_bound_is_that_of_the_check() {
        let root = json_schema();
        let mut bounded = std::collections::BTreeSet::new();
        for (name, schema) in configurations() {
            let tree = serde_json::to_value(&schema).unwrap();
            for (key, limit) in limits(&schema) {
                let Some(place) = place_of(&root, &key) else {
                    panic!("{name}: the schema has no place for {key}");
                };
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
                    assert!(limit.low >= low, "{name}: {key} from {} on", limit.low);
                }
                if let Some(low) = bound(node, "exclusiveMinimum") {
                    assert!(is_refused(&tree, &key, low), "{name}: {key} at {low}");
                    assert!(limit.low >= low, "{name}: {key} above {}", limit.low);
                }
                if let Some(high) = bound(node, "maximum") {
                    assert!(is_refused(&tree, &key, next(high, false)), "{name}: {key} above {high}");
                    assert!(limit.high <= high, "{name}: {key} up to {}", limit.high);
                    bounded.insert(place);
                }
            }
        }
        assert!(bounded.len() > 100, "{} keys have a maximum", bounded.len());
    }

    #[test]
    fn bounds_of_one_key_are_there_and_those_of_several_are_not() {
        let root = json_schema();
        let node = |key: &str| root.pointer(&place_of(&root, key).unwrap()).unwrap();
        let of = |key: &str| ["minimum", "exclusiveMinimum", "maximum"].map(|name| bound(node(key), name));
        assert_eq!(of("solver.time_step"), [Some(1e-7), None, Some(0.01)]);
        assert_eq!(of("inputs.weight_on_bit.max_age"), [None, Some(0.0), Some(3600.0)]);
        assert_eq!(
            of("inputs.rotary_speed.min_rpm"),
            [Some(-5000.0), None, None],
            "not above max_rpm"
        );
        assert_eq!(of("inputs.rotary_speed.initial_rpm"), [None, None, None]);
        assert_eq!(of("solver.rho_infinity")[2], Some(1.0));
        assert_eq!(of("solver.rho_infinity")[0], None, "it depends on the scheme");
        assert_eq!(of("solver.max_iterations"), [Some(2.0), None, Some(100.0)]);
    }
}
