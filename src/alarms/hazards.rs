use flexdrill_core::motion::{IncidentLocation, Severity, WhirlKind};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::Snapshot;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HazardKind {
    BackwardWhirl,
    ForwardWhirl,
    Shock,
    StickSlip,
    JointLoad,
    Wear,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hazard {
    pub kind: HazardKind,
    pub severity: Severity,
    pub place: Option<IncidentLocation>,
    pub value: f64,
    pub threshold: f64,
    pub whirl_ratio: f64,
    pub rolling_share: f64,
    pub impulse: f64,
    pub power: f64,
    pub confidence: f64,
    pub since: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveState {
    Standing,
    RunningUp,
    Turning,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hazards {
    pub list: [Hazard; 6],
    pub drive: DriveState,
}

pub fn hazards(snapshot: &Snapshot) -> Hazards {
    let nothing = |kind| Hazard {
        kind,
        severity: Severity::Ok,
        place: None,
        value: f64::NAN,
        threshold: f64::NAN,
        whirl_ratio: f64::NAN,
        rolling_share: f64::NAN,
        impulse: f64::NAN,
        power: f64::NAN,
        confidence: 1.0,
        since: 0.0,
    };
    let level = &snapshot.warning;
    let whirl = |kind, of| {
        if level.kind != of {
            return nothing(kind);
        }
        Hazard {
            severity: level.severity,
            place: Some(IncidentLocation {
                station: snapshot.whirl.station[level.entry],
                body: snapshot.whirl.body[level.entry],
                measured_depth: snapshot.whirl.measured_depth[level.entry],
                inclination: snapshot.whirl.inclination[level.entry],
            }),
            value: level.whirl_ratio.abs() + 1.0,
            whirl_ratio: level.whirl_ratio,
            rolling_share: level.rolling_share,
            confidence: level.confidence,
            since: level.since,
            ..nothing(kind)
        }
    };
    let shock = &snapshot.shock;
    Hazards {
        list: [
            whirl(HazardKind::BackwardWhirl, WhirlKind::Backward),
            whirl(HazardKind::ForwardWhirl, WhirlKind::Forward),
            Hazard {
                severity: shock.severity,
                place: Some(IncidentLocation {
                    station: shock.station,
                    body: if shock.layer == 0 { Body::Pipe } else { Body::Guide },
                    measured_depth: snapshot.contacts.measured_depth[shock.station],
                    inclination: snapshot.contacts.inclination[shock.station],
                }),
                value: shock.impulse,
                impulse: shock.impulse,
                since: shock.since,
                ..nothing(HazardKind::Shock)
            },
            Hazard {
                severity: snapshot.bit.stick_slip,
                value: snapshot.bit.stick_slip_index,
                ..nothing(HazardKind::StickSlip)
            },
            nothing(HazardKind::JointLoad),
            nothing(HazardKind::Wear),
        ],
        drive: if snapshot.applied.rotary_speed < 0.5 {
            DriveState::Standing
        } else {
            DriveState::Turning
        },
    }
}
