//! Rotational rows (Eq. 13), stops, play and pin friction of all joints, eight joints at a time.

#[cfg(test)]
mod one_by_one;

use crate::dynamics::state::State;
use crate::elements::factors::TangentFactors;
use crate::elements::joint::group::JointGroup;
use crate::model::{JointPlaces, Model};
use crate::simd::number::Lane;
use crate::simd::vector::Vector;
use crate::simd::{Instructions, Kernel};

/// The joints of a tool as linearised by the last residual.
#[derive(Clone)]
pub struct Joints {
    /// Eight joints each, from the top.
    groups: Vec<JointGroup>,
    /// Number of joints: the last group may have lanes without one.
    count: usize,
    instructions: Instructions,
}

impl Joints {
    pub(crate) fn new(model: &Model, instructions: Instructions) -> Self {
        Self {
            groups: model.joints.chunks(8).map(JointGroup::of).collect(),
            count: model.joints.len(),
            instructions,
        }
    }

    /// Forgets what the corrections of the step before learned of friction.
    pub(crate) fn begin(&mut self) {
        self.groups.iter_mut().for_each(JointGroup::begin);
    }

    /// Hands the tangent of every joint that is `wanted` with its number to `visit`; `lambda` gives the multipliers (N m)
    /// of its rows.
    pub(crate) fn tangents(
        &self,
        factors: TangentFactors,
        lambda: impl Fn(usize) -> [f64; 2],
        wanted: impl Fn(usize) -> bool,
        visit: impl FnMut(usize, &JointTangent<'_>),
    ) {
        self.instructions.run(JointTangents {
            groups: &self.groups,
            joints: self.count,
            factors,
            lambda,
            wanted,
            visit,
        });
    }

    /// The joints, eight at a time from the top, for a caller that linearises them itself.
    pub(crate) fn groups_mut(&mut self) -> &mut [JointGroup] {
        &mut self.groups
    }

    /// Moment (N m, >= 0), energy (J) and power of the damping (W) of the stop of each joint.
    pub fn stops(&self) -> impl Iterator<Item = StopReport> + '_ {
        let groups = self.groups.iter().map(JointGroup::stop);
        let stops = groups.flat_map(|stop| (0..8).map(move |lane| (stop, lane)));
        stops.take(self.count).map(|(stop, lane)| StopReport {
            moment: stop.moment[lane],
            energy: stop.energy[lane],
            dissipation: stop.dissipation[lane],
        })
    }

    /// Energy (J) and power of the damping (W) of the play of each joint, if there is play.
    pub(crate) fn plays(&self) -> impl Iterator<Item = PlayReport> + '_ {
        let groups = self
            .groups
            .iter()
            .filter(|group| group.has_play())
            .map(JointGroup::play);
        let plays = groups.flat_map(|play| (0..8).map(move |lane| (play, lane)));
        plays.take(self.count).map(|(play, lane)| PlayReport {
            multiplier: play.multiplier[lane],
            energy: play.energy[lane],
            dissipation: play.dissipation[lane],
        })
    }

    /// Moments of the pins' friction on the six rotations of each joint (N m), against the motion, and the power that they
    /// take (W), if there is friction.
    pub(crate) fn frictions(&self) -> impl Iterator<Item = ([f64; 6], f64)> + '_ {
        let groups = self.groups.iter().filter(|group| group.has_friction());
        let pins = groups.flat_map(|group| (0..8).map(move |lane| (group.pins(), lane)));
        pins.take(self.count).map(|(axes, lane)| {
            let mut moments = [0.0; 6];
            let mut power = 0.0;
            for axis in axes {
                let moment = axis.slip.friction[lane];
                power += moment * axis.slip.speed[lane];
                (0..6).for_each(|k| moments[k] -= axis.gradient[k][lane] * moment);
            }
            (moments, power)
        })
    }

    /// Gradient of rotational row `row` of a joint, in (psi_a, phi_ya, phi_za, psi_b, phi_yb, phi_zb).
    pub fn row_gradient(&self, joint: usize, row: usize) -> [f64; 6] {
        let gradient = &self.groups[joint / 8].rows()[row].gradient;
        std::array::from_fn(|k| gradient[k][joint % 8])
    }
}

