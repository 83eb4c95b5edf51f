//! Every value of the configuration as a ROS 2 parameter of the same dotted name.
//!
//! At the start any of them may be given by `-p` or a parameter file: the configuration is changed before the tool is
//! built, and the run's hash and recording show the changed one. While running only those change that the model can
//! take without being built anew.

use std::collections::BTreeMap;

use ros2_client::{Parameter, ParameterValue};
use serde_json::Value;

use super::store::{Declaration, ParameterStore};
use crate::ros::args::Override;
use crate::ros::args::value::show;
use flexdrill_config::{Config, ConfigError, NumberKey, Schema};

/// Parameters that are not in the configuration.
pub const USE_SIM_TIME: &str = "use_sim_time";
/// The file that the configuration was read from.
pub const CONFIG_FILE: &str = "config_file";

/// Keys of parameters that may change while running: exact, or a group that ends with a dot.
const LIVE: [&str; 12] = [
    "contact.inner.friction_tangential",
    "contact.inner.friction_axial",
    "contact.outer.friction_tangential",
    "contact.outer.friction_axial",
    "tool.bit.friction_factor",
    "inputs.rotary_speed.",
    "inputs.weight_on_bit.",
    "whirl.levels.",
    "whirl.gate_speed_rpm",
    "whirl.hysteresis",
    "outputs.rates.",
    "outputs.exaggeration",
];
/// Keys within those groups that only count at the start.
const START_ONLY: [&str; 2] = ["inputs.rotary_speed.initial_rpm", "inputs.weight_on_bit.initial_kn"];

/// Whether a parameter may change while running.
pub fn is_live(key: &str) -> bool {
    let listed = LIVE.iter().any(|live| {
        if live.ends_with('.') {
            key.starts_with(live)
        } else {
            key == *live
        }
    });
    listed && !START_ONLY.contains(&key)
}

/// Why a parameter that is not live cannot change.
fn why_fixed(key: &str) -> String {
    let what = match key.split('.').next().unwrap_or_default() {
        "well" | "tool" | "masses" => "it is part of the geometry that the model is built from",
        "solver" => "the time step and the solver's limits are fixed when the model is built",
        "contact" | "environment" | "boundary" | "loads" => "the model is built with it",
        "start" | "initial" | "run" | "inputs" => "it only counts at the start",
        "whirl" | "stick_slip" | "shock" => "the analysis is built with it",
        USE_SIM_TIME => "the clock is chosen at the start",
        CONFIG_FILE => "the configuration is read at the start",
        _ => "it is fixed at the start",
    };
    format!("{what}; start the node again with -p {key}:=VALUE or another configuration")
}

/// Why a parameter given at the start is refused.
#[derive(Debug, thiserror::Error)]
pub enum OverrideError {
    /// No such parameter.
    #[error(
        "{origin}: there is no parameter '{name}'; the parameters are the keys of the configuration (`flexdrill check CONFIG --full`) and use_sim_time"
    )]
    Unknown {
        /// Parameter.
        name: String,
        /// Where it was given.
        origin: String,
    },
    /// Wrong type.
    #[error("{origin}: '{name}' = {value}: {why}")]
    Value {
        /// Parameter.
        name: String,
        /// As given.
        value: String,
        /// Where it was given.
        origin: String,
        /// What is wrong.
        why: String,
    },
    /// The configuration does not make sense with it.
    #[error(transparent)]
    Config(#[from] ConfigError),
}

/// What the start's overrides come to.
#[derive(Debug)]
pub struct Started {
    /// The configuration with the overrides.
    pub config: Config,
    /// Whether `/clock` paces the model.
    pub use_sim_time: bool,
}

/// Applies the overrides of a node to a configuration, all at once.
///
/// # Errors
/// When a parameter does not exist, has the wrong type, or the configuration does not make sense with it.
pub fn apply_overrides(config: &Config, overrides: &[Override]) -> Result<Started, OverrideError> {
    let mut use_sim_time = false;
    let mut values = Vec::new();
    for Override {
        name, value, origin, ..
    } in overrides
    {
        let wrong = |why: &str| OverrideError::Value {
            name: name.clone(),
            value: show(value),
            origin: origin.clone(),
            why: why.to_owned(),
        };
        match (name.as_str(), value) {
            (USE_SIM_TIME, ParameterValue::Boolean(on)) => use_sim_time = *on,
            (USE_SIM_TIME, _) => return Err(wrong("use true or false")),
            (CONFIG_FILE, _) => return Err(wrong("use the option --config")),
            // rclcpp puts such parameters into every file that `ros2 param dump` writes.
            (name, _) if name.starts_with("qos_overrides.") || name == "start_type_description_service" => {}
            (key, value) => values.push((
                key.to_owned(),
                to_json(value).ok_or_else(|| wrong("this type is not used"))?,
            )),
        }
    }
    let tree = tree_of(config);
    for (key, _) in &values {
        if tree.pointer(&pointer(key)).is_none() {
            let origin = overrides
                .iter()
                .find(|o| o.name == *key)
                .map(|o| o.origin.clone())
                .unwrap_or_default();
            return Err(OverrideError::Unknown {
                name: key.clone(),
                origin,
            });
        }
    }
    Ok(Started {
        config: with_values(config, "parameters", values)?,
        use_sim_time,
    })
}

