//! `map`: the map of speed and weight that the node loads.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Checker;

/// The safe window: a map that `flexdrill map` has made for this tool.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SafeMap {
    /// The file `map.json` of the map; a relative path is relative to the folder of the configuration. The node publishes
    /// the map on `twin/safe_window` and watches whether speed and weight are within it. A map of another tool is refused.
    /// Default none.
    pub file: Option<String>,
}

impl SafeMap {
    pub(super) fn check(&self, c: &mut Checker) {
        let empty = self.file.as_ref().is_some_and(|file| file.trim().is_empty());
        c.require(
            !empty,
            "file",
            "an empty name",
            "",
            "the name of a file, or no key at all",
            "an empty name is no map",
        );
    }
}
