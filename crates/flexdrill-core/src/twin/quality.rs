//! Quality of the computed motion, judged from the energy audit over the last seconds.
//!
//! The error of a step in a collision, or where axial forces change within it, appears as work that no law accounts
//! for. This work is compared with the energy that contacts, Rayleigh and numerical damping dissipate in the same time.
//! The drive's work is no measure: most of it goes into the rock, whereas errors feed vibration and damping removes it.
//! The bounds come from comparisons with an eighth of the step (`docs/history/tried.md`).

use std::fmt;

use serde::{Deserialize, Serialize};

use super::step_choice::{StepChoice, StepRule};
use crate::dynamics::Energies;

/// Number of blocks in the sliding window.
const BLOCKS: usize = 10;
/// Length of a block (s). Over ten blocks the shares of steady drilling scatter by a twentieth; a shorter window would
/// need wider bounds.
const BLOCK: f64 = 1.0;
/// Ratio of the bound below which a level is left to that at which it is entered: the scatter of the window.
const LEFT_BELOW: f64 = 0.95;
/// Consecutive better evaluations before a level falls.
const CALM: u32 = 3;

/// Ratio of the work against the laws to the energy dissipated, from which the motion is degraded and poor.
pub const ENERGY_ERROR_BOUNDS: [f64; 2] = [0.50, 0.62];
/// Ratio of numerical damping to the energy dissipated, from which the motion is degraded and poor, provided that it
/// reaches [`NUMERICAL_COUNTS_FROM`] of the energy error too.
pub const NUMERICAL_DAMPING_BOUNDS: [f64; 2] = [0.22, 0.285];
/// Part of the energy error from which numerical damping counts: less of it only removes the energy that errors feed
/// in, more of it damps the motion itself.
pub const NUMERICAL_COUNTS_FROM: f64 = 0.7;

/// Dissipated power below which the tool does not vibrate (W).
const STILL: f64 = 0.1;
/// Part of the net change of the stored energy in a block below which dissipation is no measure either: a tool that
/// stands while drive and hoist wind and press it does not vibrate, and errors below the bounds times this part change
/// its forces by less than a third of a percent.
const LOADED: f64 = 0.01;

/// Quality of the computed motion. The codes are those of the messages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum QualityLevel {
    /// The errors are those of runs that agree with a finer step within about a tenth in ripple and forces.
    #[default]
    Good = 0,
    /// The errors are those of runs that deviate by more.
    Degraded = 1,
    /// The errors are those of runs that deviate by a sixth, up to several times.
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

    /// Factor on every confidence of the whirl analysis, 0 to 1: poor motion counts as motion under stale inputs.
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

/// Cause of a quality that is not good.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum QualityCause {
    /// Steps do work that no law accounts for: collisions are too short for the step, or axial forces change too much
    /// within it.
    EnergyError,
    /// The scheme itself damps too much of the motion.
    NumericalDamping,
}

/// Quality of the computed motion with its cause.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelQuality {
    /// Level.
    pub level: QualityLevel,
    /// Cause of a level other than good.
    pub cause: Option<QualityCause>,
    /// The share of the cause.
    pub value: f64,
    /// The bound of this share, which it reached, or below which it has not stayed long enough.
    pub bound: f64,
    /// Over the window: sum of the magnitudes of the steps' work against the laws, over the energy that contact,
    /// Rayleigh and numerical damping dissipated.
    pub energy_error_share: f64,
    /// Over the window: part of the dissipated energy that is numerical damping's.
    pub numerical_share: f64,
    /// Over the window: part of all dissipated energy that the damping by effects takes, which is the mud's.
    pub effects_share: f64,
    /// Whether the window has been full since the start; before, the level means nothing.
    pub judged: bool,
    /// The refinement in force, and the one that the motion needs.
    pub choice: StepChoice,
}

impl fmt::Display for ModelQuality {
    /// The cause with value, bound and remedy; empty if the level is good.
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
        // Where contacts and damping take nearly nothing, the share has no meaning.
        let share = match self.value {
            value if value > 10.0 => "more than 1000".to_owned(),
            value => format!("{:.0}", 100.0 * value),
        };
        write!(
            f,
            "{what} {share} % of what contacts and damping take ({} from {:.0} %); {}",
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
    /// Dissipated by contact, Rayleigh and numerical damping (J).
    dissipated: f64,
    /// Dissipated by numerical damping (J).
    numerical: f64,
    /// Dissipated by effects (J).
    by_effects: f64,
    /// Net change of the energy stored in tool and string (J).
    stored: f64,
}

/// Watches the energy audit.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct QualityWatch {
    blocks: [Block; BLOCKS],
    current: usize,
    filled: usize,
    /// The audit at the end of the last step.
    audit: Energies,
    quality: ModelQuality,
    better: u32,
}

