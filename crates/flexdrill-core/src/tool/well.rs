//! The bore's centre line as straight and arc sections in the vertical X-Z plane (`X` horizontal in the direction of
//! build, `Y` horizontal, `Z` down).

use nalgebra::{Matrix3, Vector3};

use crate::tool::{WellDescription, WellSection};

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
}

impl WellPath {
    /// Joins the sections, from the origin of the world frame on.
    pub fn new(description: &WellDescription) -> Self {
        let mut pieces = Vec::with_capacity(description.sections.len());
        let mut start = 0.0;
        let mut inclination = description.start_inclination;
        let mut origin = Vector3::zeros();
        for section in &description.sections {
            let (length, curvature) = match *section {
                WellSection::Straight { length } => (length, 0.0),
                WellSection::Arc { radius, angle } => (radius * angle, 1.0 / radius),
            };
            let piece = Piece {
                start,
                inclination,
                curvature,
                origin,
            };
            origin = piece.position(length);
            inclination += curvature * length;
            start += length;
            pieces.push(piece);
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

    fn piece(&self, depth: f64) -> (&Piece, f64) {
        let index = self.pieces.iter().rposition(|piece| piece.start <= depth).unwrap_or(0);
        let piece = &self.pieces[index];
        (piece, depth - piece.start)
    }
}

impl WellDescription {
    /// Sum of the angles by which the hole turns (rad): what friction is multiplied by along it.
    pub fn turn(&self) -> f64 {
        let turn = |section: &WellSection| match *section {
            WellSection::Straight { .. } => 0.0,
            WellSection::Arc { angle, .. } => angle,
        };
        self.sections.iter().map(turn).sum()
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

fn sinc(x: f64) -> f64 {
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
    fn the_low_side_is_down_in_a_level_hole() {
        let frame = frame_along(tangent(FRAC_PI_2));
        assert!((frame.column(2) - Vector3::z()).norm() < 1e-15);
    }
}
