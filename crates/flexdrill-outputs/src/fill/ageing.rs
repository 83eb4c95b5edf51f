//! [`Ageing`].

use super::copy;
use flexdrill_core::twin::Snapshot;
use flexdrill_messages::Ageing;
use flexdrill_messages::std_msgs::Header;

/// Seconds in an hour.
const HOUR: f64 = 3600.0;

/// Fills `out`. Rates are 0 before any time has passed.
pub fn ageing(snapshot: &Snapshot, header: &Header, out: &mut Ageing) {
    super::stamp(&mut out.header, header);
    let ageing = &snapshot.ageing;
    out.duration = ageing.duration;
    out.woehler_slope = ageing.settings.slope;
    out.rated_moment = ageing.settings.rated_moment;
    copy(&mut out.joint_measured_depth, &snapshot.joints.measured_depth);
    copy(&mut out.joint_inclination, &snapshot.joints.inclination);
    let per_hour = if ageing.duration > 0.0 {
        HOUR / ageing.duration
    } else {
        0.0
    };
    let rates = |out: &mut Vec<f64>, damage: &[f64]| {
        out.clear();
        out.extend(damage.iter().map(|damage| damage * per_hour));
    };
    rates(&mut out.stop_damage_rate, &ageing.stop_damage);
    rates(&mut out.bending_damage_rate, &ageing.bending_damage);
    out.relative_damage.clear();
    out.relative_damage.extend(ageing.relative_damage());
    copy(&mut out.station_measured_depth, &snapshot.contacts.measured_depth);
    copy(&mut out.station_inclination, &snapshot.contacts.inclination);
    copy(&mut out.pipe_guide_friction_work, &ageing.friction_work[0]);
    copy(&mut out.guide_wall_friction_work, &ageing.friction_work[1]);
}