/// A copy with several values changed, checked once as a whole.
///
/// # Errors
/// When a key does not exist, a value has the wrong type, or the whole does not make sense.
pub fn with_values(config: &Config, origin: &str, values: Vec<(String, Value)>) -> Result<Config, ConfigError> {
    let mut tree = tree_of(config);
    for (key, value) in values {
        let place = tree
            .pointer_mut(&pointer(&key))
            .ok_or_else(|| ConfigError::UnknownKey { key: key.clone() })?;
        let value = if place.is_f64() && value.is_number() {
            Value::from(value.as_f64())
        } else {
            value
        };
        if *place == value {
            continue;
        }
        let wrong_type = |value: &Value, message: String| ConfigError::WrongType {
            key: key.clone(),
            value: value.to_string(),
            message,
        };
        if kind(place) != kind(&value) && !place.is_null() {
            return Err(wrong_type(&value, format!("must be {}", kind(place))));
        }
        *place = value.clone();
        // One by one, so that the error names the key: the types do not tell by themselves.
        serde_json::from_value::<Schema>(tree.clone()).map_err(|error| wrong_type(&value, error.to_string()))?;
    }
    let schema: Schema = serde_json::from_value(tree).map_err(|error| ConfigError::WrongType {
        key: origin.to_owned(),
        value: String::new(),
        message: error.to_string(),
    })?;
    Config::from_schema(origin, schema)
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "left out",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "text",
        Value::Array(_) => "a list",
        Value::Object(_) => "a mapping",
    }
}

fn pointer(key: &str) -> String {
    format!("/{}", key.replace('.', "/"))
}

fn tree_of(config: &Config) -> Value {
    let schema: &Schema = config;
    // Plain numbers, text and lists: this does not fail, and an empty tree would only mean that no key is known.
    serde_json::to_value(schema).unwrap_or(Value::Null)
}

fn to_json(value: &ParameterValue) -> Option<Value> {
    Some(match value {
        ParameterValue::Boolean(v) => Value::from(*v),
        ParameterValue::Integer(v) => Value::from(*v),
        ParameterValue::Double(v) => Value::from(*v),
        ParameterValue::String(v) => Value::from(v.clone()),
        ParameterValue::IntegerArray(v) => Value::from(v.clone()),
        ParameterValue::DoubleArray(v) => Value::from(v.clone()),
        ParameterValue::StringArray(v) => Value::from(v.clone()),
        ParameterValue::BooleanArray(v) => Value::from(v.clone()),
        ParameterValue::NotSet | ParameterValue::ByteArray(_) => return None,
    })
}

fn from_json(value: &Value) -> Option<ParameterValue> {
    Some(match value {
        Value::Bool(v) => ParameterValue::Boolean(*v),
        Value::Number(v) => v.as_i64().map_or_else(
            || v.as_f64().map(ParameterValue::Double),
            |v| Some(ParameterValue::Integer(v)),
        )?,
        Value::String(v) => ParameterValue::String(v.clone()),
        Value::Array(items) if !items.is_empty() && items.iter().all(Value::is_number) => {
            ParameterValue::DoubleArray(items.iter().filter_map(Value::as_f64).collect())
        }
        _ => return None,
    })
}

/// All parameters of a node.
pub fn declare(config: &Config, config_file: &str, use_sim_time: bool) -> ParameterStore {
    let numbers: BTreeMap<String, NumberKey> = config
        .numbers()
        .into_iter()
        .map(|number| (number.key.clone(), number))
        .collect();
    let mut found = Vec::new();
    flatten("", &tree_of(config), &mut found);
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
        let description = match number {
            Some(NumberKey { unit: "", reason, .. }) => format!("Dimensionless; {reason}."),
            Some(NumberKey { unit, reason, .. }) => format!("In {unit}; {reason}."),
            None => "As in the configuration.".to_owned(),
        };
        let range = number
            .map(|number| [number.low, number.high])
            .filter(|range| range.iter().all(|bound| bound.is_finite()));
        let read_only = (!is_live(&name)).then(|| why_fixed(&name));
        Declaration {
            name,
            description,
            range: if read_only.is_some() { None } else { range },
            read_only,
            value,
        }
    });
    ParameterStore::new(own.into_iter().chain(configured))
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

