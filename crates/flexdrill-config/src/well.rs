//! `well`: the bore.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::well_plan::WellPlan;
use flexdrill_core::tool::{WellDescription, WellSection};
use flexdrill_core::units::deg_to_rad;

const INCLINATION: Bound = Bound::within(0.0, 180.0);
const HOLE: Bound = Bound::above(0.0, 2.0);
const LENGTH: Bound = Bound::above(0.0, 1000.0);
const RADIUS: Bound = Bound::within(0.5, 10_000.0);
const DEPTH: Bound = Bound::within(0.0, 20_000.0);
const BUILD: Bound = Bound::above(0.0, 180.0);

/// The bore: its centre line from the kick-off down and its diameter. The tool fills it from end to end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Well {
    /// Inclination at the top: 0 is vertical, 90 horizontal. Default 0.
    #[serde(default)]
    #[schemars(transform = INCLINATION.in_schema())]
    pub start_inclination_deg: f64,
    /// Sections of the bore, from the top down. Required.
    pub sections: Vec<Section>,
    /// Diameter of the hole (m). Required.
    #[schemars(transform = HOLE.in_schema())]
    pub hole_diameter: f64,
    /// The planned hole. Nothing of it acts on a run. Default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<WellPlan>,
    /// Measured depth from the kick-off (m) from which on this tool has drilled: surveys above it say nothing of the tool.
    /// Nothing of it acts on a run. Default where the arc above the bit begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = DEPTH.in_schema())]
    pub drilled_from: Option<f64>,
    /// Measured depth of the kick-off (m) as the rig counts it: surveys of the rig lie deeper by it than the model counts.
    /// Nothing of it acts on a run. Default 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(transform = DEPTH.in_schema())]
    pub kick_off_depth: f64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_zero(depth: &f64) -> bool {
    *depth == 0.0
}

/// One section of the well path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Section {
    /// `straight: {length: 1.0}`.
    Straight {
        /// Length of the section (m).
        #[schemars(transform = LENGTH.in_schema())]
        length: f64,
    },
    /// `arc: {radius: 3.2, build_angle_deg: 90}`.
    Arc {
        /// Radius of the arc (m).
        #[schemars(transform = RADIUS.in_schema())]
        radius: f64,
        /// Increase of the inclination over the arc.
        #[schemars(transform = BUILD.in_schema())]
        build_angle_deg: f64,
    },
}

impl Section {
    /// Length along the path (m).
    pub fn length(&self) -> f64 {
        match *self {
            Self::Straight { length } => length,
            Self::Arc {
                radius,
                build_angle_deg,
            } => radius * deg_to_rad(build_angle_deg),
        }
    }
}

impl Section {
    /// Curvature (1/m), 0 where it is straight.
    pub fn curvature(&self) -> f64 {
        match *self {
            Self::Straight { .. } => 0.0,
            Self::Arc { radius, .. } => 1.0 / radius,
        }
    }
}

impl Well {
    /// Length along the path (m).
    pub fn length(&self) -> f64 {
        self.sections.iter().map(Section::length).sum()
    }

    /// Inclination at the bottom (deg).
    pub fn end_inclination_deg(&self) -> f64 {
        self.start_inclination_deg + self.sections.iter().map(Section::build_deg).sum::<f64>()
    }

    /// Whether every section is straight.
    pub fn is_straight(&self) -> bool {
        !self
            .sections
            .iter()
            .any(|section| matches!(section, Section::Arc { .. }))
    }

    /// Smallest radius of curvature (m), infinite for a straight well.
    pub fn smallest_radius(&self) -> f64 {
        self.sections
            .iter()
            .fold(f64::INFINITY, |smallest, section| match section {
                Section::Arc { radius, .. } => smallest.min(*radius),
                Section::Straight { .. } => smallest,
            })
    }

    pub(super) fn check(&self, c: &mut Checker) {
        c.number(
            "start_inclination_deg",
            self.start_inclination_deg,
            INCLINATION,
            "deg",
            "0 is straight down, 180 straight up",
        );
        c.require(
            !self.sections.is_empty(),
            "sections",
            "[]",
            "",
            "at least one section",
            "the tool lies along them",
        );
        c.below("sections", |c| {
            for (index, section) in self.sections.iter().enumerate() {
                c.below(index, |c| section.check(c));
            }
        });
        // The hole grows by arcs in one vertical plane, and its depth and azimuth are those of a hole that goes down once.
        let end = self.end_inclination_deg();
        c.require(
            end <= 180.0,
            "sections",
            format!("{end} at the bottom"),
            "deg",
            "at most 180 deg",
            "beyond, the well would come back under itself",
        );
        c.number(
            "hole_diameter",
            self.hole_diameter,
            HOLE,
            "m",
            "a bore of a slim drilling tool, given in metres",
        );
        // The plan begins on the hole, so that its first depth is held against the hole's.
        if let Some(plan) = &self.plan {
            let hole = self.length();
            c.below("plan", |c| plan.check(c, hole));
        }
        c.number(
            "kick_off_depth",
            self.kick_off_depth,
            DEPTH,
            "m",
            "no well is deeper than 20 km; give the rig's measured depth where well.sections begins",
        );
        if let Some(from) = self.drilled_from {
            let bit = self.length();
            c.require(
                (0.0..bit).contains(&from) || !bit.is_finite(),
                "drilled_from",
                from,
                "m",
                format!("at least 0 m, the kick-off, and less than {bit:.3} m, the bit"),
                "it is a depth of the hole above the bit, counted from the kick-off",
            );
        }
    }

    pub(super) fn describe(&self) -> WellDescription {
        WellDescription {
            start_inclination: deg_to_rad(self.start_inclination_deg),
            sections: self.sections.iter().map(Section::describe).collect(),
        }
    }
}

impl Section {
    fn build_deg(&self) -> f64 {
        match self {
            Self::Straight { .. } => 0.0,
            Self::Arc { build_angle_deg, .. } => *build_angle_deg,
        }
    }

    fn check(&self, c: &mut Checker) {
        match *self {
            Self::Straight { length } => c.below("straight", |c| {
                c.number(
                    "length",
                    length,
                    LENGTH,
                    "m",
                    "the model is of one tool, not of a whole drill string",
                );
            }),
            Self::Arc {
                radius,
                build_angle_deg,
            } => c.below("arc", |c| {
                c.number(
                    "radius",
                    radius,
                    RADIUS,
                    "m",
                    "below 0.5 m the frames of neighbouring stations differ too much for small tilts",
                );
                c.number(
                    "build_angle_deg",
                    build_angle_deg,
                    BUILD,
                    "deg",
                    "arcs build inclination; use `straight` for none",
                );
            }),
        }
    }

    fn describe(&self) -> WellSection {
        match *self {
            Self::Straight { length } => WellSection::Straight { length },
            Self::Arc {
                radius,
                build_angle_deg,
            } => WellSection::Arc {
                radius,
                angle: deg_to_rad(build_angle_deg),
            },
        }
    }
}
