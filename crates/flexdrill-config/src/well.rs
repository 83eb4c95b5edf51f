//! `well`: the bore.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::drilled::Drilled;
use super::section::is_zero;
use super::well_plan::WellPlan;
use flexdrill_core::tool::{Course, WellDescription, WellSection};
use flexdrill_core::units::{deg_to_rad, rad_to_deg};

const INCLINATION: Bound = Bound::within(0.0, 180.0);
const HOLE: Bound = Bound::above(0.0, 2.0);
const LENGTH: Bound = Bound::above(0.0, 1000.0);
const RADIUS: Bound = Bound::within(0.5, 10_000.0);
const DEPTH: Bound = Bound::within(0.0, 20_000.0);
const BUILD: Bound = Bound::above(0.0, 180.0);
/// How far a hole may be off its vertical plane (m). Its size is not known better.
const OFF_PLANE: f64 = 1e-3;

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

/// One section of the well path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// `drilled: {points: [[0.31, 0.0], [0.30, 0.0]]}`: hole as drilled.
    Drilled(Drilled),
}

impl Section {
    /// Length along the path (m).
    pub fn length(&self) -> f64 {
        match self {
            Self::Straight { length } => *length,
            Self::Arc {
                radius,
                build_angle_deg,
            } => radius * deg_to_rad(*build_angle_deg),
            Self::Drilled(drilled) => drilled.length(),
        }
    }

    /// Curvature (1/m), 0 where it is straight; the mean of hole as drilled.
    pub fn curvature(&self) -> f64 {
        match self {
            Self::Straight { .. } => 0.0,
            Self::Arc { radius, .. } => 1.0 / radius,
            Self::Drilled(drilled) => drilled.turn(drilled.length()) / drilled.length(),
        }
    }

    /// Smallest and largest curvature (1/m).
    pub fn curvature_range(&self) -> [f64; 2] {
        match self {
            Self::Drilled(drilled) => drilled.build_range(),
            Self::Straight { .. } | Self::Arc { .. } => [self.curvature(); 2],
        }
    }

    /// Change of inclination from its top over a length (rad).
    pub fn turn(&self, length: f64) -> f64 {
        match self {
            Self::Drilled(drilled) => drilled.turn(length),
            Self::Straight { .. } | Self::Arc { .. } => self.curvature() * length,
        }
    }

    /// Adds it to a hole.
    pub fn extend(&self, course: &mut Course) {
        match self {
            Self::Drilled(drilled) => drilled.extend(course),
            Self::Straight { .. } | Self::Arc { .. } => course.advance(self.length(), [self.curvature(), 0.0]),
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
        self.sections
            .iter()
            .all(|section| section.curvature_range() == [0.0; 2])
    }

    /// Smallest radius of curvature (m), infinite for a straight well.
    pub fn smallest_radius(&self) -> f64 {
        self.sections
            .iter()
            .fold(f64::INFINITY, |smallest, section| match section {
                Section::Arc { radius, .. } => smallest.min(*radius),
                Section::Straight { .. } => smallest,
                Section::Drilled(drilled) => drilled
                    .build_range()
                    .into_iter()
                    .fold(smallest, |smallest, build| smallest.min(1.0 / build.abs())),
            })
    }

    /// The whole hole from the top to the bit, with what it walks.
    pub fn course(&self) -> Course {
        let mut course = Course::begin(deg_to_rad(self.start_inclination_deg), 0.0);
        for section in &self.sections {
            section.extend(&mut course);
        }
        course
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
        self.check_drilled(c);
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

    /// Checks where hole as drilled leads: what no single point shows.
    fn check_drilled(&self, c: &mut Checker) {
        let mut course = Course::begin(deg_to_rad(self.start_inclination_deg), 0.0);
        let mut inclination = deg_to_rad(self.start_inclination_deg);
        // Position seen from above, of each end of a section and of each point.
        let mut seen: Vec<(usize, [f64; 2])> = Vec::new();
        let walks = |section: &Section| matches!(section, Section::Drilled(drilled) if drilled.points.iter().any(|p| p[1] != 0.0));
        for (index, section) in self.sections.iter().enumerate() {
            let Section::Drilled(drilled) = section else {
                inclination += section.turn(section.length());
                section.extend(&mut course);
                seen.push((index, [course.position.x, course.position.y]));
                continue;
            };
            let (mut lowest, mut highest) = (inclination, inclination);
            for curvatures in &drilled.points {
                inclination += curvatures[0] * drilled.spacing;
                (lowest, highest) = (lowest.min(inclination), highest.max(inclination));
                course.advance(drilled.spacing, *curvatures);
                seen.push((index, [course.position.x, course.position.y]));
            }
            // Rounding of the angles of a vertical start is no drop.
            let worst = if lowest < -1e-9 { lowest } else { highest };
            c.require(
                (-1e-9..=std::f64::consts::PI + 1e-9).contains(&worst),
                &format!("sections.{index}.drilled.points"),
                format!(
                    "{:.3} at the least, {:.3} at the most",
                    rad_to_deg(lowest),
                    rad_to_deg(highest)
                ),
                "deg",
                "an inclination within 0 and 180 deg all along",
                "beyond the vertical the low side of the hole is on its other side",
            );
        }
        if !self.sections.iter().any(walks) {
            return;
        }
        // The plane through both ends; a hole without an extent seen from above has that of its start.
        let [x, y] = seen.last().map_or([0.0; 2], |(_, at)| *at);
        let extent = x.hypot(y);
        let [along, across] = if extent > OFF_PLANE {
            [x / extent, y / extent]
        } else {
            [1.0, 0.0]
        };
        let off = |[x, y]: [f64; 2]| (y * along - x * across).abs();
        let farthest = seen.iter().max_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        if let Some((index, at)) = farthest {
            c.require(
                off(*at) <= OFF_PLANE,
                &format!("sections.{index}.drilled.points"),
                format!("{:.1} off the vertical plane through both ends", 1e3 * off(*at)),
                "mm",
                format!("at most {} mm", 1e3 * OFF_PLANE),
                "the model of the motion has its hole in one vertical plane: the guide's preload, its slots and its stiffness \
                 under thrust know a turn of the hole about one axis. What is within 1 mm is laid into the plane, as the \
                 hole's size is not known better. Set the curvatures to the right to 0 for a run in the plane",
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
            Self::Drilled(drilled) => rad_to_deg(drilled.turn(drilled.length())),
        }
    }

    fn check(&self, c: &mut Checker) {
        match self {
            Self::Straight { length } => c.below("straight", |c| {
                c.number(
                    "length",
                    *length,
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
                    *radius,
                    RADIUS,
                    "m",
                    "below 0.5 m the frames of neighbouring stations differ too much for small tilts",
                );
                c.number(
                    "build_angle_deg",
                    *build_angle_deg,
                    BUILD,
                    "deg",
                    "arcs build inclination; use `straight` for none",
                );
            }),
            Self::Drilled(drilled) => c.below("drilled", |c| drilled.check(c)),
        }
    }

    fn describe(&self) -> WellSection {
        match self {
            Self::Straight { length } => WellSection::Straight { length: *length },
            Self::Arc {
                radius,
                build_angle_deg,
            } => WellSection::Arc {
                radius: *radius,
                angle: deg_to_rad(*build_angle_deg),
            },
            Self::Drilled(drilled) => drilled.describe(),
        }
    }
}
