//! Parameters of the start, from `-p` or a parameter file.

use flexdrill_ros2::parameters::ParameterValue;

use super::configured::to_json;
use super::live::{CONFIG_FILE, USE_SIM_TIME};
use flexdrill_config::{Config, ConfigError};
use flexdrill_ros2::args::Override;
use flexdrill_ros2::args::value::show;

/// Why a parameter of the start is refused.
#[derive(Debug, thiserror::Error)]
pub enum OverrideError {
    /// No such parameter.
    #[error(
        "{origin}: there is no parameter '{name}'; the parameters are the keys of the configuration (`flexdrill check CONFIG --full`) and use_sim_time"
    )]
    Unknown {
        /// Dotted name of the parameter.
        name: String,
        /// Option or file and line.
        origin: String,
    },
    /// Wrong type.
    #[error("{origin}: '{name}' = {value}: {why}")]
    Value {
        /// Dotted name of the parameter.
        name: String,
        /// Its value.
        value: String,
        /// Option or file and line.
        origin: String,
        /// What is wrong.
        why: String,
    },
    /// The configuration is not valid with the value.
    #[error(transparent)]
    Config(#[from] ConfigError),
}

/// The result of the overrides.
#[derive(Debug)]
pub struct Started {
    /// The configuration with the overrides.
    pub config: Config,
    /// Whether `/clock` paces the model.
    pub use_sim_time: bool,
}

/// The file of the configuration that the overrides of a node name, and the origin of the override.
///
/// # Errors
/// When the value is no path.
pub fn config_file(overrides: &[Override]) -> Result<Option<(&str, &str)>, OverrideError> {
    let Some(given) = overrides.iter().find(|given| given.name == CONFIG_FILE) else {
        return Ok(None);
    };
    match &given.value {
        ParameterValue::String(path) if !path.is_empty() => Ok(Some((path, &given.origin))),
        other => Err(OverrideError::Value {
            name: given.name.clone(),
            value: show(other),
            origin: given.origin.clone(),
            why: "give the path of a configuration (YAML)".to_owned(),
        }),
    }
}

/// Applies the overrides of a node to a configuration, all at once.
///
/// # Errors
/// When a parameter does not exist, has the wrong type, or the configuration is not valid with it.
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
            // The configuration was read from it: see `config_file`.
            (CONFIG_FILE, _) => {}
            // Every file of `ros2 param dump` has these parameters of rclcpp.
            (name, _) if name.starts_with("qos_overrides.") || name == "start_type_description_service" => {}
            // A file of `ros2 param dump` has optional keys without a value.
            (_, ParameterValue::NotSet) => {}
            (key, value) => values.push((
                key.to_owned(),
                to_json(value).ok_or_else(|| wrong("this type is not used"))?,
            )),
        }
    }
    // All names are checked before any value is applied, so that the error names the option or file of the wrong one.
    for (key, _) in &values {
        if !config.has(key) {
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
    // Together, because two values may be valid only with each other.
    Ok(Started {
        config: config.with_values("parameters", values)?,
        use_sim_time,
    })
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
            over("config_file", ParameterValue::String("rig_7.yaml".into())),
        ];
        assert_eq!(config_file(&overrides).unwrap(), Some(("rig_7.yaml", "-p config_file")));
        let started = apply_overrides(&config(), &overrides).unwrap();
        assert_eq!(started.config.tool.links, 20);
        assert_eq!(started.config.inputs.rotary_speed.initial_rpm, 40.0);
        assert!(started.use_sim_time);
        assert_ne!(started.config.hash(), config().hash());
    }

    #[test]
    fn an_optional_key_is_a_parameter_and_takes_a_value_at_the_start() {
        let key = "run.duration";
        let store = super::super::declare(&config(), "", false);
        assert_eq!(store.get(key), Some(&ParameterValue::NotSet));
        let described = store.describe(key);
        assert!(
            described.read_only && described.description.ends_with("Not set."),
            "{described:?}"
        );
        // A section that is left out as a whole has no keys, and lists of mappings are none of ROS 2's types.
        assert!(store.names().all(|name| !name.starts_with("environment.pressure.")));
        let started = |value| apply_overrides(&config(), &[over(key, value)]);
        assert_eq!(
            started(ParameterValue::Double(12.0)).unwrap().config.run.duration,
            Some(12.0)
        );
        assert_eq!(started(ParameterValue::NotSet).unwrap().config.run.duration, None);
        let wrong = started(ParameterValue::String("long".into())).unwrap_err().to_string();
        assert!(wrong.contains(key) && !wrong.contains("left out"), "{wrong}");
        let unknown = apply_overrides(&config(), &[over("run.length", ParameterValue::Double(1.0))]);
        assert!(unknown.unwrap_err().to_string().contains("run.length"));
    }

    #[test]
    fn wrong_overrides_are_explained() {
        let error = |name: &str, value| {
            apply_overrides(&config(), &[over(name, value)])
                .unwrap_err()
                .to_string()
        };
        let number = [over("config_file", ParameterValue::Integer(3))];
        let refused = config_file(&number).unwrap_err().to_string();
        assert!(refused.contains("'config_file' = 3"), "{refused}");
        assert!(error("tool.link", ParameterValue::Integer(3)).contains("'tool.link'"));
        assert!(error("tool.links", ParameterValue::String("many".into())).contains("must be a number"));
        assert!(error("tool.links", ParameterValue::Double(2.5)).contains("2.5"));
        assert!(error("use_sim_time", ParameterValue::Integer(1)).contains("true or false"));
        assert!(
            error("contact.inner.friction_axial", ParameterValue::Double(-1.0))
                .contains("contact.inner.friction_axial = -1")
        );
    }
}
