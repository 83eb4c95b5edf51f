//! The leading station of each direction of whirl, and the whirl warning, from the levels of all stations.

use serde::{Deserialize, Serialize};

use super::episodes::ToolLocation;
use super::hazards::{Hazard, HazardKind, Hold};
use super::settings::WhirlSettings;
use super::watched_station::StationWatch;
use super::{Severity, WhirlKind, WhirlWarningLevel};

/// Relative margin by which a station of the same level must be worse to take the lead, and for how long (s): without
/// them the lead would change with every bounce.
const LEAD_MARGIN: f64 = 0.25;
const LEAD_TIME: f64 = 2.0;

/// The leading station of one kind of whirl.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Lead {
    severity: Severity,
    entry: usize,
    since: f64,
    /// Time for which another station has been worse by the margin (s).
    outdone_for: f64,
}

impl Lead {
    /// Finds the leading station for `kind` at model time `time` (s), `elapsed` (s) after the last update.
    pub(super) fn update(&mut self, time: f64, elapsed: f64, kind: WhirlKind, watches: &[StationWatch]) {
        let level = |watch: &StationWatch| watch.level_of(kind);
        let severity = watches.iter().map(level).max().unwrap_or_default();
        if severity != self.severity {
            (self.severity, self.since) = (severity, time);
        }
        // While a level stands, stations are compared by their worst evaluations, otherwise by their present motion.
        let (mut worst, mut most) = (self.entry, f64::NEG_INFINITY);
        for (entry, watch) in watches.iter().enumerate() {
            let strength = watch.reported_evaluation(kind).strength;
            if level(watch) == severity && strength > most {
                (worst, most) = (entry, strength);
            }
        }
        let Some(leader) = watches.get(self.entry) else { return };
        let outdone = most > (1.0 + LEAD_MARGIN) * leader.reported_evaluation(kind).strength;
        self.outdone_for = if outdone { self.outdone_for + elapsed } else { 0.0 };
        if level(leader) != severity || self.outdone_for >= LEAD_TIME {
            (self.entry, self.outdone_for) = (worst, 0.0);
        }
    }

    /// The hazard at model time `time` (s).
    pub(super) fn hazard(
        &self,
        time: f64,
        kind: HazardKind,
        watches: &[StationWatch],
        input_trust: f64,
        settings: &WhirlSettings,
    ) -> Hazard {
        // The calm hazard has all fields; what is known replaces them below.
        let calm = Hazard {
            since: self.since,
            ..Hazard::calm(kind)
        };
        let whirl = whirl_of(kind);
        let thresholds: &[f64] = match whirl {
            WhirlKind::Forward => &settings.forward_power,
            _ => &settings.backward_cycles,
        };
        // At OK the threshold is that of WATCH: the next one to be crossed.
        let index = (self.severity as usize).saturating_sub(1).min(thresholds.len() - 1);
        let threshold = thresholds[index];
        // The entry may be of a station that has whirled before; without a
        // level and without strength it has nothing to report.
        let Some(watch) = watches
            .get(self.entry)
            .filter(|watch| watch.strength(whirl) > 0.0 || self.severity > Severity::Ok)
        else {
            return Hazard { threshold, ..calm };
        };
        // While a level stands this is the worst evaluation of the station, otherwise the newest.
        let (station, evaluation) = (&watch.station, watch.reported_evaluation(whirl));
        let evidence = &evaluation.evidence;
        // Whether a level holds depends on all stations: whirl wanders, and the worst station changes.
        let standing = watches.iter().filter(|watch| watch.level_of(whirl) > Severity::Ok);
        let met = standing.fold([f64::NEG_INFINITY; 3], |met, watch| {
            let of = watch.met(whirl);
            std::array::from_fn(|level| f64::max(met[level], of[level]))
        });
        Hazard {
            severity: self.severity,
            place: Some(ToolLocation {
                station: station.station,
                body: station.body,
                measured_depth: station.measured_depth,
                inclination: station.inclination,
            }),
            // Each direction has the figure that its thresholds are in.
            value: match kind {
                HazardKind::ForwardWhirl => evidence.friction_power,
                _ => evidence.cycles,
            },
            threshold,
            whirl_ratio: evaluation.whirl_ratio.unwrap_or(f64::NAN),
            rolling_share: match evaluation.rolling_share {
                // 0 stands for "not rolling or sliding" inside and must not be shown as a share.
                0.0 => f64::NAN,
                share => share,
            },
            orbit_speed: evaluation.orbit_speed,
            impulse: evidence.impulse,
            impact_rate: evidence.impact_rate,
            friction_power: evidence.friction_power,
            // Doubtful inputs lower the confidence of a hazard; they do not change its level.
            confidence: evidence.confidence * input_trust,
            seen: evaluation.time,
            hold: Hold::of(self.severity, met, time),
            ..calm
        }
    }
}

fn whirl_of(kind: HazardKind) -> WhirlKind {
    match kind {
        HazardKind::ForwardWhirl => WhirlKind::Forward,
        _ => WhirlKind::Backward,
    }
}

impl WhirlWarningLevel {
    /// The worse of the two directions leads, backward before forward. While a level stands the figures are those of
    /// its worst evaluation.
    pub(super) fn update(&mut self, backward: &Lead, forward: &Lead, watches: &[StationWatch], input_trust: f64) {
        let (lead, kind) = if forward.severity > backward.severity {
            (forward, WhirlKind::Forward)
        } else {
            (backward, WhirlKind::Backward)
        };
        let Some(watch) = watches.get(lead.entry) else { return };
        let kind = if lead.severity == Severity::Ok {
            WhirlKind::None
        } else {
            kind
        };
        let evaluation = watch.reported_evaluation(if kind == WhirlKind::Forward {
            kind
        } else {
            WhirlKind::Backward
        });
        let evidence = &evaluation.evidence;
        let severity_changed = lead.severity != self.severity;
        // At level OK no station leads.
        let moved = lead.severity > Severity::Ok && lead.entry != self.entry;
        let changed = severity_changed || kind != self.kind || moved;
        *self = Self {
            severity: lead.severity,
            kind,
            entry: lead.entry,
            whirl_ratio: evaluation.whirl_ratio.unwrap_or(f64::NAN),
            rolling_share: evaluation.rolling_share,
            rolling: evidence.rolling,
            clearance_ratio: evidence.clearance_ratio,
            contact_duty: evidence.contact_duty,
            peak_force: evidence.peak_force,
            confidence: evidence.confidence * input_trust,
            window: evaluation.window,
            since: if severity_changed { lead.since } else { self.since },
            sequence: self.sequence + u64::from(changed),
        };
    }
}
