//! `tool.guide`: section, stiffness and shape of the guide pipe.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::pipe::{DIAMETER, INNER_DIAMETER, check_tube};
use flexdrill_core::tool::{Bend, Bends, FreeCurvature, Spine, Tube};
use flexdrill_core::units::deg_to_rad;

const BENDING_FACTOR: Bound = Bound::above(0.0, 10.0);
/// Up to the tightest arc that a well may have.
const FREE_CURVATURE: Bound = Bound::within(0.0, 2.0);
/// A piece longer than a kilometre belongs to no guide.
const PIECE_LENGTH: Bound = Bound::above(0.0, 1000.0);
/// A curvature of 10 1/m is that of an arc narrower than a hand.
const SLOTS_CLOSE_AT: Bound = Bound::above(0.0, 10.0);
const PHASE: Bound = Bound::within(-360.0, 360.0);
/// A spine lies in the wall of a tube, and a tube that is 0.3 m wide fits into no arc of this kind.
const SPINE_OFFSET: Bound = Bound::within(0.0, 0.15);
/// Toolface of the low side (deg).
const LOW_SIDE: f64 = 180.0;
/// A fibre further out than a metre belongs to no guide, even over a small share of its length.
const OUTER_FIBRE: Bound = Bound::above(0.0, 1.0);

/// The guide pipe: one continuous tube that is not driven.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Guide {
    /// Outer diameter (m). Required.
    #[schemars(transform = DIAMETER.in_schema())]
    pub outer_diameter: f64,
    /// Inner diameter (m). Required.
    #[schemars(transform = INNER_DIAMETER.in_schema())]
    pub inner_diameter: f64,
    /// Factor on the bending stiffness: 1 for a plain tube, less for a slotted one. Default 1.
    #[serde(default = "one")]
    #[schemars(transform = BENDING_FACTOR.in_schema())]
    pub bending_factor: f64,
    /// Curvature of the tube as made: a number in 1/m, 0 for a straight tube; a list of pieces from the bit up, each with its
    /// `length` and `curvature`; or `as_built`, the path's own curvature, so that it lies in the hole without stress. Default
    /// as_built.
    ///
    /// Allowed: within 0 to 2 1/m
    #[serde(default)]
    pub free_curvature: FreeBend,
    /// Toolface of the bend of the free tube: its angle from the high side, clockwise looking down the hole. Default 0,
    /// along the build.
    #[serde(default)]
    #[schemars(transform = PHASE.in_schema())]
    pub free_curvature_phase_deg: f64,
    /// Curvature against the shape as made at which the slots close: a number in 1/m, or `never`. Beyond it the guide
    /// bends with the stiffness of the whole tube, `bending_factor` 1. Default never.
    ///
    /// Allowed: above 0, at most 10 1/m
    #[serde(default)]
    pub slots_close_at: SlotsClose,
    /// Distance (m) between the guide's axis and the spine that slots on one side leave. The spine carries the thrust, which
    /// bends the guide away from it by the curvature thrust x offset / bending stiffness, as far as `slots_close_at`. Bending
    /// is about the spine: `bending_factor` is that about its own neutral line. 0 for slots that leave spines on both sides.
    /// Default 0.
    #[serde(default)]
    #[schemars(transform = SPINE_OFFSET.in_schema())]
    pub spine_offset: f64,
    /// Toolface of the spine: its angle from the high side, clockwise looking down the hole. Default 180, on the low side, so
    /// that thrust builds.
    #[serde(default = "low_side")]
    #[schemars(transform = PHASE.in_schema())]
    pub spine_toolface_deg: f64,
    /// Distance (m) from the neutral line of the fibre that bending strains most, over the share of the length that bends:
    /// strain is this times the change of curvature. Only `flexdrill check` reads it. A plain tube has half of its outer
    /// diameter, which with `spine_offset` in addition is the default. Slots that leave two ribs of height h at the neutral line, over the share s of the
    /// length, have h / (2 s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = OUTER_FIBRE.in_schema())]
    pub outer_fibre: Option<f64>,
    /// `true` holds every node in all directions, like the outer beam of the paper's Fig. 8. Default false.
    #[serde(default)]
    pub fixed: bool,
}

/// `as_built`, a number in 1/m, or pieces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(transform = FREE_CURVATURE.in_schema())]
pub enum FreeBend {
    /// The curvature of the path.
    Path(AsBuilt),
    /// In 1/m, 0 is straight.
    Curvature(f64),
    /// Pieces, from the bit up.
    Pieces(Vec<BentPiece>),
}

