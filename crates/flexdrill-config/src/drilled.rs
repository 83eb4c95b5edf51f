//! `well.sections.*.drilled`: hole as drilled, point by point.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker, number};
use flexdrill_core::tool::{Course, HoleInterval, WellSection};

/// Half a millimetre is less than any survey resolves; over a metre a link would not see the hole.
const SPACING: Bound = Bound::within(0.0005, 1.0);
/// As an arc's radius of 0.5 m.
const CURVATURE: Bound = Bound::within(-2.0, 2.0);

/// Hole as drilled: arcs of one length that follow each other from the top down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drilled {
    /// Length of hole per point (m). Default 0.02.
    #[serde(default = "two_centimetres")]
    #[schemars(transform = SPACING.in_schema())]
    pub spacing: f64,
    /// Curvatures of the hole at each point (1/m), -2 to 2: build (above 0 the inclination rises) and to the right, in axes
    /// that are carried along the hole without twist. Required.
    pub points: Vec<[f64; 2]>,
    /// Whose factor of `contact.wall_friction_factors` this hole has. Default arc.
    #[serde(default)]
    pub interval: Interval,
}

/// An interval of the hole, as in `contact.wall_friction_factors`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interval {
    /// That of the straight sections before the first arc.
    BeforeArc,
    /// That of the arcs.
    #[default]
    Arc,
    /// That of the straight sections after the first arc.
    AfterArc,
}

impl From<Interval> for HoleInterval {
    fn from(interval: Interval) -> Self {
        match interval {
            Interval::BeforeArc => Self::BeforeArc,
            Interval::Arc => Self::Arc,
            Interval::AfterArc => Self::AfterArc,
        }
    }
}

impl From<HoleInterval> for Interval {
    fn from(interval: HoleInterval) -> Self {
        match interval {
            HoleInterval::BeforeArc => Self::BeforeArc,
            HoleInterval::Arc => Self::Arc,
            HoleInterval::AfterArc => Self::AfterArc,
        }
    }
}

fn two_centimetres() -> f64 {
    0.02
}

impl Drilled {
    /// Length along the path (m).
    pub fn length(&self) -> f64 {
        self.spacing * self.points.len() as f64
    }

    /// Smallest and largest build (1/m); 0 without points.
    pub fn build_range(&self) -> [f64; 2] {
        let mut build = self.points.iter().map(|[build, _]| *build);
        let first = build.next().unwrap_or(0.0);
        build.fold([first; 2], |[low, high], build| [low.min(build), high.max(build)])
    }

    /// Change of inclination from its top over a length (rad) of a hole in one plane.
    pub fn turn(&self, length: f64) -> f64 {
        let mut rest = length;
        let of = |[build, _]: &[f64; 2]| {
            let along = rest.clamp(0.0, self.spacing);
            rest -= along;
            build * along
        };
        self.points.iter().map(of).sum()
    }

    /// Adds its points to a hole.
    pub fn extend(&self, course: &mut Course) {
        for curvatures in &self.points {
            course.advance(self.spacing, *curvatures);
        }
    }

    /// The parts within two lengths from its top (m): whole points, and where an end is within a point a piece of one.
    pub fn between(&self, top: f64, bottom: f64) -> Vec<Self> {
        let mut parts: Vec<Self> = Vec::new();
        for (index, point) in self.points.iter().enumerate() {
            let start = self.spacing * index as f64;
            let spacing = bottom.min(start + self.spacing) - top.max(start);
            // What rounding leaves of a point is none.
            if spacing <= 1e-9 {
                continue;
            }
            let whole = spacing >= self.spacing - 1e-9;
            let spacing = if whole { self.spacing } else { spacing };
            match parts.last_mut().filter(|part| whole && part.spacing == spacing) {
                Some(part) => part.points.push(*point),
                None => parts.push(Self {
                    spacing,
                    points: vec![*point],
                    interval: self.interval,
                }),
            }
        }
        parts
    }

    pub(super) fn check(&self, c: &mut Checker) {
        c.number(
            "spacing",
            self.spacing,
            SPACING,
            "m",
            "finer than 0.5 mm no hole is known; a link does not see what is coarser than 1 m",
        );
        c.require(
            !self.points.is_empty(),
            "points",
            "",
            "",
            "at least one pair of curvatures",
            "the hole is as long as its points",
        );
        c.below("points", |c| {
            for (index, point) in self.points.iter().enumerate() {
                if let Some(wrong) = point.iter().find(|curvature| !CURVATURE.holds(**curvature)) {
                    let reason =
                        "below a radius of 0.5 m the frames of neighbouring stations differ too much for small tilts";
                    c.wrong(
                        &index.to_string(),
                        number(*wrong),
                        "1/m",
                        CURVATURE.words("1/m"),
                        reason,
                    );
                }
            }
        });
    }

    pub(super) fn describe(&self) -> WellSection {
        WellSection::Drilled {
            spacing: self.spacing,
            build: self.points.iter().map(|[build, _]| *build).collect(),
            interval: self.interval.into(),
        }
    }
}
