//! The items of `/diagnostics` on the tool's motion: whirl, stick-slip, lateral shock, load of the joints, and transfer to the bit.

use super::item::{Item, figure, figure_in};
use crate::alarms::AlarmId;
use flexdrill_core::twin::Snapshot;
use flexdrill_core::units::{rad_per_s_to_rpm, rad_to_deg};
use flexdrill_motion::{Hazard, HazardKind, Severity, ShockLevel, WhirlKind, WhirlWarningLevel};
use flexdrill_outputs::words;

/// The figures of the motion in the newest snapshot.
#[derive(Debug, Clone, Copy, Default)]
pub struct MotionEvidence {
    /// The whirl warning.
    pub whirl: WhirlWarningLevel,
    /// (max - min) / (2 mean) of the bit's speed over its window.
    pub stick_slip_index: f64,
    /// Speeds of drive and bit (rad/s).
    pub speeds: [f64; 2],
    /// Lateral shock.
    pub shock: ShockLevel,
    /// Location of the shock: measured depth from the kick-off (m), inclination (rad).
    pub shock_location: [f64; 2],
    /// Largest lateral acceleration one station above the bit in the publishing interval (m/s2).
    pub lateral_acceleration_peak: f64,
    /// Load of the joints: stop moment over its rating, at the joint where it is largest.
    pub joint_load: Option<Hazard>,
    /// Mean torque at the bit over that put in; NaN while unknown.
    pub torque_efficiency: f64,
    /// Mean weights at the surface, at the kick-off and at the bit (N); NaN where the tool has none.
    pub weights: [f64; 3],
}

impl MotionEvidence {
    /// The figures of a snapshot.
    pub fn of(snapshot: &Snapshot) -> Self {
        let at = |values: &[f64]| values.get(snapshot.shock.station).copied().unwrap_or_default();
        Self {
            whirl: snapshot.warning,
            stick_slip_index: snapshot.bit.stick_slip_index,
            speeds: [snapshot.applied.rotary_speed, snapshot.bit.rotary_speed],
            shock: snapshot.shock,
            shock_location: [
                at(&snapshot.contacts.measured_depth),
                at(&snapshot.contacts.inclination),
            ],
            lateral_acceleration_peak: snapshot.bit.lateral_acceleration_peak,
            joint_load: Some(*snapshot.hazards.of(HazardKind::JointLoad)),
            torque_efficiency: snapshot.transfer.torque_efficiency,
            weights: snapshot.transfer.weight.mean,
        }
    }

    pub(super) fn whirl(&self) -> Item {
        let warning = &self.whirl;
        let calm = match warning.kind {
            WhirlKind::None => "no whirl".to_owned(),
            kind => format!("{}, level {}", kind.name(), warning.severity),
        };
        Item {
            name: "whirl",
            alarms: &[AlarmId::BackwardWhirl, AlarmId::ForwardWhirl, AlarmId::ChaoticWhirl],
            calm,
            values: vec![
                ("whirl_ratio", figure(warning.whirl_ratio, 3)),
                ("clearance_ratio", figure(warning.clearance_ratio, 3)),
                ("contact_duty", figure(warning.contact_duty, 3)),
                ("peak_force", figure_in(warning.peak_force, 0, "N")),
                ("rolling_share", figure(warning.rolling_share, 3)),
                ("confidence", figure(warning.confidence, 2)),
            ],
        }
    }

    pub(super) fn stick_slip(&self) -> Item {
        let [drive, bit] = self.speeds.map(rad_per_s_to_rpm);
        Item {
            name: "stick-slip",
            alarms: &[AlarmId::StickSlip],
            calm: format!("index {}; at 1 the bit stops", figure(self.stick_slip_index, 2)),
            values: vec![
                ("stick_slip_index", figure(self.stick_slip_index, 3)),
                ("bit_speed", figure_in(bit, 2, "r/min")),
                ("drive_speed", figure_in(drive, 2, "r/min")),
            ],
        }
    }

    pub(super) fn transfer(&self) -> Item {
        let known = |value: f64, text: String| value.is_finite().then_some(text);
        let per_cent = 100.0 * self.torque_efficiency;
        let calm = known(
            per_cent,
            format!("{} of the torque arrives at the bit", figure_in(per_cent, 0, "%")),
        );
        let names = ["surface_weight", "kickoff_weight", "bit_weight"]
            .into_iter()
            .zip(self.weights);
        let weights = names.filter_map(|(name, weight)| Some((name, known(weight, figure_in(weight, 0, "N"))?)));
        let efficiency = known(self.torque_efficiency, figure(self.torque_efficiency, 3));
        Item {
            name: "transfer",
            alarms: &[
                AlarmId::WeightTransfer,
                AlarmId::TorqueTransfer,
                AlarmId::GuidePreload,
                AlarmId::PressureFolding,
                AlarmId::BitStuck,
            ],
            calm: calm.unwrap_or_else(|| "no torque".to_owned()),
            values: efficiency
                .map(|share| ("torque_efficiency", share))
                .into_iter()
                .chain(weights)
                .collect(),
        }
    }

