//! Universal and ball-cage joints eight at a time: the same formulas as [`crate::elements::joint`], over [`Eight`].

use std::f64::consts::FRAC_PI_2;

use crate::elements::joint::{Joint, product};
use crate::elements::rotation::{shaft_axis, shaft_direction, transverse_axis};
use crate::simd::number::{Eight, Number};
use crate::simd::vector::Vector;
use crate::tool::description::JointKind;

/// A value per joint of a group.
pub type Lane = [f64; 8];

/// Up to eight joints next to each other, as given and as linearised last. Lanes without a joint repeat the last one.
#[derive(Debug, Clone)]
pub struct JointGroup {
    kind: JointKind,
    /// E_a^T E_b by rows.
    relative: [[Lane; 3]; 3],
    phase: Lane,
    limit: Lane,
    limit_cosine: Lane,
    stop_stiffness: f64,
    stop_damping: f64,
    /// Rotational row: value and derivatives.
    pub row: Lane,
    /// d row / d (psi_a, phi_ya, phi_za, psi_b, phi_yb, phi_zb).
    pub gradient: [Lane; 6],
    hessian: [[Lane; 6]; 6],
    /// Whether some stop is shut; where not, the stops' values are not kept up.
    shut: bool,
    angle_gradient: [Lane; 6],
    angle_hessian: [[Lane; 6]; 6],
    rate: [Lane; 6],
    /// Stop: k (1 + c angle') and k over c, zero where the stop is open.
    stiffness: Lane,
    damping: Lane,
    /// Stop's moment (N m, >= 0).
    pub moment: Lane,
    /// Energy in the stop's spring (J).
    pub energy: Lane,
    /// Power taken by the stop's damping (W).
    pub dissipation: Lane,
}

impl JointGroup {
    /// Whether joints of this kind can be taken eight at a time.
    pub fn takes(kind: JointKind) -> bool {
        matches!(kind, JointKind::Universal | JointKind::BallCage)
    }

    /// Of up to eight joints; there is at least one.
    pub fn of(joints: &[Joint]) -> Self {
        let at = |lane: usize| &joints[lane.min(joints.len() - 1)];
        let each = |value: &dyn Fn(&Joint) -> f64| std::array::from_fn(|lane| value(at(lane)));
        let zero = [0.0; 8];
        Self {
            kind: at(0).kind,
            relative: std::array::from_fn(|i| std::array::from_fn(|j| each(&|joint| joint.relative[(i, j)]))),
            phase: each(&|joint| joint.phase),
            limit: each(&|joint| joint.limit),
            limit_cosine: each(&|joint| libm::cos(joint.limit)),
            stop_stiffness: at(0).stop_stiffness,
            stop_damping: at(0).stop_damping,
            row: zero,
            gradient: [zero; 6],
            hessian: [[zero; 6]; 6],
            shut: false,
            angle_gradient: [zero; 6],
            angle_hessian: [[zero; 6]; 6],
            rate: [zero; 6],
            stiffness: zero,
            damping: zero,
            moment: zero,
            energy: zero,
            dissipation: zero,
        }
    }

    /// Linearises row and stop at rotations `q` and rates `rate`; returns the moments that the joints must balance for multipliers (times
    /// scale) `lambda` (N m).
    #[inline(always)]
    pub fn evaluate<V: Vector>(&mut self, q: &[Lane; 6], rate: &[Lane; 6], lambda: &Lane) -> [Lane; 6] {
        let mut x = [Eight::<V>::of(0.0); 6];
        for (x, q) in x.iter_mut().zip(q) {
            *x = Eight::load(q);
        }
        self.rate = *rate;
        let mut relative = [[Eight::<V>::of(0.0); 3]; 3];
        for (to, from) in relative.iter_mut().zip(&self.relative) {
            for (to, from) in to.iter_mut().zip(from) {
                *to = Eight::load(from);
            }
        }
        match self.kind {
            JointKind::BallCage => {
                (x[0] - x[3]).store(&mut self.row);
                self.gradient[0] = [1.0; 8];
                self.gradient[3] = [-1.0; 8];
            }
            JointKind::Universal | JointKind::Revolute => {
                let phase = Eight::<V>::load(&self.phase);
                let a_z = transverse_axis((x[0] + phase + Eight::of(FRAC_PI_2)).sin_cos(), x[1], x[2]);
                let a_y = transverse_axis((x[3] + phase).sin_cos(), x[4], x[5]);
                let row = product(&a_z, &relative, &a_y);
                row.value.store(&mut self.row);
                for k in 0..6 {
                    row.gradient[k].store(&mut self.gradient[k]);
                    for l in 0..6 {
                        row.hessian[k][l].store(&mut self.hessian[k][l]);
                    }
                }
            }
        }
        let lambda = Eight::<V>::load(lambda);
        let mut moments = [[0.0; 8]; 6];
        for (moment, gradient) in moments.iter_mut().zip(&self.gradient) {
            (Eight::<V>::load(gradient) * lambda).store(moment);
        }
        self.stop::<V>(&x, &relative);
        if self.shut {
            let stop = Eight::<V>::load(&self.moment);
            for (moment, gradient) in moments.iter_mut().zip(&self.angle_gradient) {
                (Eight::<V>::load(moment) + Eight::load(gradient) * stop).store(moment);
            }
        }
        moments
    }

