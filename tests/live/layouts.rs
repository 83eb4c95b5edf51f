//! The layouts of `config/layouts/` name topics and fields that there are.

use flexdrill::messages::topics;
use serde_json::Value;

fn layout(name: &str) -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/config/layouts/");
    std::fs::read_to_string(format!("{path}{name}")).unwrap()
}

/// Holds `topic` and the field in it, if there is one, against the message definitions.
fn check(topic: &str, field: Option<&str>) {
    let is_it = |known: &&topics::TopicInfo| known.name.trim_start_matches('/') == topic.trim_start_matches('/');
    let known = topics::ALL
        .iter()
        .find(is_it)
        .unwrap_or_else(|| panic!("no topic {topic}"));
    let Some(field) = field else { return };
    // The first part of a schema is the message itself.
    let own = known.kind.schema.split("====").next().unwrap();
    let has = own
        .lines()
        .any(|line| line.split_whitespace().nth(1) == Some(field) && !line.starts_with('#'));
    assert!(has, "{topic} has no field {field}");
}

/// Every string in a JSON value.
fn strings<'a>(value: &'a Value, found: &mut Vec<&'a str>) {
    match value {
        Value::String(text) => found.push(text),
        Value::Array(items) => items.iter().for_each(|item| strings(item, found)),
        Value::Object(fields) => fields.iter().for_each(|(key, item)| {
            found.push(key);
            strings(item, found);
        }),
        _ => {}
    }
}

#[test]
fn foxgloves_panels_show_what_there_is() {
    let layout: Value = serde_json::from_str(&layout("foxglove.json")).unwrap();
    let mut found = Vec::new();
    strings(&layout["configById"], &mut found);
    let paths: Vec<&str> = found.into_iter().filter(|text| text.starts_with('/')).collect();
    assert!(paths.len() > 15, "{paths:?}");
    for path in paths {
        let (topic, field) = path
            .split_once('.')
            .map_or((path, None), |(topic, field)| (topic, Some(field)));
        check(topic, field);
    }
    // What is laid out is configured, and the other way round.
    let mut placed = Vec::new();
    strings(&layout["layout"], &mut placed);
    let mut placed: Vec<&str> = placed.into_iter().filter(|name| name.contains('!')).collect();
    let mut configured: Vec<&str> = layout["configById"]
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    placed.sort_unstable();
    configured.sort_unstable();
    assert_eq!(placed, configured);
}

#[test]
fn plotjugglers_curves_and_rvizs_displays_show_what_there_is() {
    let curves = layout("plotjuggler.xml");
    let names: Vec<&str> = curves
        .split("<curve name=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap())
        .collect();
    assert!(names.len() > 10, "{names:?}");
    for name in names {
        let (topic, field) = name.rsplit_once('/').unwrap();
        check(topic, Some(field));
    }
    let displays = layout("flexdrill.rviz");
    let shown: Vec<&str> = displays
        .split("        Value: /")
        .skip(1)
        .map(|rest| rest.lines().next().unwrap())
        .collect();
    assert_eq!(shown, ["twin/tool_shape"]);
    check(shown[0], None);
    assert!(
        displays.contains("Fixed Frame: map"),
        "as outputs.parent_frame is by default"
    );
}
