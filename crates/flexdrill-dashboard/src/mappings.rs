//! What bridges make of the items of a rig's line, for the page: from their diagnostics, which come every second.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use flexdrill_messages::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};

/// Stands between the name of a bridge's node and the number of its connection.
const MARK: &str = ": wits mapping of ";
/// A mapping is shown for so long after the last message: some messages may be lost.
const GONE: Duration = Duration::from_secs(5);
/// Most mappings that are kept: a bridge has eight connections.
const MOST: usize = 32;
/// Most bytes of one with its items, whoever sends it.
const LARGEST: usize = 32 << 10;

/// The newest diagnostics of each connection of the bridges.
#[derive(Default)]
pub(crate) struct Mappings(BTreeMap<String, (DiagnosticStatus, Instant)>);

impl Mappings {
    /// Takes diagnostics that arrived at `now`; those of others are left out.
    pub fn observe(&mut self, array: DiagnosticArray, now: Instant) {
        for status in array.status.into_iter().filter(|status| status.name.contains(MARK)) {
            let values = status.values.iter().map(|pair| pair.key.len() + pair.value.len() + 48);
            let size = status.name.len() + status.message.len() + values.sum::<usize>();
            self.0
                .retain(|_, (_, arrived)| now.saturating_duration_since(*arrived) < GONE);
            if size <= LARGEST && (self.0.len() < MOST || self.0.contains_key(&status.name)) {
                self.0.insert(status.name.clone(), (status, now));
            }
        }
    }

    /// The mappings of bridges in a namespace at `now`, for the page. `service` is the one that this server can call.
    pub fn json(&self, namespace: &str, service: Option<&str>, now: Instant) -> Value {
        let fresh = self
            .0
            .values()
            .filter(|(_, arrived)| now.saturating_duration_since(*arrived) < GONE);
        let own = fresh.filter_map(|(status, _)| {
            let node = format!("/{}", status.name.split_once(MARK)?.0);
            let (of_node, _) = node.rsplit_once('/')?;
            (of_node == namespace.trim_end_matches('/')).then(|| mapping_json(&node, status, service))
        });
        own.collect()
    }
}

/// A mapping as the page gets it.
fn mapping_json(node: &str, status: &DiagnosticStatus, service: Option<&str>) -> Value {
    let value = |key: &str| {
        let found = status.values.iter().find(|pair| pair.key == key);
        found.map_or("", |pair| pair.value.as_str())
    };
    let items = status.values.iter().filter_map(|pair| {
        let item = pair.key.strip_prefix("item_")?;
        let (quantity, rest) = pair.value.split_once(": ")?;
        // What is sent is foreign text; what is used has no sign of equality.
        let (quantity, (sent, used)) = match quantity {
            "not read" => ("", (rest, "")),
            read => (read, rest.rsplit_once(" = ").unwrap_or((rest, ""))),
        };
        Some(json!({"item": item, "quantity": quantity, "sent": sent, "used": used}))
    });
    json!({
        "node": node,
        "source": value("source"),
        "address": value("address"),
        "mapping": value("mapping"),
        "file": value("mapping_file"),
        "confirmed": value("confirmed"),
        "can_confirm": service.is_some_and(|service| service == value("confirm_service")),
        "not_shown": value("items_not_shown"),
        "items": items.collect::<Value>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::diagnostic_msgs::KeyValue;

    fn array(name: &str, values: &[(&str, &str)]) -> DiagnosticArray {
        let values = values.iter().map(|(key, value)| KeyValue {
            key: (*key).to_owned(),
            value: (*value).to_owned(),
        });
        DiagnosticArray {
            status: vec![DiagnosticStatus {
                name: name.to_owned(),
                values: values.collect(),
                ..DiagnosticStatus::default()
            }],
            ..DiagnosticArray::default()
        }
    }

    #[test]
    fn a_mapping_is_shown_to_the_page_of_its_namespace_while_its_bridge_sends() {
        let mut mappings = Mappings::default();
        let began = Instant::now();
        let values = [
            ("source", "10.0.0.7"),
            ("mapping", "0123456789abcdef"),
            ("confirmed", ""),
            ("confirm_service", "/rig_7/bridge/confirm_mapping"),
            ("item_0116", "weight_on_bit: 0.81 kdaN = 8.1 kN"),
            ("item_0144", "not read: a = b"),
            ("item_0145", "nothing"),
        ];
        mappings.observe(array("rig_7/bridge: wits mapping of connection 1", &values), began);
        mappings.observe(array("bridge: wits mapping of connection 1", &[]), began);
        mappings.observe(array("rig_7/bridge: wits", &values), began);
        let shown = mappings.json("/rig_7", Some("/rig_7/bridge/confirm_mapping"), began);
        assert_eq!(shown.as_array().unwrap().len(), 1, "{shown}");
        let first = &shown[0];
        assert_eq!(
            (&first["node"], &first["source"], &first["can_confirm"]),
            (&json!("/rig_7/bridge"), &json!("10.0.0.7"), &json!(true))
        );
        assert_eq!(
            first["items"],
            json!([
                {"item": "0116", "quantity": "weight_on_bit", "sent": "0.81 kdaN", "used": "8.1 kN"},
                {"item": "0144", "quantity": "", "sent": "a = b", "used": ""},
            ])
        );
        assert_eq!(mappings.json("/", None, began)[0]["node"], "/bridge");
        assert_eq!(mappings.json("/", None, began)[0]["can_confirm"], false);
        assert_eq!(mappings.json("/rig_8", None, began), json!([]));
        assert_eq!(mappings.json("/rig_7", None, began + GONE), json!([]));
    }

    #[test]
    fn foreign_diagnostics_do_not_fill_the_memory() {
        let mut mappings = Mappings::default();
        let began = Instant::now();
        let name = |number: usize| format!("bridge: wits mapping of connection {number}");
        let huge = "x".repeat(LARGEST);
        mappings.observe(array(&name(0), &[("item_0116", &huge)]), began);
        assert_eq!(mappings.0.len(), 0);
        for number in 0..1000 {
            mappings.observe(array(&name(number), &[]), began);
        }
        assert_eq!(mappings.0.len(), MOST);
        // Those that are gone leave their places.
        mappings.observe(array(&name(2000), &[]), began + GONE);
        assert_eq!(mappings.0.len(), 1);
    }
}
