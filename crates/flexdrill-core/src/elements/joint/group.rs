//! Joints eight at a time: [`super::law`] over eight lanes, with what was linearised last kept in memory.

use super::Joint;
use super::law::{JointLaw, RotationFunction, Stop, moments, tangent};
use crate::simd::number::Eight;
use crate::simd::vector::Vector;

/// A value per joint of a group.
pub type Lane = [f64; 8];

/// Up to eight joints next to each other, as given and as linearised last. Lanes without a joint repeat the last one.
#[derive(Debug, Clone)]
pub struct JointGroup {
    law: JointLaw<Lane>,
    /// Rotational rows; the second belongs to joints that have two.
    rows: [RotationFunction<Lane>; 2],
    /// How many.
    count: usize,
    stop: Stop<Lane>,
    /// Whether some stop is shut; where not, the stop's derivatives are not kept up.
    shut: bool,
    rate: [Lane; 6],
}

const ZERO: RotationFunction<Lane> = RotationFunction {
    value: [0.0; 8],
    gradient: [[0.0; 8]; 6],
    hessian: [[[0.0; 8]; 6]; 6],
};

const OPEN: Stop<Lane> = Stop {
    moment: [0.0; 8],
    stiffness: [0.0; 8],
    damping: [0.0; 8],
    energy: [0.0; 8],
    dissipation: [0.0; 8],
    gradient: [[0.0; 8]; 6],
    hessian: [[[0.0; 8]; 6]; 6],
};

impl JointGroup {
    /// Of up to eight joints of one kind; there is at least one.
    pub fn of(joints: &[Joint]) -> Self {
        let at = |lane: usize| &joints[lane.min(joints.len() - 1)].law;
        let each = |value: &dyn Fn(&JointLaw<f64>) -> f64| std::array::from_fn(|lane| value(at(lane)));
        Self {
            law: JointLaw {
                kind: at(0).kind,
                relative: std::array::from_fn(|i| std::array::from_fn(|j| each(&|law| law.relative[i][j]))),
                phase: each(&|law| law.phase),
                hinge_cosine: each(&|law| law.hinge_cosine),
                limit: each(&|law| law.limit),
                limit_cosine: each(&|law| law.limit_cosine),
                stop_stiffness: at(0).stop_stiffness,
                stop_damping: at(0).stop_damping,
            },
            rows: [ZERO; 2],
            count: Joint::rotational_rows(at(0).kind),
            stop: OPEN,
            shut: false,
            rate: [[0.0; 8]; 6],
        }
    }

    /// Rotational rows.
    pub fn rows(&self) -> &[RotationFunction<Lane>] {
        &self.rows[..self.count]
    }

    /// The stops' moments, energies and powers; their derivatives only where one is shut.
    pub fn stop(&self) -> &Stop<Lane> {
        &self.stop
    }

    /// Linearises rows and stops at rotations `q` and rates `rate`; returns the moments that the joints must balance (N m) for `lambda`,
    /// the multipliers of the rows times their scale (N m).
    #[inline(always)]
    pub fn evaluate<V: Vector>(&mut self, q: &[Lane; 6], rate: &[Lane; 6], lambda: &[Lane; 2]) -> [Lane; 6] {
        self.rate = *rate;
        let law = self.law.load::<V>();
        let q: [Eight<V>; 6] = load(q);
        let rows = law.rows(&q);
        for (to, from) in self.rows.iter_mut().zip(&rows).take(self.count) {
            from.store(to);
        }
        let stop = if law.has_stop() {
            law.stop(&q, &load(rate))
        } else {
            None
        };
        match &stop {
            Some(stop) => stop.store(&mut self.stop),
            None if self.shut => {
                (self.stop.moment, self.stop.energy, self.stop.dissipation) = ([0.0; 8], [0.0; 8], [0.0; 8]);
            }
            None => {}
        }
        self.shut = stop.is_some();
        let lambda: [Eight<V>; 2] = load(lambda);
        let mut out = [[0.0; 8]; 6];
        for (to, from) in out
            .iter_mut()
            .zip(moments(&rows[..self.count], &lambda[..self.count], stop.as_ref()))
        {
            from.store(to);
        }
        out
    }

    /// Derivative of the moments in rotations and rates, by columns; see [`tangent`].
    #[inline(always)]
    pub fn tangent<V: Vector>(&self, lambda: &[Lane; 2], stiffness: f64, damping: f64, out: &mut [[Lane; 6]; 6]) {
        let lambda: [Eight<V>; 2] = load(lambda);
        let rows = [self.rows[0].load::<V>(), self.rows[1].load::<V>()];
        let (stop, rate) = (self.stop.load::<V>(), load(&self.rate));
        let stop = self.shut.then_some((&stop, &rate));
        let made = tangent(&rows[..self.count], &lambda[..self.count], stop, stiffness, damping);
        for (out, made) in out.iter_mut().zip(made) {
            for (to, from) in out.iter_mut().zip(made) {
                from.store(to);
            }
        }
    }
}

#[inline(always)]
fn load<V: Vector, const N: usize>(from: &[Lane; N]) -> [Eight<V>; N] {
    let mut out = [Eight(V::splat(0.0)); N];
    for (to, from) in out.iter_mut().zip(from) {
        *to = Eight::load(from);
    }
    out
}