    #[inline(always)]
    fn stop<V: Vector>(&mut self, x: &[Eight<V>; 6], relative: &[[Eight<V>; 3]; 3]) {
        let upper = shaft_direction(x[1], x[2]);
        let below = shaft_direction(x[4], x[5]);
        let mut lower = [Eight::<V>::of(0.0); 3];
        for (lower, row) in lower.iter_mut().zip(relative) {
            *lower = row[0] * below[0] + row[1] * below[1] + row[2] * below[2];
        }
        let mut cosine = [0.0; 8];
        (upper[0] * lower[0] + upper[1] * lower[1] + upper[2] * lower[2]).store(&mut cosine);
        let was_shut = self.shut;
        self.shut = false;
        for (cosine, limit) in cosine.iter().zip(&self.limit_cosine) {
            self.shut |= cosine < limit;
        }
        if !self.shut {
            if was_shut {
                (self.moment, self.energy, self.dissipation) = ([0.0; 8], [0.0; 8], [0.0; 8]);
            }
            return;
        }
        let (mut sine, mut spring, mut inverse, mut ratio) = ([0.0; 8], [0.0; 8], [0.0; 8], [0.0; 8]);
        let across = [
            upper[1] * lower[2] - upper[2] * lower[1],
            upper[2] * lower[0] - upper[0] * lower[2],
            upper[0] * lower[1] - upper[1] * lower[0],
        ];
        (across[0] * across[0] + across[1] * across[1] + across[2] * across[2]).store(&mut sine);
        for lane in 0..8 {
            let sine = sine[lane].sqrt();
            let over = libm::atan2(sine, cosine[lane]) - self.limit[lane];
            if over > 0.0 {
                spring[lane] = self.stop_stiffness * over;
                self.energy[lane] = 0.5 * spring[lane] * over;
                inverse[lane] = 1.0 / sine;
                ratio[lane] = cosine[lane] * inverse[lane];
            } else {
                self.energy[lane] = 0.0;
            }
        }
        // cos(angle) is smooth in the rotations; the angle follows from it by the chain rule.
        let cosine = product(&shaft_axis(x[1], x[2]), relative, &shaft_axis(x[4], x[5]));
        let (inverse, ratio) = (Eight::<V>::load(&inverse), Eight::<V>::load(&ratio));
        let mut gradient = cosine.gradient;
        let mut angle_rate = Eight::<V>::of(0.0);
        for ((gradient, kept), rate) in gradient.iter_mut().zip(&mut self.angle_gradient).zip(&self.rate) {
            *gradient = -(*gradient * inverse);
            gradient.store(kept);
            angle_rate = angle_rate + *gradient * Eight::load(rate);
        }
        for k in 0..6 {
            for l in 0..6 {
                let bent = gradient[k] * gradient[l] * ratio;
                (-(cosine.hessian[k][l] * inverse) - bent).store(&mut self.angle_hessian[k][l]);
            }
        }
        let mut rates = [0.0; 8];
        angle_rate.store(&mut rates);
        for lane in 0..8 {
            let viscous = 1.0 + self.stop_damping * rates[lane];
            let by_rate = spring[lane] * self.stop_damping;
            if spring[lane] > 0.0 && viscous > 0.0 {
                self.moment[lane] = spring[lane] * viscous;
                self.stiffness[lane] = self.stop_stiffness * viscous;
                self.damping[lane] = by_rate;
                self.dissipation[lane] = by_rate * rates[lane] * rates[lane];
            } else {
                // Open, or opening faster than the law can push: no moment, the spring's energy goes into its damping.
                (self.moment[lane], self.stiffness[lane], self.damping[lane]) = (0.0, 0.0, 0.0);
                self.dissipation[lane] = -spring[lane] * rates[lane];
            }
        }
    }

