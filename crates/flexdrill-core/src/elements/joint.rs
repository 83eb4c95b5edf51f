//! Joints between links, Eq. 11 to 16: constraint rows with exact gradients and Hessians, and the one-sided limit stop.
//!
//! Rotational coordinates of a joint are (psi_a, phi_y_a, phi_z_a, psi_b, phi_y_b, phi_z_b): `a` is the end of the link
//! above, `b` the start of the link below, each in its own link's frame.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::elements::jet::Jet;
use crate::elements::rotation::{DirectionJet, shaft_axis, shaft_direction, transverse_axis};
use crate::simd::number::Number;
use crate::tool::description::{HingeAngle, JointDescription, JointKind};

/// Values of the six rotational coordinates of a joint, or forces on them.
pub type JointVector = SVector<f64, 6>;
/// Second derivatives in the six rotational coordinates.
pub type JointMatrix = SMatrix<f64, 6, 6>;

/// A scalar function of the joint's rotations.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Value; zero where a constraint holds.
    pub value: f64,
    /// First derivatives.
    pub gradient: JointVector,
    /// Second derivatives.
    pub hessian: JointMatrix,
}

/// One joint.
#[derive(Debug, Clone, Copy)]
pub struct Joint {
    /// Kind of rows.
    pub kind: JointKind,
    /// Frame of the link above, columns in the world.
    pub upper: Matrix3<f64>,
    /// Frame of the link below.
    pub lower: Matrix3<f64>,
    /// Turn of the cross about the shaft (rad).
    pub phase: f64,
    /// Bend angle at which the stop begins (rad).
    pub limit: f64,
    /// N m/rad.
    pub stop_stiffness: f64,
    /// s/rad.
    pub stop_damping: f64,
    /// E_a^T E_b.
    pub relative: Matrix3<f64>,
    /// cos(theta) of Eq. 13, third row.
    pub hinge_cosine: f64,
}

/// The stop's moment with what it takes to assemble it.
#[derive(Debug, Clone, Copy)]
pub struct Stop {
    /// Bend angle (rad).
    pub angle: f64,
    /// Moment (N m, >= 0), 0 inside the limit.
    pub moment: f64,
    /// Force on the six rotations that the joint must balance: moment times d angle / d q.
    pub force: JointVector,
    /// d force / d rotations.
    pub stiffness: JointMatrix,
    /// d force / d rotation rates.
    pub damping: JointMatrix,
    /// Energy in the stop's spring (J).
    pub energy: f64,
    /// Power taken by the stop's damping (W).
    pub dissipation: f64,
}

impl Joint {
    /// Joint number `index` (0-based from the top) between links with the given frames.
    pub fn new(description: &JointDescription, index: usize, upper: Matrix3<f64>, lower: Matrix3<f64>) -> Self {
        let mut joint = Self {
            kind: description.kind,
            upper,
            lower,
            phase: description.cross_phase + description.cross_phase_step * index as f64,
            limit: description.limit,
            stop_stiffness: description.stop_stiffness,
            stop_damping: description.stop_damping,
            relative: upper.transpose() * lower,
            hinge_cosine: 0.0,
        };
        if description.hinge_angle == HingeAngle::AsBuilt {
            joint.hinge_cosine = joint.hinge_row(&JointVector::zeros()).value;
        }
        joint
    }

    /// Number of rotational rows beside the three translational ones.
    pub fn rotational_rows(kind: JointKind) -> usize {
        match kind {
            JointKind::Universal | JointKind::BallCage => 1,
            JointKind::Revolute => 2,
        }
    }

    /// Whether the bend angle is limited by the stop.
    pub fn has_stop(&self) -> bool {
        self.kind != JointKind::Revolute
    }

    /// The rotational rows of Eq. 13; the second is used by [`JointKind::Revolute`] only.
    pub fn rows(&self, q: &JointVector) -> [Row; 2] {
        match self.kind {
            JointKind::Universal => [self.cross_row(q), Row::zero()],
            JointKind::BallCage => [equal_spin_row(q), Row::zero()],
            JointKind::Revolute => [self.cross_row(q), self.hinge_row(q)],
        }
    }

