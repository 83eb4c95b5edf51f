//! Dotted keys in the tree of a configuration's values: where they stand, which are left out, and which was meant.

use std::collections::BTreeMap;

use serde_json::Value;

use super::{key_texts, reading};

/// The JSON pointer of a dotted key.
fn pointer(key: &str) -> String {
    format!("/{}", key.replace('.', "/"))
}

/// The JSON pointer of what holds a dotted key, and the key's last name.
pub(crate) fn parent(key: &str) -> (String, &str) {
    key.rsplit_once('.')
        .map_or((String::new(), key), |(parent, name)| (pointer(parent), name))
}

/// The optional keys that a tree leaves out, with their texts.
pub(crate) fn left_out(tree: &Value) -> BTreeMap<String, String> {
    let texts = key_texts();
    let is_section = |key: &str| {
        let below = format!("{key}.");
        let mut after = texts.range(below.clone()..);
        after.next().is_some_and(|(next, _)| next.starts_with(&below))
    };
    let is_left_out = |key: &str| {
        let value = tree.pointer(&pointer(key));
        let section = tree.pointer(&parent(key).0);
        section.is_some_and(Value::is_object) && value.is_none_or(Value::is_null) && !is_section(key)
    };
    let keys = texts.iter().filter(|(key, _)| is_left_out(key));
    keys.map(|(key, text)| (key.clone(), text.clone())).collect()
}

/// The place of a key in a tree, made for an optional one that is left out; `None` for a key that does not exist.
pub(crate) fn slot<'a>(tree: &'a mut Value, key: &str) -> Option<&'a mut Value> {
    if tree.pointer(&pointer(key)).is_none() {
        if !left_out(tree).contains_key(key) {
            return None;
        }
        let (parent, name) = parent(key);
        let section = tree.pointer_mut(&parent)?.as_object_mut()?;
        section.insert(name.to_owned(), Value::Null);
    }
    tree.pointer_mut(&pointer(key))
}

/// The dotted path of the number, word or list of `tree` that was probably meant by `key`: misspelt, or in another section.
pub(crate) fn meant(key: &str, tree: &Value) -> Option<String> {
    let mut known = Vec::new();
    leaves(tree, "", &mut known);
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let misspelt = reading::nearest(key, known.iter().map(String::as_str)).map(str::to_owned);
    misspelt.or_else(|| {
        let mut elsewhere = known.iter().filter(|path| last(path) == last(key));
        // Several sections with the key are no hint.
        elsewhere.next().filter(|_| elsewhere.next().is_none()).cloned()
    })
}

/// The dotted paths of all values that are no mapping.
fn leaves(tree: &Value, path: &str, into: &mut Vec<String>) {
    let Value::Object(map) = tree else {
        into.push(path.to_owned());
        return;
    };
    let dot = if path.is_empty() { "" } else { "." };
    for (key, value) in map {
        leaves(value, &format!("{path}{dot}{key}"), into);
    }
}

/// The kind of a value, for error messages.
pub(crate) fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "left out",
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "text",
        Value::Array(_) => "a list",
        Value::Object(_) => "a mapping",
    }
}
