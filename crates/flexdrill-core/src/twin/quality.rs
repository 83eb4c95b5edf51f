//! How far the motion can be trusted, judged from the energy audit over the last seconds.
//!
//! What a step does wrongly in a collision, or where axial forces change within it, is work that no law accounts for. It is
//! compared with what contacts, Rayleigh and numerical damping take in the same time, not with the drive's work, most
//! of which goes into the rock: vibration is what errors feed, and what damping ends. Bounds come from runs against an
//! eighth of the step (`docs/measurements.md`).

use std::fmt;

use serde::{Deserialize, Serialize};

use super::step_choice::{StepChoice, StepRule};
use crate::dynamics::outcome::EnergyAudit;

/// Blocks that make up the window; it moves by one of them.
const BLOCKS: usize = 10;
/// Length of a block (s). In the window of ten of them the shares of steady drilling scatter by a twentieth; a shorter
/// one would need bounds further from where errors begin.
const BLOCK: f64 = 1.0;
/// Share below which a level is left, of the bound at which it is entered: the scatter of the window.
const LEFT_BELOW: f64 = 0.95;
/// Judgements in a row that must be better before a level falls.
const CALM: u32 = 3;

/// Work against the laws over what was taken from vibration, from which the motion is degraded and poor.
pub const ENERGY_ERROR_BOUNDS: [f64; 2] = [0.50, 0.62];
/// Numerical damping over what was taken from vibration, from which the motion is degraded and poor if it comes to
/// [`NUMERICAL_COUNTS_FROM`] of the energy error too.
pub const NUMERICAL_DAMPING_BOUNDS: [f64; 2] = [0.22, 0.285];
/// Part of the energy error from which numerical damping counts: what is less takes away again what errors feed, what is
/// more damps the motion itself.
pub const NUMERICAL_COUNTS_FROM: f64 = 0.7;

/// Power below which nothing vibrates that could be judged (W).
const STILL: f64 = 0.1;

/// How far the motion can be trusted, in a word. The codes are those of the messages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum QualityLevel {
    /// The steps' errors are those of runs that agree with a finer step within about a tenth in ripple and forces.
    #[default]
    Good = 0,
    /// They are those of runs that are off by more.
    Degraded = 1,
    /// They are those of runs that are off by a sixth to several times.
    Poor = 2,
}

impl QualityLevel {
    /// One word, as in messages: `good`, `degraded` or `poor`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Degraded => "degraded",
            Self::Poor => "poor",
        }
    }

    /// Factor on every confidence of the whirl analysis, 0 to 1: a motion that is not the tool's counts like one driven
    /// by values that are stale.
    pub const fn trust(self) -> f64 {
        match self {
            Self::Good | Self::Degraded => 1.0,
            Self::Poor => 0.6,
        }
    }

    const fn of(value: f64, [degraded, poor]: [f64; 2], factor: f64) -> Self {
        if value >= poor * factor {
            Self::Poor
        } else if value >= degraded * factor {
            Self::Degraded
        } else {
            Self::Good
        }
    }
}

impl fmt::Display for QualityLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What makes the motion doubtful.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum QualityCause {
    /// Steps do work that no law accounts for: collisions are too short for the step, or axial forces change too much
    /// within it.
    EnergyError,
    /// The scheme itself damps too much of the motion.
    NumericalDamping,
}

/// How far the motion can be trusted, and why not further.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelQuality {
    /// In a word.
    pub level: QualityLevel,
    /// Why it is not good.
    pub cause: Option<QualityCause>,
    /// The share that gave the cause.
    pub value: f64,
    /// The bound that it reached, or below which it has not stayed long enough yet.
    pub bound: f64,
    /// Over the window: work of the steps against the laws, magnitudes added, over what contact, Rayleigh and numerical
    /// damping took.
    pub energy_error_share: f64,
    /// Over the window: part of the latter that numerical damping took.
    pub numerical_share: f64,
    /// Whether the window has been full since the start; before, the word says nothing.
    pub judged: bool,
    /// The step in force, and the one that the motion asks for.
    pub choice: StepChoice,
}

impl fmt::Display for ModelQuality {
    /// Why the word is not `good`, with value and bound and what to do; nothing if it is.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.judged {
            return write!(f, "not judged before {} s of model time", BLOCKS as f64 * BLOCK);
        }
        let Some(cause) = self.cause else {
            return Ok(());
        };
        let what = match cause {
            QualityCause::EnergyError => "energy errors of the steps come to",
            QualityCause::NumericalDamping => "numerical damping is",
        };
        write!(
            f,
            "{what} {:.0} % of what contacts and damping take ({} from {:.0} %); {}",
            100.0 * self.value,
            self.level,
            100.0 * self.bound,
            self.choice.remedy()
        )
    }
}

/// Sums over a part of the window.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Block {
    duration: f64,
    /// Magnitudes of the steps' work against the laws (J).
    error: f64,
    /// Taken by contact, Rayleigh and numerical damping (J).
    taken: f64,
    /// Taken by numerical damping (J).
    numerical: f64,
}