impl QualityWatch {
    /// Takes the audit after a step of `dt` (s); returns whether the level has changed.
    pub(super) fn push(&mut self, dt: f64, audit: &Energies) -> bool {
        let before = std::mem::replace(&mut self.audit, *audit);
        let block = &mut self.blocks[self.current];
        block.duration += dt;
        block.error += audit.against_laws - before.against_laws;
        block.dissipated += audit.damped() - before.damped();
        block.numerical += audit.numerical_damping - before.numerical_damping;
        block.by_effects += audit.damped_by_effects() - before.damped_by_effects();
        block.stored += audit.stored - before.stored;
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
            sum.dissipated += block.dissipated;
            sum.numerical += block.numerical;
            sum.by_effects += block.by_effects;
            // Vibration is over within a block and cancels; loading goes on for several.
            sum.stored += block.stored.abs();
        }
        // Errors are compared with what is dissipated; the floors keep a tool that rests or is loaded slowly from a
        // division by nearly nothing.
        let dissipated = sum.dissipated.max(STILL * sum.duration).max(LOADED * sum.stored);
        let (error, numerical) = (sum.error / dissipated, sum.numerical / dissipated);
        // Numerical damping counts from a part of the error on: less of it only
        // removes what errors feed in, more damps the motion itself.
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
        // With hysteresis: a level is raised at its bounds and left below them.
        let reached = |factor: f64| {
            let levels = shares(factor).map(|(_, share, bounds)| QualityLevel::of(share, bounds, factor));
            levels.into_iter().max().unwrap_or_default()
        };
        let (raised, held) = (reached(1.0), reached(LEFT_BELOW));
        let level_before = self.quality.level;
        // Worse counts at once, better only after it has lasted.
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
        // The cause is the share that is largest relative to its bound at this level.
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
            effects_share: sum.by_effects / dissipated,
            judged: true,
            choice: self.quality.choice,
        };
        self.quality.choice.judge(error);
        level != level_before
    }

    /// The newest quality.
    pub(super) fn quality(&self) -> ModelQuality {
        self.quality
    }

    /// A watch at the start of a run with this rule of the step.
    pub(super) fn new(rule: StepRule, finest: u32) -> Self {
        let mut watch = Self::default();
        watch.quality.choice = StepChoice::new(rule, finest);
        watch
    }

    /// Steps have 2^`refinement` parts from now on: the window restarts, and the level stays until it is full again.
    pub(super) fn set_refinement(&mut self, refinement: u32) {
        if refinement != self.quality.choice.in_force {
            self.quality.choice.in_force = refinement;
            self.blocks = Default::default();
            (self.current, self.filled, self.better) = (0, 0, CALM - 1);
        }
    }

    /// Resets everything except the rule of the step; the audit restarts at zero too.
    pub(super) fn reset(&mut self) {
        let before = self.quality.choice;
        let mut choice = StepChoice::new(before.rule, before.finest);
        choice.in_force = before.in_force;
        *self = Self::default();
        self.quality.choice = choice;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Step of the tests (s); a power of two, so that sums of steps are exact.
    const DT: f64 = 1.0 / 512.0;
    /// Power that damping dissipates in them (W).
    const TAKEN: f64 = 5.0;

    /// A run whose steps have errors of a set size and alternating sign, so that their sum stays zero.
    struct Fed {
        watch: QualityWatch,
        audit: Energies,
        steps: u32,
    }

    impl Fed {
        fn new() -> Self {
            Self {
                watch: QualityWatch::default(),
                audit: Energies::default(),
                steps: 0,
            }
        }

        /// Runs for `seconds`; returns the number of changes of the level.
        fn run(&mut self, seconds: f64, error: f64, numerical: f64) -> u32 {
            let mut changes = 0;
            for _ in 0..(seconds / DT) as u32 {
                self.steps += 1;
                let sign = if self.steps.is_multiple_of(2) { 1.0 } else { -1.0 };
                self.audit.error += sign * error * TAKEN * DT;
                self.audit.against_laws += error * TAKEN * DT;
                self.audit.numerical_damping += numerical * TAKEN * DT;
                self.audit.rayleigh_damping += (1.0 - numerical) * TAKEN * DT;
                // Most work goes into the rock, and is no measure of quality.
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
    fn errors_that_cancel_count_nevertheless() {
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
    fn the_level_does_not_flicker_at_a_bound() {
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

    /// 80 W wind the string above a bit that stands; errors of a thousandth of it exceed the little that vibrates.
    #[test]
    fn a_tool_that_is_wound_is_judged_by_the_energy_that_it_takes_up() {
        let mut fed = Fed::new();
        for _ in 0..(12.0 / DT) as u32 {
            fed.audit.against_laws += 0.08 * DT;
            fed.audit.rayleigh_damping += 0.05 * DT;
            fed.audit.stored += 80.0 * DT;
            fed.watch.push(DT, &fed.audit);
        }
        let quality = fed.watch.quality();
        assert_eq!(quality.level, QualityLevel::Good, "{quality:?}");
        // 0.08 W of a hundredth of 80 W.
        assert!((quality.energy_error_share - 0.1).abs() < 1e-9, "{quality:?}");
    }

    #[test]
    fn a_tool_at_rest_is_good() {
        let mut fed = Fed::new();
        // Rounding of a tool at rest: errors as large as the dissipation, both a billionth of those of drilling.
        for _ in 0..(12.0 / DT) as u32 {
            fed.audit.against_laws += 1e-9 * DT;
            fed.audit.rayleigh_damping += 1e-9 * DT;
            fed.watch.push(DT, &fed.audit);
        }
        assert_eq!(fed.level(), QualityLevel::Good);
        assert!(fed.watch.quality().judged);
    }
}
