//! The stop that limits a joint's bend: the third row of Eq. 13 as an inequality.

use super::law::{JointLaw, Product};
use super::rotation::{shaft_axis, shaft_direction};
use crate::simd::number::Number;

/// Coefficients of arcsin(x)/x in powers of x^2: (2n)! / (4^n n!^2 (2n + 1)).
const ARC_SINE: [f64; 10] = {
    let mut c = [1.0; 10];
    let (mut n, mut ratio) = (1, 1.0);
    while n < c.len() {
        ratio *= (2 * n - 1) as f64 / (2 * n) as f64;
        c[n] = ratio / (2 * n + 1) as f64;
        n += 1;
    }
    c
};
/// Up to this sine (7 degrees) the series yields the angle to rounding: the next term is 0.125^20 / 120.
const LARGEST_SINE: f64 = 0.125;

/// The stop's moment with its derivatives. All of them are zero while the stop is open.
#[derive(Debug, Clone, Copy, Default)]
pub struct Stop<M> {
    /// Moment M (N m, >= 0).
    pub moment: M,
    /// d M / d angle at a constant rate: k (1 + c angle').
    pub stiffness: M,
    /// d M / d angle': k (angle - limit) c.
    pub damping: M,
    /// Energy in the stop's spring (J).
    pub energy: M,
    /// Power taken by the stop's damping (W).
    pub dissipation: M,
    /// d angle / d rotations.
    pub gradient: [M; 6],
    /// d2 angle / d rotations2.
    pub hessian: [[M; 6]; 6],
}

impl<M> JointLaw<M> {
    /// Bend angle minus the limit (rad), from the sine and cosine of the bend angle. Only the sign of a negative result
    /// is valid: an open stop needs no more.
    #[inline(always)]
    fn angle_past_limit<T: Number<Memory = M>>(&self, sine: T, cosine: T) -> T {
        let (limit_sine, limit_cosine) = (T::load(&self.limit_sine), T::load(&self.limit_cosine));
        // Sine and cosine of the difference of the two angles.
        let of_sine = sine * limit_cosine - cosine * limit_sine;
        let of_cosine = cosine * limit_cosine + sine * limit_sine;
        // The arc tangent is a scalar function; it runs only where a lane is outside the range of the series.
        if T::of(LARGEST_SINE).any_below(of_sine) || of_cosine.any_below(T::of(0.0)) {
            return of_sine.zip(of_cosine, libm::atan2);
        }
        let square = of_sine * of_sine;
        let mut sum = T::of(ARC_SINE[ARC_SINE.len() - 1]);
        for &c in ARC_SINE[..ARC_SINE.len() - 1].iter().rev() {
            sum = T::of(c).plus_product(sum, square);
        }
        sum * of_sine
    }

