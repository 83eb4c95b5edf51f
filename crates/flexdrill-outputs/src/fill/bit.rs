//! [`BitState`].

use flexdrill_core::twin::Snapshot;
use flexdrill_messages::BitState;
use flexdrill_messages::std_msgs::Header;

/// Fills `out`.
pub fn bit_state(snapshot: &Snapshot, header: &Header, out: &mut BitState) {
    super::stamp(&mut out.header, header);
    let bit = &snapshot.bit;
    out.torque = bit.mean_torque;
    out.rotary_speed = bit.mean_rotary_speed;
    out.weight_on_bit = bit.mean_weight_on_bit;
    out.stick_slip_index = bit.stick_slip_index;
    out.tangential_acceleration = bit.tangential_acceleration;
    out.axial_acceleration = bit.axial_acceleration;
    out.lateral_acceleration = bit.lateral_acceleration;
    out.lateral_acceleration_peak = bit.lateral_acceleration_peak;
    out.lateral_impulse = bit.lateral_impulse;
    out.stick_slip_severity = bit.stick_slip as u8;
}
