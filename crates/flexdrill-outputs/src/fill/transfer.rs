//! [`Transfer`].

use crate::figures::fill_transfer;
use flexdrill_core::twin::Snapshot;
use flexdrill_messages::Transfer;
use flexdrill_messages::std_msgs::Header;

/// Fills `out`.
pub fn transfer(snapshot: &Snapshot, header: &Header, out: &mut Transfer) {
    super::stamp(&mut out.header, header);
    fill_transfer(snapshot, out);
}