/// A piece of a guide that was made with several curvatures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BentPiece {
    /// Length (m); the uppermost piece reaches to the top of the guide, however long it is.
    #[schemars(transform = PIECE_LENGTH.in_schema())]
    pub length: f64,
    /// Curvature as made (1/m), 0 is straight.
    #[schemars(transform = FREE_CURVATURE.in_schema())]
    pub curvature: f64,
}

/// A piece of a guide as made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MadePiece {
    /// Distances of its lower and its upper end above the bit (m); the uppermost one has no end.
    pub above_bit: [f64; 2],
    /// Curvature (1/m).
    pub curvature: f64,
}

/// The word for a tube that has the curvature of the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AsBuilt {
    /// Without stress in the hole.
    AsBuilt,
}

impl Default for FreeBend {
    fn default() -> Self {
        Self::Path(AsBuilt::AsBuilt)
    }
}

/// `never`, or a number in 1/m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(transform = SLOTS_CLOSE_AT.in_schema())]
pub enum SlotsClose {
    /// At no curvature.
    Never(Never),
    /// In 1/m.
    At(f64),
}

/// The word for slots that stay open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Never {
    /// Open however far the guide bends.
    Never,
}

impl Default for SlotsClose {
    fn default() -> Self {
        Self::Never(Never::Never)
    }
}

fn one() -> f64 {
    1.0
}

fn low_side() -> f64 {
    LOW_SIDE
}

impl Guide {
    pub(super) fn check(&self, c: &mut Checker) {
        check_tube(c, self.outer_diameter, self.inner_diameter);
        c.number(
            "bending_factor",
            self.bending_factor,
            BENDING_FACTOR,
            "",
            "1 is a plain tube; without any bending stiffness the guide would fold",
        );
        if let Some(fibre) = self.outer_fibre {
            c.number("outer_fibre", fibre, OUTER_FIBRE, "m", "given in metres");
        }
        let phase = self.free_curvature_phase_deg;
        c.number("free_curvature_phase_deg", phase, PHASE, "deg", "one turn");
        let reason = "0 is a straight tube; no arc of a well is tighter than 0.5 m";
        // What is made can bend only where the guide is free: at every node it would be a load without effect.
        if let (true, Some(first)) = (self.fixed, self.made().first()) {
            c.wrong(
                "free_curvature",
                first.curvature,
                "1/m",
                "as_built while tool.guide.fixed is true",
                "a guide that is held at every node does not bend",
            );
        }
        // Each piece has the bounds of a whole guide. Where nothing is given there is no plane for the phase to turn.
        match &self.free_curvature {
            FreeBend::Curvature(curvature) => c.number("free_curvature", *curvature, FREE_CURVATURE, "1/m", reason),
            FreeBend::Pieces(pieces) => c.below("free_curvature", |c| {
                c.require(
                    (1..=Bends::MOST + 1).contains(&pieces.len()),
                    "",
                    pieces.len(),
                    "pieces",
                    format!("1 to {} pieces", Bends::MOST + 1),
                    "join pieces of about the same curvature",
                );
                for (index, piece) in pieces.iter().enumerate() {
                    c.below(index, |c| {
                        c.number("length", piece.length, PIECE_LENGTH, "m", "a piece has a length");
                        c.number("curvature", piece.curvature, FREE_CURVATURE, "1/m", reason);
                    });
                }
            }),
            FreeBend::Path(_) => c.require(
                phase == 0.0,
                "free_curvature_phase_deg",
                phase,
                "deg",
                "0 while tool.guide.free_curvature is as_built",
                "such a guide bends along the path",
            ),
        }
        self.check_slots(c);
        self.check_spine(c);
    }

    fn check_spine(&self, c: &mut Checker) {
        let (offset, toolface) = (self.spine_offset, self.spine_toolface_deg);
        c.number(
            "spine_offset",
            offset,
            SPINE_OFFSET,
            "m",
            "a spine lies in the wall of the tube",
        );
        c.number("spine_toolface_deg", toolface, PHASE, "deg", "one turn");
        // Without an offset nothing but the default makes sense.
        if !self.has_spine_off_axis() {
            c.require(
                toolface == LOW_SIDE,
                "spine_toolface_deg",
                toolface,
                "deg",
                "180 while tool.guide.spine_offset is 0",
                "a spine on the axis has no toolface",
            );
            return;
        }
        // With one, the tube must be one that has a spine: of its diameter, slotted, and free to bend.
        c.require(
            offset <= 0.5 * self.outer_diameter,
            "spine_offset",
            offset,
            "m",
            format!(
                "at most {} m, half of tool.guide.outer_diameter",
                0.5 * self.outer_diameter
            ),
            "a spine lies in the wall of the tube",
        );
        c.require(
            self.bending_factor < 1.0,
            "spine_offset",
            offset,
            "m",
            format!("0 while tool.guide.bending_factor is {}", self.bending_factor),
            "a tube as stiff as one without slots bends about its axis",
        );
        c.require(
            !self.fixed,
            "spine_offset",
            offset,
            "m",
            "0 while tool.guide.fixed is true",
            "a guide that is held at every node does not bend",
        );
    }

