//! The law of a joint, for one joint (`T` = f64) or eight at a time: rotational rows of Eq. 13, and the moments of rows
//! and [stop](super::stop).
//!
//! `M` is a number in memory (`Number::Memory`): the linearisation of a residual is stored until the tangent needs it.

use std::f64::consts::FRAC_PI_2;

use super::jet::Jet;
use super::rotation::{DirectionJet, TransverseAxis, shaft_axis, transverse_axes, transverse_axis};
use super::stop::Stop;
use crate::simd::number::Number;
use crate::tool::{JointKind, JointPlay, PinFriction};

/// A scalar function of a joint's six rotations with its derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub struct RotationFunction<M> {
    /// Its value (-); zero where a constraint row holds.
    pub value: M,
    /// First derivatives: of a row, its part of Phi_q, Eq. 16.
    pub gradient: [M; 6],
    /// Second derivatives, symmetric.
    pub hessian: [[M; 6]; 6],
}

/// Constants of a joint's law: the relative frame of its links, the cross, the hinge and the stop.
#[derive(Debug, Clone, Copy)]
pub struct JointLaw<M> {
    /// Which rotational rows it has, and whether a stop.
    pub kind: JointKind,
    /// Q = E_a^T E_b, by rows.
    pub relative: [[M; 3]; 3],
    /// Turn of the cross about the shaft (rad).
    pub phase: M,
    /// cos(theta) of Eq. 13, third row.
    pub hinge_cosine: M,
    /// Bend angle at which the stop begins (rad).
    pub limit: M,
    /// Cosine of the limit: whether the stop is shut follows from the cosine of the bend, without an angle.
    pub limit_cosine: M,
    /// Sine of the limit.
    pub limit_sine: M,
    /// k of the stop (N m/rad).
    pub stop_stiffness: f64,
    /// c of the stop (s/rad).
    pub stop_damping: f64,
    /// Friction in the pins of the cross.
    pub friction: PinFriction,
    /// Play about the shaft.
    pub play: JointPlay,
}

impl<M> RotationFunction<M> {
    /// Stores `product`.
    #[inline(always)]
    fn set<T: Number<Memory = M>>(&mut self, product: &Product<T>) {
        product.value.store(&mut self.value);
        for k in 0..6 {
            product.gradient[k].store(&mut self.gradient[k]);
            for l in 0..6 {
                product.hessian[k][l].store(&mut self.hessian[k][l]);
            }
        }
    }
}

/// d_a . (Q d_b) of a direction of the end above and one of the start below, with its derivatives in the six rotations.
pub(super) struct Product<T> {
    pub value: T,
    pub gradient: [T; 6],
    pub hessian: [[T; 6]; 6],
}

