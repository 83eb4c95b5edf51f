//! Every topic and field, from the table of topics and the comments in `msg/`.

use std::fmt::Write as _;

use flexdrill_messages::TypeInfo;
use flexdrill_messages::topics::{self, Cadence, Qos, TopicInfo};

use crate::cell;

/// Units as they stand in the comments, the longer before those that they begin with.
const UNITS: [&str; 20] = [
    "rad/s2", "rad/s", "rad/m", "rad", "r/min", "N m", "N s", "N/s", "N", "kN", "m/s2", "m/s", "m", "W/m", "1/s",
    "1/h", "J", "Hz", "ms", "s",
];
/// What begins the definitions that a message is made of.
const NEXT: &str = "====";

/// A constant, or a field with the comment above it.
struct Entry<'a> {
    kind: &'a str,
    name: &'a str,
    value: Option<&'a str>,
    comment: String,
}

/// Every topic with its type, rate and quality of service, and every field with its unit.
pub fn page() -> String {
    let mut out = String::from(
        "# Topics and messages\n\n\
         Written by `cargo xtask reference topics`. Names are relative to the node's namespace unless they begin with `/`; all\n\
         can be remapped. Messages are SI; rig/rotary_speed_rpm is in r/min, rig/weight_on_bit_kn in kN,\n\
         rig/rate_of_penetration in m/h (optional) and rig/standpipe_pressure in MPa (optional). Every message of the\n\
         twin begins with a header: stamp = model time on the rig's clock, frame = the tool ([frames](frames.md)).\n\n\
         ## All topics\n\
         | topic | type | sent | quality of service |\n|---|---|---|---|\n",
    );
    for topic in &topics::ALL {
        let _ = writeln!(
            out,
            "| {} | `{}` | {} | {} |",
            linked(topic),
            topic.kind.ros_type,
            cadence(topic.cadence),
            qos(topic.qos)
        );
    }
    out.push_str(
        "\nRates are of model time, at their defaults; 0 switches a topic off ([configuration](configuration.md)). Types of other\n\
         packages are those of ROS 2.\n",
    );
    let mut told: Vec<&str> = Vec::new();
    for topic in topics::ALL.iter().filter(|topic| is_ours(&topic.kind)) {
        if told.contains(&topic.kind.name) {
            continue;
        }
        told.push(topic.kind.name);
        definition(&mut out, topic.kind.name, topic.kind.schema, Some(topic.name));
        // A message of ours within it, such as one alarm of the list.
        for (name, text) in inner(topic.kind.schema) {
            if !told.contains(&name) {
                told.push(name);
                definition(&mut out, name, text, None);
            }
        }
    }
    out
}

fn is_ours(kind: &TypeInfo) -> bool {
    kind.package == "flexdrill"
}

fn linked(topic: &TopicInfo) -> String {
    if is_ours(&topic.kind) {
        format!("[`{}`](#{})", topic.name, topic.kind.name.to_lowercase())
    } else {
        format!("`{}`", topic.name)
    }
}

fn cadence(cadence: Cadence) -> String {
    match cadence {
        Cadence::Rate(key) => {
            let rates = serde_json::to_value(flexdrill_config::Rates::default()).unwrap_or_default();
            format!(
                "{} Hz (`outputs.rates.{key}`)",
                rates.get(key).and_then(serde_json::Value::as_f64).unwrap_or(f64::NAN)
            )
        }
        Cadence::OnChange => "on change".to_owned(),
        Cadence::Received => "received".to_owned(),
    }
}

fn qos(qos: Qos) -> String {
    format!(
        "{}{}, {}",
        if qos.reliable { "reliable" } else { "best effort" },
        if qos.transient_local { ", transient local" } else { "" },
        qos.depth
    )
}

/// Messages of ours that a schema brings along: name and text.
fn inner(schema: &str) -> impl Iterator<Item = (&str, &str)> {
    schema
        .split("\nMSG: flexdrill/")
        .skip(1)
        .filter_map(|rest| rest.split_once('\n'))
        .map(|(name, text)| (name.trim_start_matches("msg/"), text))
}

