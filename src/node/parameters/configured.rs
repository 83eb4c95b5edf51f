//! Every value of the configuration as a ROS 2 parameter of the same dotted name.
//!
//! At the start `-p` or a parameter file may set any of them: the configuration is changed before the model is built, and
//! the hash and the recording of the run are those of the changed one. While the node runs, only those values may change
//! for which the model need not be rebuilt.

use flexdrill_ros2::parameters::{Parameter, ParameterValue};
use serde_json::Value;

use super::live::is_live;
use flexdrill_config::{Config, ConfigError};

/// The configuration with changed parameters, checked as a whole.
///
/// # Errors
/// When the configuration is not valid with them.
pub fn reconfigured(config: &Config, changed: &[Parameter]) -> Result<Config, ConfigError> {
    let values = changed
        .iter()
        .filter(|parameter| is_live(&parameter.name))
        .filter_map(|parameter| Some((&parameter.name, to_json(&parameter.value)?)));
    config.with_live_values("parameter", values)
}

/// The value for the configuration; `None` for types that it does not use.
pub(super) fn to_json(value: &ParameterValue) -> Option<Value> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> Config {
        Config::from_text("default.yaml", include_str!("../../../config/default.yaml")).unwrap()
    }

    #[test]
    fn values_that_depend_on_each_other_change_together() {
        let double = |name: &str, value| Parameter {
            name: name.into(),
            value: ParameterValue::Double(value),
        };
        let (low, high) = ("inputs.rotary_speed.min_rpm", "inputs.rotary_speed.max_rpm");
        let error = reconfigured(&config(), &[double(low, 150.0)]).unwrap_err().to_string();
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
        // The initial value is not live and remains below the new limit.
        assert!(
            reconfigured(&config(), &both)
                .unwrap_err()
                .to_string()
                .contains("initial_rpm")
        );
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
