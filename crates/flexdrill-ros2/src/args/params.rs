//! Parameter overrides: `-p [node:]name:=value` and parameter files.

use std::path::Path;

use ros2_client::ParameterValue;
use serde_json::Value;

use super::ArgsError;
use super::names::NodeIdentity;
use super::value::{parse, to_parameter};

/// One override, for the nodes whose full name matches `node`.
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    /// Pattern of the node's full name: `/**`, `/rig/*`, `/rig/flexdrill`.
    pub node: String,
    /// Parameter, dotted.
    pub name: String,
    /// Value.
    pub value: ParameterValue,
    /// Where it was given, for error messages.
    pub origin: String,
}

/// Overrides in the order given; later ones win.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Overrides {
    pub(super) entries: Vec<Override>,
}

impl Overrides {
    /// Those for a node, each name once, the last one given.
    pub fn for_node(&self, identity: &NodeIdentity) -> Vec<Override> {
        let full_name = identity.full_name();
        let mut chosen: Vec<Override> = Vec::new();
        for entry in self.entries.iter().filter(|entry| matches(&entry.node, &full_name)) {
            chosen.retain(|earlier| earlier.name != entry.name);
            chosen.push(entry.clone());
        }
        chosen
    }
}

/// Whether a node's full name matches a pattern: `*` stands for one part, `**` for any number of parts.
pub fn matches(pattern: &str, full_name: &str) -> bool {
    fn parts(text: &str) -> Vec<&str> {
        text.split('/').filter(|part| !part.is_empty()).collect()
    }
    let name = parts(full_name);
    // By number of parts of the name: whether the pattern so far matches so many. Each part of the pattern is looked at
    // once for each of the name, however many `**` there are.
    let mut so_far = vec![false; name.len() + 1];
    so_far[0] = true;
    for part in parts(pattern) {
        if part == "**" {
            let shortest = so_far.iter().position(|matched| *matched).unwrap_or(so_far.len());
            so_far[shortest..].fill(true);
        } else {
            for count in (1..so_far.len()).rev() {
                so_far[count] = so_far[count - 1] && (part == "*" || part == name[count - 1]);
            }
            so_far[0] = false;
        }
    }
    so_far[name.len()]
}

/// Reads `[node:]name:=value`.
///
/// # Errors
/// When there is no `:=`, no name, or the value is not YAML of a parameter type.
pub(super) fn read_override(text: &str, into: &mut Overrides) -> Result<(), ArgsError> {
    let wrong = |why: String| ArgsError::Parameter {
        parameter: text.to_owned(),
        why,
    };
    let (left, right) = text
        .split_once(":=")
        .ok_or_else(|| wrong("write it as name:=value".into()))?;
    let (node, name) = match left.split_once(':') {
        Some((node, name)) => (format!("/**/{}", node.trim_start_matches('/')), name),
        None => ("/**".to_owned(), left),
    };
    if name.is_empty() {
        return Err(wrong("the name is missing".into()));
    }
    let value = parse(right)
        .and_then(|value| to_parameter(&value))
        .map_err(|error| wrong(error.to_string()))?;
    into.entries.push(Override {
        node,
        name: name.to_owned(),
        value,
        origin: format!("-p {text}"),
    });
    Ok(())
}

/// Reads a parameter file.
///
/// # Errors
/// When the file cannot be read, is not YAML, or is not laid out as node names with `ros__parameters` below.
pub(super) fn read_file(path: &Path, into: &mut Overrides) -> Result<(), ArgsError> {
    let text = std::fs::read_to_string(path).map_err(|source| ArgsError::File {
        path: path.to_owned(),
        why: source.to_string(),
    })?;
    read_text(path, &text, into)
}

fn read_text(path: &Path, text: &str, into: &mut Overrides) -> Result<(), ArgsError> {
    let wrong = |why: String| ArgsError::File {
        path: path.to_owned(),
        why,
    };
    match parse(text).map_err(|error| wrong(error.to_string()))? {
        Value::Null => Ok(()),
        Value::Object(entries) => entries
            .iter()
            .try_for_each(|(key, below)| read_nodes(path, key, below, into)),
        _ => Err(wrong("the top level must map node names to 'ros__parameters'".into())),
    }
}