/// Tells the limits that follow from a changed configuration.
pub fn refresh_ranges(store: &mut ParameterStore, config: &Config) {
    for number in config.numbers().into_iter().filter(|number| is_live(&number.key)) {
        store.set_range(&number.key, [number.low, number.high]);
    }
}

/// The configuration as changed parameters make it, checked as a whole.
///
/// # Errors
/// What is wrong, in words.
pub fn reconfigured(config: &Config, changed: &[Parameter]) -> Result<Config, String> {
    let values = changed
        .iter()
        .filter(|parameter| is_live(&parameter.name))
        .filter_map(|parameter| Some((parameter.name.clone(), to_json(&parameter.value)?)))
        .collect();
    with_values(config, "parameter", values).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> Config {
        Config::from_text("default.yaml", include_str!("../../../config/default.yaml")).unwrap()
    }

    fn over(name: &str, value: ParameterValue) -> Override {
        Override {
            node: "/**".into(),
            name: name.into(),
            value,
            origin: format!("-p {name}"),
        }
    }

    #[test]
    fn the_start_takes_any_key_of_the_configuration() {
        let overrides = [
            over("tool.links", ParameterValue::Integer(20)),
            over("inputs.rotary_speed.initial_rpm", ParameterValue::Integer(40)),
            over("use_sim_time", ParameterValue::Boolean(true)),
            over("qos_overrides./clock.depth", ParameterValue::Integer(1)),
        ];
        let started = apply_overrides(&config(), &overrides).unwrap();
        assert_eq!(started.config.tool.links, 20);
        assert_eq!(started.config.inputs.rotary_speed.initial_rpm, 40.0);
        assert!(started.use_sim_time);
        assert_ne!(started.config.hash(), config().hash());
    }

    #[test]
    fn wrong_overrides_are_explained() {
        let error = |name: &str, value| {
            apply_overrides(&config(), &[over(name, value)])
                .unwrap_err()
                .to_string()
        };
        assert!(error("tool.link", ParameterValue::Integer(3)).contains("'tool.link'"));
        assert!(error("tool.links", ParameterValue::String("many".into())).contains("must be a number"));
        assert!(error("tool.links", ParameterValue::Double(2.5)).contains("2.5"));
        assert!(error("use_sim_time", ParameterValue::Integer(1)).contains("true or false"));
        assert!(
            error("contact.inner.friction_axial", ParameterValue::Double(-1.0))
                .contains("contact.inner.friction_axial = -1")
        );
    }

    #[test]
    fn live_and_fixed_parameters() {
        for (key, live) in [
            ("contact.inner.friction_axial", true),
            ("contact.inner.stiffness", false),
            ("tool.bit.friction_factor", true),
            ("tool.links", false),
            ("solver.time_step", false),
            ("inputs.rotary_speed.slew_rpm_per_s", true),
            ("inputs.rotary_speed.initial_rpm", false),
            ("whirl.levels.warning.contact_duty", true),
            ("outputs.rates.bit_state", true),
            ("use_sim_time", false),
        ] {
            assert_eq!(is_live(key), live, "{key}");
        }
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
        assert_eq!(slew.floating_point_range.len(), 1);
        assert!(store.get("use_sim_time").is_some());
        assert!(store.names().count() > 60);
    }

    #[test]
    fn values_that_depend_on_each_other_change_together() {
        let double = |name: &str, value| Parameter {
            name: name.into(),
            value: ParameterValue::Double(value),
        };
        let (low, high) = ("inputs.rotary_speed.min_rpm", "inputs.rotary_speed.max_rpm");
        let error = reconfigured(&config(), &[double(low, 150.0)]).unwrap_err();
        assert!(error.contains("min_rpm = 150") && error.contains("120"), "{error}");
        let both = [
            double(low, 150.0),
            double(high, 300.0),
            double("inputs.rotary_speed.safe_rpm", 150.0),
            Parameter {
                name: "inputs.rotary_speed.initial_rpm".into(),
                value: ParameterValue::Double(150.0),
            },
        ];
        // The initial value is not live and stays where it was, below the new limit.
        assert!(reconfigured(&config(), &both).unwrap_err().contains("initial_rpm"));
        assert_eq!(
            reconfigured(&config(), &[double(high, 300.0)])
                .unwrap()
                .inputs
                .rotary_speed
                .max_rpm,
            300.0
        );
    }
}