#[inline(always)]
fn load_square<V: Vector, const N: usize>(from: &[[Lane; N]; N]) -> [[Eight<V>; N]; N] {
    let mut out = [[Eight(V::splat(0.0)); N]; N];
    for (to, from) in out.iter_mut().zip(from) {
        *to = load(from);
    }
    out
}

#[inline(always)]
fn store<V: Vector, const N: usize>(from: &[Eight<V>; N], to: &mut [Lane; N]) {
    for (from, to) in from.iter().zip(to) {
        from.store(to);
    }
}

impl JointLaw<Lane> {
    #[inline(always)]
    fn load<V: Vector>(&self) -> JointLaw<Eight<V>> {
        JointLaw {
            kind: self.kind,
            relative: load_square(&self.relative),
            phase: Eight::load(&self.phase),
            hinge_cosine: Eight::load(&self.hinge_cosine),
            limit: Eight::load(&self.limit),
            limit_cosine: Eight::load(&self.limit_cosine),
            stop_stiffness: self.stop_stiffness,
            stop_damping: self.stop_damping,
        }
    }
}

impl RotationFunction<Lane> {
    #[inline(always)]
    fn load<V: Vector>(&self) -> RotationFunction<Eight<V>> {
        RotationFunction {
            value: Eight::load(&self.value),
            gradient: load(&self.gradient),
            hessian: load_square(&self.hessian),
        }
    }
}

impl<V: Vector> RotationFunction<Eight<V>> {
    #[inline(always)]
    fn store(&self, to: &mut RotationFunction<Lane>) {
        self.value.store(&mut to.value);
        store(&self.gradient, &mut to.gradient);
        for (from, to) in self.hessian.iter().zip(&mut to.hessian) {
            store(from, to);
        }
    }
}

impl Stop<Lane> {
    #[inline(always)]
    fn load<V: Vector>(&self) -> Stop<Eight<V>> {
        Stop {
            moment: Eight::load(&self.moment),
            stiffness: Eight::load(&self.stiffness),
            damping: Eight::load(&self.damping),
            energy: Eight::load(&self.energy),
            dissipation: Eight::load(&self.dissipation),
            gradient: load(&self.gradient),
            hessian: load_square(&self.hessian),
        }
    }
}

impl<V: Vector> Stop<Eight<V>> {
    #[inline(always)]
    fn store(&self, to: &mut Stop<Lane>) {
        self.moment.store(&mut to.moment);
        self.stiffness.store(&mut to.stiffness);
        self.damping.store(&mut to.damping);
        self.energy.store(&mut to.energy);
        self.dissipation.store(&mut to.dissipation);
        store(&self.gradient, &mut to.gradient);
        for (from, to) in self.hessian.iter().zip(&mut to.hessian) {
            store(from, to);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::*;
    use crate::simd::vector::Portable;
    use crate::tool::description::{JointDescription, JointKind};

    #[test]
    fn eight_joints_are_eight_times_one() {
        for kind in [JointKind::Universal, JointKind::BallCage, JointKind::Revolute] {
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
            let lambda: [Lane; 2] =
                std::array::from_fn(|row| std::array::from_fn(|lane| 50.0 - 10.0 * lane as f64 + 7.0 * row as f64));
            let mut group = JointGroup::of(&joints);
            let got = group.evaluate::<Portable>(&q, &rate, &lambda);
            let mut derivative = [[[0.0; 8]; 6]; 6];
            group.tangent::<Portable>(&lambda, 1.0, 700.0, &mut derivative);
            let count = group.rows().len();
            for (lane, joint) in joints.iter().enumerate() {
                let q = std::array::from_fn(|k| at(k, lane));
                let rate = std::array::from_fn(|k| rates(k, lane));
                let lambda = [lambda[0][lane], lambda[1][lane]];
                let rows = joint.law.rows(&q);
                let stop = if joint.law.has_stop() {
                    joint.law.stop(&q, &rate)
                } else {
                    None
                };
                assert_eq!(stop.is_some(), lane < 3 && kind != JointKind::Revolute);
                assert_eq!(stop.is_some_and(|stop| stop.moment > 0.0), stop.is_some() && lane != 1);
                let moment = moments(&rows[..count], &lambda, stop.as_ref());
                let m = tangent(&rows[..count], &lambda, stop.as_ref().map(|s| (s, &rate)), 1.0, 700.0);
                // Rounding of some hundred operations; sine and cosine to two units in the last place.
                let near = |x: f64, y: f64, scale: f64| assert!((x - y).abs() < 1e-12 * scale, "joint {lane}: {x} {y}");
                let largest = |x: &[f64]| x.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
                let (shut, kept) = (
                    stop.map_or([0.0; 3], |s| [s.moment, s.energy, s.dissipation]),
                    group.stop(),
                );
                for (x, y) in [kept.moment, kept.energy, kept.dissipation].iter().zip(shut) {
                    near(x[lane], y, y.abs() + 1.0);
                }
                for (row, one) in group.rows().iter().zip(&rows) {
                    near(row.value[lane], one.value, 1.0);
                    (0..6).for_each(|k| near(row.gradient[k][lane], one.gradient[k], 1.0));
                }
                for k in 0..6 {
                    near(got[k][lane], moment[k], largest(&moment));
                    for l in 0..6 {
                        near(derivative[l][k][lane], m[l][k], largest(m.as_flattened()));
                    }
                }
            }
        }
    }
}
