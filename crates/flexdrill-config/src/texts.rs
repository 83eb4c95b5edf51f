//! The meaning of every key, by its dotted name: the texts of the JSON Schema, for parameter descriptions.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::json_schema::json_schema;

/// The meaning of every key, in a sentence or two, with the words that it takes; no two keys have the same text. Bounds
/// are not in it.
pub fn key_texts() -> BTreeMap<String, String> {
    let schema = json_schema();
    let mut keys = Vec::new();
    walk(&schema, &schema, &Position::default(), &mut Vec::new(), &mut keys);
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for key in &keys {
        *count.entry(&key.text).or_default() += 1;
    }
    // Keys of shared sections have equal texts; the text of the section distinguishes them.
    let texts = keys.iter().map(|key| match count.get(key.text.as_str()) {
        Some(2..) => (key.name.clone(), format!("{} {}", key.section, key.text)),
        _ => (key.name.clone(), key.text.clone()),
    });
    texts.collect()
}

/// A key with its own text and that of its section.
struct Key {
    name: String,
    text: String,
    section: String,
}

/// Position of the walk: the dotted name and the text of the section.
#[derive(Default)]
struct Position {
    path: String,
    text: String,
}

fn walk(root: &Value, schema: &Value, at: &Position, above: &mut Vec<*const Value>, keys: &mut Vec<Key>) {
    // A definition that contains itself would never end.
    if above.contains(&std::ptr::from_ref(schema)) {
        return;
    }
    above.push(std::ptr::from_ref(schema));
    for (key, value) in properties(schema).into_iter().flatten() {
        let target = resolved(root, value);
        let name = match at.path.as_str() {
            "" => key.clone(),
            path => format!("{path}.{key}"),
        };
        let mut text = described(root, value, target);
        if text.is_empty() {
            // The only key of a form is described by the form.
            text = described(root, schema, schema);
        }
        let below = Position {
            path: name.clone(),
            text: text.clone(),
        };
        keys.push(Key {
            name,
            text,
            section: at.text.clone(),
        });
        walk(root, target, &below, above, keys);
    }
    for form in forms(schema) {
        walk(root, resolved(root, form), at, above, keys);
    }
    above.pop();
}

/// The first paragraph of a key's description, with the words that it takes where they are not in it.
fn described(root: &Value, value: &Value, target: &Value) -> String {
    let description = value.get("description").or_else(|| target.get("description"));
    let text = description.and_then(Value::as_str).unwrap_or_default();
    let mut text = text.split("\n\n").next().unwrap_or_default().to_owned();
    let words = words(root, target);
    if !words.iter().all(|word| text.contains(word)) {
        text = format!("{text} One of {}.", words.join(", "));
    }
    text
}

/// The words of an enumeration.
fn words(root: &Value, target: &Value) -> Vec<String> {
    let listed = target.get("enum").and_then(Value::as_array).into_iter().flatten();
    let constant = target.get("const").into_iter();
    let own = listed.chain(constant).filter_map(Value::as_str).map(str::to_owned);
    let of_forms = forms(target).flat_map(|form| words(root, resolved(root, form)));
    own.chain(of_forms).collect()
}

fn forms(schema: &Value) -> impl Iterator<Item = &Value> {
    let of = |name: &str| schema.get(name).and_then(Value::as_array);
    of("oneOf").or_else(|| of("anyOf")).into_iter().flatten()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_a_text_of_its_own() {
        let texts = key_texts();
        assert!(texts.len() > 150, "{}", texts.len());
        let mut seen: BTreeMap<&str, &str> = BTreeMap::new();
        for (key, text) in &texts {
            assert!(text.len() > 5 && !text.contains("\n"), "{key}: {text:?}");
            let other = seen.insert(text, key);
            assert!(other.is_none(), "{key} and {other:?}: {text}");
        }
        assert!(texts["outputs.rates.whirl"].contains("twin/whirl"));
        assert!(texts["tool.joint.kind"].contains("ball_cage"));
        assert_ne!(texts["shock.levels.watch"], texts["stick_slip.levels.watch"]);
    }
}
