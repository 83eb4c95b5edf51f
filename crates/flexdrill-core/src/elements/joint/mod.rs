//! Joints between links, Eq. 11 to 16: constraint rows with exact gradients and Hessians, and the one-sided limit stop.
//!
//! | quantity | meaning |
//! |---|---|
//! | `a`, `b` | end of the link above, start of the link below, each in its own link's frame |
//! | rotations | (psi_a, phi_y_a, phi_z_a, psi_b, phi_y_b, phi_z_b), rad |
//! | E_a, E_b | link frames, columns in the world; E_a u_a - E_b u_b = 0 are the translational rows, Eq. 12 |
//! | rows | the rotational rows of Eq. 13, zero where they hold |
//! | bend angle | between the two links' axes at the joint (rad, >= 0) |
//!
//! Friction in the pins is in [`friction`], play about the shaft in [`play`], the stop in [`stop`].
//!
//! The law is written once, in [`law`], over `Number`: for one joint, and for eight at a time in [`group`].

pub mod friction;
pub mod group;
mod jet;
pub mod law;
pub mod play;
pub mod rotation;
pub mod stop;

use nalgebra::{Matrix3, Vector3};

use crate::tool::{HingeAngle, JointDescription, JointKind};
use law::JointLaw;
use rotation::shaft_direction;

/// Values of the six rotational coordinates of a joint, or moments on them.
pub type Rotations = [f64; 6];

/// A joint as built: the frames of its two links, and its law.
#[derive(Debug, Clone, Copy)]
pub struct Joint {
    /// Frame of the link above, columns in the world. With the rotation of the node it is the Lambda of Eq. 11.
    pub upper: Matrix3<f64>,
    /// Frame of the link below (Lambda of Eq. 11 for a node that has not turned).
    pub lower: Matrix3<f64>,
    /// Rotational rows and stop.
    pub law: JointLaw<f64>,
}

impl Joint {
    /// Joint number `index` (0-based from the top) between links with the given frames.
    pub fn new(description: &JointDescription, index: usize, upper: Matrix3<f64>, lower: Matrix3<f64>) -> Self {
        let relative = upper.transpose() * lower;
        let mut law = JointLaw {
            kind: description.kind,
            relative: std::array::from_fn(|i| std::array::from_fn(|j| relative[(i, j)])),
            phase: description.cross_phase + description.cross_phase_step * index as f64,
            hinge_cosine: 0.0,
            limit: description.limit,
            limit_cosine: libm::cos(description.limit),
            limit_sine: libm::sin(description.limit),
            stop_stiffness: description.stop_stiffness,
            stop_damping: description.stop_damping,
            friction: description.friction,
            play: description.play,
        };
        if description.hinge_angle == HingeAngle::AsBuilt {
            let mut row = Default::default();
            law.hinge_row(&[0.0; 6], &mut row);
            law.hinge_cosine = row.value;
        }
        Self { upper, lower, law }
    }

    /// Number of rotational rows, in addition to the three translational ones.
    pub fn rotational_rows(kind: JointKind) -> usize {
        match kind {
            JointKind::Universal | JointKind::BallCage => 1,
            JointKind::Revolute => 2,
        }
    }

    /// Number of rotational rows that are constraints with a multiplier: with play there are none.
    pub fn constraints(description: &JointDescription) -> usize {
        if description.play.half_angle > 0.0 {
            0
        } else {
            Self::rotational_rows(description.kind)
        }
    }

    /// Angle between the two links' axes at the joint (rad, >= 0).
    pub fn bend_angle(&self, q: &Rotations) -> f64 {
        let (upper, lower) = self.axes(q);
        libm::atan2(upper.cross(&lower).norm(), upper.dot(&lower))
    }

    /// Toolface of the bend (rad, -pi to pi): direction in which the lower link turns away from the upper one, from the
    /// high side clockwise looking down the hole.
    pub fn bend_toolface(&self, q: &Rotations) -> f64 {
        let (upper, lower) = self.axes(q);
        let away = lower - upper;
        libm::atan2(away.y, -away.z)
    }

    /// Axes of the link above and of the link below at the joint, in the frame of the link above.
    fn axes(&self, q: &Rotations) -> (Vector3<f64>, Vector3<f64>) {
        let relative = Matrix3::from_fn(|i, j| self.law.relative[i][j]);
        (
            Vector3::from(shaft_direction(q[1], q[2])),
            relative * Vector3::from(shaft_direction(q[4], q[5])),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::{frame_along, tangent};

    /// With the angle as built, the undeflected joint satisfies its row at any bend. After half a turn the bend points
    /// to the other side, and the row is off by twice its cosine.
    #[test]
    fn a_hinge_as_built_fits_once_per_turn() {
        let bend = 0.05_f64;
        let frame = |angle: f64| frame_along(tangent(angle));
        let description = JointDescription {
            cross_phase: 0.3,
            cross_phase_step: 0.0,
            hinge_angle: HingeAngle::AsBuilt,
            ..JointDescription::new(JointKind::Revolute, 0.1)
        };
        let joint = Joint::new(&description, 0, frame(0.4), frame(0.4 + bend));
        let turned = |psi: f64| {
            let mut row = law::RotationFunction::default();
            joint.law.hinge_row(&[psi, 0.0, 0.0, psi, 0.0, 0.0], &mut row);
            row.value
        };
        assert_eq!(turned(0.0), 0.0);
        let cosine = joint.law.hinge_cosine;
        // sin(bend) times the cosine of the hinge's turn away from the well's plane.
        assert!((cosine.abs() - bend.sin() * 0.3_f64.cos()).abs() < 1e-12, "{cosine}");
        assert!((turned(std::f64::consts::PI) + 2.0 * cosine).abs() < 1e-12);
        assert!(turned(2.0 * std::f64::consts::PI).abs() < 1e-12);
    }
}