fn definition(out: &mut String, name: &str, schema: &str, topic: Option<&str>) {
    let text = schema.split(NEXT).next().unwrap_or_default();
    let (about, entries) = parse(text);
    let _ = write!(out, "\n## {name}\n");
    if let Some(topic) = topic {
        let _ = write!(out, "Topic `{topic}`. ");
    }
    let _ = writeln!(out, "{}\n", wrapped(&about));
    let (constants, fields): (Vec<_>, Vec<_>) = entries.iter().partition(|entry| entry.value.is_some());
    if !constants.is_empty() {
        out.push_str("| constant | value | meaning |\n|---|---|---|\n");
        for entry in constants {
            let value = entry.value.unwrap_or_default();
            let _ = writeln!(out, "| `{}` | {value} | {} |", entry.name, cell(&entry.comment));
        }
        out.push('\n');
    }
    out.push_str("| field | type | unit | meaning |\n|---|---|---|---|\n");
    for entry in fields {
        let _ = writeln!(
            out,
            "| `{}` | `{}` | {} | {} |",
            entry.name,
            entry.kind,
            unit(&entry.comment),
            cell(&entry.comment)
        );
    }
}

/// The comment on top, and the rest line by line. A comment stands for all fields that follow it without an empty line.
fn parse(text: &str) -> (String, Vec<Entry<'_>>) {
    let (mut about, mut comment, mut entries) = (None, Vec::new(), Vec::new());
    let mut fresh = false;
    for line in text.lines().map(str::trim) {
        if let Some(words) = line.strip_prefix('#') {
            if fresh {
                comment.clear();
                fresh = false;
            }
            comment.push(words.trim());
        } else if line.is_empty() {
            // The first paragraph is about the whole message; others stay with what follows.
            if about.is_none() {
                about = Some(comment.join(" "));
                comment.clear();
            }
        } else if let Some((kind, rest)) = line.split_once(' ') {
            let (name, value) = match rest.split_once('=') {
                Some((name, value)) => (name.trim(), Some(value.trim())),
                None => (rest.trim(), None),
            };
            entries.push(Entry {
                kind,
                name,
                value,
                comment: comment.join(" "),
            });
            fresh = true;
        }
    }
    (about.unwrap_or_default(), entries)
}

/// The unit that a comment gives in brackets; empty where it gives none.
fn unit(comment: &str) -> &'static str {
    comment
        .split('(')
        .skip(1)
        .find_map(|rest| {
            UNITS.into_iter().find(|unit| {
                rest.strip_prefix(unit)
                    .is_some_and(|behind| behind.starts_with([')', ',', ';']))
            })
        })
        .unwrap_or_default()
}

/// Lines no wider than the documents allow.
fn wrapped(text: &str) -> String {
    let (mut out, mut width) = (String::new(), 40);
    for word in text.split_whitespace() {
        if width + word.len() >= 118 {
            out.push('\n');
            width = 0;
        } else if !out.is_empty() {
            out.push(' ');
        }
        out.push_str(word);
        width += word.len() + 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_found_in_the_comments() {
        assert_eq!(unit("Moment of the stop (N m, >= 0, zero below the limit)."), "N m");
        assert_eq!(
            unit("Rate of the orbit (rad/s, positive in the sense of the rotation)."),
            "rad/s"
        );
        assert_eq!(unit("Part of the window in contact (0 to 1)."), "");
        assert_eq!(
            unit("Largest impulse above the resting one in the window (N s)."),
            "N s"
        );
    }

    #[test]
    fn every_field_of_ours_has_its_line() {
        let page = page();
        for topic in topics::ALL.iter().filter(|topic| is_ours(&topic.kind)) {
            let text = topic.kind.schema.split(NEXT).next().unwrap();
            let (_, entries) = parse(text);
            assert!(!entries.is_empty(), "{}", topic.name);
            for entry in entries {
                assert!(
                    page.contains(&format!("| `{}` |", entry.name)),
                    "{}: {}",
                    topic.name,
                    entry.name
                );
                assert!(entry.comment.len() > 3, "{}: {} has no comment", topic.name, entry.name);
            }
        }
    }
}
