//! Every key of the configuration, from the JSON Schema, which is made from the doc comments.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use crate::cell;

/// Every key with type, default, bounds and meaning.
pub fn page() -> String {
    let schema = flexdrill_config::json_schema();
    let mut out = String::from(
        "# Configuration reference\n\n\
         Written by `cargo xtask reference configuration`. A file is YAML; units are SI, and a key with another unit carries it\n\
         in its name. Only `well` and `tool` must be given, unknown keys are refused, and `flexdrill check FILE` reports errors\n\
         with file, line, key, value, bound and unit. `config/default.yaml` gives every value with its reason.\n\n\
         Editors complete keys and show these texts by the JSON Schema `config/flexdrill.schema.json`\n\
         (`flexdrill check --schema`): the first line of `config/default.yaml` points to it for editors with a YAML language\n\
         server, such as VS Code with its YAML extension.\n\n\
         Each key is a ROS 2 parameter of the same dotted name; which may change while the twin runs, `ros2 param describe` says.\n",
    );
    section(&mut out, &schema, &schema, "", &mut Vec::new());
    out
}

/// The definition that a schema refers to, or itself.
fn resolved<'a>(root: &'a Value, schema: &'a Value) -> &'a Value {
    let reference = schema.get("$ref").and_then(Value::as_str);
    reference
        .and_then(|reference| root.pointer(reference.trim_start_matches('#')))
        .unwrap_or(schema)
}

fn properties(schema: &Value) -> Option<&Map<String, Value>> {
    schema.get("properties").and_then(Value::as_object)
}

/// A key's dotted path.
fn joined(path: &str, key: &str) -> String {
    if path.is_empty() {
        key.to_owned()
    } else {
        format!("{path}.{key}")
    }
}

/// A table of an object's keys, then a section for each that holds keys itself.
fn section(out: &mut String, root: &Value, schema: &Value, path: &str, above: &mut Vec<*const Value>) {
    let Some(keys) = properties(schema) else { return };
    // Definitions that hold themselves would have no end.
    if above.contains(&std::ptr::from_ref(schema)) {
        return;
    }
    above.push(std::ptr::from_ref(schema));
    if !path.is_empty() {
        let _ = writeln!(out, "\n## {path}");
    } else {
        out.push_str("\n## The whole file\n");
    }
    // JSON Schema lists required keys at the object and not at the key.
    let required: Vec<&str> = schema["required"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    // A default of the whole section applies to its keys where they have none.
    let default = schema.get("default");
    out.push_str("| key | type | default | meaning |\n|---|---|---|---|\n");
    for (key, value) in keys {
        let full = joined(path, key);
        let target = resolved(root, value);
        // Objects have a section below; their default would be the whole section in a cell.
        let shown = match value.get("default").or_else(|| default?.get(key)) {
            _ if required.contains(&key.as_str()) => "required".to_owned(),
            Some(Value::Object(_)) if properties(target).is_some() => "see below".to_owned(),
            Some(Value::Null) | None => String::new(),
            Some(value) => format!("`{}`", plain_value(value)),
        };
        // The comment at the key says more than that of its type.
        let description = value
            .get("description")
            .or_else(|| target.get("description"))
            .and_then(Value::as_str);
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} |",
            if properties(target).is_some() {
                format!("[`{key}`](#{})", anchor(&full))
            } else {
                format!("`{key}`")
            },
            kind(root, value),
            cell(&shown),
            cell(description.unwrap_or_default())
        );
    }
    // Sections follow the table, depth first, so that a section stands below the key that leads to it.
    for (key, value) in keys {
        below(out, root, value, &joined(path, key), above);
    }
    // A type may occur at two places; only one within itself would have no end.
    above.pop();
}

/// The sections of what stands under a key: of an object, of the items of a list, of each form that has keys of its own.
fn below(out: &mut String, root: &Value, value: &Value, path: &str, above: &mut Vec<*const Value>) {
    let target = resolved(root, value);
    section(out, root, target, path, above);
    if let Some(items) = target.get("items") {
        below(out, root, items, &format!("{path}[]"), above);
    }
    let forms = target
        .get("oneOf")
        .or_else(|| target.get("anyOf"))
        .and_then(Value::as_array);
    for form in forms.into_iter().flatten() {
        match properties(resolved(root, form)) {
            // `{arc: {radius: ...}}`: one key that names the form.
            Some(keys) if keys.len() == 1 => {
                for (name, inner) in keys {
                    below(out, root, inner, &format!("{path}.{name}"), above);
                }
            }
            _ => below(out, root, form, path, above),
        }
    }
}

/// A default as one would write it.
fn plain_value(value: &Value) -> String {
    match value {
        Value::String(text) if text.is_empty() => "\"\"".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) => number
            .as_f64()
            .map_or_else(|| number.to_string(), flexdrill_config::checker::number),
        Value::Array(items) => format!("[{}]", items.iter().map(plain_value).collect::<Vec<_>>().join(", ")),
        other => other.to_string(),
    }
}

/// The anchor of a heading, as mdBook and GitHub make it.
fn anchor(heading: &str) -> String {
    heading
        .to_lowercase()
        .chars()
        .filter(|c| c.is_alphanumeric() || "-_".contains(*c))
        .collect()
}

/// The type in a word or two, with the words of an enumeration.
fn kind(root: &Value, value: &Value) -> String {
    let target = resolved(root, value);
    let several = target
        .get("oneOf")
        .or_else(|| target.get("anyOf"))
        .and_then(Value::as_array);
    if let Some(several) = several {
        let words: Vec<String> = several
            .iter()
            .map(
                |one| match one.get("const").or_else(|| one.get("enum")?.as_array()?.first()) {
                    Some(Value::String(word)) => format!("`{word}`"),
                    _ => match properties(one) {
                        Some(keys) => format!("`{{{}: ...}}`", keys.keys().cloned().collect::<Vec<_>>().join(", ")),
                        None => kind(root, one),
                    },
                },
            )
            .collect();
        return words.join(", ");
    }
    if let Some(words) = target.get("enum").and_then(Value::as_array) {
        let words: Vec<String> = words
            .iter()
            .filter_map(Value::as_str)
            .map(|word| format!("`{word}`"))
            .collect();
        return words.join(", ");
    }
    match target.get("type") {
        Some(Value::String(name)) => plain(root, target, name),
        // What may be left out is also null.
        Some(Value::Array(names)) => {
            let name = names.iter().filter_map(Value::as_str).find(|name| *name != "null");
            name.map_or_else(String::new, |name| plain(root, target, name))
        }
        _ => String::new(),
    }
}

fn plain(root: &Value, target: &Value, name: &str) -> String {
    match name {
        "number" => "number".to_owned(),
        "integer" => "whole number".to_owned(),
        "string" => "text".to_owned(),
        "boolean" => "true or false".to_owned(),
        "array" => match target.get("items") {
            Some(items) => format!("list of {}", kind(root, items)),
            None => "list".to_owned(),
        },
        _ => "section".to_owned(),
    }
}
