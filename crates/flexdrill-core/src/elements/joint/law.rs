//! The law of a joint, for one joint (`T` = f64) or eight at a time: rotational rows of Eq. 13 and the limit stop.

use std::f64::consts::FRAC_PI_2;

use super::jet::Jet;
use super::rotation::{DirectionJet, shaft_axis, shaft_direction, transverse_axis};
use crate::simd::number::Number;
use crate::tool::description::JointKind;

/// A scalar function of a joint's six rotations with its derivatives.
#[derive(Debug, Clone, Copy)]
pub struct RotationFunction<T> {
    /// Value.
    pub value: T,
    /// First derivatives.
    pub gradient: [T; 6],
    /// Second derivatives, symmetric.
    pub hessian: [[T; 6]; 6],
}

/// Where a joint stands and how far it bends.
#[derive(Debug, Clone, Copy)]
pub struct JointLaw<T> {
    /// Which rows.
    pub kind: JointKind,
    /// Q = E_a^T E_b, by rows.
    pub relative: [[T; 3]; 3],
    /// Turn of the cross about the shaft (rad).
    pub phase: T,
    /// cos(theta) of Eq. 13, third row.
    pub hinge_cosine: T,
    /// Bend angle at which the stop begins (rad).
    pub limit: T,
    /// Its cosine.
    pub limit_cosine: T,
    /// k of the stop (N m/rad).
    pub stop_stiffness: f64,
    /// c of the stop (s/rad).
    pub stop_damping: f64,
}

/// The stop's moment with what its tangent takes. All zero where it is open.
#[derive(Debug, Clone, Copy)]
pub struct Stop<T> {
    /// Moment M (N m, >= 0).
    pub moment: T,
    /// d M / d angle at a constant rate: k (1 + c angle').
    pub stiffness: T,
    /// d M / d angle': k (angle - limit) c.
    pub damping: T,
    /// Energy in the stop's spring (J).
    pub energy: T,
    /// Power taken by the stop's damping (W).
    pub dissipation: T,
    /// d angle / d rotations.
    pub gradient: [T; 6],
    /// d2 angle / d rotations2.
    pub hessian: [[T; 6]; 6],
}

impl<T: Number> RotationFunction<T> {
    /// Zero everywhere.
    #[inline(always)]
    pub fn zero() -> Self {
        let zero = T::of(0.0);
        Self {
            value: zero,
            gradient: [zero; 6],
            hessian: [[zero; 6]; 6],
        }
    }

    /// d_a . (Q d_b) of a direction of the end above and one of the start below, Q by rows.
    #[inline(always)]
    fn bilinear(above: &DirectionJet<T>, relative: &[[T; 3]; 3], below: &DirectionJet<T>) -> Self {
        let mut out = Self::zero();
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
}

impl<T> JointLaw<T> {
    /// Whether the bend angle is limited by the stop. A revolute joint's is kept by its second row.
    pub fn has_stop(&self) -> bool {
        self.kind != JointKind::Revolute
    }
}

impl<T: Number> JointLaw<T> {
    /// The rotational rows at rotations `q`, Eq. 13; the second belongs to [`JointKind::Revolute`] only.
    #[inline(always)]
    pub fn rows(&self, q: &[T; 6]) -> [RotationFunction<T>; 2] {
        match self.kind {
            JointKind::Universal => [self.cross_row(q), RotationFunction::zero()],
            JointKind::BallCage => [Self::equal_spin_row(q), RotationFunction::zero()],
            JointKind::Revolute => [self.cross_row(q), self.hinge_row(q)],
        }
    }

    /// Eq. 13, second row, a_z(a) . a_y(b) = 0: the two arms of the cross stay normal to each other.
    #[inline(always)]
    pub fn cross_row(&self, q: &[T; 6]) -> RotationFunction<T> {
        let a_y = transverse_axis((q[3] + self.phase).sin_cos(), q[4], q[5]);
        RotationFunction::bilinear(&self.upper_arm(q), &self.relative, &a_y)
    }

    /// Eq. 13, third row, a_z(a) . a_x(b) - cos(theta) = 0.
    #[inline(always)]
    pub fn hinge_row(&self, q: &[T; 6]) -> RotationFunction<T> {
        let mut row = RotationFunction::bilinear(&self.upper_arm(q), &self.relative, &shaft_axis(q[4], q[5]));
        row.value = row.value - self.hinge_cosine;
        row
    }

    /// psi_a - psi_b = 0: a constant-velocity joint.
    #[inline(always)]
    pub fn equal_spin_row(q: &[T; 6]) -> RotationFunction<T> {
        let mut row = RotationFunction::zero();
        row.value = q[0] - q[3];
        (row.gradient[0], row.gradient[3]) = (T::of(1.0), T::of(-1.0));
        row
    }

