//! `well.plan`: the planned hole, to compare with what the tool drills.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker, number};
use super::section::section;
use super::{Config, ConfigError};

/// A target narrower than a centimetre is less than any survey knows, and one wider than a hundred metres is none.
const TARGET: Bound = Bound::within(0.01, 100.0);
/// A hole that is farther off is another one.
const OFFSET: Bound = Bound::within(-100.0, 100.0);
/// Longer plans stand in a file.
const STATIONS: Bound = Bound::within(2.0, 1000.0);

/// The planned hole: `stations`, or the `file` of a table. `flexdrill ahead` and a live twin compare with it what the tool
/// drills, and `flexdrill check` says whether the guide can drill it. Between two stations the hole is an arc (minimum curvature).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WellPlan {
    /// Stations of the plan, from the top down, at least two. The first lies on the hole of `well.sections`. Required
    /// without `file`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stations: Vec<PlannedStation>,
    /// Table of the stations (CSV) with the columns `measured_depth_m`, `inclination_deg` and `azimuth_deg`, in place of
    /// `stations`. A relative path is relative to the folder of the configuration. A recording has its stations. Default
    /// none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Radius around the plan (m) within which the bit is on plan. Default 0.5.
    #[serde(default = "half_a_metre")]
    #[schemars(transform = TARGET.in_schema())]
    pub target: f64,
    /// Where the plan begins (m), from the point of the hole at the depth of the first station: along azimuth 0 of the hole's
    /// plane, to the right, down, -100 to 100 each. `flexdrill rebase` sets it where the hole has left its plan. Default
    /// [0, 0, 0].
    #[serde(default, skip_serializing_if = "is_on_hole")]
    pub offset: [f64; 3],
}

fn is_on_hole(offset: &[f64; 3]) -> bool {
    *offset == [0.0; 3]
}

section! {
    /// A station of the plan.
    #[derive(Copy)]
    pub struct PlannedStation(this) {
        /// Measured depth from the kick-off, where `well.sections` begins (m); above that of the station before. Required.
        measured_depth: f64, within(0.0, 100000.0), "m", "depths count from the kick-off, where well.sections begins";
        /// Inclination: 0 is vertical, 90 horizontal. Required.
        inclination_deg: f64, within(0.0, 180.0), "deg", "0 is straight down, 180 straight up";
        /// Azimuth, clockwise seen from above. Required.
        azimuth_deg: f64, within(-360.0, 360.0), "deg", "one turn";
    }
}

impl Config {
    /// A copy with another plan, or none.
    ///
    /// # Errors
    /// When the plan does not make sense; it is named `origin`.
    pub fn with_plan(&self, origin: &str, plan: Option<WellPlan>) -> Result<Self, ConfigError> {
        let mut schema = self.schema.clone();
        schema.well.plan = plan;
        Self::from_schema(origin, schema)
    }

    /// A copy whose plan has these stations in place of `well.plan.file`, so that a recording of it needs no file.
    ///
    /// # Errors
    /// When the stations do not make sense; they are named `origin`.
    pub fn with_planned(&self, origin: &str, stations: Vec<PlannedStation>) -> Result<Self, ConfigError> {
        let mut schema = self.schema.clone();
        if let Some(plan) = &mut schema.well.plan {
            plan.file = None;
            plan.stations = stations;
        }
        Self::from_schema(origin, schema)
    }
}

fn half_a_metre() -> f64 {
    0.5
}

impl WellPlan {
    /// Checks the plan of a hole that is as long as `hole` (m).
    pub(super) fn check(&self, c: &mut Checker, hole: f64) {
        c.number(
            "target",
            self.target,
            TARGET,
            "m",
            "below a centimetre no survey knows where the bit is; beyond 100 m every hole is on plan",
        );
        let reason = "a hole that is farther from its plan is another hole";
        for part in self.offset {
            c.number("offset", part, OFFSET, "m", reason);
        }
        if let Some(file) = &self.file {
            c.require(
                !file.trim().is_empty(),
                "file",
                "an empty name",
                "",
                "the name of a table, or no key at all",
                "an empty name is no plan",
            );
            // Of two plans one would be obeyed and the other not, without a word.
            c.require(
                self.stations.is_empty(),
                "file",
                file,
                "",
                "left out with well.plan.stations",
                "there is one plan",
            );
            return;
        }
        let reason = "two stations have a curvature between them; longer plans stand in a file (well.plan.file)";
        c.count("stations", self.stations.len(), STATIONS, reason);
        let mut before: Option<f64> = None;
        c.below("stations", |c| {
            for (index, station) in self.stations.iter().enumerate() {
                let depth = station.measured_depth;
                c.below(index, |c| {
                    station.check_numbers(c);
                    match before {
                        // A depth that falls would turn the plan back on itself, and an equal one has no curvature.
                        Some(above) => c.require(
                            depth > above || depth.is_nan(),
                            "measured_depth",
                            number(depth),
                            "m",
                            format!("above {} m, the station before", number(above)),
                            "stations follow each other down the hole",
                        ),
                        None => c.require(
                            depth <= hole || !hole.is_finite() || depth.is_nan(),
                            "measured_depth",
                            number(depth),
                            "m",
                            format!("at most {hole:.3} m, the end of well.sections"),
                            "the first station is a point of the hole, from which the plan is laid",
                        ),
                    }
                });
                before = Some(depth);
            }
        });
    }
}