    /// a_z(a) . a_y(b) = 0: the two arms of the cross stay normal to each other.
    fn cross_row(&self, q: &JointVector) -> Row {
        let a_z = transverse_axis(libm::sincos(q[0] + self.phase + FRAC_PI_2), q[1], q[2]);
        let a_y = transverse_axis(libm::sincos(q[3] + self.phase), q[4], q[5]);
        Row::bilinear(&a_z, &self.relative, &a_y)
    }

    /// a_z(a) . a_x(b) - cos(theta) = 0.
    fn hinge_row(&self, q: &JointVector) -> Row {
        let a_z = transverse_axis(libm::sincos(q[0] + self.phase + FRAC_PI_2), q[1], q[2]);
        let a_x = shaft_axis(q[4], q[5]);
        let mut row = Row::bilinear(&a_z, &self.relative, &a_x);
        row.value -= self.hinge_cosine;
        row
    }

    /// Angle between the two links' axes at the joint (rad, >= 0).
    pub fn bend_angle(&self, q: &JointVector) -> f64 {
        let upper = Vector3::from(shaft_direction(q[1], q[2]));
        let lower = self.relative * Vector3::from(shaft_direction(q[4], q[5]));
        libm::atan2(upper.cross(&lower).norm(), upper.dot(&lower))
    }

    /// Toolface of the bend (rad, -pi to pi): direction in which the lower link turns away from the upper one, from the
    /// high side clockwise looking down the hole.
    pub fn bend_toolface(&self, q: &JointVector) -> f64 {
        let away =
            self.relative * Vector3::from(shaft_direction(q[4], q[5])) - Vector3::from(shaft_direction(q[1], q[2]));
        libm::atan2(away.y, -away.z)
    }

    /// The stop at rotations `q` and rates `rate`: M = k (angle - limit)(1 + c angle') >= 0, continuous at onset.
    pub fn stop(&self, q: &JointVector, rate: &JointVector) -> Stop {
        let angle = self.bend_angle(q);
        let over = angle - self.limit;
        let mut stop = Stop {
            angle,
            moment: 0.0,
            force: JointVector::zeros(),
            stiffness: JointMatrix::zeros(),
            damping: JointMatrix::zeros(),
            energy: 0.0,
            dissipation: 0.0,
        };
        if !self.has_stop() || over <= 0.0 {
            return stop;
        }
        stop.energy = 0.5 * self.stop_stiffness * over * over;
        // cos(angle) is smooth in the rotations; the angle follows from it by the chain rule.
        let cosine = Row::bilinear(&shaft_axis(q[1], q[2]), &self.relative, &shaft_axis(q[4], q[5]));
        let (sin, cos) = libm::sincos(angle);
        let gradient = -cosine.gradient / sin;
        let hessian = -cosine.hessian / sin - gradient * gradient.transpose() * (cos / sin);
        let angle_rate = gradient.dot(rate);
        let viscous = 1.0 + self.stop_damping * angle_rate;
        let spring = self.stop_stiffness * over;
        if viscous <= 0.0 {
            // Opening faster than the law can push: no moment, the spring's energy goes into its damping.
            stop.dissipation = -spring * angle_rate;
            return stop;
        }
        stop.moment = spring * viscous;
        stop.force = gradient * stop.moment;
        let by_rate = spring * self.stop_damping;
        stop.stiffness = gradient * (gradient * (self.stop_stiffness * viscous) + hessian * rate * by_rate).transpose()
            + hessian * stop.moment;
        stop.damping = gradient * gradient.transpose() * by_rate;
        stop.dissipation = by_rate * angle_rate * angle_rate;
        stop
    }
}

/// psi_a - psi_b = 0: a constant-velocity joint.
fn equal_spin_row(q: &JointVector) -> Row {
    let mut row = Row::zero();
    row.value = q[0] - q[3];
    row.gradient[0] = 1.0;
    row.gradient[3] = -1.0;
    row
}