    /// Evaluates the stop at rotations `q` and rates `rate`: M = k (angle - limit)(1 + c angle') >= 0, continuous at
    /// onset (third row of Eq. 13 as an inequality). Returns whether the stop of some joint in `T` is shut. If none is,
    /// which is the usual case, `stop` stays unchanged.
    #[inline(always)]
    pub fn stop<T: Number<Memory = M>>(&self, q: &[T; 6], rate: &[T; 6], stop: &mut Stop<M>) -> bool {
        // Both shafts are compared in the frame of the upper link.
        let relative = self.relative::<T>();
        let upper = shaft_direction(q[1], q[2]);
        let below = shaft_direction(q[4], q[5]);
        let mut lower = [T::of(0.0); 3];
        for (lower, row) in lower.iter_mut().zip(&relative) {
            *lower = row[0] * below[0] + row[1] * below[1] + row[2] * below[2];
        }
        let cosine = upper[0] * lower[0] + upper[1] * lower[1] + upper[2] * lower[2];
        // The cosine alone decides whether the stop is shut: most calls end here, without a root or an angle.
        if !cosine.any_below(T::load(&self.limit_cosine)) {
            return false;
        }
        let across = [
            upper[1] * lower[2] - upper[2] * lower[1],
            upper[2] * lower[0] - upper[0] * lower[2],
            upper[0] * lower[1] - upper[1] * lower[0],
        ];
        // Sine and cosine together: near the limit neither alone gives the angle with all its digits.
        let sine = (across[0] * across[0] + across[1] * across[1] + across[2] * across[2]).root();
        let over = self.angle_past_limit(sine, cosine);
        // Lanes whose stop is open have no spring, and their inverse is zero, so that nothing of theirs is stored.
        let (k, c) = (self.stop_stiffness, self.stop_damping);
        let spring = over.map(|over| if over > 0.0 { k * over } else { 0.0 });
        let inverse = sine.zip(over, |sine, over| if over > 0.0 { 1.0 / sine } else { 0.0 });
        let ratio = cosine * inverse;

        // cos(angle) is smooth in the rotations, also at bend 0; the derivatives of the angle follow by the chain rule.
        let bend = Product::of(&shaft_axis(q[1], q[2]), &relative, &shaft_axis(q[4], q[5]));
        let mut gradient = bend.gradient;
        let mut angle_rate = T::of(0.0);
        for i in 0..6 {
            gradient[i] = -(gradient[i] * inverse);
            gradient[i].store(&mut stop.gradient[i]);
            angle_rate = angle_rate + gradient[i] * rate[i];
        }
        for i in 0..6 {
            for j in 0..6 {
                let bent = gradient[i] * gradient[j] * ratio;
                (-(bend.hessian[i][j] * inverse) - bent).store(&mut stop.hessian[i][j]);
            }
        }
        // The stop pushes while it is shut and does not open faster than the law can push. A stop that opens faster has
        // no moment, and its spring's energy is lost to the damping.
        let pushing = |spring: f64, rate: f64| spring > 0.0 && 1.0 + c * rate > 0.0;
        let zero_or = |pushing: bool, value: f64| if pushing { value } else { 0.0 };
        spring
            .zip(angle_rate, |s, rate| zero_or(pushing(s, rate), s * (1.0 + c * rate)))
            .store(&mut stop.moment);
        spring
            .zip(angle_rate, |s, rate| zero_or(pushing(s, rate), k * (1.0 + c * rate)))
            .store(&mut stop.stiffness);
        spring
            .zip(angle_rate, |s, rate| zero_or(pushing(s, rate), s * c))
            .store(&mut stop.damping);
        spring
            .zip(over, |s, over| zero_or(over > 0.0, 0.5 * s * over))
            .store(&mut stop.energy);
        spring
            .zip(angle_rate, |s, rate| {
                if pushing(s, rate) {
                    s * c * rate * rate
                } else {
                    -s * rate
                }
            })
            .store(&mut stop.dissipation);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::tests::{AT, joint};
    use super::*;
    use crate::tool::JointKind;

    #[test]
    fn the_angle_past_the_limit_is_that_of_the_arc_tangent() {
        let law = joint(JointKind::Universal).law;
        let (mut by_series, mut by_arc_tangent) = (0, 0);
        for step in 1..=400 {
            let beyond = 0.001 * f64::from(step);
            let angle: f64 = law.limit + beyond;
            let got = law.angle_past_limit(angle.sin(), angle.cos());
            // Rounding of an angle of at most 0.5 rad, of its sine and cosine, and of their four products.
            assert!((got - beyond).abs() < 4e-16, "{got} against {beyond}");
            assert!(law.angle_past_limit((law.limit - beyond).sin(), (law.limit - beyond).cos()) < 0.0);
            if beyond.sin() < LARGEST_SINE {
                by_series += 1;
            } else {
                by_arc_tangent += 1;
            }
        }
        assert!(by_series > 100 && by_arc_tangent > 100, "{by_series}, {by_arc_tangent}");
    }

    #[test]
    fn a_stop_that_opens_too_fast_does_not_pull() {
        let law = joint(JointKind::Universal).law;
        let opening = [0.0, -30.0, 0.0, 0.0, 30.0, 0.0];
        let mut stop = Stop::default();
        assert!(law.stop(&AT, &opening, &mut stop));
        assert_eq!((stop.moment, stop.stiffness, stop.damping), (0.0, 0.0, 0.0));
        assert!(stop.energy > 0.0 && stop.dissipation > 0.0);
        assert!(!law.stop(&[0.0; 6], &opening, &mut stop));
    }
}
