//! `look_ahead`: runs from forks of the present state.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};

const THREADS: Bound = Bound::within(1.0, 256.0);
const FORECAST_MEMBERS: Bound = Bound::within(2.0, 64.0);

/// Runs from forks of the present state: for the action `~/what_if`, for advice and for the forecast.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LookAhead {
    /// Threads that look ahead, in processor time that nothing else on the machine uses (`SCHED_IDLE`). The result does
    /// not depend on their number. Default 1.
    #[schemars(transform = THREADS.in_schema())]
    pub threads: u32,
    /// Whether the advice of an alarm of the tool's motion comes from look-aheads: a small change of speed or weight
    /// that ends all alarms of the motion that stand in at least 9 of 10 runs that took no part in choosing it, and
    /// raises no other. Until one is found the rule of `alarms.advice` stands and says that it is a rule. Default false.
    pub advice: bool,
    /// Whether the node forecasts the next minute at the present speed and weight, every half minute, on `twin/forecast`.
    /// Default false.
    pub forecast: bool,
    /// Runs that a forecast is made from. Each takes 60 s of model time, so that four every half minute take eight times
    /// real time. Default 4.
    #[schemars(transform = FORECAST_MEMBERS.in_schema())]
    pub forecast_members: u32,
}

impl Default for LookAhead {
    fn default() -> Self {
        Self {
            threads: 1,
            advice: false,
            forecast: false,
            forecast_members: 4,
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
        c.count(
            "forecast_members",
            self.forecast_members as usize,
            FORECAST_MEMBERS,
            "one run has no band, and more than a few dozen take longer than the minute that they forecast",
        );
    }
}
