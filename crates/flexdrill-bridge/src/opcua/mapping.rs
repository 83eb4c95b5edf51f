//! The mapping file of a client: which node of the rig's server is which quantity, in which unit.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::str::FromStr as _;

use ::opcua::types::NodeId;
use flexdrill_config::ConfigError;
use flexdrill_config::checker::{Bound, Checker};
use flexdrill_config::reading;
use flexdrill_core::inputs::Unit;
use serde::{Deserialize, Serialize};

use crate::Quantity;
use crate::quantity::check_unit_and_range;

/// Where the stamp of a value comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StampSource {
    /// The source timestamp that the server gives; the time of arrival where it gives none, or one that is more than ten
    /// seconds from it.
    #[default]
    Source,
    /// The time of arrival, on this machine's clock.
    Arrival,
}

/// The nodes of a site.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeMapping {
    /// For people. Default empty.
    #[serde(default)]
    pub title: String,
    /// Time between two looks at a value that the server is asked for (s). Default 0.2.
    #[serde(default = "fifth")]
    pub interval_s: f64,
    /// A value that does not change is sent again after so long (s), while the server shows life. Default 1.
    #[serde(default = "one")]
    pub repeat_s: f64,
    /// Where the stamp comes from. Default the source.
    #[serde(default)]
    pub stamp: StampSource,
    /// Required: the nodes by their ids, such as `ns=2;s=Rig.HookLoad` or `nsu=urn:vendor:rig;s=Rig.HookLoad`.
    pub nodes: BTreeMap<String, NodeItem>,
}

/// The meaning of a node.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeItem {
    /// Required.
    pub quantity: Quantity,
    /// Required.
    #[serde(deserialize_with = "flexdrill_config::units::spelled")]
    pub unit: Unit,
    /// Smallest and largest valid value, in the unit. Default: what a rig can have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub valid: Option<[f64; 2]>,
}

fn fifth() -> f64 {
    0.2
}

fn one() -> f64 {
    1.0
}

const REQUIRED: &[&str] = &["nodes"];

/// Longest id of a node: that of the standard.
const LONGEST_ID: usize = 4096;

impl NodeMapping {
    /// Reads and checks a mapping file.
    ///
    /// # Errors
    /// When the file cannot be read, is not YAML of this schema, or does not make sense.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, ConfigError> {
        let (name, text) = reading::read(path.as_ref())?;
        Self::from_text(&name, &text)
    }

    /// Reads and checks a mapping; errors name it `name`.
    ///
    /// # Errors
    /// When the text is not YAML of this schema, or does not make sense.
    pub fn from_text(name: &str, text: &str) -> Result<Self, ConfigError> {
        reading::checked(name, text, REQUIRED, Self::check)
    }

    fn check(&self, c: &mut Checker) {
        let reason = "the twin's inputs are late after a second, and a server has others to serve";
        c.number("interval_s", self.interval_s, Bound::within(0.01, 10.0), "s", reason);
        let reason = "the twin holds an input only for as long as inputs.*.max_age_s says";
        c.number("repeat_s", self.repeat_s, Bound::within(0.1, 10.0), "s", reason);
        c.require(
            !self.nodes.is_empty(),
            "nodes",
            "none",
            "",
            "at least one node",
            "without a node nothing is read",
        );
        let mut seen = BTreeSet::new();
        c.below("nodes", |c| {
            for (id, item) in &self.nodes {
                c.below(id.clone(), |c| {
                    c.require(
                        parse(id).is_some(),
                        "quantity",
                        id,
                        "",
                        "ns=2;s=NAME, ns=2;i=NUMBER or nsu=URI;s=NAME",
                        "the key is the id of a node",
                    );
                    c.require(
                        seen.insert(item.quantity),
                        "quantity",
                        item.quantity,
                        "",
                        "a quantity of one node",
                        "two sources of one quantity would take turns",
                    );
                    check_unit_and_range(c, item.quantity, item.unit, item.valid);
                });
            }
        });
    }
}

/// The id of a node, with the URI of its namespace where that stands in place of a number.
pub fn parse(id: &str) -> Option<(Option<&str>, NodeId)> {
    if id.len() > LONGEST_ID {
        return None;
    }
    let Some(rest) = id.strip_prefix("nsu=") else {
        return NodeId::from_str(id).ok().map(|node| (None, node));
    };
    let (uri, local) = rest.split_once(';')?;
    let node = NodeId::from_str(local).ok()?;
    (!uri.is_empty() && node.namespace == 0).then_some((Some(uri), node))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_site_is_read_with_defaults() {
        let text = "nodes:\n  \"ns=2;s=Speed\": {quantity: rotary_speed, unit: r/min, valid: [0, 200]}\n  \
                    \"nsu=urn:vendor:rig;i=7\": {quantity: hook_load, unit: klbf}\n";
        let mapping = NodeMapping::from_text("site.yaml", text).unwrap();
        assert_eq!((mapping.interval_s, mapping.repeat_s), (0.2, 1.0));
        assert_eq!(mapping.stamp, StampSource::Source);
        let spelled =
            NodeMapping::from_text("site.yaml", &text.replace("klbf", "kip").replace("r/min", "RPM")).unwrap();
        assert_eq!(spelled, mapping);
        let (uri, node) = parse("nsu=urn:vendor:rig;i=7").unwrap();
        assert_eq!((uri, node), (Some("urn:vendor:rig"), NodeId::new(0, 7_u32)));
        assert_eq!(parse("ns=2;s=Speed").unwrap(), (None, NodeId::new(2, "Speed")));
    }

    #[test]
    fn what_cannot_be_is_refused_with_its_line() {
        for (text, words) in [
            ("nodes: {}\n", "at least one"),
            ("title: x\n", "nodes"),
            (
                "nodes: {\"Speed\": {quantity: rotary_speed, unit: r/min}}\n",
                "ns=2;s=NAME",
            ),
            (
                "nodes: {\"nsu=;s=a\": {quantity: rotary_speed, unit: r/min}}\n",
                "nsu=URI",
            ),
            ("nodes: {\"ns=2;s=a\": {quantity: rotary_speed, unit: kN}}\n", "r/min"),
            (
                "nodes: {\"ns=2;s=a\": {quantity: rotary_speed, unit: r/min, valid: [3, 1]}}\n",
                "smallest",
            ),
            (
                "nodes: {\"ns=2;s=a\": {quantity: torque, unit: kN.m}}\n",
                "surface_torque",
            ),
            (
                "nodes: {\"ns=2;s=a\": {quantity: hook_load, unit: kN}, \"ns=2;s=b\": {quantity: hook_load, unit: kN}}\n",
                "take turns",
            ),
            (
                "repeat_s: 60\nnodes: {\"ns=2;s=a\": {quantity: hook_load, unit: kN}}\n",
                "10",
            ),
        ] {
            let error = NodeMapping::from_text("site.yaml", text).unwrap_err().to_string();
            assert!(error.contains("site.yaml:1") && error.contains(words), "{text}{error}");
        }
    }
}
