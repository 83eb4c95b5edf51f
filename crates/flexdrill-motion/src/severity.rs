//! Level of a station's whirl: by its damage, its duration in turns of the tool, hysteresis and hold-off.
//!
//! Backward whirl is judged by the bending cycles that it brings per turn of the tool, forward whirl by the power of
//! its friction. Neither depends on the stiffness of the contact. Chaotic motion harms by its collisions, which the
//! shock watch judges; vibration of the joints is part of drilling.

use serde::{Deserialize, Serialize};

use super::hysteresis::{Hysteresis, Transition};
use super::settings::WhirlSettings;
use super::{Severity, WhirlKind};

/// Measured figures of the motion at one station.
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
    /// Bending cycles per turn of the tool; 0 where there is no whirl of one rate.
    pub(super) cycles: f64,
    /// Largest impulse above the resting one in the window (N s).
    pub(super) impulse: f64,
    /// Impacts per second (1/s).
    pub(super) impact_rate: f64,
    /// Work of the friction per second and metre (W/m).
    pub(super) friction_power: f64,
}

/// Result of one evaluation of a station.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Evaluation {
    /// Model time (s).
    pub(super) time: f64,
    pub(super) evidence: Evidence,
    /// Whirl rate over rotary speed, where there is one rate and the tool turns.
    pub(super) whirl_ratio: Option<f64>,
    /// Whirl rate over that of rolling without slip; 0 where there is no such whirl.
    pub(super) rolling_share: f64,
    /// Speed of the centre on its orbit (m/s).
    pub(super) orbit_speed: f64,
    /// Length of the window (s).
    pub(super) window: f64,
    /// Severity measure for comparing stations and evaluations; 0 where the motion is of another kind.
    pub(super) strength: f64,
}

/// Time since the last evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Elapsed {
    /// Model time now (s).
    pub(super) time: f64,
    /// Time (s).
    pub(super) seconds: f64,
    /// Turns of the tool.
    pub(super) turns: f64,
}

/// The level of one station for one kind of whirl.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct StationSeverity {
    hysteresis: Hysteresis,
    /// Turns of the tool for which the conditions of WATCH, WARNING and CRITICAL have been met, minus those for which
    /// they have not: the motion of a bouncing pipe is not classified alike at every evaluation.
    met_for: [f64; 3],
    /// The worst evaluation that met the conditions of the level, since it was reached.
    worst: Evaluation,
}

impl StationSeverity {
    /// Takes the newest evaluation. `trust`, 0 to 1, is how far the inputs and the model behind the motion can be
    /// trusted. Doubtful inputs never raise or clear a level on their own. It is 0 while the drive does not turn
    /// steadily.
    pub(super) fn update(
        &mut self,
        kind: WhirlKind,
        elapsed: Elapsed,
        evaluation: &Evaluation,
        trust: f64,
        settings: &WhirlSettings,
    ) {
        let (evidence, before) = (&evaluation.evidence, self.level());
        let (mut raised, mut held) = (Severity::Ok, Severity::Ok);
        for (index, level) in Severity::RAISED.into_iter().enumerate() {
            let stands = self.level() >= level;
            let (factor, trust) = if stands {
                (1.0 - settings.hysteresis, 1.0)
            } else {
                (1.0, trust)
            };
            let met = evidence.kind == kind
                && trust > 0.0
                && evidence.confidence * trust >= settings.min_confidence * factor
                && meets(index, evidence, factor, settings);
            let lasting = settings.lasting_turns[index];
            let met_for = &mut self.met_for[index];
            *met_for = if met {
                (*met_for + elapsed.turns).min(lasting)
            } else {
                (*met_for - elapsed.turns).max(0.0)
            };
            if met && stands {
                held = level;
            }
            if met && *met_for >= lasting {
                raised = level;
            }
        }
        let change = self
            .hysteresis
            .update(elapsed.time, elapsed.seconds, raised, held, settings.hold_off);
        let met = matches!(change, Transition::Rose | Transition::Stands);
        if self.level() != before || (met && evaluation.strength > self.worst.strength) {
            self.worst = *evaluation;
        }
    }

    /// The worst evaluation since the level was reached; undefined while it is OK.
    pub(super) fn worst(&self) -> &Evaluation {
        &self.worst
    }

    /// Model time at which the conditions of WATCH, WARNING and CRITICAL were met last (s).
    pub(super) fn met(&self) -> [f64; 3] {
        self.hysteresis.met
    }

    pub(super) fn level(&self) -> Severity {
        self.hysteresis.level
    }
}