fn read_nodes(path: &Path, node: &str, below: &Value, into: &mut Overrides) -> Result<(), ArgsError> {
    let wrong = |why: String| ArgsError::File {
        path: path.to_owned(),
        why,
    };
    let Value::Object(entries) = below else {
        return Err(wrong(format!(
            "'{node}' must hold 'ros__parameters' or a deeper node name, not a value"
        )));
    };
    for (key, value) in entries {
        if key != "ros__parameters" {
            read_nodes(
                path,
                &format!("{}/{}", node.trim_end_matches('/'), key.trim_start_matches('/')),
                value,
                into,
            )?;
            continue;
        }
        match value {
            Value::Null => {}
            Value::Object(parameters) => {
                for (name, value) in parameters {
                    read_parameter(path, node, name.clone(), value, into)?;
                }
            }
            _ => {
                return Err(wrong(format!(
                    "'ros__parameters' of '{node}' must be a mapping of names to values"
                )));
            }
        }
    }
    Ok(())
}

fn read_parameter(path: &Path, node: &str, name: String, value: &Value, into: &mut Overrides) -> Result<(), ArgsError> {
    if let Value::Object(deeper) = value {
        return deeper
            .iter()
            .try_for_each(|(key, value)| read_parameter(path, node, format!("{name}.{key}"), value, into));
    }
    let value = to_parameter(value).map_err(|why| ArgsError::File {
        path: path.to_owned(),
        why: format!("parameter '{name}' of '{node}': {why}"),
    })?;
    let node = if node.starts_with('/') {
        node.to_owned()
    } else {
        format!("/{node}")
    };
    into.entries.push(Override {
        node,
        name,
        value,
        origin: path.display().to_string(),
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(namespace: &str) -> NodeIdentity {
        NodeIdentity::new(namespace, "flexdrill").unwrap()
    }

    #[test]
    fn patterns_match_whole_parts() {
        for (pattern, name, expected) in [
            ("/**", "/a/b", true),
            ("/**", "/a", true),
            ("/*", "/a", true),
            ("/*", "/a/b", false),
            ("/rig/*", "/rig/flexdrill", true),
            ("/**/flexdrill", "/rig/deep/flexdrill", true),
            ("/**/flexdrill", "/flexdrill", true),
            ("/flexdrill", "/rig/flexdrill", false),
            ("/flex", "/flexdrill", false),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} against {name}");
        }
    }

    #[test]
    fn file_forms_and_order() {
        let text = "
/**:
  ros__parameters:
    rates: {bit_state: 20.0}
    use_sim_time: false
rig_7:
  flexdrill:
    ros__parameters: {rates.bit_state: 25.0}
/other:
  ros__parameters: {bit.friction_factor: 0.9}
";
        let mut overrides = Overrides::default();
        read_text(Path::new("p.yaml"), text, &mut overrides).unwrap();
        read_override("flexdrill:use_sim_time:=true", &mut overrides).unwrap();
        read_override("someone_else:use_sim_time:=false", &mut overrides).unwrap();
        let here = overrides.for_node(&node("/rig_7"));
        let get = |name: &str| here.iter().find(|o| o.name == name).map(|o| o.value.clone());
        assert_eq!(get("rates.bit_state"), Some(ParameterValue::Double(25.0)));
        assert_eq!(get("use_sim_time"), Some(ParameterValue::Boolean(true)));
        assert_eq!(get("bit.friction_factor"), None);
        assert_eq!(overrides.for_node(&node("/")).len(), 2);
    }

    #[test]
    fn wrong_files_say_what_is_wrong() {
        let error = |text: &str| {
            read_text(Path::new("p.yaml"), text, &mut Overrides::default())
                .unwrap_err()
                .to_string()
        };
        assert!(error("a: 1").contains("'a' must hold 'ros__parameters'"));
        assert!(error("[1]").contains("top level"));
        assert!(error("/**: {ros__parameters: {x: [1, a]}}").contains("'x'"));
        assert!(error("/**: {ros__parameters: {x: [}").contains("p.yaml"));
    }
}