    /// Derivative of the moments in the rotations, by columns, with factors on stiffness and damping and multipliers (times scale) `lambda`.
    #[inline(always)]
    pub fn tangent<V: Vector>(&self, lambda: &Lane, stiffness: f64, damping: f64, out: &mut [[Lane; 6]; 6]) {
        let lambda = Eight::<V>::load(lambda) * Eight::of(stiffness);
        for (out, hessian) in out.iter_mut().zip(&self.hessian) {
            for (out, hessian) in out.iter_mut().zip(hessian) {
                (Eight::<V>::load(hessian) * lambda).store(out);
            }
        }
        if !self.shut {
            return;
        }
        let stop = [
            Eight::<V>::load(&self.stiffness),
            Eight::load(&self.damping),
            Eight::load(&self.moment),
        ];
        let zero = Eight::<V>::of(0.0);
        let (mut gradient, mut rate) = ([zero; 6], [zero; 6]);
        for k in 0..6 {
            gradient[k] = Eight::load(&self.angle_gradient[k]);
            rate[k] = Eight::load(&self.rate[k]);
        }
        let (stiff, damped) = (Eight::of(stiffness), Eight::of(damping));
        for l in 0..6 {
            // d moment / d q_l = k (1 + c angle') g_l + k over c (H rate)_l, and with the rates k over c g_l.
            let mut turned = zero;
            for (hessian, &rate) in self.angle_hessian[l].iter().zip(&rate) {
                turned = turned + Eight::load(hessian) * rate;
            }
            let slope = (stop[0] * gradient[l] + stop[1] * turned) * stiff + stop[1] * gradient[l] * damped;
            for k in 0..6 {
                let curved = Eight::load(&self.angle_hessian[l][k]) * stop[2] * stiff;
                (Eight::<V>::load(&out[l][k]) + gradient[k] * slope + curved).store(&mut out[l][k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::joint::JointVector;
    use crate::simd::vector::Portable;
    use crate::tool::description::JointDescription;
    use nalgebra::{Matrix3, Rotation3, Vector3};

    #[test]
    fn eight_joints_are_eight_times_one() {
        for kind in [JointKind::Universal, JointKind::BallCage] {
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
            // Five joints, so that three lanes have none; at three of them the stop is shut, at one it opens too fast to push.
            let joints: Vec<Joint> = (0..5)
                .map(|j| Joint::new(&description, j, Matrix3::identity(), turn))
                .collect();
            let at = |k: usize, lane: usize| {
                let lane = lane.min(4);
                let bend = if lane < 3 { 0.08 } else { 0.01 };
                [0.7 * lane as f64, bend, 0.01, 0.71 * lane as f64, -bend, 0.02][k]
            };
            let rates = |k: usize, lane: usize| {
                let fast = if lane == 1 { -30.0 } else { 0.3 };
                [4.0, fast, 0.1, 4.1, -0.2, 0.05][k]
            };
            let q: [Lane; 6] = std::array::from_fn(|k| std::array::from_fn(|lane| at(k, lane)));
            let rate: [Lane; 6] = std::array::from_fn(|k| std::array::from_fn(|lane| rates(k, lane)));
            let lambda: Lane = std::array::from_fn(|lane| 50.0 - 10.0 * lane as f64);
            let mut group = JointGroup::of(&joints);
            let moments = group.evaluate::<Portable>(&q, &rate, &lambda);
            let mut tangent = [[[0.0; 8]; 6]; 6];
            group.tangent::<Portable>(&lambda, 1.0, 700.0, &mut tangent);
            for (lane, joint) in joints.iter().enumerate() {
                let q = JointVector::from_fn(|k, _| at(k, lane));
                let rate = JointVector::from_fn(|k, _| rates(k, lane));
                let (row, stop) = (joint.rows(&q)[0], joint.stop(&q, &rate));
                assert_eq!(stop.energy > 0.0, lane < 3);
                assert_eq!(stop.moment > 0.0, lane < 3 && lane != 1);
                let moment = row.gradient * lambda[lane] + stop.force;
                let m = row.hessian * lambda[lane] + stop.stiffness + stop.damping * 700.0;
                // Rounding of some hundred operations; sine and cosine to two units in the last place.
                let near = |x: f64, y: f64, scale: f64| assert!((x - y).abs() < 1e-12 * scale, "joint {lane}: {x} {y}");
                near(group.row[lane], row.value, 1.0);
                near(group.moment[lane], stop.moment, stop.moment + 1.0);
                near(group.energy[lane], stop.energy, stop.energy + 1.0);
                near(group.dissipation[lane], stop.dissipation, stop.dissipation.abs() + 1.0);
                for k in 0..6 {
                    near(group.gradient[k][lane], row.gradient[k], 1.0);
                    near(moments[k][lane], moment[k], moment.amax() + 1.0);
                    for l in 0..6 {
                        near(tangent[l][k][lane], m[(k, l)], m.amax() + 1.0);
                    }
                }
            }
        }
    }
}
