//! Choice of the step's refinement, from the energy error of the steps.
//!
//! The model step stays constant, and with it every grid of inputs, samples and outputs; it is divided into 2^n equal
//! parts. The refinement that the motion needs is a function of the motion alone. The refinement in force is an input
//! of the run ([`RunInputs::refinement`](super::RunInputs)), so that a recording replays to the bit: live, the machine
//! may be too slow for the one that is needed.

use serde::{Deserialize, Serialize};

/// `solver.step`: how a model step is divided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StepRule {
    /// Undivided, or in a fixed number of parts.
    #[default]
    Fixed,
    /// In as many parts as the motion needs.
    Auto,
}

/// Refinement at the start, to which a run returns: half steps. Its pipe-guide forces are 1 to 4 % off those of an
/// eighth, a whole step's 3 to 6 % (`docs/measurements.md`), and the machine usually has time for the more accurate
/// ones.
const USUAL: u32 = 1;

/// Share of the energy error from which the next finer step is needed: half above the 0.18 to 0.21 of half steps in the
/// measured cases, whose forces are accurate.
const FINER_FROM: f64 = 0.30;
/// Share below which the next coarser step suffices: the same cases have 0.07 to 0.08 with quarter steps. Halving the
/// step reduces the error to a half or a third, so that the choice does not alternate.
const COARSER_BELOW: f64 = 0.09;
/// Consecutive evaluations, one per second, before a coarser step.
const CALM: u32 = 10;

/// The refinement in force and the one that the motion needs: a step has 2^refinement parts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StepChoice {
    /// How it is chosen.
    pub rule: StepRule,
    /// Refinement in force.
    pub in_force: u32,
    /// Refinement that the motion needs; 0 with [`StepRule::Fixed`].
    pub wanted: u32,
    /// Finest refinement allowed: in shorter steps the stations inside a span would not follow its ends.
    pub finest: u32,
    calm: u32,
}

impl StepChoice {
    /// At the start of a run.
    pub(super) fn new(rule: StepRule, finest: u32) -> Self {
        Self {
            rule,
            wanted: match rule {
                StepRule::Fixed => 0,
                StepRule::Auto => USUAL.min(finest),
            },
            finest,
            ..Self::default()
        }
    }

    /// Updates the choice with the share of the energy error over a window, at the refinement in force.
    pub(super) fn judge(&mut self, error_share: f64) {
        if self.rule == StepRule::Fixed {
            return;
        }
        if error_share >= FINER_FROM {
            self.calm = 0;
            self.wanted = self.wanted.max((self.in_force + 1).min(self.finest));
        } else if self.wanted > USUAL && self.in_force == self.wanted && error_share < COARSER_BELOW {
            self.calm += 1;
            if self.calm == CALM {
                self.calm = 0;
                self.wanted -= 1;
            }
        } else {
            self.calm = 0;
        }
    }

    /// The remedy for poor quality, for the quality message.
    pub(super) fn remedy(&self) -> &'static str {
        match self.rule {
            StepRule::Auto if self.wanted > self.in_force => {
                "a finer step is asked for, and this machine is too slow for it"
            }
            _ => "a smaller solver.time_step is needed",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::MOST_REFINEMENT;

    /// Judged so many times.
    fn judged(mut choice: StepChoice, times: u32, share: f64) -> StepChoice {
        (0..times).for_each(|_| choice.judge(share));
        choice
    }

    fn auto(in_force: u32) -> StepChoice {
        StepChoice {
            in_force,
            ..StepChoice::new(StepRule::Auto, MOST_REFINEMENT)
        }
    }

    #[test]
    fn errors_ask_for_a_finer_step_at_once_and_calm_for_a_coarser_one_after_a_while() {
        let mut choice = auto(1);
        assert_eq!(choice.wanted, 1);
        choice.judge(0.31);
        assert_eq!(choice.wanted, 2);
        choice.in_force = 2;
        choice = judged(choice, CALM - 1, 0.08);
        assert_eq!(choice.wanted, 2);
        // An interruption counts anew.
        choice.judge(0.10);
        choice = judged(choice, CALM - 1, 0.08);
        assert_eq!(choice.wanted, 2);
        choice.judge(0.08);
        assert_eq!(choice.wanted, 1);
    }

    #[test]
    fn it_never_asks_for_less_than_the_usual_or_more_than_the_finest() {
        assert_eq!(judged(auto(1), 100, 0.0).wanted, USUAL);
        assert_eq!(judged(auto(2), 100, 2.0).wanted, MOST_REFINEMENT);
        let soft = StepChoice {
            in_force: 1,
            ..StepChoice::new(StepRule::Auto, 1)
        };
        assert_eq!(judged(soft, 100, 2.0).wanted, 1);
        assert_eq!(StepChoice::new(StepRule::Auto, 0).wanted, 0);
    }

    #[test]
    fn a_pace_that_allows_less_is_told() {
        let choice = judged(auto(0), 1, 0.5);
        assert_eq!(choice.wanted, 1);
        assert!(choice.remedy().contains("too slow"));
        assert!(!judged(auto(2), 1, 0.5).remedy().contains("too slow"));
        let fixed = judged(StepChoice::new(StepRule::Fixed, MOST_REFINEMENT), 3, 0.5);
        assert_eq!(
            (fixed.wanted, fixed.remedy()),
            (0, "a smaller solver.time_step is needed")
        );
    }
}