/// The stop of a joint at the last residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StopReport {
    /// Its moment (N m, >= 0).
    pub moment: f64,
    /// Energy in its spring (J).
    pub energy: f64,
    /// Power taken by its damping (W).
    pub dissipation: f64,
}

/// The play of a joint at the last residual.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlayReport {
    /// What takes the place of the multiplier of the joint's row (N m).
    pub multiplier: f64,
    /// Energy in its spring (J).
    pub energy: f64,
    /// Power taken by its damping (W).
    pub dissipation: f64,
}

/// What a joint adds to the tangent.
pub(crate) struct JointTangent<'a> {
    rotations: &'a [[Lane; 6]; 6],
    lane: usize,
}

impl JointTangent<'_> {
    /// Derivative of moment `k` in rotation `l`: stop, play, friction, and the curvature of the rotational rows.
    #[inline(always)]
    pub fn rotation(&self, l: usize, k: usize) -> f64 {
        self.rotations[l][k][self.lane]
    }
}

/// Multipliers of the `count` joints from `first` on, by row; lanes without a joint have none.
#[inline(always)]
fn lanes_of(lambda: impl Fn(usize) -> [f64; 2], first: usize, count: usize) -> [Lane; 2] {
    let mut lanes = [Lane::default(); 2];
    for (lane, of) in (first..first + count).map(lambda).enumerate() {
        (lanes[0][lane], lanes[1][lane]) = (of[0], of[1]);
    }
    lanes
}

/// Moments with which slipping pins resist (N m), of the up to eight joints from `first` on; lanes without a joint have
/// none.
#[inline(always)]
pub(crate) fn pin_lanes(moments: &[f64], first: usize) -> Lane {
    let mut lanes = Lane::default();
    for (lane, moment) in lanes.iter_mut().zip(&moments[first..]) {
        *lane = *moment;
    }
    lanes
}

/// Rotations of up to eight joints and their rates, a joint per lane; lanes without a joint repeat the last one.
#[inline(always)]
pub(crate) fn rotations(places: &[JointPlaces], state: &State) -> ([Lane; 6], [Lane; 6]) {
    let (mut q, mut rate) = ([Lane::default(); 6], [Lane::default(); 6]);
    for lane in 0..8 {
        let joint = &places[lane.min(places.len() - 1)];
        for (from, to) in [(&state.q, &mut q), (&state.v, &mut rate)] {
            let above: &[f64] = &from[joint.above..joint.above + 3];
            let below: &[f64] = &from[joint.below..joint.below + 3];
            for k in 0..3 {
                (to[k][lane], to[3 + k][lane]) = (above[k], below[k]);
            }
        }
    }
    (q, rate)
}

/// Derivatives of the moments of rotational rows and stops, eight joints at a time.
struct JointTangents<'a, L, W, F> {
    groups: &'a [JointGroup],
    joints: usize,
    factors: TangentFactors,
    lambda: L,
    wanted: W,
    visit: F,
}

impl<L, W, F> Kernel for JointTangents<'_, L, W, F>
where
    L: Fn(usize) -> [f64; 2],
    W: Fn(usize) -> bool,
    F: FnMut(usize, &JointTangent<'_>),
{
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            groups,
            joints,
            factors,
            lambda,
            wanted,
            mut visit,
        } = self;
        let mut rotations = [[Lane::default(); 6]; 6];
        for (g, group) in groups.iter().enumerate() {
            let first = 8 * g;
            let count = (joints - first).min(8);
            if !(first..first + count).any(&wanted) {
                continue;
            }
            let lambda = lanes_of(&lambda, first, count);
            group.tangent::<V>(&lambda, factors.stiffness, factors.damping, &mut rotations);
            for lane in 0..count {
                let tangent = JointTangent {
                    rotations: &rotations,
                    lane,
                };
                if wanted(first + lane) {
                    visit(first + lane, &tangent);
                }
            }
        }
    }
}

#[cfg(test)]
pub(crate) use one_by_one::JointLinearisation;