    /// a_z(a): the arm of the cross that the link above carries.
    #[inline(always)]
    fn upper_arm(&self, q: &[T; 6]) -> DirectionJet<T> {
        transverse_axis((q[0] + self.phase + T::of(FRAC_PI_2)).sin_cos(), q[1], q[2])
    }

    /// The stop at rotations `q` and rates `rate`: M = k (angle - limit)(1 + c angle') >= 0, which is continuous at onset. `None` where
    /// it is open (for all joints of `T`), as nearly all are nearly always: derivatives are formed only where one is shut.
    #[inline(always)]
    pub fn stop(&self, q: &[T; 6], rate: &[T; 6]) -> Option<Stop<T>> {
        let upper = shaft_direction(q[1], q[2]);
        let below = shaft_direction(q[4], q[5]);
        let lower = self
            .relative
            .map(|row| row[0] * below[0] + row[1] * below[1] + row[2] * below[2]);
        let cosine = upper[0] * lower[0] + upper[1] * lower[1] + upper[2] * lower[2];
        if !cosine.any_below(self.limit_cosine) {
            return None;
        }
        let across = [
            upper[1] * lower[2] - upper[2] * lower[1],
            upper[2] * lower[0] - upper[0] * lower[2],
            upper[0] * lower[1] - upper[1] * lower[0],
        ];
        let sine = (across[0] * across[0] + across[1] * across[1] + across[2] * across[2]).map(f64::sqrt);
        let over = sine.zip(cosine, libm::atan2) - self.limit;
        let (k, c) = (self.stop_stiffness, self.stop_damping);
        let spring = over.map(|over| if over > 0.0 { k * over } else { 0.0 });
        let inverse = sine.zip(over, |sine, over| if over > 0.0 { 1.0 / sine } else { 0.0 });
        let ratio = cosine * inverse;

        // cos(angle) is smooth in the rotations; the angle follows from it by the chain rule.
        let bend = RotationFunction::bilinear(&shaft_axis(q[1], q[2]), &self.relative, &shaft_axis(q[4], q[5]));
        let gradient = bend.gradient.map(|slope| -(slope * inverse));
        let mut hessian = bend.hessian;
        let mut angle_rate = T::of(0.0);
        for i in 0..6 {
            angle_rate = angle_rate + gradient[i] * rate[i];
            for j in 0..6 {
                hessian[i][j] = -(hessian[i][j] * inverse) - gradient[i] * gradient[j] * ratio;
            }
        }
        // Pushing: shut, and not opening faster than the law can push. Where it opens too fast there is no moment and the spring's
        // energy goes into its damping.
        let pushing = |spring: f64, rate: f64| spring > 0.0 && 1.0 + c * rate > 0.0;
        let when_pushing = |value: fn(f64, f64, f64, f64) -> f64| {
            spring.zip(angle_rate, |spring, rate| {
                if pushing(spring, rate) {
                    value(k, c, spring, 1.0 + c * rate)
                } else {
                    0.0
                }
            })
        };
        Some(Stop {
            moment: when_pushing(|_, _, spring, viscous| spring * viscous),
            stiffness: when_pushing(|k, _, _, viscous| k * viscous),
            damping: when_pushing(|_, c, spring, _| spring * c),
            energy: spring.zip(over, |spring, over| if over > 0.0 { 0.5 * spring * over } else { 0.0 }),
            dissipation: spring.zip(angle_rate, |spring, rate| {
                if pushing(spring, rate) {
                    spring * c * rate * rate
                } else {
                    -spring * rate
                }
            }),
            gradient,
            hessian,
        })
    }
}

/// Moments on the six rotations that a joint must balance: rows times their multipliers `lambda` (N m), and the stop.
#[inline(always)]
pub fn moments<T: Number>(rows: &[RotationFunction<T>], lambda: &[T], stop: Option<&Stop<T>>) -> [T; 6] {
    let mut out = [T::of(0.0); 6];
    for (k, out) in out.iter_mut().enumerate() {
        *out = rows[0].gradient[k] * lambda[0];
        for (row, &lambda) in rows.iter().zip(lambda).skip(1) {
            *out = *out + row.gradient[k] * lambda;
        }
        if let Some(stop) = stop {
            *out = *out + stop.gradient[k] * stop.moment;
        }
    }
    out
}

/// Derivative of [`moments`] in the rotations, times `stiffness`, and in their rates, times `damping`: by columns.
/// `rate` are the rates at which the stop was evaluated.
#[inline(always)]
pub fn tangent<T: Number>(
    rows: &[RotationFunction<T>],
    lambda: &[T],
    stop: Option<(&Stop<T>, &[T; 6])>,
    stiffness: f64,
    damping: f64,
) -> [[T; 6]; 6] {
    let (stiff, damped) = (T::of(stiffness), T::of(damping));
    let mut out = [[T::of(0.0); 6]; 6];
    for (r, (row, &lambda)) in rows.iter().zip(lambda).enumerate() {
        let lambda = lambda * stiff;
        for (out, hessian) in out.iter_mut().zip(&row.hessian) {
            for (out, &hessian) in out.iter_mut().zip(hessian) {
                *out = if r == 0 {
                    hessian * lambda
                } else {
                    *out + hessian * lambda
                };
            }
        }
    }
    let Some((stop, rate)) = stop else { return out };
    for l in 0..6 {
        // d M / d q_l = k (1 + c angle') g_l + k over c (H rate)_l, and with the rates k over c g_l.
        let mut turned = T::of(0.0);
        for (&hessian, &rate) in stop.hessian[l].iter().zip(rate) {
            turned = turned + hessian * rate;
        }
        let gradient = stop.gradient[l];
        let slope = (stop.stiffness * gradient + stop.damping * turned) * stiff + stop.damping * gradient * damped;
        for k in 0..6 {
            let curved = stop.hessian[l][k] * stop.moment * stiff;
            out[l][k] = out[l][k] + stop.gradient[k] * slope + curved;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::*;
    use crate::elements::joint::Joint;
    use crate::tool::description::JointDescription;

    fn joint(kind: JointKind) -> Joint {
        let description = JointDescription {
            kind,
            limit: 0.1,
            stop_stiffness: 2e5,
            stop_damping: 0.5,
            cross_phase: 0.2,
            cross_phase_step: FRAC_PI_2,
            hinge_angle: Default::default(),
        };
        let turn = *Rotation3::from_axis_angle(&Vector3::y_axis(), 0.047).matrix();
        Joint::new(&description, 1, Matrix3::identity(), turn)
    }

    /// The stop is shut (0.16 rad of bend against 0.1) and pushes.
    const AT: [f64; 6] = [0.7, 0.09, 0.01, 0.71, -0.12, 0.02];
    const RATE: [f64; 6] = [4.0, 0.3, 0.1, 4.1, -0.2, 0.05];

    #[test]
    fn the_tangent_is_that_of_differences() {
        for kind in [JointKind::Universal, JointKind::BallCage, JointKind::Revolute] {
            let law = joint(kind).law;
            let lambda = [40.0, -25.0];
            let force = |q: &[f64; 6], rate: &[f64; 6]| moments(&law.rows(q), &lambda, law.stop(q, rate).as_ref());
            let (rows, stop) = (law.rows(&AT), law.stop(&AT, &RATE));
            assert!(stop.is_some_and(|stop| stop.moment > 0.0));
            let by_angle = tangent(&rows, &lambda, stop.as_ref().map(|stop| (stop, &RATE)), 1.0, 0.0);
            let by_rate = tangent(&rows, &lambda, stop.as_ref().map(|stop| (stop, &RATE)), 0.0, 1.0);
            let h = 1e-6;
            for l in 0..6 {
                let moved = |x: &[f64; 6], by: f64| {
                    let mut x = *x;
                    x[l] += by;
                    x
                };
                let (up, down) = (force(&moved(&AT, h), &RATE), force(&moved(&AT, -h), &RATE));
                let (faster, slower) = (force(&AT, &moved(&RATE, h)), force(&AT, &moved(&RATE, -h)));
                for k in 0..6 {
                    // Central differences of moments of 1e4 N m: 1e-6 by the step's square, 1e-6 by rounding.
                    let scale = 1e5;
                    assert!((by_angle[l][k] - (up[k] - down[k]) / (2.0 * h)).abs() < 1e-8 * scale * 10.0);
                    assert!((by_rate[l][k] - (faster[k] - slower[k]) / (2.0 * h)).abs() < 1e-8 * scale);
                }
            }
        }
    }

    #[test]
    fn a_stop_that_opens_too_fast_does_not_pull() {
        let law = joint(JointKind::Universal).law;
        let opening = [0.0, -30.0, 0.0, 0.0, 30.0, 0.0];
        let stop = law.stop(&AT, &opening).expect("it is shut");
        assert_eq!((stop.moment, stop.stiffness, stop.damping), (0.0, 0.0, 0.0));
        assert!(stop.energy > 0.0 && stop.dissipation > 0.0);
        assert!(law.stop(&[0.0; 6], &opening).is_none());
    }
}
