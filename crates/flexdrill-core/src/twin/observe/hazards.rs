//! Every hazard's level, with its worst location.

use super::Observer;
use crate::model::Model;
use crate::tool::Body;
use flexdrill_motion::{Hazard, HazardKind, Hazards, LoadLevel, LoadWatch, ToolLocation, TransferLevel};

impl Observer {
    /// Every hazard at model time `time` (s), with its worst location.
    pub(super) fn hazards(&self, model: &Model, time: f64) -> Hazards {
        // A location is looked up where a hazard has one; a station out of range has none instead of another's.
        let place = |station: usize, body: Body| {
            model.stations.get(station).map(|at| ToolLocation {
                station,
                body,
                measured_depth: at.depth,
                inclination: at.inclination,
            })
        };
        // Each level is taken once for all its fields.
        let (shock, chaotic) = (self.shock.level(), self.chaotic_whirl.level());
        // Transfer has no location: it is a property of the whole tool.
        let transfer = |kind: HazardKind, level: TransferLevel| Hazard {
            severity: level.severity,
            value: level.value,
            threshold: level.threshold,
            since: level.since,
            seen: level.seen,
            hold: level.hold,
            ..Hazard::calm(kind)
        };
        // Loads are optional: without a rating the hazard is calm and has no figure.
        let load = |kind: HazardKind, watch: &Option<LoadWatch>, body: Body| {
            let Some(watch) = watch else {
                return Hazard::calm(kind);
            };
            let LoadLevel {
                severity,
                part,
                ratio,
                since,
                seen,
                hold,
            } = watch.level();
            Hazard {
                severity,
                place: place(part, body),
                value: ratio,
                threshold: watch.settings().thresholds.of(severity),
                since,
                seen,
                hold,
                ..Hazard::calm(kind)
            }
        };
        let (joint_load, joint_settings) = (self.joint_load.level(), self.joint_load.settings());
        // The list is by kind, complete: a kind without a level would be an alarm that can never stand.
        let list = HazardKind::ALL.map(|kind| match kind {
            HazardKind::BackwardWhirl => self.whirl.backward(),
            HazardKind::ForwardWhirl => self.whirl.forward(),
            HazardKind::Shock => Hazard {
                severity: shock.severity,
                place: place(shock.station, if shock.layer == 0 { Body::Pipe } else { Body::Guide }),
                value: shock.impulse,
                threshold: self.shock.settings().thresholds.of(shock.severity),
                impulse: shock.impulse,
                since: shock.since,
                seen: shock.seen,
                hold: shock.hold,
                ..Hazard::calm(kind)
            },
            // Stick-slip is one motion of the whole string, so that it has no location either.
            HazardKind::StickSlip => {
                let (severity, (worst, seen)) = (self.stick_slip.severity(), self.stick_slip.worst());
                Hazard {
                    severity,
                    value: worst,
                    threshold: self.stick_slip.settings().thresholds.of(severity),
                    since: self.stick_slip.since(),
                    seen,
                    hold: self.stick_slip.hold(time),
                    least_speed: self.stick_slip.least_speed(),
                    ..Hazard::calm(kind)
                }
            }
            // Joints are counted by the watch; the location needs the station.
            HazardKind::JointLoad => Hazard {
                severity: joint_load.severity,
                place: model
                    .joint_stations
                    .get(joint_load.joint)
                    .and_then(|&station| place(station, Body::Pipe)),
                value: joint_load.ratio,
                threshold: joint_settings.thresholds.of(joint_load.severity),
                since: joint_load.since,
                seen: joint_load.seen,
                hold: joint_load.hold,
                ..Hazard::calm(kind)
            },
            HazardKind::ChaoticWhirl => Hazard {
                severity: chaotic.severity,
                place: place(chaotic.station, Body::Pipe),
                value: chaotic.power,
                threshold: self.chaotic_whirl.settings().thresholds.of(chaotic.severity),
                since: chaotic.since,
                seen: chaotic.seen,
                hold: chaotic.hold,
                ..Hazard::calm(kind)
            },
            HazardKind::WeightTransfer => transfer(kind, self.transfer.weight(time)),
            HazardKind::TorqueTransfer => transfer(kind, self.transfer.torque(time)),
            HazardKind::BitStuck => transfer(kind, self.transfer.stall(time)),
            HazardKind::GuidePreload => load(kind, &self.guide_preload, Body::Guide),
            HazardKind::PressureFolding => load(kind, &self.pressure_folding, Body::Pipe),
        });
        Hazards {
            list,
            // The drive's state says whether any of these are judged.
            drive: self.whirl.drive(),
        }
    }
}