/// Watches the energy audit.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct QualityWatch {
    blocks: [Block; BLOCKS],
    current: usize,
    filled: usize,
    /// At the end of the last step.
    audit: EnergyAudit,
    quality: ModelQuality,
    better: u32,
}

impl QualityWatch {
    /// Takes the audit after a step of `dt` (s); says whether the word has changed.
    pub(super) fn push(&mut self, dt: f64, audit: &EnergyAudit) -> bool {
        let before = std::mem::replace(&mut self.audit, *audit);
        let block = &mut self.blocks[self.current];
        block.duration += dt;
        block.error += audit.against_laws - before.against_laws;
        block.taken += taken(audit) - taken(&before);
        block.numerical += audit.numerical_damping - before.numerical_damping;
        // Half a step of slack, so that rounding in the sum does not make blocks of different lengths.
        if block.duration + 0.5 * dt < BLOCK {
            return false;
        }
        self.current = (self.current + 1) % BLOCKS;
        self.filled = (self.filled + 1).min(BLOCKS);
        let changed = self.filled == BLOCKS && self.judge();
        self.blocks[self.current] = Block::default();
        changed
    }

    fn judge(&mut self) -> bool {
        let mut sum = Block::default();
        for block in &self.blocks {
            sum.duration += block.duration;
            sum.error += block.error;
            sum.taken += block.taken;
            sum.numerical += block.numerical;
        }
        let taken = sum.taken.max(STILL * sum.duration);
        let (error, numerical) = (sum.error / taken, sum.numerical / taken);
        let shares = |factor: f64| {
            [
                (QualityCause::EnergyError, error, ENERGY_ERROR_BOUNDS),
                (
                    QualityCause::NumericalDamping,
                    if numerical >= NUMERICAL_COUNTS_FROM * error * factor {
                        numerical
                    } else {
                        0.0
                    },
                    NUMERICAL_DAMPING_BOUNDS,
                ),
            ]
        };
        let reached = |factor: f64| {
            let levels = shares(factor).map(|(_, share, bounds)| QualityLevel::of(share, bounds, factor));
            levels.into_iter().max().unwrap_or_default()
        };
        let (raised, held) = (reached(1.0), reached(LEFT_BELOW));
        let level_before = self.quality.level;
        let level = if raised >= level_before || held >= level_before {
            self.better = 0;
            raised.max(level_before)
        } else {
            self.better += 1;
            if self.better < CALM { level_before } else { held }
        };
        if level != level_before {
            self.better = 0;
        }
        // The cause is the share that comes nearest to its bound of this level, or lies further beyond it.
        let bound = |bounds: [f64; 2]| {
            if level == QualityLevel::Poor {
                bounds[1]
            } else {
                bounds[0]
            }
        };
        let [error_share, damping_share] = shares(LEFT_BELOW);
        let first = if damping_share.1 / bound(damping_share.2) > error_share.1 / bound(error_share.2) {
            damping_share
        } else {
            error_share
        };
        let (cause, value, bounds) = first;
        self.quality = ModelQuality {
            level,
            cause: (level > QualityLevel::Good).then_some(cause),
            value,
            bound: bound(bounds),
            energy_error_share: error,
            numerical_share: numerical,
            judged: true,
            choice: self.quality.choice,
        };
        self.quality.choice.judge(error);
        level != level_before
    }

    /// As judged last.
    pub(super) fn quality(&self) -> ModelQuality {
        self.quality
    }

    /// At the start of a run whose step is chosen so.
    pub(super) fn new(rule: StepRule, finest: u32) -> Self {
        let mut watch = Self::default();
        watch.quality.choice = StepChoice::new(rule, finest);
        watch
    }

    /// Steps are taken in 2^`refinement` parts from here on: what was judged with others says nothing of them, and the
    /// word stays until a window of theirs is full.
    pub(super) fn set_refinement(&mut self, refinement: u32) {
        if refinement != self.quality.choice.in_force {
            self.quality.choice.in_force = refinement;
            self.blocks = Default::default();
            (self.current, self.filled, self.better) = (0, 0, CALM - 1);
        }
    }

    /// Forgets everything but how the step is chosen; the audit starts at zero too.
    pub(super) fn reset(&mut self) {
        let before = self.quality.choice;
        let mut choice = StepChoice::new(before.rule, before.finest);
        choice.in_force = before.in_force;
        *self = Self::default();
        self.quality.choice = choice;
    }
}

