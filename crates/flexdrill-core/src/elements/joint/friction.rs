//! Friction in the pins of a universal joint's cross.
//!
//! The cross turns in two pins about the arm of the link above, e1, and in two about the arm of the link below, e2. With
//! the bend angles q1 about e1 and q2 about e2,
//!
//! ```text
//! sin q1 = - a_x(a) . a_y(b),      sin q2 = - a_z(a) . a_x(b),
//! F = hypot(T / d_c, Q / 2),       M = 2 mu r F,
//! moment on q_i:                   - M q_i' / sqrt(q_i'^2 + w^2)
//! ```
//!
//! F is the mean force on a pin (N): a torque T loads both pins of an axis by a couple over the pin circle's diameter d_c, a
//! force Q through the joint by half each. Both are those of the last accepted step, since a pin force that changed with
//! the corrections of a step would have to be linearised with the multipliers. r is the radius of a pin (m), mu its coefficient of
//! friction, w the rate (rad/s) within which the smooth sign changes.
//!
//! Where the joint's row holds, the relative angular velocity of the two links is q1' e1 + q2' e2 with e1 and e2 at a right
//! angle, so that the gradient of q_i is the generalised direction of a couple about e_i on both links.

use super::law::{JointLaw, Product};
use super::rotation::{shaft_axis, transverse_axis};
use crate::elements::slip::{Slip, SlipMemory};
use crate::simd::number::{Lane, Number};
use crate::tool::PinFriction;

/// Friction about one axis of a cross, with its derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub struct AxisFriction<M> {
    /// Rate of the bend about the axis (rad/s), the moment against it (N m), of its sign, and the slope that the
    /// tangent uses.
    pub slip: Slip<M>,
    /// d angle / d rotations.
    pub gradient: [M; 6],
    /// d2 angle / d rotations2.
    pub hessian: [[M; 6]; 6],
}

impl PinFriction {
    /// Moment (N m) that slipping pins of one axis resist with, under a torque (N m) and a force (N) through the joint.
    pub(crate) fn moment(&self, torque: f64, force: f64) -> f64 {
        2.0 * self.coefficient * self.pin_radius * libm::hypot(torque / self.circle_diameter, 0.5 * force)
    }
}

impl<M> JointLaw<M> {
    /// Evaluates the friction about both axes at rotations `q` and rates `rate`, where a slipping axis resists with the moment
    /// `full` (N m).
    #[inline(always)]
    pub fn friction<T: Number<Memory = M>>(&self, q: &[T; 6], rate: &[T; 6], full: T, axes: &mut [AxisFriction<M>; 2]) {
        let relative = self.relative();
        let phase = T::load(&self.phase);
        let lower_arm = transverse_axis((q[3] + phase).sin_cos(), q[4], q[5]);
        let about_upper = Product::of(&shaft_axis(q[1], q[2]), &relative, &lower_arm);
        let about_lower = Product::of(&self.upper_arm(q), &relative, &shaft_axis(q[4], q[5]));
        for (axis, sine) in axes.iter_mut().zip([about_upper, about_lower]) {
            // With p = - sin q: d q = - d p / cos q, d2 q = - (d2 p + p d q d q) / cos q.
            let cosine = (T::of(1.0) - sine.value * sine.value).root();
            let over = T::of(1.0).over(cosine);
            let mut gradient = [T::of(0.0); 6];
            let mut speed = T::of(0.0);
            for k in 0..6 {
                gradient[k] = -(sine.gradient[k] * over);
                gradient[k].store(&mut axis.gradient[k]);
                speed = speed.plus_product(gradient[k], rate[k]);
            }
            for k in 0..6 {
                for l in 0..6 {
                    let curved = sine.hessian[k][l].plus_product(sine.value, gradient[k] * gradient[l]);
                    (-(curved * over)).store(&mut axis.hessian[k][l]);
                }
            }
            let slip = Slip::at(speed, full, self.friction.slip_rate);
            slip.speed.store(&mut axis.slip.speed);
            slip.friction.store(&mut axis.slip.friction);
            slip.slope.store(&mut axis.slip.slope);
        }
    }
}

