//! [`ContactForces`].

use super::{copy, largest};
use crate::figures::fill_contact_forces;
use flexdrill_core::twin::Snapshot;
use flexdrill_messages::ContactForces;
use flexdrill_messages::std_msgs::Header;

/// Fills `out`. The largest forces are those of the publishing interval, not of the instant.
pub fn contact_forces(snapshot: &Snapshot, header: &Header, out: &mut ContactForces) {
    super::stamp(&mut out.header, header);
    let contacts = &snapshot.contacts;
    fill_contact_forces(snapshot, out);
    out.max_pipe_guide_station = largest(&contacts.pipe_guide.normal_peak).1;
    out.max_guide_wall_station = largest(&contacts.guide_wall.normal_peak).1;
    copy(&mut out.measured_depth, &contacts.measured_depth);
    copy(&mut out.inclination, &contacts.inclination);
    copy(&mut out.state, &contacts.state);

    let inner = &contacts.pipe_guide;
    copy(&mut out.pipe_guide_gap, &inner.gap);
    copy(&mut out.pipe_guide_normal, &inner.normal);
    copy(&mut out.pipe_guide_tangential, &inner.tangential);
    copy(&mut out.pipe_guide_axial, &inner.axial);
    copy(&mut out.pipe_guide_normal_peak, &inner.normal_peak);
    copy(&mut out.pipe_guide_normal_rms, &inner.normal_rms);

    let outer = &contacts.guide_wall;
    copy(&mut out.guide_wall_gap, &outer.gap);
    copy(&mut out.guide_wall_normal, &outer.normal);
    copy(&mut out.guide_wall_tangential, &outer.tangential);
    copy(&mut out.guide_wall_axial, &outer.axial);
    copy(&mut out.guide_wall_normal_peak, &outer.normal_peak);
    copy(&mut out.guide_wall_normal_rms, &outer.normal_rms);

    copy(&mut out.pipe_guide_shock, &inner.shock);
    copy(&mut out.guide_wall_shock, &outer.shock);
    let shock = &snapshot.shock;
    out.shock_severity = shock.severity as u8;
    out.shock_impulse = shock.impulse;
    out.shock_station = u32::try_from(shock.station).unwrap_or(u32::MAX);
    out.shock_layer = if shock.layer == 0 {
        ContactForces::INNER
    } else {
        ContactForces::OUTER
    };
}
