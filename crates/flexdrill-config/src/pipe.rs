//! `tool.pipe`: the section of the flexible pipe.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use flexdrill_core::tool::Tube;

pub(super) const DIAMETER: Bound = Bound::above(0.0, 2.0);
/// 0 is a solid bar.
pub(super) const INNER_DIAMETER: Bound = Bound::within(0.0, 2.0);
const DIAMETER_REASON: &str = "given in metres";

/// The links of the flexible pipe, all identical: either uniform (`outer_diameter`, `inner_diameter`) or stepped
/// (`pieces`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pipe {
    /// Outer diameter (m). Required unless there are pieces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = DIAMETER.in_schema())]
    pub outer_diameter: Option<f64>,
    /// Inner diameter (m), 0 is a solid bar. Required unless there are pieces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = INNER_DIAMETER.in_schema())]
    pub inner_diameter: Option<f64>,
    /// Diameter at which the pipe contacts the guide (m). Default: the outer diameter of the steel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = DIAMETER.in_schema())]
    pub contact_diameter: Option<f64>,
    /// Pieces of a stepped link, from top to bottom without gaps. Default: a uniform link.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pieces: Vec<Piece>,
}

/// A piece of a stepped link. An element has the section of the piece at its middle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Beginning of the piece, as a fraction of the link from its top.
    pub from: f64,
    /// End of the piece, as a fraction of the link from its top.
    #[schemars(transform = Bound::within(f64::NEG_INFINITY, 1.0).in_schema())]
    pub to: f64,
    /// Outer diameter (m).
    #[schemars(transform = DIAMETER.in_schema())]
    pub outer_diameter: f64,
    /// Inner diameter (m).
    #[schemars(transform = INNER_DIAMETER.in_schema())]
    pub inner_diameter: f64,
}

pub(super) fn check_tube(c: &mut Checker, outer: f64, inner: f64) {
    c.number("outer_diameter", outer, DIAMETER, "m", DIAMETER_REASON);
    c.number("inner_diameter", inner, INNER_DIAMETER, "m", DIAMETER_REASON);
    if inner >= outer {
        c.wrong(
            "inner_diameter",
            inner,
            "m",
            format!("below the outer diameter, {outer} m"),
            "the wall would be gone",
        );
    }
}

impl Pipe {
    pub(super) fn check(&self, c: &mut Checker) {
        match (self.outer_diameter, self.inner_diameter, self.pieces.is_empty()) {
            (Some(outer), Some(inner), true) => check_tube(c, outer, inner),
            (None, None, false) => self.check_pieces(c),
            (_, _, true) => c.wrong(
                "",
                "incomplete",
                "",
                "given by outer_diameter and inner_diameter, or by pieces",
                "there is no default for the tool's sections",
            ),
            (_, _, false) => c.wrong(
                "pieces",
                "given beside a uniform section",
                "",
                "the only section given",
                "leave out outer_diameter and inner_diameter",
            ),
        }
        if let Some(contact) = self.contact_diameter {
            c.number("contact_diameter", contact, DIAMETER, "m", DIAMETER_REASON);
        }
    }

    fn check_pieces(&self, c: &mut Checker) {
        let mut end = 0.0;
        c.below("pieces", |c| {
            for (index, piece) in self.pieces.iter().enumerate() {
                c.below(index, |c| {
                    check_tube(c, piece.outer_diameter, piece.inner_diameter);
                    // 1e-9: decimals such as 0.2 + 0.1 are not exact.
                    let follows = (piece.from - end).abs() < 1e-9;
                    c.require(
                        follows,
                        "from",
                        piece.from,
                        "",
                        end,
                        "pieces follow one another without gap or overlap, from 0 to 1",
                    );
                    c.number(
                        "to",
                        piece.to,
                        Bound::above(piece.from, 1.0),
                        "",
                        "a fraction of the link's length, after `from`",
                    );
                    end = piece.to;
                });
            }
            let last = self.pieces.len().saturating_sub(1);
            c.below(last, |c| {
                c.require(
                    (end - 1.0).abs() < 1e-9,
                    "to",
                    end,
                    "",
                    "1 for the last piece",
                    "pieces cover the link",
                );
            });
        });
    }

    /// The section of a pipe without pieces.
    pub(super) fn uniform_section(&self) -> Option<Tube> {
        Some(Tube {
            outer_diameter: self.outer_diameter?,
            inner_diameter: self.inner_diameter?,
        })
    }

    fn piece_at(&self, fraction: f64) -> Tube {
        self.uniform_section().unwrap_or_else(|| {
            let at = self.pieces.iter().find(|piece| fraction <= piece.to);
            let piece = at.or(self.pieces.last());
            piece.map_or(Tube::default(), |piece| Tube {
                outer_diameter: piece.outer_diameter,
                inner_diameter: piece.inner_diameter,
            })
        })
    }

    /// Section of each of a link's elements: the piece at the element's middle.
    pub fn element_sections(&self, elements: usize) -> Vec<Tube> {
        (0..elements)
            .map(|element| self.piece_at((element as f64 + 0.5) / elements as f64))
            .collect()
    }

    /// Contact diameter (m) at each of a link's stations: `contact_diameter`, or the thicker of the pieces that meet
    /// there.
    pub fn contact_diameters(&self, elements: usize) -> Vec<f64> {
        (0..=elements)
            .map(|station| {
                self.contact_diameter.unwrap_or_else(|| {
                    let fraction = station as f64 / elements as f64;
                    let above = self.piece_at((fraction - 1e-9).max(0.0));
                    let below = self.piece_at((fraction + 1e-9).min(1.0));
                    above.outer_diameter.max(below.outer_diameter)
                })
            })
            .collect()
    }

    /// Ends of pieces (fractions of the link) that fall inside an element, whose section is then that at its middle.
    pub fn pieces_off_mesh(&self, elements: usize) -> Vec<f64> {
        self.pieces
            .iter()
            .map(|piece| piece.to)
            .filter(|to| {
                let position = to * elements as f64;
                (position - position.round()).abs() > 1e-6
            })
            .collect()
    }
}
