//! The items of `/diagnostics` on the tool's motion: whirl, stick-slip and lateral shock.

use super::item::{Item, figure, figure_in};
use crate::alarms::AlarmId;
use crate::messages::words;
use flexdrill_core::motion::{Severity, ShockLevel, WhirlKind, WhirlWarningLevel};
use flexdrill_core::twin::Snapshot;
use flexdrill_core::units::{rad_per_s_to_rpm, rad_to_deg};

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
    fn a_calm_tool_has_no_location_of_shock() {
        let calm = MotionEvidence::default();
        assert_eq!(calm.shock().calm, "impacts of 0.0 N s");
        assert_eq!(calm.whirl().calm, "no whirl");
    }
}
