//! Values of parameters as they are written in YAML: on the command line (`-p name:=value`) and in parameter files.

use std::fmt;

use ros2_client::ParameterValue;
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

/// A YAML document without the styles: what a scalar is follows YAML 1.2 (`1` integer, `1.0` float, `true` boolean).
#[derive(Debug, Clone, PartialEq)]
pub enum Yaml {
    /// `null`, `~` or nothing.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A number with a fraction or an exponent.
    Float(f64),
    /// Anything else.
    Text(String),
    /// A sequence.
    List(Vec<Yaml>),
    /// A mapping, in the order written.
    Map(Vec<(String, Yaml)>),
}

impl Yaml {
    /// Turns a scalar or a list of scalars of one kind into a parameter value. Whole numbers in a list of floats are
    /// taken as floats.
    ///
    /// # Errors
    /// Says what the value is when ROS 2 has no parameter type for it.
    pub fn to_parameter(&self) -> Result<ParameterValue, String> {
        Ok(match self {
            Yaml::Null => return Err("nothing is given".into()),
            Yaml::Bool(v) => ParameterValue::Boolean(*v),
            Yaml::Integer(v) => ParameterValue::Integer(*v),
            Yaml::Float(v) => ParameterValue::Double(*v),
            Yaml::Text(v) => ParameterValue::String(v.clone()),
            Yaml::Map(_) => return Err("a mapping is not a parameter value".into()),
            Yaml::List(items) => return list_to_parameter(items),
        })
    }
}

fn list_to_parameter(items: &[Yaml]) -> Result<ParameterValue, String> {
    let collect = |pick: fn(&Yaml) -> Option<ParameterValue>| items.iter().map(pick).collect::<Option<Vec<_>>>();
    let kind = |value: &Yaml| match value {
        Yaml::Bool(v) => Some(ParameterValue::Boolean(*v)),
        Yaml::Integer(v) => Some(ParameterValue::Integer(*v)),
        Yaml::Float(v) => Some(ParameterValue::Double(*v)),
        Yaml::Text(v) => Some(ParameterValue::String(v.clone())),
        _ => None,
    };
    let mixed = || "a list must hold values of one kind: all true/false, all numbers or all text".to_owned();
    let values = collect(kind).ok_or_else(mixed)?;
    let integers: Option<Vec<i64>> = values
        .iter()
        .map(|v| {
            if let ParameterValue::Integer(i) = v {
                Some(*i)
            } else {
                None
            }
        })
        .collect();
    if let Some(integers) = integers {
        return Ok(ParameterValue::IntegerArray(integers));
    }
    let doubles: Option<Vec<f64>> = values
        .iter()
        .map(|v| match v {
            ParameterValue::Integer(i) => Some(*i as f64),
            ParameterValue::Double(d) => Some(*d),
            _ => None,
        })
        .collect();
    if let Some(doubles) = doubles {
        return Ok(ParameterValue::DoubleArray(doubles));
    }
    let booleans: Option<Vec<bool>> = values
        .iter()
        .map(|v| {
            if let ParameterValue::Boolean(b) = v {
                Some(*b)
            } else {
                None
            }
        })
        .collect();
    if let Some(booleans) = booleans {
        return Ok(ParameterValue::BooleanArray(booleans));
    }
    let texts: Option<Vec<String>> = values
        .into_iter()
        .map(|v| {
            if let ParameterValue::String(s) = v {
                Some(s)
            } else {
                None
            }
        })
        .collect();
    texts.map(ParameterValue::StringArray).ok_or_else(mixed)
}

impl<'de> Deserialize<'de> for Yaml {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(YamlVisitor)
    }
}

struct YamlVisitor;

impl<'de> Visitor<'de> for YamlVisitor {
    type Value = Yaml;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a YAML value")
    }

    fn visit_unit<E>(self) -> Result<Yaml, E> {
        Ok(Yaml::Null)
    }

    fn visit_none<E>(self) -> Result<Yaml, E> {
        Ok(Yaml::Null)
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Yaml, D::Error> {
        Yaml::deserialize(deserializer)
    }

    fn visit_bool<E>(self, v: bool) -> Result<Yaml, E> {
        Ok(Yaml::Bool(v))
    }

    fn visit_i64<E>(self, v: i64) -> Result<Yaml, E> {
        Ok(Yaml::Integer(v))
    }

    fn visit_u64<E: serde::de::Error>(self, v: u64) -> Result<Yaml, E> {
        i64::try_from(v)
            .map(Yaml::Integer)
            .map_err(|_| E::custom(format!("{v} does not fit a 64-bit signed integer")))
    }

    fn visit_f64<E>(self, v: f64) -> Result<Yaml, E> {
        Ok(Yaml::Float(v))
    }

    fn visit_str<E>(self, v: &str) -> Result<Yaml, E> {
        Ok(Yaml::Text(v.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Yaml, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = seq.next_element()? {
            items.push(item);
        }
        Ok(Yaml::List(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Yaml, A::Error> {
        let mut entries = Vec::new();
        while let Some(key) = map.next_key::<String>()? {
            entries.push((key, map.next_value()?));
        }
        Ok(Yaml::Map(entries))
    }
}

/// Reads one YAML value from text.
///
/// # Errors
/// The parser's message with line and column.
pub fn parse(text: &str) -> Result<Yaml, String> {
    if text.trim().is_empty() {
        return Ok(Yaml::Null);
    }
    serde_saphyr::from_str(text).map_err(|error| error.to_string())
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
        parse(text).unwrap().to_parameter().unwrap()
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
        assert!(parse("[1, a]").unwrap().to_parameter().is_err());
        assert!(parse("[[1]]").unwrap().to_parameter().is_err());
    }
}
