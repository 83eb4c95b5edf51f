//! `run`: what the file is for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};

const DURATION: Bound = Bound::above(0.0, 1e7);

/// The run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// Title of the run, for displays and reports. Default empty.
    pub title: String,
    /// Model time after which a run ends (s). Default: it continues until it is stopped.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = DURATION.in_schema())]
    pub duration: Option<f64>,
}

impl Run {
    pub(super) fn check(&self, c: &mut Checker) {
        if let Some(duration) = self.duration {
            c.number("duration", duration, DURATION, "s", "some months");
        }
    }
}