impl<T: Number> Product<T> {
    /// Value, gradient (a row of Phi_q, Eq. 16) and second derivatives, by the product rule. Derivatives that are zero for
    /// every motion are left out of the sums.
    #[inline(always)]
    pub fn of<const A: usize, const B: usize>(
        above: &DirectionJet<T, A>,
        relative: &[[T; 3]; 3],
        below: &DirectionJet<T, B>,
    ) -> Self {
        let zero = T::of(0.0);
        let mut out = Self {
            value: zero,
            gradient: [zero; 6],
            hessian: [[zero; 6]; 6],
        };
        for (a, row) in above.0.iter().zip(relative) {
            let mut b = Jet::zero();
            for (part, &factor) in below.0.iter().zip(row) {
                b.add::<B>(factor, part);
            }
            out.value = out.value.plus_product(a.value, b.value);
            for k in A..3 {
                out.gradient[k] = out.gradient[k].plus_product(a.gradient[k], b.value);
                for l in k..3 {
                    out.hessian[k][l] = out.hessian[k][l].plus_product(a.hessian[k][l], b.value);
                }
                for l in B..3 {
                    out.hessian[k][3 + l] = out.hessian[k][3 + l].plus_product(a.gradient[k], b.gradient[l]);
                }
            }
            for k in B..3 {
                out.gradient[3 + k] = out.gradient[3 + k].plus_product(a.value, b.gradient[k]);
                for l in k..3 {
                    out.hessian[3 + k][3 + l] = out.hessian[3 + k][3 + l].plus_product(a.value, b.hessian[k][l]);
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

    /// The difference to `other`.
    #[inline(always)]
    fn less(mut self, other: &Self) -> Self {
        self.value = self.value - other.value;
        for k in 0..6 {
            self.gradient[k] = self.gradient[k] - other.gradient[k];
            for l in 0..6 {
                self.hessian[k][l] = self.hessian[k][l] - other.hessian[k][l];
            }
        }
        self
    }
}

impl<M> JointLaw<M> {
    /// Whether a stop limits the bend angle. The second row of a revolute joint fixes it instead.
    pub fn has_stop(&self) -> bool {
        self.kind != JointKind::Revolute
    }

    /// Linearises the rotational rows at rotations `q`, Eq. 13: one, or two for [`JointKind::Revolute`].
    #[inline(always)]
    pub fn rows<T: Number<Memory = M>>(&self, q: &[T; 6], rows: &mut [RotationFunction<M>; 2]) {
        match self.kind {
            JointKind::BallCage => self.equal_spin_row(q, &mut rows[0]),
            JointKind::Universal | JointKind::Revolute => self.cross_row(q, &mut rows[0]),
        }
        if self.kind == JointKind::Revolute {
            self.hinge_row(q, &mut rows[1]);
        }
    }

    /// Eq. 13, second row, a_z(a) . a_y(b) = 0: the two arms of the cross stay normal to each other.
    #[inline(always)]
    fn cross_row<T: Number<Memory = M>>(&self, q: &[T; 6], row: &mut RotationFunction<M>) {
        let a_y = transverse_axis((q[3] + T::load(&self.phase)).sin_cos(), q[4], q[5]);
        row.set(&Product::of(&self.upper_arm(q), &self.relative(), &a_y));
    }

    /// a_y(a) . a_z(b) - a_z(a) . a_y(b) = 0, a constant-velocity joint: the turn from one end to the other is about an
    /// axis normal to the bisector of the two shafts, so that the spins are equal at any bend and in any frame. Its
    /// moment lies along that bisector.
    #[inline(always)]
    fn equal_spin_row<T: Number<Memory = M>>(&self, q: &[T; 6], row: &mut RotationFunction<M>) {
        let relative = self.relative();
        let [upper_y, upper_z] = transverse_axes(q[0], q[1], q[2]);
        let [lower_y, lower_z] = transverse_axes(q[3], q[4], q[5]);
        let product = Product::of(&upper_y, &relative, &lower_z);
        row.set(&product.less(&Product::of(&upper_z, &relative, &lower_y)));
    }

    /// Eq. 13, third row, a_z(a) . a_x(b) - cos(theta) = 0.
    #[inline(always)]
    pub fn hinge_row<T: Number<Memory = M>>(&self, q: &[T; 6], row: &mut RotationFunction<M>) {
        let mut product = Product::of(&self.upper_arm(q), &self.relative(), &shaft_axis(q[4], q[5]));
        product.value = product.value - T::load(&self.hinge_cosine);
        row.set(&product);
    }

    /// a_z(a): the arm of the cross that the link above carries.
    #[inline(always)]
    pub(super) fn upper_arm<T: Number<Memory = M>>(&self, q: &[T; 6]) -> TransverseAxis<T> {
        let angle = q[0] + T::load(&self.phase) + T::of(FRAC_PI_2);
        transverse_axis(angle.sin_cos(), q[1], q[2])
    }

    #[inline(always)]
    pub(super) fn relative<T: Number<Memory = M>>(&self) -> [[T; 3]; 3] {
        let mut out = [[T::of(0.0); 3]; 3];
        for (to, from) in out.iter_mut().zip(&self.relative) {
            for (to, from) in to.iter_mut().zip(from) {
                *to = T::load(from);
            }
        }
        out
    }
}

/// Moments on the six rotations that a joint must balance: rows times their multipliers `lambda` (N m), and the stop's
/// where it is shut. The plain form, which tests compare the residual's kernel with.
#[cfg(test)]
pub fn moments<T: Number>(
    rows: &[RotationFunction<T::Memory>],
    lambda: &[T],
    stop: Option<&Stop<T::Memory>>,
    out: &mut [T::Memory; 6],
) {
    for (k, out) in out.iter_mut().enumerate() {
        let mut moment = T::load(&rows[0].gradient[k]) * lambda[0];
        for (row, &lambda) in rows.iter().zip(lambda).skip(1) {
            moment = moment.plus_product(T::load(&row.gradient[k]), lambda);
        }
        if let Some(stop) = stop {
            moment = moment.plus_product(T::load(&stop.gradient[k]), T::load(&stop.moment));
        }
        moment.store(out);
    }
}

/// A shut stop with the rates at which it was evaluated.
pub type ShutStop<'a, M> = (&'a Stop<M>, &'a [M; 6]);

/// Derivative of [`moments`] in the rotations, times `stiffness`, and in their rates, times `damping`: by columns.
/// `stop` comes with the rates at which it was evaluated.
#[inline(always)]
pub fn tangent<T: Number>(
    rows: &[RotationFunction<T::Memory>],
    lambda: &[T],
    stop: Option<ShutStop<'_, T::Memory>>,
    stiffness: f64,
    damping: f64,
    out: &mut [[T::Memory; 6]; 6],
) {
    let (stiff, damped) = (T::of(stiffness), T::of(damping));
    for (l, column) in out.iter_mut().enumerate() {
        for (k, entry) in column.iter_mut().enumerate() {
            let mut sum = T::load(&rows[0].hessian[l][k]) * (lambda[0] * stiff);
            for (row, &lambda) in rows.iter().zip(lambda).skip(1) {
                sum = sum.plus_product(T::load(&row.hessian[l][k]), lambda * stiff);
            }
            sum.store(entry);
        }
    }
    let Some((stop, rate)) = stop else { return };
    let (by_angle, by_rate, moment) = (T::load(&stop.stiffness), T::load(&stop.damping), T::load(&stop.moment));
    for (l, column) in out.iter_mut().enumerate() {
        // With the angle past the limit d: d M / d q_l = k (1 + c angle') g_l + k d c (H rate)_l, and d M / d rate_l =
        // k d c g_l.
        let mut turned = T::of(0.0);
        for (hessian, rate) in stop.hessian[l].iter().zip(rate) {
            turned = turned + T::load(hessian) * T::load(rate);
        }
        let gradient = T::load(&stop.gradient[l]);
        let slope = (by_angle * gradient + by_rate * turned) * stiff + by_rate * gradient * damped;
        for (k, entry) in column.iter_mut().enumerate() {
            let curved = T::load(&stop.hessian[l][k]) * moment * stiff;
            (T::load(entry) + T::load(&stop.gradient[k]) * slope + curved).store(entry);
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::*;
    use crate::elements::joint::Joint;
    use crate::tool::JointDescription;

    pub fn joint(kind: JointKind) -> Joint {
        let mut description = JointDescription::new(kind, 0.1);
        description.cross_phase = 0.2;
        let turn = *Rotation3::from_axis_angle(&Vector3::y_axis(), 0.047).matrix();
        Joint::new(&description, 1, Matrix3::identity(), turn)
    }

    /// The stop is shut (0.16 rad of bend against 0.1) and pushes.
    pub const AT: [f64; 6] = [0.7, 0.09, 0.01, 0.71, -0.12, 0.02];
    const RATE: [f64; 6] = [4.0, 0.3, 0.1, 4.1, -0.2, 0.05];

    #[test]
    fn the_tangent_is_that_of_differences() {
        for kind in [JointKind::Universal, JointKind::BallCage, JointKind::Revolute] {
            let law = joint(kind).law;
            let lambda = [40.0, -25.0];
            let count = Joint::rotational_rows(kind);
            let linearised = |q: &[f64; 6], rate: &[f64; 6]| {
                let (mut rows, mut stop) = Default::default();
                law.rows(q, &mut rows);
                assert!(law.stop(q, rate, &mut stop) && stop.moment > 0.0);
                (rows, stop)
            };
            let force = |q: &[f64; 6], rate: &[f64; 6]| {
                let (rows, stop) = linearised(q, rate);
                let mut out = [0.0; 6];
                moments(&rows[..count], &lambda, Some(&stop), &mut out);
                out
            };
            let (rows, stop) = linearised(&AT, &RATE);
            let derivative = |stiffness: f64, damping: f64| {
                let mut out = [[0.0; 6]; 6];
                let stop = Some((&stop, &RATE));
                tangent(&rows[..count], &lambda, stop, stiffness, damping, &mut out);
                out
            };
            let (by_angle, by_rate) = (derivative(1.0, 0.0), derivative(0.0, 1.0));
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

    /// The ball cage row's value at `q`.
    fn cage(law: &JointLaw<f64>, q: &[f64; 6]) -> RotationFunction<f64> {
        let mut rows: [_; 2] = Default::default();
        law.rows(q, &mut rows);
        rows[0]
    }

    /// Rotations of a node that has the rotation `r` in its link's frame.
    fn coordinates(r: &Rotation3<f64>) -> [f64; 3] {
        let shaft = r * Vector3::x();
        // The tilt is the shortest rotation from the frame's axis to the shaft; the spin is the rest.
        let tilt = Rotation3::rotation_between(&Vector3::x(), &shaft).unwrap();
        let (spin, tilt) = (tilt.inverse() * r, tilt.scaled_axis());
        [spin.scaled_axis().x, tilt.y, tilt.z]
    }

    #[test]
    fn a_ball_cage_joint_does_not_see_the_frame() {
        let law = joint(JointKind::BallCage).law;
        let q = [0.7, 0.11, -0.05, 0.69, -0.12, 0.07];
        let relative = Matrix3::from_fn(|i, j| law.relative[i][j]);
        let turn = |psi: f64, y: f64, z: f64| {
            Rotation3::new(Vector3::new(0.0, y, z)) * Rotation3::new(Vector3::new(psi, 0.0, 0.0))
        };
        let (above, below) = (turn(q[0], q[1], q[2]), turn(q[3], q[4], q[5]));
        let value = cage(&law, &q).value;
        assert!(value.abs() > 0.01, "the two values would agree anyway");
        // Both ends turned together, about axes that tilt and spin.
        for by in [[0.3, 0.0, 0.0], [0.0, 0.2, -0.1], [0.4, -0.15, 0.2]] {
            let by = Rotation3::new(Vector3::from(by));
            let below = Rotation3::from_matrix_unchecked(relative.transpose() * (by * relative * below));
            let ([a, b, c], [d, e, f]) = (coordinates(&(by * above)), coordinates(&below));
            let turned = cage(&law, &[a, b, c, d, e, f]).value;
            // Rounding of products of order one.
            assert!((turned - value).abs() < 1e-13, "{turned} against {value}");
        }
    }

    #[test]
    fn a_ball_cage_joint_turns_evenly_and_its_moment_bisects_the_shafts() {
        let law = joint(JointKind::BallCage).law;
        let tilts = [0.11, -0.05, -0.12, 0.07];
        let (mut lag, mut farthest) = (None, 0.0_f64);
        for step in 0..40 {
            let psi = 0.3 * f64::from(step);
            let at = |psi_b: f64| [psi, tilts[0], tilts[1], psi_b, tilts[2], tilts[3]];
            let mut psi_b = psi;
            for _ in 0..5 {
                let row = cage(&law, &at(psi_b));
                psi_b -= row.value / row.gradient[3];
            }
            let row = cage(&law, &at(psi_b));
            // Virtual work of a moment M on the end below: M . shaft per spin. Both shafts see the same of it.
            assert!((row.gradient[0] + row.gradient[3]).abs() < 1e-13, "torques differ");
            farthest = farthest.max((psi - psi_b - *lag.get_or_insert(psi - psi_b)).abs());
        }
        // Rounding of angles of some 10 rad. A cross joint of this bend (0.24 rad) would sway by 0.014 rad.
        assert!(farthest < 1e-13, "the spins part by {farthest} rad");
    }
}
