//! The declarations of the node's parameters: description, unit, limits.

use std::collections::BTreeMap;

use flexdrill_ros2::parameters::{Declaration, NumberRange, ParameterStore, ParameterValue};
use serde_json::Value;

use super::live::{CONFIG_FILE, USE_SIM_TIME, is_live, why_fixed};
use flexdrill_config::{Config, HardBounds, NumberKey, key_texts};
use flexdrill_ros2::args::value::to_parameter;

/// The description of a key without one. The configurations of the program have no such key.
const NOT_DESCRIBED: &str = "A key of the configuration.";

/// All parameters of a node.
pub fn declare(config: &Config, config_file: &str, use_sim_time: bool) -> ParameterStore {
    // Bounds and units come from the configuration's own table, so that
    // a parameter can never accept what a file could not.
    let numbers: BTreeMap<String, NumberKey> = config
        .numbers()
        .into_iter()
        .map(|number| (number.key.clone(), number))
        .collect();
    let (hard, texts) = (HardBounds::of(config), key_texts());
    let mut found = Vec::new();
    // Every key is a parameter under its path in the file.
    flatten("", &config.to_tree(), &mut found);
    let fixed = |name: &str, description: &str, value| Declaration {
        name: name.to_owned(),
        description: description.to_owned(),
        range: None,
        read_only: Some(why_fixed(name)),
        value,
    };
    let own = [
        fixed(
            USE_SIM_TIME,
            "Whether /clock paces the model instead of the machine's clock.",
            ParameterValue::Boolean(use_sim_time),
        ),
        fixed(
            CONFIG_FILE,
            "File that the configuration was read from.",
            ParameterValue::String(config_file.to_owned()),
        ),
    ];
    let configured = found.into_iter().map(|(name, value)| {
        let number = numbers.get(&name);
        let text = texts.get(&name).map_or(NOT_DESCRIBED, String::as_str);
        // A range with an open end cannot be declared in ROS 2; its bound is checked when the value is set.
        let range = number
            .map(|number| range_of(number, &hard))
            .filter(|range| range.low.is_finite() && range.high.is_finite());
        let read_only = (!is_live(&name)).then(|| why_fixed(&name));
        let description = match number {
            Some(number) => described(text, number, read_only.is_none()),
            None => text.to_owned(),
        };
        Declaration {
            name,
            description,
            // The range of a constant would suggest that it can be set.
            range: if read_only.is_some() { None } else { range },
            read_only,
            value,
        }
    });
    // An optional key is a parameter too: a client sees that it exists, and `-p` gives it a value at the start.
    let left_out = config
        .keys_left_out()
        .into_iter()
        .map(|(name, text)| fixed(&name, &format!("{text} Not set."), ParameterValue::NotSet));
    ParameterStore::new(own.into_iter().chain(configured).chain(left_out))
}

fn flatten(prefix: &str, value: &Value, into: &mut Vec<(String, ParameterValue)>) {
    if let Value::Object(entries) = value {
        for (key, value) in entries {
            let name = if prefix.is_empty() {
                key.clone()
            } else {
                format!("{prefix}.{key}")
            };
            flatten(&name, value, into);
        }
    } else if let Some(value) = from_json(value) {
        into.push((prefix.to_owned(), value));
    }
}

/// A value as a parameter, with all numbers of a list as floats; none where ROS 2 has no type for it.
fn from_json(value: &Value) -> Option<ParameterValue> {
    match value {
        Value::Array(items) if !items.is_empty() => {
            let numbers: Option<Vec<f64>> = items.iter().map(Value::as_f64).collect();
            numbers.map(ParameterValue::DoubleArray)
        }
        Value::Array(_) => None,
        scalar => to_parameter(scalar).ok(),
    }
}

/// The text of a number's key with its unit and, where its limits are shown, their reason.
fn described(text: &str, number: &NumberKey, is_live: bool) -> String {
    let mut out = text.to_owned();
    match number.unit {
        "" => out += " Dimensionless.",
        unit if out.contains(&format!("({unit})")) => {}
        unit => out += &format!(" In {unit}."),
    }
    if is_live {
        out += &format!(" Limits: {}.", number.reason);
    }
    out
}

/// The values that a number may have while the node runs.
fn range_of(number: &NumberKey, hard: &HardBounds) -> NumberRange {
    let [low, high] = hard.cut(&number.key, [number.low, number.high]);
    NumberRange {
        low,
        high,
        // A hard limit itself is allowed.
        low_is_in: number.low_is_in || low > number.low,
        unit: number.unit,
    }
}

/// Replaces the ranges of live parameters, which depend on other values. The hard limits remain.
pub fn refresh_ranges(store: &mut ParameterStore, config: &Config, hard: &HardBounds) {
    for number in config.numbers().into_iter().filter(|number| is_live(&number.key)) {
        store.set_range(&number.key, range_of(&number, hard));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> Config {
        Config::from_text("default.yaml", include_str!("../../../config/default.yaml")).unwrap()
    }

    #[test]
    fn all_keys_are_declared_with_unit_and_limits() {
        let store = declare(&config(), "default.yaml", false);
        let links = store.describe("tool.links");
        assert!(links.read_only && links.additional_constraints.contains("geometry"));
        let slew = store.describe("inputs.rotary_speed.slew_rpm_per_s");
        assert!(
            !slew.read_only && slew.description.contains("r/min per s"),
            "{}",
            slew.description
        );
        // A range of ROS 2 includes its ends, and 0 is refused.
        assert!(slew.floating_point_range[0].from_value > 0.0, "{slew:?}");
        // It is a number that people can read.
        assert!(
            slew.floating_point_range[0].from_value.to_string().len() < 12,
            "{slew:?}"
        );
        assert!(slew.additional_constraints.starts_with("above 0, at most"), "{slew:?}");
        let rate = store.describe("outputs.rates.whirl");
        assert!(rate.description.contains("twin/whirl"), "{}", rate.description);
        // The range ends at inputs.hard_limits.
        let limit = store.describe("inputs.rotary_speed.max_rpm");
        assert_eq!(limit.floating_point_range[0].to_value, 300.0);
        assert!(store.describe("inputs.hard_limits.max_rpm").read_only);
        assert!(store.get("use_sim_time").is_some());
        assert!(store.names().count() > 60);
    }

    #[test]
    fn each_parameter_has_a_description_of_its_own() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/config");
        let mut texts: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "yaml"))
            .map(|path| std::fs::read_to_string(path).unwrap())
            .filter(|text| text.contains("\ntool:"))
            .collect();
        assert!(texts.len() > 2, "{}", texts.len());
        let stations = texts[0].replace("watched: joints", "watched: {stations: [1, 2]}");
        texts.push(stations);
        for text in &texts {
            let store = declare(&Config::from_text("a configuration", text).unwrap(), "", false);
            let mut seen = BTreeMap::new();
            for name in store.names() {
                let before = seen.insert(store.describe(name).description, name);
                assert!(before.is_none(), "{name} and {before:?} have the same text");
                let description = store.describe(name).description;
                assert!(
                    description.len() > 10 && description != NOT_DESCRIBED,
                    "{name}: {description}"
                );
            }
        }
        let kind = declare(&config(), "", false).describe("tool.joint.kind").description;
        assert!(kind.contains("ball_cage"), "{kind}");
    }
}