    fn check_slots(&self, c: &mut Checker) {
        let SlotsClose::At(curvature) = self.slots_close_at else {
            return;
        };
        let reason = "the width of a slot over its distance from the next one and the tube's outer radius; never for a \
                      tube without slots";
        c.number("slots_close_at", curvature, SLOTS_CLOSE_AT, "1/m", reason);
        c.require(
            self.bending_factor < 1.0,
            "slots_close_at",
            curvature,
            "1/m",
            format!("never while tool.guide.bending_factor is {}", self.bending_factor),
            "a tube as stiff as one without slots has none that close",
        );
        c.require(
            !self.fixed,
            "slots_close_at",
            curvature,
            "1/m",
            "never while tool.guide.fixed is true",
            "a guide that is held at every node does not bend",
        );
    }

    /// Curvature at which the slots close (1/m).
    pub(super) fn slots_close_at(&self) -> Option<f64> {
        match self.slots_close_at {
            SlotsClose::Never(_) => None,
            SlotsClose::At(curvature) => Some(curvature),
        }
    }

    /// Distance of the outermost bent fibre from the neutral line over the share of the length that bends (m).
    pub(super) fn outer_fibre(&self) -> f64 {
        self.outer_fibre
            .unwrap_or(0.5 * self.outer_diameter + self.spine_offset)
    }

    /// Whether thrust bends the guide.
    pub fn has_spine_off_axis(&self) -> bool {
        self.spine_offset != 0.0
    }

    /// Toolface of the bend that thrust adds (deg), opposite to the spine: 0 builds. Whole turns are left out, so that a bend
    /// in the plane of the build is exactly in it.
    pub fn thrust_bend_toolface_deg(&self) -> f64 {
        (self.spine_toolface_deg - LOW_SIDE) % 360.0
    }

    /// The spine, where it lies off the axis.
    pub(super) fn spine(&self) -> Option<Spine> {
        self.has_spine_off_axis().then(|| Spine {
            offset: self.spine_offset,
            phase: deg_to_rad(self.thrust_bend_toolface_deg()),
        })
    }

    /// Whether the slots close at some curvature.
    pub fn closes_slots(&self) -> bool {
        self.slots_close_at().is_some()
    }

    /// The guide as made, from the bit up; nothing where it has the curvature of the path.
    pub(super) fn made(&self) -> Vec<MadePiece> {
        let mut from = 0.0;
        let one = |curvature| MadePiece {
            above_bit: [0.0, f64::INFINITY],
            curvature,
        };
        match &self.free_curvature {
            FreeBend::Path(_) => Vec::new(),
            FreeBend::Curvature(curvature) => vec![one(*curvature)],
            FreeBend::Pieces(pieces) => {
                let mut made: Vec<MadePiece> = Vec::new();
                for piece in pieces {
                    let above_bit = [from, from + piece.length];
                    made.push(MadePiece {
                        above_bit,
                        curvature: piece.curvature,
                    });
                    from = above_bit[1];
                }
                if let Some(last) = made.last_mut() {
                    last.above_bit[1] = f64::INFINITY;
                }
                made
            }
        }
    }

    /// The free bend at the bit, if it is not that of the path.
    pub(super) fn free_curvature(&self) -> Option<FreeCurvature> {
        self.made().first().map(|piece| FreeCurvature {
            curvature: piece.curvature,
            phase: deg_to_rad(self.free_curvature_phase_deg),
        })
    }

    /// Where the curvature as made changes above the bit.
    pub(super) fn bends(&self) -> Bends {
        let changes: Vec<Bend> = self
            .made()
            .iter()
            .skip(1)
            .map(|piece| Bend {
                from: piece.above_bit[0],
                curvature: piece.curvature,
            })
            .collect();
        // Pieces that have been checked rise, and are few enough.
        Bends::new(&changes).unwrap_or_default()
    }

    pub(super) fn section(&self) -> Tube {
        Tube {
            outer_diameter: self.outer_diameter,
            inner_diameter: self.inner_diameter,
        }
    }
}