/// Whether level number `index` above OK is reached.
fn meets(index: usize, evidence: &Evidence, factor: f64, settings: &WhirlSettings) -> bool {
    match evidence.kind {
        WhirlKind::Backward => evidence.rolling || evidence.cycles >= settings.backward_cycles[index] * factor,
        WhirlKind::Forward => settings
            .forward_power
            .get(index)
            .is_some_and(|power| evidence.friction_power >= power * factor),
        WhirlKind::None | WhirlKind::Chaotic | WhirlKind::JointVibration => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// s, a fifteenth of a turn at 40 r/min.
    const STEP: f64 = 0.1;
    const TURNS: f64 = STEP / 1.5;

    fn backward(cycles: f64) -> Evidence {
        Evidence {
            kind: WhirlKind::Backward,
            cycles,
            confidence: 0.9,
            ..Evidence::default()
        }
    }

    fn forward(friction_power: f64) -> Evidence {
        Evidence {
            kind: WhirlKind::Forward,
            friction_power,
            confidence: 0.9,
            ..Evidence::default()
        }
    }

    /// Level after each evaluation.
    fn run_trusted(watch: &mut StationSeverity, evidence: &[Evidence], trust: f64) -> Vec<Severity> {
        let settings = WhirlSettings::default();
        evidence
            .iter()
            .enumerate()
            .map(|(index, evidence)| {
                let elapsed = Elapsed {
                    time: index as f64 * STEP,
                    seconds: STEP,
                    turns: TURNS,
                };
                let kind = if evidence.kind == WhirlKind::Forward {
                    WhirlKind::Forward
                } else {
                    WhirlKind::Backward
                };
                let evaluation = Evaluation {
                    time: elapsed.time,
                    evidence: *evidence,
                    strength: evidence.cycles.max(evidence.friction_power),
                    ..Evaluation::default()
                };
                watch.update(kind, elapsed, &evaluation, trust, &settings);
                watch.level()
            })
            .collect()
    }

    fn run(watch: &mut StationSeverity, evidence: &[Evidence]) -> Vec<Severity> {
        run_trusted(watch, evidence, 1.0)
    }

    fn last(evidence: Evidence) -> Severity {
        run(&mut StationSeverity::default(), &[evidence; 60])[59]
    }

    #[test]
    fn levels_need_their_turns() {
        let levels = run(&mut StationSeverity::default(), &[backward(4.7); 60]);
        let first = |level| levels.iter().position(|&got| got >= level);
        // One turn is 15 evaluations, one and a half are 23.
        let about = |index: Option<usize>, expected: usize| index.is_some_and(|index| index.abs_diff(expected) <= 1);
        assert!(
            about(first(Severity::Watch), 14) && about(first(Severity::Critical), 22),
            "{levels:?}"
        );
    }

    #[test]
    fn a_level_falls_after_the_hold_off() {
        let mut watch = StationSeverity::default();
        run(&mut watch, &[backward(4.0); 60]);
        let levels = run(&mut watch, &[Evidence::default(); 100]);
        let end = levels.iter().position(|&level| level < Severity::Critical);
        assert!(end.is_some_and(|end| (18..=21).contains(&end)), "{end:?}");
    }

    #[test]
    fn no_flapping_at_a_threshold() {
        let mut watch = StationSeverity::default();
        run(&mut watch, &[backward(3.1); 60]);
        let wavering: Vec<_> = (0..3000)
            .map(|index| backward(3.0 + 0.3 * (f64::from(index) * 0.37).sin()))
            .collect();
        assert!(
            run(&mut watch, &wavering)
                .iter()
                .all(|&level| level == Severity::Critical)
        );
    }

    #[test]
    fn each_kind_is_judged_by_what_it_does() {
        assert_eq!(last(backward(1.5)), Severity::Watch);
        assert_eq!(last(backward(2.5)), Severity::Warning);
        assert_eq!(last(backward(3.5)), Severity::Critical);
        let rolling = Evidence {
            rolling: true,
            ..backward(2.2)
        };
        assert_eq!(last(rolling), Severity::Critical);
        assert_eq!(last(forward(20.0)), Severity::Ok);
        assert_eq!(last(forward(100.0)), Severity::Watch);
        assert_eq!(last(forward(1e6)), Severity::Warning);
        let chaotic = Evidence {
            kind: WhirlKind::Chaotic,
            ..backward(5.0)
        };
        assert_eq!(last(chaotic), Severity::Ok);
    }

    #[test]
    fn doubtful_evidence_raises_nothing_and_ends_nothing() {
        let doubtful = Evidence {
            confidence: 0.3,
            ..backward(5.0)
        };
        assert_eq!(last(doubtful), Severity::Ok);
        let mut watch = StationSeverity::default();
        assert_eq!(run_trusted(&mut watch, &[backward(5.0); 60], 0.0)[59], Severity::Ok);
        run(&mut watch, &[backward(5.0); 60]);
        assert_eq!(
            run_trusted(&mut watch, &[backward(5.0); 200], 0.4)[199],
            Severity::Critical
        );
    }
}
