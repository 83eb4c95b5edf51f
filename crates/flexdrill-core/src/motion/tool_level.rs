//! From the levels of all stations to the one warning of the tool.

use super::watched_station::StationWatch;
use super::{Severity, WhirlKind, WhirlWarningLevel};

impl WhirlWarningLevel {
    /// The worst station leads; it keeps the lead against others of the same level, so that the warning does not jump.
    pub(super) fn update(&mut self, time: f64, watches: &[StationWatch], input_trust: f64) {
        let worst = watches
            .iter()
            .map(|watch| watch.severity.level())
            .max()
            .unwrap_or_default();
        let keeps = |watch: &StationWatch| watch.severity.level() == worst;
        let entry = if worst == Severity::Ok {
            0
        } else if watches.get(self.entry).is_some_and(keeps) {
            self.entry
        } else {
            let mut leader = 0;
            let mut force = f64::NEG_INFINITY;
            for (index, watch) in watches.iter().enumerate() {
                if keeps(watch) && watch.evidence.peak_force > force {
                    (leader, force) = (index, watch.evidence.peak_force);
                }
            }
            leader
        };
        let Some(watch) = watches.get(entry) else { return };
        let kind = if worst == Severity::Ok {
            WhirlKind::None
        } else {
            watch.level_kind()
        };
        let severity_changed = worst != self.severity;
        let changed = severity_changed || kind != self.kind || entry != self.entry;
        *self = Self {
            severity: worst,
            kind,
            entry,
            whirl_ratio: watch.whirl_ratio,
            rolling_share: watch.rolling_share(),
            rolling: watch.evidence.rolling,
            clearance_ratio: watch.evidence.clearance_ratio,
            contact_duty: watch.evidence.contact_duty,
            peak_force: watch.evidence.peak_force,
            confidence: watch.evidence.confidence * input_trust,
            window: watch.used_window,
            since: if severity_changed { time } else { self.since },
            sequence: self.sequence + u64::from(changed),
        };
    }
}