impl<M> AxisFriction<M> {
    /// Adds the derivative of the moments in the rotations, times `stiffness`, and in their `rate`, times `damping`, by
    /// columns.
    #[inline(always)]
    pub fn add_tangent<T: Number<Memory = M>>(
        &self,
        rate: &[M; 6],
        stiffness: f64,
        damping: f64,
        out: &mut [[M; 6]; 6],
    ) {
        let (stiff, damped) = (T::of(stiffness), T::of(damping));
        let (moment, slope) = (T::load(&self.slip.friction) * stiff, T::load(&self.slip.slope));
        for (l, column) in out.iter_mut().enumerate() {
            // The angle's rate changes with the rotations too: d angle' / d q_l = (H rate)_l.
            let mut turned = T::of(0.0);
            for (hessian, rate) in self.hessian[l].iter().zip(rate) {
                turned = turned.plus_product(T::load(hessian), T::load(rate));
            }
            let change = slope * (turned * stiff + T::load(&self.gradient[l]) * damped);
            for (k, entry) in column.iter_mut().enumerate() {
                let sum = T::load(entry).plus_product(T::load(&self.gradient[k]), change);
                sum.plus_product(T::load(&self.hessian[l][k]), moment).store(entry);
            }
        }
    }
}

/// Memory of the friction of eight joints over the corrections of a step, see [`SlipMemory`].
#[derive(Debug, Clone, Copy)]
pub struct PinMemory {
    axes: [[SlipMemory; 8]; 2],
    /// Whether a residual of this step was evaluated.
    begun: bool,
}

impl Default for PinMemory {
    fn default() -> Self {
        Self {
            axes: [[SlipMemory::new(Slip::default()); 8]; 2],
            begun: false,
        }
    }
}

impl PinMemory {
    /// Forgets the corrections of the step before.
    pub fn begin(&mut self) {
        self.begun = false;
    }

