//! Joints on the whole tool: Eq. 12 as translational rows, Eq. 13 and the stops as rotational ones.

use super::assembler::Assembler;
use super::equations::StationRoom;
use crate::dynamics::joints::{JointLinearisation, JointTangent, Joints};
use crate::dynamics::state::{State, translation};
use crate::elements::factors::TangentFactors;
use crate::model::Model;

impl Assembler {
    /// Adds the joints' forces Phi_q^T lambda (Eq. 17) and the rows of all joints (Eq. 14) to the residual, and
    /// linearises the rotational rows and stops.
    pub(super) fn joint_forces(&mut self, joints: &mut Joints, model: &Model, state: &State) {
        self.translational_rows(model, state);
        let (residual, increment) = (&mut self.residual, &mut self.increment.joints);
        joints.linearise(&model.places.joints, state, |joint, at: &JointLinearisation<'_>| {
            let lambda = rotational_multipliers(model, state, joint);
            let places = &model.places.joints[joint];
            let mut stop = at.stop_moments().unwrap_or_default();
            if let Some(further) = at.further_moments() {
                stop.iter_mut().zip(further).for_each(|(sum, moment)| *sum += moment);
            }
            let rotations = (places.above..places.above + 3).chain(places.below..places.below + 3);
            for (k, (place, stop)) in rotations.zip(stop).enumerate() {
                let of_rows = (0..at.rows()).map(|row| lambda[row] * at.gradient(row)[k]);
                residual[place] += stop + of_rows.sum::<f64>();
            }
            let first = model.multipliers(joint) + 3;
            for row in 0..at.rows() {
                residual[first + row] = model.moment_scale * at.value(row);
                increment[joint].rows[row] = at.gradient(row).map(|x| x * model.moment_scale);
            }
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
    pub(super) fn joint_tangent(&mut self, joints: &Joints, model: &Model, state: &State, factors: TangentFactors) {
        let increment = &mut self.increment.joints;
        let lambda = |joint: usize| rotational_multipliers(model, state, joint);
        joints.tangents(
            factors,
            lambda,
            |_| true,
            |joint, tangent: &JointTangent<'_>| {
                let to = &mut increment[joint];
                for (l, column) in to.rotations.iter_mut().enumerate() {
                    for (k, x) in column.iter_mut().enumerate() {
                        *x = tangent.rotation(l, k);
                    }
                }
            },
        );
    }
}

impl StationRoom {
    /// Sets the moments with which slipping pins of the joints resist (N m) to those under the multipliers in `from`.
    pub(crate) fn set_pin_moments(&self, model: &Model, from: &State, moments: &mut [f64]) {
        let pins = &model.description.joint.friction;
        if pins.coefficient == 0.0 {
            return;
        }
        for (joint, moment) in moments.iter_mut().enumerate() {
            let force = translation(&from.q, model.multipliers(joint)).norm() * model.force_scale;
            *moment = pins.moment(rotational_multipliers(model, from, joint)[0], force);
        }
    }
}

/// Multipliers (N m) of the rotational rows of a joint in the model's numbering.
fn rotational_multipliers(model: &Model, state: &State, joint: usize) -> [f64; 2] {
    // A joint with one row has no equation for the second, and zero there.
    let first = model.multipliers(joint) + 3;
    [
        model.moment_scale * state.q[first],
        model.moment_scale * state.q[first + 1],
    ]
}
