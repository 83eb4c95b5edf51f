//! The bore's centre line as straight sections, arcs and hole as drilled in the vertical X-Z plane (`X` horizontal in the
//! direction of build, `Y` horizontal, `Z` down).
//!
//! All of it is arcs: a straight section is one without curvature, and hole as drilled one per point. Position,
//! inclination and curvature at any depth are those of its arc, exact up to rounding. Frames of the hole have y along `Y`
//! and are therefore free of twist; z is the low side, because the inclination stays within 0 and 180 deg.
//! [`Course`](super::Course) has holes that leave the plane.

use nalgebra::{Matrix3, Vector3};

use crate::tool::{HoleInterval, WellDescription, WellSection};

/// A well path with its points and frames at any measured depth.
#[derive(Debug, Clone)]
pub struct WellPath {
    pieces: Vec<Piece>,
    length: f64,
}

#[derive(Debug, Clone, Copy)]
struct Piece {
    start: f64,
    inclination: f64,
    /// Change of inclination per metre (1/m), 0 where straight.
    curvature: f64,
    origin: Vector3<f64>,
    interval: HoleInterval,
}

impl WellPath {
    /// Joins the sections, from the origin of the world frame on.
    pub fn new(description: &WellDescription) -> Self {
        let mut pieces = Vec::with_capacity(description.sections.len());
        let mut start = 0.0;
        let mut inclination = description.start_inclination;
        let mut origin = Vector3::zeros();
        for (section, interval) in description.sections.iter().zip(description.intervals()) {
            section.arcs(|length, curvature| {
                let piece = Piece {
                    start,
                    inclination,
                    curvature,
                    origin,
                    interval,
                };
                origin = piece.position(length);
                inclination += curvature * length;
                start += length;
                pieces.push(piece);
            });
        }
        Self { pieces, length: start }
    }

    /// Total length (m).
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Inclination at measured depth `depth` (rad, 0 straight down).
    pub fn inclination(&self, depth: f64) -> f64 {
        let (piece, along) = self.piece(depth);
        piece.inclination + piece.curvature * along
    }

    /// Curvature at measured depth `depth` (1/m).
    pub fn curvature(&self, depth: f64) -> f64 {
        self.piece(depth).0.curvature
    }

    /// Point on the centre line (m, world).
    pub fn position(&self, depth: f64) -> Vector3<f64> {
        let (piece, along) = self.piece(depth);
        piece.position(along)
    }

    /// Interval of the hole at measured depth `depth`; at a boundary the one below.
    pub fn interval(&self, depth: f64) -> HoleInterval {
        self.piece(depth).0.interval
    }

    /// Mean over the length from measured depth `top` to `bottom` (m) of a quantity of the intervals. Where all have the
    /// same, the mean is that to the bit.
    pub fn mean(&self, [top, bottom]: [f64; 2], of: impl Fn(HoleInterval) -> f64) -> f64 {
        let first = of(self.interval(top));
        let ends = self.pieces.iter().skip(1).map(|next| next.start).chain([self.length]);
        self.pieces.iter().zip(ends).fold(first, |mean, (piece, end)| {
            let within = (bottom.min(end) - top.max(piece.start)).max(0.0);
            mean + within / (bottom - top) * (of(piece.interval) - first)
        })
    }

    fn piece(&self, depth: f64) -> (&Piece, f64) {
        let index = self.pieces.iter().rposition(|piece| piece.start <= depth).unwrap_or(0);
        let piece = &self.pieces[index];
        (piece, depth - piece.start)
    }
}

impl WellDescription {
    /// Interval of each section.
    pub fn intervals(&self) -> impl Iterator<Item = HoleInterval> {
        let mut before_arc = true;
        self.sections.iter().map(move |section| match section {
            WellSection::Arc { .. } => {
                before_arc = false;
                HoleInterval::Arc
            }
            WellSection::Drilled { interval, .. } => {
                before_arc &= *interval == HoleInterval::BeforeArc;
                *interval
            }
            WellSection::Straight { .. } if before_arc => HoleInterval::BeforeArc,
            WellSection::Straight { .. } => HoleInterval::AfterArc,
        })
    }

    /// Whether the hole has such an interval.
    pub fn has(&self, interval: HoleInterval) -> bool {
        self.intervals().any(|of_section| of_section == interval)
    }

    /// Sum of the angles by which the hole turns (rad): what friction is multiplied by along it.
    pub fn turn(&self) -> f64 {
        let turn = |section: &WellSection| match section {
            WellSection::Straight { .. } => 0.0,
            WellSection::Arc { angle, .. } => *angle,
            WellSection::Drilled { spacing, build, .. } => build.iter().map(|build| build.abs() * spacing).sum(),
        };
        self.sections.iter().map(turn).sum()
    }
}

impl WellSection {
    /// Calls `each` with length (m) and curvature (1/m) of each of its arcs, from the top down.
    fn arcs(&self, mut each: impl FnMut(f64, f64)) {
        match self {
            Self::Straight { length } => each(*length, 0.0),
            Self::Arc { radius, angle } => each(radius * angle, 1.0 / radius),
            Self::Drilled { spacing, build, .. } => build.iter().for_each(|&curvature| each(*spacing, curvature)),
        }
    }
}

