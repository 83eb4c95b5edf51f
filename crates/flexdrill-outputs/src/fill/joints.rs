//! [`JointDeflections`] and the stock [`JointState`].

use super::{copy, largest};
use crate::figures::fill_joint_deflections;
use flexdrill_core::twin::Snapshot;
use flexdrill_messages::JointDeflections;
use flexdrill_messages::sensor_msgs::JointState;
use flexdrill_messages::std_msgs::Header;

/// Fills `out`.
pub fn joint_deflections(snapshot: &Snapshot, header: &Header, out: &mut JointDeflections) {
    super::stamp(&mut out.header, header);
    let joints = &snapshot.joints;
    fill_joint_deflections(snapshot, out);
    out.max_bend_joint = largest(&joints.bend_angle).1;
    copy(&mut out.measured_depth, &joints.measured_depth);
    copy(&mut out.inclination, &joints.inclination);
    copy(&mut out.bend_angle, &joints.bend_angle);
    copy(&mut out.bend_direction, &joints.bend_direction);
    copy(&mut out.limit_angle, &joints.limit_angle);
    copy(&mut out.stop_moment, &joints.stop_moment);
    copy(&mut out.lateral_y, &joints.lateral_y);
    copy(&mut out.lateral_z, &joints.lateral_z);
    copy(&mut out.spin_rate, &joints.spin_rate);
    copy(&mut out.axial_force, &joints.axial_force);
    copy(&mut out.shear_force, &joints.shear_force);
    copy(&mut out.torque, &joints.torque);
}

/// Fills `out`: position is the bend angle (rad), velocity the spin rate of the link below (rad/s), effort the torque
/// through the joint (N m).
pub fn joint_state(snapshot: &Snapshot, header: &Header, out: &mut JointState) {
    super::stamp(&mut out.header, header);
    let joints = &snapshot.joints;
    let count = joints.bend_angle.len();
    if out.name.len() != count {
        out.name = (1..=count).map(|number| format!("joint_{number:02}")).collect();
    }
    copy(&mut out.position, &joints.bend_angle);
    copy(&mut out.velocity, &joints.spin_rate);
    copy(&mut out.effort, &joints.torque);
}
