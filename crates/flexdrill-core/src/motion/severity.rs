//! From whirl, reach and contact to a level, with duration, hysteresis, hold-off and latch.

use serde::{Deserialize, Serialize};

use super::hysteresis::{Change, Hysteresis};
use super::settings::{LevelThresholds, WhirlSettings};
use super::{Severity, WhirlKind};

/// What a level is judged by, at one station.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Evidence {
    pub(super) kind: WhirlKind,
    pub(super) clearance_ratio: f64,
    pub(super) contact_duty: f64,
    /// Largest normal force in the window (N).
    pub(super) peak_force: f64,
    pub(super) confidence: f64,
    /// Backward at the rate of rolling without slip.
    pub(super) rolling: bool,
}

/// The level of one station.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct StationSeverity {
    hysteresis: Hysteresis,
    /// The kind that was seen last while the level's conditions were met.
    pub(super) kind: WhirlKind,
    /// How long the conditions of WATCH, WARNING and CRITICAL have been met (s).
    met_for: [f64; 3],
    /// Model time until which CRITICAL is latched (s).
    latched_until: f64,
}

impl StationSeverity {
    /// Takes the evidence at model time `time` (s), `elapsed` (s) after the one before. `input_trust`, 0 to 1, is how
    /// far the inputs behind the motion can be trusted: what they make doubtful raises no level, but does not end one
    /// either.
    pub(super) fn update(
        &mut self,
        time: f64,
        elapsed: f64,
        evidence: &Evidence,
        input_trust: f64,
        settings: &WhirlSettings,
    ) {
        let mut raised = Severity::Ok;
        let mut held = Severity::Ok;
        for (index, level) in Severity::RAISED.into_iter().enumerate() {
            let stands = self.level() >= level;
            let (factor, trust) = if stands {
                (1.0 - settings.hysteresis, 1.0)
            } else {
                (1.0, input_trust)
            };
            let met = evidence.confidence * trust >= settings.min_confidence * factor
                && meets(level, evidence, factor, settings);
            let met_for = if met { self.met_for[index] + elapsed } else { 0.0 };
            self.met_for[index] = met_for;
            if met && stands {
                held = level;
            }
            if met_for > 0.0 && met_for >= thresholds(level, settings).duration {
                raised = level;
            }
        }
        if evidence.kind != WhirlKind::None && raised.max(held) > Severity::Ok {
            self.kind = evidence.kind;
        }
        let latched = self.level() == Severity::Critical && time < self.latched_until;
        let change = self
            .hysteresis
            .update(elapsed, raised, held, settings.hold_off, latched);
        if change == Change::Rose && raised == Severity::Critical {
            self.latched_until = time + settings.latch;
        }
    }

    pub(super) fn level(&self) -> Severity {
        self.hysteresis.level
    }

    /// Ends the latch.
    pub(super) fn acknowledge(&mut self) {
        self.latched_until = 0.0;
    }
}

fn thresholds(level: Severity, settings: &WhirlSettings) -> &LevelThresholds {
    match level {
        Severity::Ok | Severity::Watch => &settings.watch,
        Severity::Warning => &settings.warning,
        Severity::Critical => &settings.critical,
    }
}

fn meets(level: Severity, evidence: &Evidence, factor: f64, settings: &WhirlSettings) -> bool {
    if evidence.kind == WhirlKind::None {
        return false;
    }
    if evidence.kind == WhirlKind::Forward && level > settings.forward_limit {
        return false;
    }
    let within = |thresholds: &LevelThresholds| {
        evidence.clearance_ratio >= thresholds.clearance_ratio * factor
            && evidence.contact_duty >= thresholds.contact_duty * factor
            && evidence.peak_force >= thresholds.force * factor
    };
    let one_below = match level {
        Severity::Critical => &settings.warning,
        _ => &settings.watch,
    };
    within(thresholds(level, settings))
        || (evidence.rolling && evidence.contact_duty >= settings.warning.contact_duty * factor && within(one_below))
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 0.1;

    fn strong() -> Evidence {
        Evidence {
            kind: WhirlKind::Backward,
            clearance_ratio: 1.1,
            contact_duty: 0.8,
            peak_force: 30e3,
            confidence: 0.9,
            rolling: false,
        }
    }

    /// Level after each evaluation.
    fn run(watch: &mut StationSeverity, from: f64, evidence: &[Evidence]) -> Vec<Severity> {
        let settings = WhirlSettings::default();
        evidence
            .iter()
            .enumerate()
            .map(|(index, evidence)| {
                watch.update(from + index as f64 * STEP, STEP, evidence, 1.0, &settings);
                watch.level()
            })
            .collect()
    }

    #[test]
    fn levels_need_their_duration() {
        let levels = run(&mut StationSeverity::default(), 0.0, &[strong(); 40]);
        let first = |level| levels.iter().position(|&got| got >= level);
        assert_eq!(
            (first(Severity::Watch), first(Severity::Critical)),
            (Some(14), Some(29))
        );
    }

    #[test]
    fn critical_is_latched_then_falls_after_the_hold_off() {
        let mut watch = StationSeverity::default();
        run(&mut watch, 0.0, &[strong(); 40]);
        let calm = [Evidence::default(); 400];
        let levels = run(&mut watch, 4.0, &calm);
        let end = levels
            .iter()
            .position(|&level| level < Severity::Critical)
            .map(|index| 4.0 + index as f64 * STEP);
        assert!(end.is_some_and(|end| (end - 32.9).abs() < 0.2), "{end:?}");
        let mut acknowledged = StationSeverity::default();
        run(&mut acknowledged, 0.0, &[strong(); 40]);
        acknowledged.acknowledge();
        let end = run(&mut acknowledged, 4.0, &calm)
            .iter()
            .position(|&level| level < Severity::Critical);
        assert!(end.is_some_and(|end| (48..=51).contains(&end)), "{end:?}");
    }

    #[test]
    fn no_flapping_at_a_threshold() {
        let mut watch = StationSeverity::default();
        let wavering: Vec<_> = (0..3000)
            .map(|index| Evidence {
                clearance_ratio: 0.5 + 0.04 * (index as f64 * 0.37).sin(),
                peak_force: 0.0,
                ..strong()
            })
            .collect();
        let settled = [Evidence {
            clearance_ratio: 0.52,
            peak_force: 0.0,
            ..strong()
        }; 30];
        run(&mut watch, 0.0, &settled);
        assert!(
            run(&mut watch, 3.0, &wavering)
                .iter()
                .all(|&level| level == Severity::Watch)
        );
    }

    #[test]
    fn forward_whirl_stops_at_its_limit_and_rolling_counts_one_more() {
        let forward = Evidence {
            kind: WhirlKind::Forward,
            ..strong()
        };
        assert_eq!(
            run(&mut StationSeverity::default(), 0.0, &[forward; 60])[59],
            Severity::Warning
        );
        let light = Evidence {
            peak_force: 500.0,
            ..strong()
        };
        assert_eq!(
            run(&mut StationSeverity::default(), 0.0, &[light; 60])[59],
            Severity::Watch
        );
        let rolling = Evidence { rolling: true, ..light };
        assert_eq!(
            run(&mut StationSeverity::default(), 0.0, &[rolling; 60])[59],
            Severity::Warning
        );
    }

    #[test]
    fn doubtful_evidence_raises_nothing() {
        let doubtful = Evidence {
            confidence: 0.3,
            ..strong()
        };
        assert_eq!(
            run(&mut StationSeverity::default(), 0.0, &[doubtful; 60])[59],
            Severity::Ok
        );
    }
}