    /// Sets the slopes of the friction of `axes`, whose pins resist with `full` (N m).
    #[inline(always)]
    pub fn follow(&mut self, full: &Lane, width: f64, axes: &mut [AxisFriction<Lane>; 2]) {
        for (memories, axis) in self.axes.iter_mut().zip(axes) {
            for (lane, memory) in memories.iter_mut().enumerate() {
                let mut slip = axis.slip.lane(lane);
                if self.begun {
                    memory.follow(&mut slip, full[lane], width);
                    axis.slip.slope[lane] = slip.slope;
                } else {
                    *memory = SlipMemory::new(slip);
                }
            }
        }
        self.begun = true;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::super::law::tests::joint;
    use super::*;
    use crate::tool::JointKind;

    const RATE: [f64; 6] = [4.0, 0.03, 0.01, 4.1, -0.02, 0.05];
    const FULL: f64 = 2.5;

    fn law() -> JointLaw<f64> {
        let mut law = joint(JointKind::Universal).law;
        law.friction.slip_rate = 0.02;
        law
    }

    fn forces(law: &JointLaw<f64>, q: &[f64; 6], rate: &[f64; 6]) -> [f64; 6] {
        let mut axes: [AxisFriction<f64>; 2] = Default::default();
        law.friction(q, rate, FULL, &mut axes);
        std::array::from_fn(|k| axes.iter().map(|axis| axis.gradient[k] * axis.slip.friction).sum())
    }

    #[test]
    fn the_tangent_is_that_of_differences() {
        let law = law();
        let at = [0.7, 0.09, 0.01, 0.71, -0.12, 0.02];
        let mut axes = Default::default();
        law.friction(&at, &RATE, FULL, &mut axes);
        let derivative = |stiffness: f64, damping: f64| {
            let mut out = [[0.0; 6]; 6];
            for axis in &axes {
                axis.add_tangent::<f64>(&RATE, stiffness, damping, &mut out);
            }
            out
        };
        let (by_angle, by_rate) = (derivative(1.0, 0.0), derivative(0.0, 1.0));
        let h = 1e-6;
        let moved = |x: &[f64; 6], l: usize, by: f64| {
            let mut x = *x;
            x[l] += by;
            x
        };
        for l in 0..6 {
            let quotient = |forward: [f64; 6], back: [f64; 6], k: usize| (forward[k] - back[k]) / (2.0 * h);
            let (up, down) = (
                forces(&law, &moved(&at, l, h), &RATE),
                forces(&law, &moved(&at, l, -h), &RATE),
            );
            let (faster, slower) = (
                forces(&law, &at, &moved(&RATE, l, h)),
                forces(&law, &at, &moved(&RATE, l, -h)),
            );
            for k in 0..6 {
                // The slope at zero rate is M / w = 125 N m s/rad; its third derivative over w^2 times h^2 is 3e-7.
                assert!((by_angle[l][k] - quotient(up, down, k)).abs() < 1e-4, "{l} {k}");
                assert!((by_rate[l][k] - quotient(faster, slower, k)).abs() < 1e-4, "{l} {k}");
            }
        }
    }

    /// The rates about the two arms are those of the relative angular velocity, which is the matrix derivative of the
    /// relative rotation of the two ends, where the joint's row holds in motion too.
    #[test]
    fn the_rates_are_those_of_the_relative_rotation_about_the_arms() {
        let law = law();
        let relative = Matrix3::from_fn(|i, j| law.relative[i][j]);
        let turn = |q: &[f64]| {
            *(Rotation3::new(Vector3::new(0.0, q[1], q[2])) * Rotation3::new(Vector3::new(q[0], 0.0, 0.0))).matrix()
        };
        let row = |q: &[f64; 6]| {
            let mut rows: [_; 2] = Default::default();
            law.rows(q, &mut rows);
            rows[0]
        };
        // The spin below such that the row holds, and its rate such that it goes on holding.
        let mut q = [0.7, 0.09, 0.01, 0.71, -0.12, 0.02];
        for _ in 0..6 {
            let row = row(&q);
            q[3] -= row.value / row.gradient[3];
        }
        let mut rate = RATE;
        let held = row(&q);
        rate[3] -= held.gradient.iter().zip(rate).map(|(g, r)| g * r).sum::<f64>() / held.gradient[3];
        let mut axes: [AxisFriction<f64>; 2] = Default::default();
        law.friction(&q, &rate, FULL, &mut axes);
        let rates = axes.map(|axis| axis.slip.speed);

        let h = 1e-6;
        let at = |by: f64| -> (Matrix3<f64>, Matrix3<f64>) {
            let x: [f64; 6] = std::array::from_fn(|k| q[k] + by * rate[k]);
            (turn(&x[..3]), relative * turn(&x[3..]))
        };
        let (above, below) = at(0.0);
        let spin = |forward: Matrix3<f64>, back: Matrix3<f64>, now: Matrix3<f64>| {
            let w = (forward - back) / (2.0 * h) * now.transpose();
            Vector3::new(w[(2, 1)], w[(0, 2)], w[(1, 0)])
        };
        let ((a1, b1), (a0, b0)) = (at(h), at(-h));
        let difference = spin(b1, b0, below) - spin(a1, a0, above);
        let (sin, cos) = law.phase.sin_cos();
        let upper_arm = above * Vector3::new(0.0, -sin, cos);
        let lower_arm = below * Vector3::new(0.0, cos, sin);
        // Central differences of rotations at 4 rad/s: 4^3 h^2 / 6 and rounding over h.
        assert!((difference.dot(&upper_arm) - rates[0]).abs() < 1e-8, "{rates:?}");
        assert!((difference.dot(&lower_arm) - rates[1]).abs() < 1e-8, "{rates:?}");
        // Nothing is left over: the cross has no third axis.
        let left = difference - upper_arm * rates[0] - lower_arm * rates[1];
        assert!(left.norm() < 1e-8 && difference.norm() > 0.05, "{left}");
    }

    /// Friction moment of a cross joint's pins, 2 mu r F: 0.1 on pins of 6 mm in a circle of 40 mm. F is the torque over the
    /// circle, half of the thrust, and both at a right angle. Tolerance: rounding.
    #[test]
    fn analytic_friction_of_the_pins() {
        use crate::support::figure;
        let pins = PinFriction {
            coefficient: 0.1,
            pin_radius: 6e-3,
            circle_diameter: 0.04,
            slip_rate: 0.02,
        };
        figure("92.43 N m (N m)", 2.7729, pins.moment(92.43, 0.0), 1e-12);
        figure("1 kN across (N m)", 0.6, pins.moment(0.0, 1e3), 1e-12);
        let both = 1.2 * 2.0_f64.sqrt();
        figure("-40 N m and 2 kN across (N m)", both, pins.moment(-40.0, 2e3), 1e-12);
    }
}
