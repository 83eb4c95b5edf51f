//! What plausible tools say of the rig, at an age at which a node and a replay both have it.

use std::collections::VecDeque;

use flexdrill_calibration::plausible::Compared;

/// Age of what is judged (s). A replay computes plausible tools up to ten seconds behind its run, a node mostly one or two:
/// both have the same second at this age.
const AGE: f64 = 11.0;
/// Time between two seconds of plausible tools (s).
const SECOND: f64 = 1.0;
/// Time after which plausible tools that say nothing are waited for no longer (s): members that begin again have means of
/// their own by then.
const PATIENCE: f64 = 60.0;

/// Seconds that are kept at most, while nothing is judged.
const MOST: usize = 64;

/// What plausible tools say of the rig at the end of a second.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Judgement {
    /// The rig against all tools and those that fit; `None` where too few tools run to speak of.
    pub compared: Option<Compared>,
    /// The friction that they have by their weights; `None` where too few of them have weight.
    pub friction: Option<Friction>,
}

/// Friction of both layers over that of the configuration, as `calibration.friction_factor` has it: for a tool whose layers
/// differ, the mean of both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Mean of the tools by their weights.
    pub mean: f64,
    /// Its quantiles of 5 and 95 %.
    pub band: [f64; 2],
    /// The same before anything was measured. Both ends are equal where friction is not drawn.
    pub prior: [f64; 2],
}

/// What is heard of plausible tools at an instant.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Said {
    /// They run and have not come to it. What stands remains.
    Later,
    /// They have not come to it for long: the twin is judged alone.
    Nothing,
    /// This.
    Judgement(Box<Judgement>),
}

/// Plausible tools that run with the twin.
#[derive(Debug, Clone)]
pub(super) struct Tools {
    time_step: f64,
    /// Ticks and what was said of them, the oldest first.
    seconds: VecDeque<(u64, Judgement)>,
    /// Ticks from which on nothing was said.
    silent: Option<u64>,
}

impl Tools {
    pub(super) fn new(time_step: f64) -> Self {
        Self {
            time_step,
            seconds: VecDeque::new(),
            silent: None,
        }
    }

    /// Takes what they say of the second that ends at these ticks.
    pub(super) fn hear(&mut self, ticks: u64, judgement: Judgement) {
        if self.seconds.len() >= MOST {
            self.seconds.pop_front();
        }
        self.seconds.push_back((ticks, judgement));
    }

    /// What is judged at these ticks: what they said of one second, [`AGE`] ago. A recorded run that had it too late is
    /// repeated `without` it.
    pub(super) fn at(&mut self, ticks: u64, without: bool) -> Said {
        let passed = |since: u64| ticks.saturating_sub(since) as f64 * self.time_step;
        // Ticks are whole, ages are sums of rounded steps.
        let margin = 0.5 * self.time_step;
        while let Some((of, _)) = self.seconds.front()
            && passed(*of) > AGE + SECOND - margin
        {
            self.seconds.pop_front();
        }
        let known = self.seconds.front().filter(|(of, _)| passed(*of) > AGE - margin);
        match known.filter(|_| !without) {
            Some((_, judgement)) => {
                self.silent = None;
                Said::Judgement(Box::new(judgement.clone()))
            }
            None => match passed(*self.silent.get_or_insert(ticks)) {
                waited if waited > PATIENCE => Said::Nothing,
                _ => Said::Later,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_calibration::residual::RigQuantity;

    const STEP: f64 = 0.01;

    fn judgement(tools: u32) -> Judgement {
        Judgement {
            compared: Some(Compared {
                readings: [None; RigQuantity::COUNT],
                drilling: true,
                tools,
            }),
            friction: None,
        }
    }

    /// What is judged follows from instants, whenever messages come within the age.
    #[test]
    fn a_second_is_judged_at_its_age_however_late_it_came() {
        let of = |delay: u64| {
            let mut tools = Tools::new(STEP);
            (0..40_u64)
                .map(|second| {
                    if second >= delay {
                        tools.hear(100 * (second - delay), judgement((second - delay) as u32));
                    }
                    // A comparison need not be at a whole second.
                    tools.at(100 * second + 37, false)
                })
                .collect::<Vec<_>>()
        };
        let soon = of(1);
        assert_eq!(soon, of(10));
        for (second, said) in soon.iter().enumerate() {
            match second {
                0..=10 => assert_eq!(*said, Said::Later),
                _ => assert_eq!(
                    *said,
                    Said::Judgement(Box::new(judgement(second as u32 - 11))),
                    "{second}"
                ),
            }
        }
    }

    #[test]
    fn silent_tools_are_waited_for_a_minute_and_a_second_that_came_too_late_is_left_out() {
        let mut tools = Tools::new(STEP);
        tools.hear(0, judgement(8));
        assert_eq!(tools.at(1100, true), Said::Later);
        assert_eq!(tools.at(1101, false), Said::Judgement(Box::new(judgement(8))));
        for second in 12..=72 {
            assert_eq!(tools.at(100 * second, false), Said::Later, "{second}");
        }
        assert_eq!(tools.at(7301, false), Said::Nothing);
        tools.hear(7000, judgement(8));
        assert_eq!(tools.at(8100, false), Said::Judgement(Box::new(judgement(8))));
    }
}
