//! Joints eight at a time: [`super::law`] over eight lanes. The last linearisation stays in memory for the tangent.

use super::friction::{AxisFriction, PinMemory};
use super::law::{JointLaw, RotationFunction, tangent};
use super::play::Play;
use super::stop::Stop;
use super::{Joint, Rotations};
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::number::{Eight, Lane, Number};
use crate::simd::vector::Vector;

/// Up to eight neighbouring joints with their last linearisation. Lanes without a joint repeat the last joint.
#[derive(Debug, Clone)]
pub struct JointGroup {
    law: JointLaw<Lane>,
    /// Rotational rows; the second belongs to joints that have two.
    rows: [RotationFunction<Lane>; 2],
    /// Rotational rows per joint.
    count: usize,
    /// Torque of the rows that are contacts with play.
    play: Play<Lane>,
    /// Friction about both axes of the crosses.
    pins: [AxisFriction<Lane>; 2],
    memory: PinMemory,
    stop: Stop<Lane>,
    /// Whether some stop is shut; if none is, the derivatives in `stop` are out of date.
    shut: bool,
    rate: [Lane; 6],
}

impl JointGroup {
    /// A group of one to eight joints of one kind.
    pub fn of(joints: &[Joint]) -> Self {
        let at = |lane: usize| &joints[lane.min(joints.len() - 1)].law;
        let each = |value: &dyn Fn(&JointLaw<f64>) -> f64| Aligned(std::array::from_fn(|lane| value(at(lane))));
        Self {
            law: JointLaw {
                kind: at(0).kind,
                relative: std::array::from_fn(|i| std::array::from_fn(|j| each(&|law| law.relative[i][j]))),
                phase: each(&|law| law.phase),
                hinge_cosine: each(&|law| law.hinge_cosine),
                limit: each(&|law| law.limit),
                limit_cosine: each(&|law| law.limit_cosine),
                limit_sine: each(&|law| law.limit_sine),
                stop_stiffness: at(0).stop_stiffness,
                stop_damping: at(0).stop_damping,
                friction: at(0).friction,
                play: at(0).play,
            },
            rows: Default::default(),
            count: Joint::rotational_rows(at(0).kind),
            play: Play::default(),
            pins: Default::default(),
            memory: PinMemory::default(),
            stop: Stop::default(),
            shut: false,
            rate: [Lane::default(); 6],
        }
    }

    /// The rotational rows as linearised last: one, or two for revolute joints.
    pub fn rows(&self) -> &[RotationFunction<Lane>] {
        &self.rows[..self.count]
    }

    /// Moments, energies and powers of the stops; their derivatives are valid only if one is shut.
    pub fn stop(&self) -> &Stop<Lane> {
        &self.stop
    }

    /// Whether the rows are contacts with play instead of constraints.
    pub fn has_play(&self) -> bool {
        self.law.has_play()
    }

    /// The torque of rows with play.
    pub fn play(&self) -> &Play<Lane> {
        &self.play
    }

    /// Whether the pins have friction.
    pub fn has_friction(&self) -> bool {
        self.law.friction.coefficient > 0.0
    }

    /// Friction of the pins about both axes of the cross; zero without friction.
    pub fn pins(&self) -> &[AxisFriction<Lane>; 2] {
        &self.pins
    }

    /// Forgets what the corrections of the step before learned of friction.
    pub fn begin(&mut self) {
        self.memory.begin();
    }

    /// Moments on the six rotations of play and friction of the joint in `lane` (N m); `None` where there is neither.
    #[inline(always)]
    pub fn further_moments(&self, lane: usize) -> Option<Rotations> {
        if !self.has_play() && !self.has_friction() {
            return None;
        }
        let mut out = [0.0; 6];
        if self.has_play() {
            let multiplier = self.play.multiplier[lane];
            (0..6).for_each(|k| out[k] = self.rows[0].gradient[k][lane] * multiplier);
        }
        if self.has_friction() {
            for axis in &self.pins {
                (0..6).for_each(|k| out[k] += axis.gradient[k][lane] * axis.slip.friction[lane]);
            }
        }
        Some(out)
    }

    /// Linearises rows, stops, play and friction at rotations `q` and rates `rate`, where slipping pins of an axis resist with
    /// the moment `full` (N m).
    #[inline(always)]
    pub fn linearise<V: Vector>(&mut self, q: &[Lane; 6], rate: &[Lane; 6], full: &Lane) {
        V::call(Linearise {
            group: self,
            q,
            rate,
            full,
        });
    }

    /// The stops at the last linearisation, if one of them is shut.
    pub fn shut_stop(&self) -> Option<&Stop<Lane>> {
        self.shut.then_some(&self.stop)
    }

    /// Derivative of the moments in rotations and rates, by columns; see [`tangent`].
    #[inline(always)]
    pub fn tangent<V: Vector>(&self, lambda: &[Lane; 2], stiffness: f64, damping: f64, out: &mut [[Lane; 6]; 6]) {
        V::call(Derive {
            group: self,
            lambda,
            stiffness,
            damping,
            out,
        });
    }
}

/// [`JointGroup::linearise`] for one kind of vectors.
struct Linearise<'a> {
    group: &'a mut JointGroup,
    q: &'a [Lane; 6],
    rate: &'a [Lane; 6],
    full: &'a Lane,
}