impl Piece {
    fn position(&self, along: f64) -> Vector3<f64> {
        let turned = self.curvature * along;
        // The chord leaves the tangent by half the angle turned; sinc keeps the straight case exact.
        let chord = along * sinc(0.5 * turned);
        self.origin + chord * tangent(self.inclination + 0.5 * turned)
    }
}

/// sin(x)/x, the chord of an arc over its length where `x` is half of the angle turned.
pub(super) fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { libm::sin(x) / x }
}

/// Unit tangent at inclination `inclination` (rad): (sin, 0, cos).
pub fn tangent(inclination: f64) -> Vector3<f64> {
    Vector3::new(libm::sin(inclination), 0.0, libm::cos(inclination))
}

/// Frame whose x axis is `axis` (unit, in the X-Z plane), y is world Y and z = x cross y, the low side. Columns are
/// the frame's axes in the world.
pub fn frame_along(axis: Vector3<f64>) -> Matrix3<f64> {
    let y = Vector3::y();
    Matrix3::from_columns(&[axis, y, axis.cross(&y)])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_quarter_circle_ends_at_its_radius_and_points_level() {
        let path = WellPath::new(&WellDescription {
            start_inclination: 0.0,
            sections: vec![
                WellSection::Straight { length: 2.0 },
                WellSection::Arc {
                    radius: 3.2,
                    angle: FRAC_PI_2,
                },
                WellSection::Straight { length: 1.0 },
            ],
        });
        let end = path.position(path.length());
        // Straight 2 m down, then 3.2 m over and down, then 1 m level; rounding only.
        assert!((end - Vector3::new(4.2, 0.0, 5.2)).norm() < 1e-14);
        assert!((path.inclination(path.length()) - FRAC_PI_2).abs() < 1e-14);
    }

    #[test]
    fn a_straight_section_belongs_to_the_interval_before_or_after_the_arcs() {
        use HoleInterval::{AfterArc, Arc, BeforeArc};
        let (straight, arc) = (
            || WellSection::Straight { length: 2.0 },
            |radius| WellSection::Arc { radius, angle: 0.5 },
        );
        let drilled = |interval| WellSection::Drilled {
            spacing: 0.02,
            build: vec![0.3],
            interval,
        };
        let well = |sections| WellDescription {
            start_inclination: 0.0,
            sections,
        };
        let whole = well(vec![straight(), arc(4.0), straight(), arc(8.0), straight()]);
        let intervals: Vec<_> = whole.intervals().collect();
        assert_eq!(intervals, [BeforeArc, Arc, AfterArc, Arc, AfterArc]);
        let of_drilled = well(vec![
            drilled(BeforeArc),
            straight(),
            drilled(Arc),
            straight(),
            drilled(AfterArc),
        ]);
        let intervals: Vec<_> = of_drilled.intervals().collect();
        assert_eq!(intervals, [BeforeArc, BeforeArc, Arc, AfterArc, AfterArc]);
        let level = well(vec![straight(), straight()]);
        assert!(level.has(BeforeArc) && !level.has(Arc) && !level.has(AfterArc));
        let path = WellPath::new(&whole);
        assert_eq!(
            [0.0, 1.9, 2.0, 3.9, 4.1, 6.1, 12.0].map(|depth| path.interval(depth)),
            [BeforeArc, BeforeArc, Arc, Arc, AfterArc, Arc, AfterArc]
        );
    }

    #[test]
    fn a_mean_over_a_boundary_is_by_length() {
        let path = WellPath::new(&WellDescription {
            start_inclination: 0.0,
            sections: vec![
                WellSection::Straight { length: 2.0 },
                WellSection::Arc {
                    radius: 2.0,
                    angle: 0.5,
                },
                WellSection::Straight { length: 2.0 },
            ],
        });
        let of = |interval| match interval {
            HoleInterval::BeforeArc => 0.3,
            HoleInterval::Arc => 2.0,
            HoleInterval::AfterArc => 1.0,
        };
        for (range, mean) in [
            ([0.0, 2.0], 0.3),
            ([1.0, 2.0], 0.3),
            ([1.75, 2.25], 1.15),
            ([2.0, 2.5], 2.0),
            ([1.5, 3.5], (0.5 * 0.3 + 2.0 + 0.5) / 2.0),
            ([3.0, 5.0], 1.0),
        ] {
            // Sums of three terms of size one round to 1e-15.
            assert!((path.mean(range, of) - mean).abs() < 1e-15, "{range:?}");
        }
        assert_eq!(path.mean([1.0 / 3.0, 4.9], |_| 0.7), 0.7);
    }

    #[test]
    fn the_low_side_is_down_in_a_level_hole() {
        let frame = frame_along(tangent(FRAC_PI_2));
        assert!((frame.column(2) - Vector3::z()).norm() < 1e-15);
    }
}
