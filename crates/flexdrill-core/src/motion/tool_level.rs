//! From the levels of all places to the one warning of the tool.

use super::place::Place;
use super::{Severity, WhirlKind, WhirlWarningLevel};

impl WhirlWarningLevel {
    /// The worst place leads; it keeps the lead against others of the same level, so that the warning does not jump.
    pub(super) fn update(&mut self, time: f64, places: &[Place], input_trust: f64) {
        let worst = places
            .iter()
            .map(|place| place.severity.level())
            .max()
            .unwrap_or_default();
        let keeps = |place: &Place| place.severity.level() == worst;
        let entry = if worst == Severity::Ok {
            0
        } else if places.get(self.entry).is_some_and(keeps) {
            self.entry
        } else {
            let mut leader = 0;
            let mut force = f64::NEG_INFINITY;
            for (index, place) in places.iter().enumerate() {
                if keeps(place) && place.evidence.peak_force > force {
                    (leader, force) = (index, place.evidence.peak_force);
                }
            }
            leader
        };
        let Some(place) = places.get(entry) else { return };
        let kind = if worst == Severity::Ok {
            WhirlKind::None
        } else {
            place.level_kind()
        };
        let severity_changed = worst != self.severity;
        let changed = severity_changed || kind != self.kind || entry != self.entry;
        *self = Self {
            severity: worst,
            kind,
            entry,
            whirl_ratio: place.whirl_ratio,
            rolling_share: place.rolling_share(),
            rolling: place.evidence.rolling,
            clearance_ratio: place.evidence.clearance_ratio,
            contact_duty: place.evidence.contact_duty,
            peak_force: place.evidence.peak_force,
            confidence: place.evidence.confidence * input_trust,
            window: place.used_window,
            since: if severity_changed { time } else { self.since },
            sequence: self.sequence + u64::from(changed),
        };
    }
}
