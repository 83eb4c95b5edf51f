//! `ensemble`: plausible tools that run with the twin.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};

const MEMBERS: Bound = Bound::within(8.0, 256.0);

/// Plausible tools that run with the twin, for bands and chances on `twin/bands`: tools drawn from `uncertainty`, under the
/// same inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Ensemble {
    /// Their number, or `auto` for as many as the computer runs in the time that the twin leaves. A replay of a recording
    /// has those of the recorded run; one of a log has none with `auto`. Default auto.
    pub members: Members,
    /// Seed of all draws. Default 1.
    pub seed: u64,
}

/// `auto`, or a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(transform = MEMBERS.in_schema())]
pub enum Members {
    /// As many as the computer runs.
    Auto(Auto),
    /// So many.
    Count(u32),
}

/// The word for a number that is found while the program runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Auto {
    /// As many as the computer runs.
    Auto,
}

impl Default for Ensemble {
    fn default() -> Self {
        Self {
            members: Members::Auto(Auto::Auto),
            seed: 1,
        }
    }
}

impl Ensemble {
    /// Checks the section; `uncertain` says whether the file states what is not known.
    pub(super) fn check(&self, c: &mut Checker, uncertain: bool) {
        if let Members::Count(count) = self.members {
            c.count(
                "members",
                count as usize,
                MEMBERS,
                "fewer than 8 have no band from 5 to 95 %, and more take more than a workstation has",
            );
        }
        c.require(
            uncertain,
            "members",
            "ensemble",
            "",
            "given with uncertainty.keys or uncertainty.sensors",
            "all members would be the tool of the file",
        );
    }
}
