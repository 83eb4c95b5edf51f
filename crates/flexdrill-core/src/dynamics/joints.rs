//! Joints on the whole tool: Eq. 12 as translational rows, Eq. 13 and the stops as rotational ones.

use crate::dynamics::assembly::{Assembler, JointReport};
use crate::dynamics::factors::TangentFactors;
use crate::dynamics::state::{State, translation};
use crate::elements::joint::group::{JointGroup, Lane};
use crate::linear::JointIncrement;
use crate::model::{JointPlaces, Model};
use crate::simd::Kernel;
use crate::simd::vector::Vector;

impl Assembler {
    /// Adds the joints' forces Phi_q^T lambda (Eq. 17) and the rows of all joints (Eq. 14) to the residual, and
    /// linearises the rotational rows and stops.
    pub(super) fn joint_forces(&mut self, model: &Model, state: &State) {
        self.translational_rows(model, state);
        let mut residual = std::mem::take(&mut self.residual);
        self.rotational_rows(&mut residual, &model.places.joints, model, state);
        self.residual = residual;
    }

    /// Rotational rows and stops, in the numbering of `places`.
    pub(crate) fn rotational_rows(
        &mut self,
        residual: &mut [f64],
        places: &[JointPlaces],
        model: &Model,
        state: &State,
    ) {
        self.instructions.run(RotationalRows {
            residual,
            reports: &mut self.joints,
            groups: &mut self.groups,
            places,
            scale: model.moment_scale,
            state,
        });
    }

    /// E_a u_a - E_b u_b = 0, Eq. 12, and the multipliers' forces on both ends.
    fn translational_rows(&mut self, model: &Model, state: &State) {
        for (j, joint) in model.joints.iter().enumerate() {
            let station = &model.stations[model.joint_stations[j]];
            let (a, b, first) = (station.pipe_above, station.pipe_below, model.multipliers(j));
            let scale = model.force_scale;
            let lambda = translation(&state.q, first) * scale;
            let (on_a, on_b) = (joint.upper.tr_mul(&lambda), joint.lower.tr_mul(&lambda));
            let open = joint.upper * translation(&state.q, a) - joint.lower * translation(&state.q, b);
            for k in 0..3 {
                self.residual[a + k] += on_a[k];
                self.residual[b + k] -= on_b[k];
                self.residual[first + k] = scale * open[k];
            }
        }
    }

    /// Fills the joints' part of the tangent increment.
    pub(crate) fn joint_tangent(
        &mut self,
        places: &[JointPlaces],
        model: &Model,
        state: &State,
        factors: TangentFactors,
    ) {
        for (change, report) in self.increment.joints.iter_mut().zip(&self.joints) {
            for (to, from) in change.rows.iter_mut().zip(&report.rows) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to = from * model.moment_scale;
                }
            }
        }
        self.instructions.run(RotationalTangents {
            increment: &mut self.increment.joints,
            groups: &self.groups,
            places,
            scale: model.moment_scale,
            state,
            factors,
        });
    }
}

/// Multipliers of the rotational rows of the first eight joints of `places`, times their scale (N m); lanes without a
/// joint have none.
#[inline(always)]
fn multipliers(places: &[JointPlaces], scale: f64, state: &State, rows: usize) -> [Lane; 2] {
    let mut lambda = [[0.0; 8]; 2];
    for (lane, joint) in places.iter().take(8).enumerate() {
        for (row, lambda) in lambda.iter_mut().enumerate().take(rows) {
            lambda[lane] = scale * state.q[joint.row + row];
        }
    }
    lambda
}

/// Rotational rows and stops, eight joints at a time.
struct RotationalRows<'a> {
    residual: &'a mut [f64],
    reports: &'a mut [JointReport],
    groups: &'a mut [JointGroup],
    places: &'a [JointPlaces],
    scale: f64,
    state: &'a State,
}

impl Kernel for RotationalRows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            residual,
            reports,
            groups,
            places,
            scale,
            state,
        } = self;
        for (g, group) in groups.iter_mut().enumerate() {
            let first = 8 * g;
            let places = &places[first..];
            let count = places.len().min(8);
            let (mut q, mut rate) = ([[0.0; 8]; 6], [[0.0; 8]; 6]);
            for lane in 0..8 {
                let joint = &places[lane.min(count - 1)];
                for k in 0..3 {
                    q[k][lane] = state.q[joint.above + k];
                    q[3 + k][lane] = state.q[joint.below + k];
                    rate[k][lane] = state.v[joint.above + k];
                    rate[3 + k][lane] = state.v[joint.below + k];
                }
            }
            let lambda = multipliers(places, scale, state, group.rows().len());
            let moments = group.evaluate::<V>(&q, &rate, &lambda);
            let stop = group.stop();
            for lane in 0..count {
                let joint = &places[lane];
                for k in 0..3 {
                    residual[joint.above + k] += moments[k][lane];
                    residual[joint.below + k] += moments[3 + k][lane];
                }
                let report = &mut reports[first + lane];
                for (r, row) in group.rows().iter().enumerate() {
                    residual[joint.row + r] = scale * row.value[lane];
                    for (to, from) in report.rows[r].iter_mut().zip(&row.gradient) {
                        *to = from[lane];
                    }
                }
                report.moment = stop.moment[lane];
                report.energy = stop.energy[lane];
                report.dissipation = stop.dissipation[lane];
            }
        }
    }
}

/// Derivatives of the moments of rotational rows and stops, eight joints at a time.
struct RotationalTangents<'a> {
    increment: &'a mut [JointIncrement],
    groups: &'a [JointGroup],
    places: &'a [JointPlaces],
    scale: f64,
    state: &'a State,
    factors: TangentFactors,
}

impl Kernel for RotationalTangents<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            increment,
            groups,
            places,
            scale,
            state,
            factors,
        } = self;
        let mut tangent = [[[0.0; 8]; 6]; 6];
        for (g, group) in groups.iter().enumerate() {
            let first = 8 * g;
            let lambda = multipliers(&places[first..], scale, state, group.rows().len());
            group.tangent::<V>(&lambda, factors.stiffness, factors.damping, &mut tangent);
            for (lane, change) in increment[first..].iter_mut().enumerate().take(8) {
                for (to, from) in change.rotations.iter_mut().zip(&tangent) {
                    for (to, from) in to.iter_mut().zip(from) {
                        *to = from[lane];
                    }
                }
            }
        }
    }
}
