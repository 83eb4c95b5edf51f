//! What the analysis says of the tool's motion, as items of `/diagnostics`: whirl, stick-slip and lateral shock.

use super::judgement::Judgement;
use crate::messages::diagnostic_msgs::DiagnosticStatus;
use crate::messages::words;
use flexdrill_core::motion::{Severity, ShockLevel, WhirlWarningLevel};
use flexdrill_core::twin::Snapshot;
use flexdrill_core::units::{rad_per_s_to_rpm, rad_to_deg};

/// Levels of the motion with what led to them, of the newest snapshot.
#[derive(Debug, Clone, Copy, Default)]
pub struct MotionEvidence {
    /// Level of the whirl warning.
    pub whirl: WhirlWarningLevel,
    /// Level that the stick-slip index has reached.
    pub stick_slip: Severity,
    /// (max - min) / (2 mean) of the bit's speed over its window.
    pub stick_slip_index: f64,
    /// Speeds of drive and bit (rad/s).
    pub speeds: [f64; 2],
    /// Level of lateral shock.
    pub shock: ShockLevel,
    /// Where it was: along the path from the kick-off (m), inclination (rad).
    pub shock_place: [f64; 2],
    /// Largest lateral acceleration one station above the bit in the publishing interval (m/s2).
    pub lateral_acceleration_peak: f64,
}

impl MotionEvidence {
    /// Of a snapshot.
    pub fn of(snapshot: &Snapshot) -> Self {
        let at = |values: &[f64]| values.get(snapshot.shock.station).copied().unwrap_or_default();
        Self {
            whirl: snapshot.warning,
            stick_slip: snapshot.bit.stick_slip,
            stick_slip_index: snapshot.bit.stick_slip_index,
            speeds: [snapshot.applied.rotary_speed, snapshot.bit.rotary_speed],
            shock: snapshot.shock,
            shock_place: [
                at(&snapshot.contacts.measured_depth),
                at(&snapshot.contacts.inclination),
            ],
            lateral_acceleration_peak: snapshot.bit.lateral_acceleration_peak,
        }
    }

    pub(super) fn whirl(&self) -> Judgement {
        let warning = &self.whirl;
        Judgement {
            name: "whirl",
            level: level(warning.severity),
            message: format!("{}, {} whirl", warning.severity, words::whirl_kind(warning.kind as u8)),
            values: vec![
                ("whirl_ratio", format!("{:.3}", warning.whirl_ratio)),
                ("clearance_ratio", format!("{:.3}", warning.clearance_ratio)),
                ("contact_duty", format!("{:.3}", warning.contact_duty)),
                ("peak_force", format!("{:.0} N", warning.peak_force)),
                ("rolling_share", format!("{:.3}", warning.rolling_share)),
                ("confidence", format!("{:.2}", warning.confidence)),
            ],
        }
    }

    pub(super) fn stick_slip(&self) -> Judgement {
        let [drive, bit] = self.speeds.map(rad_per_s_to_rpm);
        Judgement {
            name: "stick-slip",
            level: level(self.stick_slip),
            message: format!(
                "{}, index {:.2} of the bit's speed, 1 is a bit that just stops",
                self.stick_slip, self.stick_slip_index
            ),
            values: vec![
                ("stick_slip_index", format!("{:.3}", self.stick_slip_index)),
                ("bit_speed", format!("{bit:.2} r/min")),
                ("drive_speed", format!("{drive:.2} r/min")),
            ],
        }
    }

    pub(super) fn shock(&self) -> Judgement {
        let shock = &self.shock;
        let layer = words::layer(shock.layer);
        let [depth, inclination] = self.shock_place;
        // While all is well the place changes with every interval and says nothing.
        let place = match shock.severity {
            Severity::Ok => String::new(),
            _ => format!(
                ", {layer} at {depth:.2} m (inclination {:.0} deg)",
                rad_to_deg(inclination)
            ),
        };
        Judgement {
            name: "shock",
            level: level(shock.severity),
            message: format!("{}, {:.1} N s{place}", shock.severity, shock.impulse),
            values: vec![
                ("impulse", format!("{:.2} N s", shock.impulse)),
                ("layer", layer.to_owned()),
                ("station", shock.station.to_string()),
                ("measured_depth", format!("{depth:.2} m")),
                (
                    "bit_lateral_acceleration_peak",
                    format!("{:.1} m/s2", self.lateral_acceleration_peak),
                ),
            ],
        }
    }
}

fn level(severity: Severity) -> u8 {
    match severity {
        Severity::Ok => DiagnosticStatus::OK,
        Severity::Watch | Severity::Warning => DiagnosticStatus::WARN,
        Severity::Critical => DiagnosticStatus::ERROR,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_carry_their_evidence_with_units() {
        let evidence = MotionEvidence {
            stick_slip: Severity::Critical,
            stick_slip_index: 1.2,
            shock: ShockLevel {
                severity: Severity::Watch,
                layer: 1,
                station: 80,
                impulse: 7.25,
                ..ShockLevel::default()
            },
            shock_place: [2.5, 0.785],
            ..MotionEvidence::default()
        };
        let (stick_slip, shock) = (evidence.stick_slip(), evidence.shock());
        assert_eq!(stick_slip.level, DiagnosticStatus::ERROR);
        assert!(
            stick_slip.message.starts_with("critical, index 1.20"),
            "{}",
            stick_slip.message
        );
        assert_eq!(shock.level, DiagnosticStatus::WARN);
        // {:.1} of 7.25 rounds half to even.
        assert_eq!(
            shock.message,
            "watch, 7.2 N s, guide-wall at 2.50 m (inclination 45 deg)"
        );
        assert!(shock.values.contains(&("impulse", "7.25 N s".to_owned())));
    }

    #[test]
    fn a_calm_tool_has_no_place_of_shock() {
        let calm = MotionEvidence::default().shock();
        assert_eq!(
            (calm.level, calm.message.as_str()),
            (DiagnosticStatus::OK, "ok, 0.0 N s")
        );
    }
}
