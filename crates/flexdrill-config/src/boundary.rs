//! `boundary`: what holds and drives the tool, Table 1 of the paper and its variants.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Checker;
use super::json_schema;
use super::place::{At, Mesh};
use flexdrill_core::tool::{Body, Direction, Location, Support, WeightPlace, WobPath};

/// Supports, drive and load path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Boundary {
    /// Set of supports: `paper` (Table 1) or `none` (only `supports`). Default paper.
    pub preset: Preset,
    /// Whether the preset holds the axial displacement u at the bottom: `free` or `fixed`. Default free.
    pub bottom_axial: BottomAxial,
    /// The pipe that carries the weight on bit: `guide`, or `shared`, which ties the pipe's lower end to the guide's.
    /// Default guide.
    #[schemars(with = "json_schema::WobPath")]
    pub wob_path: WobPath,
    /// Where the weight on bit of the inputs is measured: at the `bit`, or at the `kickoff` as the axial force on the
    /// guide. The weight at the bit then follows, less by the friction of the guide. Default bit.
    #[schemars(with = "json_schema::WeightPlace")]
    pub weight_on_bit_at: WeightPlace,
    /// Drive of the first pipe node: `top` turns it at the commanded speed, `none` leaves it to the supports. Default
    /// top.
    pub drive: Drive,
    /// Supports in addition to those of the preset. Default none.
    pub supports: Vec<Held>,
}

/// Sets of supports.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Table 1: top u, v, w of both pipes, bottom v, w of both. The guide's spin is free, because its curvature holds
    /// it.
    #[default]
    Paper,
    /// Only `supports`.
    None,
}

/// The axial direction at the bottom.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BottomAxial {
    /// The paper's text: the weight on bit moves the end.
    #[default]
    Free,
    /// Table 1 as printed, for comparison: the support carries the weight on bit.
    Fixed,
}

/// Drive of the pipe.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// The first pipe node follows the commanded speed.
    #[default]
    Top,
    /// No drive; the supports determine the motion of the first node.
    None,
}

/// Directions held at zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Held {
    /// Location along the tool.
    pub at: At,
    /// The supported body: `pipe` or `guide`.
    #[schemars(with = "json_schema::Body")]
    pub body: Body,
    /// Directions that are held: any of u (axial), v (horizontal), w (towards the low side), psi (spin), phi_y, phi_z
    /// (tilts).
    #[schemars(with = "Vec<json_schema::Direction>")]
    pub fix: Vec<Direction>,
}

impl Default for Boundary {
    fn default() -> Self {
        Self {
            preset: Preset::default(),
            bottom_axial: BottomAxial::default(),
            wob_path: WobPath::Guide,
            weight_on_bit_at: WeightPlace::Bit,
            drive: Drive::default(),
            supports: Vec::new(),
        }
    }
}

impl Boundary {
    pub(super) fn check(&self, c: &mut Checker, mesh: &Mesh) {
        // Each support is checked with its index, so that the error points at the line of the file.
        c.below("supports", |c| {
            for (index, held) in self.supports.iter().enumerate() {
                c.below(index, |c| {
                    held.at.check(c, mesh);
                    c.require(
                        !held.fix.is_empty(),
                        "fix",
                        "[]",
                        "",
                        "at least one of u, v, w, psi, phi_y, phi_z",
                        "a support that holds nothing is a mistake",
                    );
                    // A support of the spin at the drive would hold the node
                    // against the speed that the drive prescribes.
                    let spin_held_at_drive = self.drive == Drive::Top
                        && held.body == Body::Pipe
                        && matches!(
                            held.at.location(mesh),
                            Location::Top | Location::All | Location::Station(0)
                        )
                        && held.fix.contains(&Direction::Psi);
                    c.require(
                        !spin_held_at_drive,
                        "fix",
                        "psi of the driven node",
                        "",
                        "without psi, or boundary.drive none",
                        "the drive sets the spin there",
                    );
                });
            }
        });
        // The checks from here on concern combinations of keys, each valid by itself.
        let nothing_held = self.preset == Preset::None && self.supports.is_empty();
        c.require(
            !nothing_held,
            "supports",
            "[]",
            "",
            "given when the preset is none",
            "the tool would fall without end",
        );
        c.require(
            self.preset == Preset::Paper || self.bottom_axial == BottomAxial::Free,
            "bottom_axial",
            "fixed",
            "",
            "free when the preset is none",
            "it belongs to the preset; hold u at the bottom with a support",
        );
        // With the weight at the kick-off its reaction is the input, so exactly one support may carry the guide along
        // the hole, and that at the top.
        let at_kickoff = self.weight_on_bit_at == WeightPlace::Kickoff;
        c.require(
            !at_kickoff || self.wob_path == WobPath::Guide,
            "weight_on_bit_at",
            "kickoff",
            "",
            "bit with boundary.wob_path shared",
            "the pipe carries a part of the weight there",
        );
        // The supports of the preset count with those of the configuration: what holds is the sum of both.
        let held = |bottom: bool| {
            self.describe(mesh, false).iter().any(|support| {
                let top = match support.location {
                    Location::Top | Location::Station(0) => Some(true),
                    // A support along the whole tool holds the top and everything below.
                    Location::All => None,
                    _ => Some(false),
                };
                support.body == Body::Guide
                    && support.directions.contains(&Direction::U)
                    && (top.is_none() || top == Some(!bottom))
            })
        };
        c.require(
            !at_kickoff || held(false),
            "weight_on_bit_at",
            "kickoff",
            "",
            "bit where no support in boundary.supports holds u of the guide at the top",
            "the force at the kick-off is that of this support",
        );
        c.require(
            !at_kickoff || !held(true),
            "weight_on_bit_at",
            "kickoff",
            "",
            "bit where boundary.supports or boundary.bottom_axial hold u of the guide below the top",
            "such a support carries a part of the weight",
        );
    }

    /// Table 1 as supports. Below a hoist the tops of both pipes are free along the hole: the pipe hangs on the guide, and
    /// the guide on the string.
    pub(super) fn describe(&self, mesh: &Mesh, with_hoist: bool) -> Vec<Support> {
        use Direction::{U, V, W};
        let mut supports = Vec::new();
        if self.preset == Preset::Paper {
            let bottom = match self.bottom_axial {
                BottomAxial::Free => vec![V, W],
                BottomAxial::Fixed => vec![U, V, W],
            };
            for (location, directions) in [(Location::Top, vec![U, V, W]), (Location::Bottom, bottom)] {
                for body in [Body::Pipe, Body::Guide] {
                    let hangs = with_hoist && location == Location::Top;
                    let mut directions = directions.clone();
                    directions.retain(|&direction| !(hangs && direction == U));
                    supports.push(Support {
                        location,
                        body,
                        directions,
                    });
                }
            }
        }
        supports.extend(self.supports.iter().map(|held| Support {
            location: held.at.location(mesh),
            body: held.body,
            directions: held.fix.clone(),
        }));
        supports
    }

    /// Whether a support other than the preset's holds the top of a pipe along the hole.
    pub(super) fn holds_a_top(&self, mesh: &Mesh) -> bool {
        self.supports.iter().any(|held| {
            let at = held.at.location(mesh);
            let at_top = matches!(at, Location::Top | Location::All | Location::Station(0));
            at_top && held.fix.contains(&Direction::U)
        })
    }

    /// Whether a support holds the guide's spin.
    pub fn holds_guide_spin(&self) -> bool {
        self.supports
            .iter()
            .any(|held| held.body == Body::Guide && held.fix.contains(&Direction::Psi))
    }
}
