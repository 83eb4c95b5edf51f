//! The messages of bridges on `/diagnostics`.

use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use flexdrill_messages::std_msgs::Header;

/// An item of a part of a node: its level and words, what it is connected to, and values by their keys.
pub(super) fn item<K: Into<String>>(
    node: &str,
    part: &str,
    (level, message): (u8, String),
    place: &str,
    values: impl IntoIterator<Item = (K, String)>,
) -> DiagnosticStatus {
    let values = values.into_iter();
    DiagnosticStatus {
        level,
        // The name has the node's path without its slash and the part, as `diagnostic_aggregator` matches it.
        name: format!("{}: {part}", node.trim_start_matches('/')),
        message,
        hardware_id: place.to_owned(),
        values: values.map(|(key, value)| KeyValue { key: key.into(), value }).collect(),
    }
}

/// Counts as values of an item.
pub(super) fn counts<K>(counts: impl IntoIterator<Item = (K, u64)>) -> impl Iterator<Item = (K, String)> {
    counts.into_iter().map(|(key, count)| (key, count.to_string()))
}

/// The message with these items at an instant (ns since 1970).
pub(super) fn array(now: i64, status: Vec<DiagnosticStatus>) -> DiagnosticArray {
    DiagnosticArray {
        header: Header {
            stamp: Time::from_nanoseconds(now),
            ..Header::default()
        },
        status,
    }
}