    pub(super) fn hole() -> Item {
        Item {
            name: "hole",
            alarms: &[AlarmId::HoleLeavesPlan, AlarmId::FrictionNearStuck],
            calm: "no alarm on where the tool drills, or on what would free it".to_owned(),
            values: Vec::new(),
        }
    }

    pub(super) fn joint_load(&self) -> Item {
        let load = self.joint_load.unwrap_or(Hazard::calm(HazardKind::JointLoad));
        // Below the first level the location changes with every turn.
        let place = load.place.as_ref().filter(|_| load.severity != Severity::Ok);
        let location = place.map_or_else(String::new, |place| {
            format!(
                " at {} (inclination {})",
                figure_in(place.measured_depth, 2, "m"),
                figure_in(rad_to_deg(place.inclination), 0, "deg")
            )
        });
        let calm = if load.value > 0.0 {
            format!(
                "a joint carries {} of its rating{location}",
                figure_in(100.0 * load.value, 0, "%")
            )
        } else {
            "no joint is at its limit".to_owned()
        };
        Item {
            name: "joint load",
            alarms: &[AlarmId::JointLoad],
            calm,
            values: vec![
                ("moment_over_rating", figure(load.value, 3)),
                ("threshold", figure(load.threshold, 3)),
            ],
        }
    }

    pub(super) fn shock(&self) -> Item {
        let shock = &self.shock;
        let layer = words::layer(shock.layer);
        let [depth, inclination] = self.shock_location;
        // Below the first level the location changes with every interval and means nothing.
        let location = match shock.severity {
            Severity::Ok => String::new(),
            _ => format!(
                ", {layer} at {} (inclination {})",
                figure_in(depth, 2, "m"),
                figure_in(rad_to_deg(inclination), 0, "deg")
            ),
        };
        Item {
            name: "shock",
            alarms: &[AlarmId::Shock],
            calm: format!("impacts of {}{location}", figure_in(shock.impulse, 1, "N s")),
            values: vec![
                ("impulse", figure_in(shock.impulse, 2, "N s")),
                ("layer", layer.to_owned()),
                ("station", shock.station.to_string()),
                ("measured_depth", figure_in(depth, 2, "m")),
                (
                    "bit_lateral_acceleration_peak",
                    figure_in(self.lateral_acceleration_peak, 1, "m/s2"),
                ),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_core::tool::Body;
    use flexdrill_motion::ToolLocation;

    #[test]
    fn figures_carry_their_units() {
        let evidence = MotionEvidence {
            stick_slip_index: 1.2,
            shock: ShockLevel {
                severity: Severity::Watch,
                layer: 1,
                station: 80,
                impulse: 7.25,
                ..ShockLevel::default()
            },
            shock_location: [2.5, 0.785],
            ..MotionEvidence::default()
        };
        assert_eq!(evidence.stick_slip().calm, "index 1.20; at 1 the bit stops");
        let shock = evidence.shock();
        // {:.1} of 7.25 rounds half to even.
        assert_eq!(
            shock.calm,
            "impacts of 7.2 N s, guide-wall at 2.50 m (inclination 45 deg)"
        );
        assert!(shock.values.contains(&("impulse", "7.25 N s".to_owned())));
    }

    #[test]
    fn a_loaded_joint_is_named_from_the_first_level_on() {
        let mut load = Hazard {
            value: 0.62,
            threshold: 0.8,
            place: Some(ToolLocation {
                station: 80,
                body: Body::Pipe,
                measured_depth: 2.5,
                inclination: 0.785,
            }),
            ..Hazard::calm(HazardKind::JointLoad)
        };
        let item = |load| {
            MotionEvidence {
                joint_load: Some(load),
                ..MotionEvidence::default()
            }
            .joint_load()
        };
        assert_eq!(item(load).calm, "a joint carries 62 % of its rating");
        (load.value, load.severity) = (1.13, Severity::Warning);
        assert_eq!(
            item(load).calm,
            "a joint carries 113 % of its rating at 2.50 m (inclination 45 deg)"
        );
        assert_eq!(MotionEvidence::default().joint_load().calm, "no joint is at its limit");
    }

    #[test]
    fn a_calm_tool_has_no_location_of_shock() {
        let calm = MotionEvidence::default();
        assert_eq!(calm.shock().calm, "impacts of 0.0 N s");
        assert_eq!(calm.whirl().calm, "no whirl");
    }

    #[test]
    fn transfer_says_only_what_is_known() {
        let evidence = MotionEvidence {
            torque_efficiency: 0.931,
            weights: [f64::NAN, 9375.0, 10e3],
            ..MotionEvidence::default()
        };
        let item = evidence.transfer();
        assert_eq!(item.calm, "93 % of the torque arrives at the bit");
        let names: Vec<_> = item.values.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["torque_efficiency", "kickoff_weight", "bit_weight"]);
        let unknown = MotionEvidence {
            torque_efficiency: f64::NAN,
            weights: [f64::NAN; 3],
            ..MotionEvidence::default()
        };
        assert_eq!(
            (unknown.transfer().calm.as_str(), unknown.transfer().values.len()),
            ("no torque", 0)
        );
    }
}