impl Kernel for Linearise<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { group, q, rate, full } = self;
        group.rate = *rate;
        let (q, rate): ([Eight<V>; 6], [Eight<V>; 6]) = (load(q), load(rate));
        group.law.rows(&q, &mut group.rows);
        // An open stop leaves `stop` unchanged, so the values of a stop that has just opened are cleared here.
        let was_shut = group.shut;
        group.shut = group.law.has_stop() && group.law.stop(&q, &rate, &mut group.stop);
        if was_shut && !group.shut {
            (group.stop.moment, group.stop.energy, group.stop.dissipation) = Default::default();
        }
        if group.law.has_play() {
            group.law.play(&group.rows[0], &rate, &mut group.play);
        }
        if group.law.friction.coefficient > 0.0 {
            let pins = &mut group.pins;
            group.law.friction(&q, &rate, Eight::<V>::load(full), pins);
            group.memory.follow(full, group.law.friction.slip_rate, pins);
        }
    }
}

/// [`JointGroup::tangent`] for one kind of vectors.
struct Derive<'a> {
    group: &'a JointGroup,
    lambda: &'a [Lane; 2],
    stiffness: f64,
    damping: f64,
    out: &'a mut [[Lane; 6]; 6],
}

impl Kernel for Derive<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { group, lambda, out, .. } = self;
        let mut lambda = load::<V, 2>(lambda);
        if group.has_play() {
            lambda[0] = Eight::load(&group.play.multiplier);
        }
        let stop = group.shut.then_some((&group.stop, &group.rate));
        let rows = &group.rows[..group.count];
        tangent(rows, &lambda[..group.count], stop, self.stiffness, self.damping, out);
        if group.has_play() {
            let play = &group.play;
            play.add_tangent::<Eight<V>>(&group.rows[0], &group.rate, self.stiffness, self.damping, out);
        }
        if group.has_friction() {
            for axis in &group.pins {
                axis.add_tangent::<Eight<V>>(&group.rate, self.stiffness, self.damping, out);
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

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::super::law::moments;
    use super::*;
    use crate::simd::vector::Portable;
    use crate::tool::{JointDescription, JointKind};

    #[test]
    fn eight_joints_are_eight_times_one() {
        for kind in [JointKind::Universal, JointKind::BallCage, JointKind::Revolute] {
            let mut description = JointDescription::new(kind, 0.1);
            description.cross_phase = 0.2;
            let turn = *Rotation3::from_axis_angle(&Vector3::y_axis(), 0.047).matrix();
            // Five joints, so that three lanes have none; at three of them the stop is shut, at one it opens too fast
            // to push.
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
            let q: [Lane; 6] = std::array::from_fn(|k| Aligned(std::array::from_fn(|lane| at(k, lane))));
            let rate: [Lane; 6] = std::array::from_fn(|k| Aligned(std::array::from_fn(|lane| rates(k, lane))));
            let lambda: [Lane; 2] = std::array::from_fn(|row| {
                Aligned(std::array::from_fn(|lane| 50.0 - 10.0 * lane as f64 + 7.0 * row as f64))
            });
            let mut group = JointGroup::of(&joints);
            group.linearise::<Portable>(&q, &rate, &Lane::default());
            let got: [Lane; 6] = std::array::from_fn(|k| {
                let of_rows = |lane: usize| -> f64 {
                    let rows = group.rows().iter().zip(&lambda);
                    rows.map(|(row, lambda)| row.gradient[k][lane] * lambda[lane]).sum()
                };
                let of_stop = |lane: usize| {
                    group
                        .shut_stop()
                        .map_or(0.0, |stop| stop.gradient[k][lane] * stop.moment[lane])
                };
                Aligned(std::array::from_fn(|lane| of_rows(lane) + of_stop(lane)))
            });
            let mut derivative = [[Lane::default(); 6]; 6];
            group.tangent::<Portable>(&lambda, 1.0, 700.0, &mut derivative);
            let count = group.rows().len();
            for (lane, joint) in joints.iter().enumerate() {
                let q = std::array::from_fn(|k| at(k, lane));
                let rate = std::array::from_fn(|k| rates(k, lane));
                let lambda = [lambda[0][lane], lambda[1][lane]];
                let (mut rows, mut stop) = <([_; 2], _)>::default();
                joint.law.rows(&q, &mut rows);
                let shut = joint.law.has_stop() && joint.law.stop(&q, &rate, &mut stop);
                assert_eq!(shut, lane < 3 && kind != JointKind::Revolute);
                assert_eq!(stop.moment > 0.0, shut && lane != 1);
                let (mut moment, mut m) = ([0.0; 6], [[0.0; 6]; 6]);
                moments(&rows[..count], &lambda, shut.then_some(&stop), &mut moment);
                let with_rate = shut.then_some((&stop, &rate));
                tangent(&rows[..count], &lambda, with_rate, 1.0, 700.0, &mut m);
                // Rounding of some hundred operations; sine and cosine to two units in the last place.
                let near = |x: f64, y: f64, scale: f64| assert!((x - y).abs() < 1e-12 * scale, "joint {lane}: {x} {y}");
                let largest = |x: &[f64]| x.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
                let (one, kept) = ([stop.moment, stop.energy, stop.dissipation], group.stop());
                for (x, y) in [kept.moment, kept.energy, kept.dissipation].iter().zip(one) {
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
