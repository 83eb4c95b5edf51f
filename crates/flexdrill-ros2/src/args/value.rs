//! Values of parameters as they are written in YAML: on the command line (`-p name:=value`) and in parameter files.
//!
//! What a scalar is follows YAML 1.2 (`1` integer, `1.0` float, `true` boolean).

use ros2_client::ParameterValue;
use serde_json::Value;

/// Why a text is not the value of a parameter.
#[derive(Debug, thiserror::Error)]
pub enum ValueError {
    /// Empty, `null` or `~`.
    #[error("nothing is given")]
    Missing,
    /// A mapping, which ROS 2 has no parameter type for.
    #[error("a mapping is not a parameter value")]
    Mapping,
    /// A list that no array type of ROS 2 can hold.
    #[error("a list must hold values of one kind: all true/false, all numbers or all text")]
    MixedList,
    /// A whole number beyond the largest of ROS 2's integers.
    #[error("{0} does not fit a 64-bit signed integer")]
    TooLarge(u64),
    /// Not YAML; with line and column.
    #[error("{}", .0.render_with_formatter(&serde_saphyr::UserMessageFormatter))]
    Syntax(#[from] serde_saphyr::Error),
}

/// Reads one YAML value from text.
///
/// # Errors
/// When it is not YAML.
pub fn parse(text: &str) -> Result<Value, ValueError> {
    if text.trim().is_empty() {
        return Ok(Value::Null);
    }
    Ok(serde_saphyr::from_str(text)?)
}

/// Turns a scalar or a list of scalars of one kind into a parameter value. Whole numbers in a list of floats are taken
/// as floats.
///
/// # Errors
/// When ROS 2 has no parameter type for the value.
pub fn to_parameter(value: &Value) -> Result<ParameterValue, ValueError> {
    match value {
        Value::Null => Err(ValueError::Missing),
        Value::Bool(v) => Ok(ParameterValue::Boolean(*v)),
        Value::Number(v) => match (v.as_i64(), v.as_u64(), v.as_f64()) {
            (Some(v), ..) => Ok(ParameterValue::Integer(v)),
            (_, Some(v), _) => Err(ValueError::TooLarge(v)),
            (.., Some(v)) => Ok(ParameterValue::Double(v)),
            _ => Err(ValueError::Missing),
        },
        Value::String(v) => Ok(ParameterValue::String(v.clone())),
        Value::Array(items) => list_to_parameter(items),
        Value::Object(_) => Err(ValueError::Mapping),
    }
}

fn list_to_parameter(items: &[Value]) -> Result<ParameterValue, ValueError> {
    fn all<T>(items: &[Value], pick: impl Fn(&Value) -> Option<T>) -> Option<Vec<T>> {
        items.iter().map(pick).collect()
    }
    all(items, Value::as_i64)
        .map(ParameterValue::IntegerArray)
        .or_else(|| all(items, Value::as_f64).map(ParameterValue::DoubleArray))
        .or_else(|| all(items, Value::as_bool).map(ParameterValue::BooleanArray))
        .or_else(|| all(items, |item| item.as_str().map(str::to_owned)).map(ParameterValue::StringArray))
        .ok_or(ValueError::MixedList)
}

/// A parameter value as `ros2 param get` would print it.
pub fn show(value: &ParameterValue) -> String {
    match value {
        ParameterValue::NotSet => "not set".into(),
        ParameterValue::Boolean(v) => v.to_string(),
        ParameterValue::Integer(v) => v.to_string(),
        ParameterValue::Double(v) => format!("{v:?}"),
        ParameterValue::String(v) => v.clone(),
        ParameterValue::ByteArray(v) => format!("{v:?}"),
        ParameterValue::BooleanArray(v) => format!("{v:?}"),
        ParameterValue::IntegerArray(v) => format!("{v:?}"),
        ParameterValue::DoubleArray(v) => format!("{v:?}"),
        ParameterValue::StringArray(v) => format!("{v:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> ParameterValue {
        to_parameter(&parse(text).unwrap()).unwrap()
    }

    #[test]
    fn scalars_have_the_types_of_ros() {
        assert_eq!(value("true"), ParameterValue::Boolean(true));
        assert_eq!(value("-7"), ParameterValue::Integer(-7));
        assert_eq!(value("1.5"), ParameterValue::Double(1.5));
        assert_eq!(value("1e3"), ParameterValue::Double(1000.0));
        assert_eq!(value("rig one"), ParameterValue::String("rig one".into()));
        assert_eq!(value("'12'"), ParameterValue::String("12".into()));
        assert_eq!(value("\"true\""), ParameterValue::String("true".into()));
    }

    #[test]
    fn lists_are_of_one_kind() {
        assert_eq!(value("[1, 2]"), ParameterValue::IntegerArray(vec![1, 2]));
        assert_eq!(value("[1, 2.5]"), ParameterValue::DoubleArray(vec![1.0, 2.5]));
        assert_eq!(
            value("[a, b]"),
            ParameterValue::StringArray(vec!["a".into(), "b".into()])
        );
        for wrong in ["[1, a]", "[[1]]", "{a: 1}", "", "~", ".nan", "18446744073709551615"] {
            let value = parse(wrong).and_then(|value| to_parameter(&value));
            assert!(value.is_err(), "{wrong}");
        }
    }
}
