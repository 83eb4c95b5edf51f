//! `look_ahead`: runs from forks of the present state.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};

const THREADS: Bound = Bound::within(1.0, 256.0);

/// Runs from forks of the present state, for the action `~/what_if`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LookAhead {
    /// Threads that look ahead, at the lowest priority. The result does not depend on their number. Default 1.
    #[schemars(transform = THREADS.in_schema())]
    pub threads: u32,
    /// Whether the advice of an alarm of the tool's motion comes from look-aheads: the smallest change of speed or weight
    /// that ends it in at least 9 of 10 of them and raises no other. Until one is found the rule of `alarms.advice` stands
    /// and says that it is a rule. Default false.
    pub advice: bool,
}

impl Default for LookAhead {
    fn default() -> Self {
        Self {
            threads: 1,
            advice: false,
        }
    }
}

impl LookAhead {
    pub(super) fn check(&self, c: &mut Checker) {
        c.count(
            "threads",
            self.threads as usize,
            THREADS,
            "more than any machine on a rig has",
        );
    }
}
