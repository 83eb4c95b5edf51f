//! Parts of a snapshot that are read from the mechanics as it stands.

use super::snapshot::{ContactLayer, Holder, Joints, Reactions};
use crate::chain::Touched;
use crate::dynamics::joints::Joints as Linearised;
use crate::dynamics::state::{State, joint_rotations, translation};
use crate::model::Model;
use crate::step::Stepper;
use crate::tool::{Direction, JointKind};
use flexdrill_motion::ContactStatistics;

/// Contacts of one layer at all stations: gaps, present forces, peak and RMS.
pub(super) fn fill_layer(
    out: &mut ContactLayer,
    touched: impl Fn(usize) -> Option<Touched>,
    statistics: &ContactStatistics,
    gap: impl Fn(usize) -> f64,
) {
    for s in 0..out.gap.len() {
        out.gap[s] = gap(s);
        let values = touched(s).map_or([0.0; 3], |t| [t.normal, t.tangential, t.axial]);
        [out.normal[s], out.tangential[s], out.axial[s]] = values;
    }
    statistics.write(&mut out.normal_peak, &mut out.normal_rms);
}

/// Reactions with all arrays at their size.
pub(super) fn new_reactions(model: &Model) -> Reactions {
    let supports = model.held_nodes.iter();
    let mut held: Vec<_> = supports
        .map(|held| (held.station, Holder::Support(held.body)))
        .collect();
    held.extend(model.description.moves_at_top().then_some((0, Holder::String)));
    let at = |&(station, _): &(usize, Holder)| &model.stations[station];
    Reactions {
        measured_depth: held.iter().map(|held| at(held).depth).collect(),
        inclination: held.iter().map(|held| at(held).inclination).collect(),
        holder: held.iter().map(|&(_, holder)| holder).collect(),
        force: vec![[0.0; 3]; held.len()],
        moment: vec![[0.0; 3]; held.len()],
        ..Reactions::default()
    }
}

/// Forces of the supports and of the string, and the sums of all forces from outside.
pub(super) fn fill_reactions(stepper: &Stepper, out: &mut Reactions) {
    let supports = &stepper.model().held_nodes;
    for (index, held) in supports.iter().enumerate() {
        let [force, moment] = stepper.reaction(held);
        (out.force[index], out.moment[index]) = (force.into(), moment.into());
    }
    if let (Some(out), Some(force)) = (out.force.get_mut(supports.len()), stepper.carried_from_above()) {
        *out = force.into();
    }
    out.top_torque = stepper.torque_at_kickoff();
    let forces = stepper.outside_forces();
    out.supports = forces.supports.into();
    out.weight = forces.weight.into();
    out.wall = forces.wall.into();
    out.bit = forces.end.into();
    out.loads = forces.loads.into();
    out.inertia = forces.inertia.into();
    out.damping = forces.damping.into();
    out.unbalance = forces.unbalance().into();
}

/// Bend, motion and forces of all joints.
///
/// The pins carry the force between both links' ends and what is `on_pins` of each joint beyond (N).
pub(super) fn fill_joints(
    model: &Model,
    state: &State,
    joints: &Linearised,
    on_pins: impl Fn(usize) -> f64,
    out: &mut Joints,
) {
    for (to, stop) in out.stop_moment.iter_mut().zip(joints.stops()) {
        *to = stop.moment;
    }
    for (j, joint) in model.joints.iter().enumerate() {
        let station = &model.stations[model.joint_stations[j]];
        let q = joint_rotations(model, j, &state.q);
        out.bend_angle[j] = joint.bend_angle(&q);
        out.bend_direction[j] = joint.bend_toolface(&q);
        let displaced = station.pipe_to_station * translation(&state.q, station.pipe_above);
        out.lateral_y[j] = displaced.y + station.offset.x;
        out.lateral_z[j] = displaced.z + station.offset.y;
        out.spin_rate[j] = state.v[station.pipe_below + Direction::Psi as usize];
        // The translational multipliers are the force of the link above on the link below, in world axes.
        let first = model.multipliers(j);
        let force = joint.upper.tr_mul(&(translation(&state.q, first) * model.force_scale));
        out.axial_force[j] = -force.x + on_pins(j);
        out.shear_force[j] = (force.y * force.y + force.z * force.z).sqrt();
        let twist = -joints.row_gradient(j, 0)[3] * state.q[first + 3] * model.moment_scale;
        out.torque[j] = match joint.law.kind {
            JointKind::Universal | JointKind::BallCage => twist,
            JointKind::Revolute => twist - joints.row_gradient(j, 1)[3] * state.q[first + 4] * model.moment_scale,
        };
    }
}
