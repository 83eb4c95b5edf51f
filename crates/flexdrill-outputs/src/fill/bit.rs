//! [`BitState`].

use crate::figures::fill_bit_state;
use flexdrill_core::twin::Snapshot;
use flexdrill_messages::BitState;
use flexdrill_messages::std_msgs::Header;

/// Fills `out`.
pub fn bit_state(snapshot: &Snapshot, header: &Header, out: &mut BitState) {
    super::stamp(&mut out.header, header);
    fill_bit_state(snapshot, out);
    out.stick_slip_severity = snapshot.bit.stick_slip as u8;
}