impl Row {
    fn zero() -> Self {
        Self {
            value: 0.0,
            gradient: JointVector::zeros(),
            hessian: JointMatrix::zeros(),
        }
    }

    /// d_a . (Q d_b) of a direction above and one below.
    fn bilinear(above: &DirectionJet<f64>, relative: &Matrix3<f64>, below: &DirectionJet<f64>) -> Self {
        let rows = std::array::from_fn(|i| std::array::from_fn(|j| relative[(i, j)]));
        let product = product(above, &rows, below);
        Self {
            value: product.value,
            gradient: JointVector::from(product.gradient),
            // Symmetric, so rows are columns.
            hessian: JointMatrix::from(product.hessian),
        }
    }
}

/// A scalar function of six rotations with its derivatives, one number or several at once.
#[derive(Debug, Clone, Copy)]
pub struct Product<T> {
    /// Value.
    pub value: T,
    /// First derivatives.
    pub gradient: [T; 6],
    /// Second derivatives.
    pub hessian: [[T; 6]; 6],
}

/// d_a . (Q d_b), Q by rows.
#[inline(always)]
pub fn product<T: Number>(above: &DirectionJet<T>, relative: &[[T; 3]; 3], below: &DirectionJet<T>) -> Product<T> {
    let zero = T::of(0.0);
    let mut out = Product {
        value: zero,
        gradient: [zero; 6],
        hessian: [[zero; 6]; 6],
    };
    for (a, row) in above.iter().zip(relative) {
        let mut b = Jet::zero();
        for (part, &factor) in below.iter().zip(row) {
            b.add(factor, part);
        }
        out.value = out.value + a.value * b.value;
        for k in 0..3 {
            out.gradient[k] = out.gradient[k] + a.gradient[k] * b.value;
            out.gradient[3 + k] = out.gradient[3 + k] + a.value * b.gradient[k];
            for l in k..3 {
                out.hessian[k][l] = out.hessian[k][l] + a.hessian[k][l] * b.value;
                out.hessian[3 + k][3 + l] = out.hessian[3 + k][3 + l] + a.value * b.hessian[k][l];
            }
            for l in 0..3 {
                out.hessian[k][3 + l] = out.hessian[k][3 + l] + a.gradient[k] * b.gradient[l];
            }
        }
    }
    for k in 0..6 {
        for l in 0..k {
            out.hessian[k][l] = out.hessian[l][k];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::well::{frame_along, tangent};

    /// With the angle as built, the undeflected joint is at rest whatever its bend; half a turn on, the bend is kept to the other side,
    /// so that the row is off by twice its cosine.
    #[test]
    fn a_hinge_as_built_fits_once_per_turn() {
        let bend = 0.05_f64;
        let frame = |angle: f64| frame_along(tangent(angle));
        let description = JointDescription {
            kind: JointKind::Revolute,
            limit: 0.1,
            stop_stiffness: 1e5,
            stop_damping: 0.5,
            cross_phase: 0.3,
            cross_phase_step: 0.0,
            hinge_angle: HingeAngle::AsBuilt,
        };
        let joint = Joint::new(&description, 0, frame(0.4), frame(0.4 + bend));
        let turned = |psi: f64| joint.rows(&JointVector::from_column_slice(&[psi, 0.0, 0.0, psi, 0.0, 0.0]))[1].value;
        assert_eq!(turned(0.0), 0.0);
        let cosine = joint.hinge_cosine;
        // sin(bend) times the cosine of the hinge's turn away from the well's plane.
        assert!((cosine.abs() - bend.sin() * 0.3_f64.cos()).abs() < 1e-12, "{cosine}");
        assert!((turned(std::f64::consts::PI) + 2.0 * cosine).abs() < 1e-12);
        assert!(turned(2.0 * std::f64::consts::PI).abs() < 1e-12);
    }
}
