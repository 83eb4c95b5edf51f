//! [`Reactions`].

use super::copy;
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{Holder, Snapshot};
use flexdrill_messages::Reactions;
use flexdrill_messages::std_msgs::Header;

/// Fills `out`.
pub fn reactions(snapshot: &Snapshot, header: &Header, out: &mut Reactions) {
    super::stamp(&mut out.header, header);
    let from = &snapshot.reactions;
    out.drive_torque = from.top_torque;
    out.bit_torque = snapshot.bit.torque;
    out.support_force = from.supports;
    out.weight = from.weight;
    out.wall_force = from.wall;
    out.bit_force = from.bit;
    out.load_force = from.loads;
    out.inertia_force = from.inertia;
    out.damping_force = from.damping;
    out.unbalanced_force = from.unbalance;
    copy(&mut out.measured_depth, &from.measured_depth);
    copy(&mut out.inclination, &from.inclination);
    out.body.clear();
    out.body.extend(from.holder.iter().map(|holder| match holder {
        Holder::Support(Body::Pipe) => Reactions::PIPE,
        Holder::Support(Body::Guide) => Reactions::GUIDE,
        Holder::String => Reactions::STRING,
    }));
    let forces = [&mut out.force_x, &mut out.force_y, &mut out.force_z];
    let moments = [&mut out.moment_x, &mut out.moment_y, &mut out.moment_z];
    for (axis, (force, moment)) in forces.into_iter().zip(moments).enumerate() {
        force.clear();
        force.extend(from.force.iter().map(|vector| vector[axis]));
        moment.clear();
        moment.extend(from.moment.iter().map(|vector| vector[axis]));
    }
}
