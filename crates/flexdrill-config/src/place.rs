//! Locations along the tool in `supports`, `loads` and `masses`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use flexdrill_core::tool::Location;

/// `top`, `bottom`, `all`, `{station: 12}`, `{joint: 3}` or `{measured_depth: 2.5}`. Stations and joints count from 0
/// at the top, so that joint 0 is `joint_01` in the outputs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum At {
    /// First station.
    Top,
    /// Last station.
    Bottom,
    /// Every station.
    All,
    /// By number.
    Station(usize),
    /// By number.
    Joint(usize),
    /// The station nearest to this distance from the kick-off (m).
    MeasuredDepth(#[schemars(transform = Bound::within(0.0, f64::INFINITY).in_schema())] f64),
}

/// The mesh that locations refer to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mesh {
    pub(super) links: usize,
    pub(super) elements_per_link: usize,
    pub(super) length: f64,
}

impl Mesh {
    pub(super) fn last_station(&self) -> usize {
        self.links * self.elements_per_link
    }

    /// Station numbers from the top to the bottom.
    pub(super) fn stations(&self) -> Bound {
        Bound::within(0.0, self.last_station() as f64)
    }
}

impl At {
    pub(super) fn check(&self, c: &mut Checker, mesh: &Mesh) {
        match *self {
            Self::Top | Self::Bottom | Self::All => {}
            Self::Station(station) => c.below("at", |c| {
                c.count("station", station, mesh.stations(), "stations count from 0 at the top");
            }),
            Self::Joint(joint) => c.below("at", |c| {
                let bound = match mesh.links {
                    0 | 1 => "left out: one link has no joint".to_string(),
                    links => format!("0 to {}", links - 2),
                };
                let reason = "joints count from 0 at the top, one less than links";
                c.require(joint + 1 < mesh.links, "joint", joint, "", bound, reason);
            }),
            Self::MeasuredDepth(depth) => c.below("at", |c| {
                let reason = "the tool's length, from the kick-off on";
                c.number("measured_depth", depth, Bound::within(0.0, mesh.length), "m", reason);
            }),
        }
    }

    pub(super) fn location(&self, mesh: &Mesh) -> Location {
        match *self {
            Self::Top => Location::Top,
            Self::Bottom => Location::Bottom,
            Self::All => Location::All,
            Self::Station(station) => Location::Station(station),
            Self::Joint(joint) => Location::Joint(joint),
            Self::MeasuredDepth(depth) => {
                let last = mesh.last_station();
                let nearest = (depth / mesh.length * last as f64).round();
                // A float that is checked to be within 0..=last.
                Location::Station((nearest.max(0.0) as usize).min(last))
            }
        }
    }
}
