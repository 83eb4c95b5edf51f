//! A hole in space, point by point: what is drilled does not stay in one plane.

use nalgebra::{Matrix3, Vector3};

use super::well::{frame_along, sinc, tangent};

/// The end of a hole that grows by arcs, in a frame that is carried along it without twist.
///
/// The frame's axes are x down the hole, y to the right and z to the low side where the hole began. An arc has two
/// curvatures in it: `build` turns x to -z, `right` turns x to +y (1/m). A frame without twist turns about axes across
/// the hole only, so that nothing in it depends on the world's axes: a hole whose start is turned about the vertical is
/// the same hole turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Length from the start (m).
    pub depth: f64,
    /// Position (m, world: X along azimuth 0, Y to the right of it, Z down).
    pub position: Vector3<f64>,
    /// Axes x, y, z as columns in the world.
    pub frame: Matrix3<f64>,
}

impl Course {
    /// A hole of no length that begins at the origin at an inclination and an azimuth (rad).
    pub fn begin(inclination: f64, azimuth: f64) -> Self {
        let (sine, cosine) = libm::sincos(azimuth);
        #[rustfmt::skip]
        let turned = Matrix3::new(
            cosine, -sine, 0.0,
            sine, cosine, 0.0,
            0.0, 0.0, 1.0,
        );
        Self {
            depth: 0.0,
            position: Vector3::zeros(),
            frame: turned * frame_along(tangent(inclination)),
        }
    }

    /// Adds an arc of a length (m) with curvatures (build, right) (1/m).
    pub fn advance(&mut self, length: f64, [build, right]: [f64; 2]) {
        let curvature = build.hypot(right);
        let angle = curvature * length;
        let [x, y, z] = [0, 1, 2].map(|axis| self.frame.column(axis).into_owned());
        // The arc turns x towards `side`, across the hole; the third direction does not move.
        let side = if curvature > 0.0 {
            (y * right - z * build) / curvature
        } else {
            -z
        };
        let fixed = x.cross(&side);
        let turned = |by: f64| {
            let (sine, cosine) = libm::sincos(by);
            [x * cosine + side * sine, side * cosine - x * sine]
        };
        let [chord, _] = turned(0.5 * angle);
        self.position += chord * (length * sinc(0.5 * angle));
        let [new_x, new_side] = turned(angle);
        let carry = |axis: &Vector3<f64>| new_side * axis.dot(&side) + fixed * axis.dot(&fixed);
        // Rounding of many arcs must not shear the frame.
        let new_y = carry(&y);
        let new_y = (new_y - new_x * new_x.dot(&new_y)).normalize();
        let new_x = new_x.normalize();
        self.frame = Matrix3::from_columns(&[new_x, new_y, new_x.cross(&new_y)]);
        self.depth += length;
    }

    /// Inclination (rad), 0 is straight down.
    pub fn inclination(&self) -> f64 {
        let x = self.frame.column(0);
        libm::atan2(x[0].hypot(x[1]), x[2])
    }

    /// Azimuth (rad), clockwise seen from above; 0 for a vertical hole.
    pub fn azimuth(&self) -> f64 {
        let x = self.frame.column(0);
        libm::atan2(x[1], x[0])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::tool::{HoleInterval, WellDescription, WellPath, WellSection};

    /// Some hole that builds, drops and walks.
    fn curvatures() -> Vec<[f64; 2]> {
        let at = |point: u32| f64::from(point) * 0.1;
        (0..200)
            .map(|point| [0.3 * at(point).cos(), 0.1 * at(point).sin()])
            .collect()
    }

    fn drilled(azimuth: f64) -> Course {
        let mut course = Course::begin(0.7, azimuth);
        curvatures()
            .into_iter()
            .for_each(|curvatures| course.advance(0.02, curvatures));
        course
    }

    /// In the plane both are the same arcs. 200 sums of some 1e-16.
    #[test]
    fn a_course_without_walk_is_the_path_of_the_same_points() {
        let build: Vec<f64> = curvatures().into_iter().map(|[build, _]| build).collect();
        let path = WellPath::new(&WellDescription {
            start_inclination: 0.7,
            sections: vec![WellSection::Drilled {
                spacing: 0.02,
                build: build.clone(),
                interval: HoleInterval::Arc,
            }],
        });
        let mut course = Course::begin(0.7, 0.0);
        for build in build {
            course.advance(0.02, [build, 0.0]);
            assert!((course.position - path.position(course.depth)).norm() < 1e-13);
            assert!((course.inclination() - path.inclination(course.depth)).abs() < 1e-13);
            assert_eq!(course.azimuth(), 0.0);
        }
    }

    /// A helix about the vertical has the curvature sin2(inc)/r and the torsion sin(inc) cos(inc)/r. Without twist the
    /// two components of its curvature turn by minus the torsion per metre: in closed form the hole returns to its
    /// radius, climbs by cos(inc) per metre, and keeps its inclination. Arcs of 1 mm have it to second order:
    /// (0.5 mm)2 times the curvature to the third, times 10 m, is 1e-6 m.
    #[test]
    fn a_helix_keeps_its_inclination() {
        let (inclination, radius, step) = (1.0_f64, 3.0, 1e-3);
        let (sine, cosine) = inclination.sin_cos();
        let (curvature, torsion) = (sine * sine / radius, sine * cosine / radius);
        let mut course = Course::begin(inclination, FRAC_PI_2);
        for index in 0..10_000 {
            // At the start the curvature of the helix is level: to the right.
            let angle = torsion * (f64::from(index) + 0.5) * step;
            course.advance(step, [-curvature * angle.sin(), curvature * angle.cos()]);
        }
        let turned = sine * 10.0 / radius;
        // The axis of the helix is to the right of the start, along -X.
        let expected = Vector3::new(radius * (turned.cos() - 1.0), radius * turned.sin(), 10.0 * cosine);
        assert!((course.inclination() - inclination).abs() < 1e-6, "{course:?}");
        assert!(
            (course.position - expected).norm() < 1e-5,
            "{:?} {expected:?}",
            course.position
        );
    }

    #[test]
    fn a_hole_whose_plane_turns_is_the_same_hole_turned() {
        let (here, there) = (drilled(0.0), drilled(1.1));
        let (sine, cosine) = libm::sincos(1.1);
        let turned = Vector3::new(
            here.position.x * cosine - here.position.y * sine,
            here.position.x * sine + here.position.y * cosine,
            here.position.z,
        );
        // 200 turns of frames, each of some 1e-16.
        assert!((turned - there.position).norm() < 1e-13);
        assert!((here.inclination() - there.inclination()).abs() < 1e-13);
        assert!((there.azimuth() - here.azimuth() - 1.1).abs() < 1e-13);
        assert!((there.frame.transpose() * there.frame - Matrix3::identity()).norm() < 1e-14);
    }
}
