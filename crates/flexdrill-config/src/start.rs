//! `start` and `initial`: how a run begins.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker, EachItem};

/// How a run begins.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// At rest under gravity and the initial weight on bit, so that the tool does not drop when the run begins.
    #[default]
    Static,
    /// The same after the guide has been slid in: the friction of the wall is at its limit against an advance that has
    /// just ended, and holds weight back. Needs `contact.outer.friction: bristle`.
    SlidIn,
    /// On the bore's centre line with the motion given in `initial`.
    AsGiven,
}

const VELOCITY: Bound = Bound::within(-100.0, 100.0);
const DISPLACEMENT: Bound = Bound::within(-1.0, 1.0);
const SPIN: Bound = Bound::within(-10_000.0, 10_000.0);

/// Motion of every pipe node at the start; only with `start: as_given`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Initial {
    /// Velocity (u, v, w) in the station frame (m/s). Default 0.
    #[schemars(transform = EachItem(VELOCITY))]
    pub velocity: [f64; 3],
    /// Displacement (u, v, w) in the station frame (m). Default 0.
    #[schemars(transform = EachItem(DISPLACEMENT))]
    pub displacement: [f64; 3],
    /// Spin of every pipe node. Default 0.
    #[schemars(transform = SPIN.in_schema())]
    pub spin_rpm: f64,
}

impl Initial {
    pub(super) fn check(&self, c: &mut Checker, start: Start) {
        for (index, name) in ["0", "1", "2"].into_iter().enumerate() {
            c.below("velocity", |c| {
                let reason = "a drilling tool does not move faster";
                c.number(name, self.velocity[index], VELOCITY, "m/s", reason);
            });
            c.below("displacement", |c| {
                let reason = "of the order of the clearances";
                c.number(name, self.displacement[index], DISPLACEMENT, "m", reason);
            });
        }
        let reason = "far above any drive";
        c.number("spin_rpm", self.spin_rpm, SPIN, "r/min", reason);
        c.require(
            start == Start::AsGiven || *self == Self::default(),
            "",
            "a motion",
            "",
            "left out with start: static",
            "a static start is at rest; write start: as_given",
        );
    }
}
