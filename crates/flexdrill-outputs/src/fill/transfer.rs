//! [`Transfer`].

use flexdrill_core::twin::Snapshot;
use flexdrill_messages::Transfer;
use flexdrill_messages::std_msgs::Header;
use flexdrill_motion::{BIT, KICK_OFF, SURFACE};

/// Fills `out`.
pub fn transfer(snapshot: &Snapshot, header: &Header, out: &mut Transfer) {
    // Filled in place, so that nothing allocates after the first frame.
    super::stamp(&mut out.header, header);
    let from = &snapshot.transfer;
    out.duration = from.duration;
    // Mean and RMS stand together for each place, from the top to the bit; NaN for a place that the tool does not have.
    let (torque, weight) = (&from.torque, &from.weight);
    (out.surface_torque, out.surface_torque_rms) = (torque.mean[SURFACE], torque.rms[SURFACE]);
    (out.kickoff_torque, out.kickoff_torque_rms) = (torque.mean[KICK_OFF], torque.rms[KICK_OFF]);
    (out.bit_torque, out.bit_torque_rms) = (torque.mean[BIT], torque.rms[BIT]);
    out.torque_efficiency = from.torque_efficiency;
    (out.surface_weight, out.surface_weight_rms) = (weight.mean[SURFACE], weight.rms[SURFACE]);
    (out.kickoff_weight, out.kickoff_weight_rms) = (weight.mean[KICK_OFF], weight.rms[KICK_OFF]);
    (out.bit_weight, out.bit_weight_rms) = (weight.mean[BIT], weight.rms[BIT]);

    // Destructured by position: the order of the arrays is that of their definition in the analysis.
    let mean = &from.mean;
    [
        out.pipe_guide_friction_torque,
        out.guide_wall_friction_torque,
        out.joint_friction_torque,
        out.string_friction_torque,
    ] = from.friction_torque;
    [
        out.pipe_guide_axial_drag,
        out.guide_wall_axial_drag,
        out.string_axial_drag,
    ] = mean.axial_drag;
    out.hook_load = mean.hook_load;
    out.depth_of_cut = mean.depth_of_cut;
    out.rate_of_penetration = mean.rate_of_penetration;
    out.drive_at_limit = mean.drive_at_limit;

    // The powers are the terms of the energy balance; what they leave over is `error_power`.
    let power = &from.power;
    out.drive_power = power.drive;
    out.hoist_power = power.hoist;
    out.weight_on_bit_power = power.weight_on_bit;
    out.gravity_power = power.gravity;
    out.load_power = power.loads;
    out.feed_power = power.feed;
    out.pressure_power = power.pressure;
    out.bit_power = power.bit;
    out.friction_power = power.friction;
    [
        out.pipe_guide_friction_power,
        out.guide_wall_friction_power,
        out.joint_friction_power,
    ] = mean.friction_power;
    out.contact_damping_power = power.contact_damping;
    out.rayleigh_damping_power = power.rayleigh_damping;
    out.numerical_damping_power = power.numerical_damping;
    out.string_power = power.string;
    out.axial_update_power = power.axial_update;
    out.stored_power = power.stored;
    out.error_power = power.error;
    out.mud_power = power.mud;
}