/// Energy taken from vibration so far (J).
fn taken(audit: &EnergyAudit) -> f64 {
    audit.contact_damping + audit.rayleigh_damping + audit.numerical_damping
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Step of the tests (s); a power of two, so that sums of steps are exact.
    const DT: f64 = 1.0 / 512.0;
    /// Power taken from vibration in them (W).
    const TAKEN: f64 = 5.0;

    /// A run whose steps have given errors, of alternating sign so that their sum stays zero.
    struct Fed {
        watch: QualityWatch,
        audit: EnergyAudit,
        steps: u32,
    }

    impl Fed {
        fn new() -> Self {
            Self {
                watch: QualityWatch::default(),
                audit: EnergyAudit::default(),
                steps: 0,
            }
        }

        /// Over `seconds`; gives the number of changes of the word.
        fn run(&mut self, seconds: f64, error: f64, numerical: f64) -> u32 {
            let mut changes = 0;
            for _ in 0..(seconds / DT) as u32 {
                self.steps += 1;
                let sign = if self.steps.is_multiple_of(2) { 1.0 } else { -1.0 };
                self.audit.error += sign * error * TAKEN * DT;
                self.audit.against_laws += error * TAKEN * DT;
                self.audit.numerical_damping += numerical * TAKEN * DT;
                self.audit.rayleigh_damping += (1.0 - numerical) * TAKEN * DT;
                // Most work goes into the rock, and says nothing.
                self.audit.drive += 400.0 * DT;
                self.audit.bit += 395.0 * DT;
                changes += u32::from(self.watch.push(DT, &self.audit));
            }
            changes
        }

        fn level(&self) -> QualityLevel {
            self.watch.quality().level
        }
    }

    #[test]
    fn errors_that_cancel_are_seen_all_the_same() {
        let mut fed = Fed::new();
        fed.run(9.9, 0.9, 0.1);
        assert!(!fed.watch.quality().judged);
        assert!(fed.watch.quality().to_string().contains("not judged before 10 s"));
        assert_eq!(fed.run(0.2, 0.9, 0.1), 1);
        let quality = fed.watch.quality();
        assert_eq!(
            (quality.level, quality.cause),
            (QualityLevel::Poor, Some(QualityCause::EnergyError))
        );
        // Rounding of sums only.
        assert!((quality.energy_error_share - 0.9).abs() < 1e-9, "{quality:?}");
        assert!((quality.numerical_share - 0.1).abs() < 1e-9, "{quality:?}");
        assert_eq!(
            quality.to_string(),
            "energy errors of the steps come to 90 % of what contacts and damping take (poor from 62 %); \
             a smaller solver.time_step is needed"
        );
        // 400 W of drive, and nothing gained or lost in sum: the audit since the start sees nothing.
        assert!(fed.audit.error.abs() < 1e-6 * fed.audit.drive);
    }

    #[test]
    fn too_much_numerical_damping_is_a_cause_of_its_own() {
        let mut fed = Fed::new();
        fed.run(11.0, 0.1, 0.25);
        let quality = fed.watch.quality();
        assert_eq!(
            (quality.level, quality.cause),
            (QualityLevel::Degraded, Some(QualityCause::NumericalDamping))
        );
        assert!(
            quality.to_string().starts_with("numerical damping is 25 % of"),
            "{quality}"
        );
        fed.run(10.0, 0.1, 0.30);
        assert_eq!(fed.level(), QualityLevel::Poor);
        // Less than what errors may feed.
        let mut fed = Fed::new();
        fed.run(11.0, 0.42, 0.26);
        assert_eq!(fed.level(), QualityLevel::Good);
    }

    #[test]
    fn the_window_forgets() {
        let mut fed = Fed::new();
        fed.run(11.0, 0.9, 0.1);
        assert_eq!(fed.level(), QualityLevel::Poor);
        fed.run(14.0, 0.2, 0.1);
        assert_eq!(fed.level(), QualityLevel::Good);
        assert_eq!(fed.watch.quality().to_string(), "");
        fed.watch.reset();
        assert_eq!(fed.watch, QualityWatch::default());
    }

    #[test]
    fn the_word_does_not_flicker_at_a_bound() {
        let mut fed = Fed::new();
        fed.run(11.0, 0.51, 0.1);
        assert_eq!(fed.level(), QualityLevel::Degraded);
        // Between 95 % of the bound and the bound: held.
        assert_eq!(fed.run(30.0, 0.49, 0.1), 0);
        assert_eq!(fed.level(), QualityLevel::Degraded);
        // Below: left once, for good.
        assert_eq!(fed.run(30.0, 0.46, 0.1), 1);
        assert_eq!(fed.run(30.0, 0.49, 0.1), 0);
        assert_eq!(fed.level(), QualityLevel::Good);
    }

    #[test]
    fn a_tool_at_rest_is_good() {
        let mut fed = Fed::new();
        // Rounding of a tool at rest: errors of the size of what is taken, both a billionth of what drilling takes.
        for _ in 0..(12.0 / DT) as u32 {
            fed.audit.against_laws += 1e-9 * DT;
            fed.audit.rayleigh_damping += 1e-9 * DT;
            fed.watch.push(DT, &fed.audit);
        }
        assert_eq!(fed.level(), QualityLevel::Good);
        assert!(fed.watch.quality().judged);
    }
}
