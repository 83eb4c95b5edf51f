//! The steps at which outputs are due, and the instant of a step on the rig's clock.
//!
//! Both are pure functions of the step, so that the node and a replay publish the same messages.

use serde::{Deserialize, Serialize};

/// The outputs made from snapshots, in the order in which those due at one step are published.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub enum Output {
    /// Output `twin/joint_deflections`.
    JointDeflections,
    /// Output `joint_states`.
    JointStates,
    /// Output `twin/contact_forces`.
    ContactForces,
    /// Output `twin/bit_state`.
    BitState,
    /// `twin/whirl`, and `twin/whirl_warnings` when the level has changed.
    Whirl,
    /// Output `twin/tool_shape`.
    ToolShape,
    /// Output `twin/ageing`.
    Ageing,
    /// Output `twin/reactions`.
    Reactions,
    /// Output `twin/transfer`.
    Transfer,
    /// No message: the alarms of the tool are evaluated, independently of what is published.
    Alarms,
}

impl Output {
    /// All of them, in order.
    pub const ALL: [Output; 10] = [
        Output::JointDeflections,
        Output::JointStates,
        Output::ContactForces,
        Output::BitState,
        Output::Whirl,
        Output::ToolShape,
        Output::Ageing,
        Output::Reactions,
        Output::Transfer,
        Output::Alarms,
    ];
}

/// Steps between two messages of each output; 0 is never.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Schedule {
    every: [u64; Output::ALL.len()],
}

impl Schedule {
    /// A schedule for rates in Hz; a rate of 0 switches an output off. Rates are rounded to a whole number of steps,
    /// and none is higher than one message per step.
    pub fn new(time_step: f64, rate: impl Fn(Output) -> f64) -> Self {
        Self {
            every: Output::ALL.map(|output| match rate(output) {
                rate if rate > 0.0 => ((1.0 / (rate * time_step)).round() as u64).max(1),
                _ => 0,
            }),
        }
    }

    /// What is due after `step` steps. At the start, `step` 0, everything that is on.
    pub fn due(&self, step: u64) -> Due {
        let mut due = Due::default();
        for output in Output::ALL {
            let every = self.every[output as usize];
            if every > 0 && step.is_multiple_of(every) {
                due.0 |= 1 << output as usize;
            }
        }
        due
    }

    /// Which statistics end with this snapshot: those of the contacts with the contact forces, and those of the bit with the
    /// bit's state. An output that is off leaves its statistics to the other one. Those of the bit across the hole end with the
    /// judging of the alarms.
    pub fn ends_interval(&self, step: u64) -> EndsInterval {
        let due = self.due(step);
        let ends = |output: Output, other: Output| match self.every[output as usize] {
            0 => due.has(other),
            _ => due.has(output),
        };
        EndsInterval {
            contacts: ends(Output::ContactForces, Output::BitState),
            bit: ends(Output::BitState, Output::ContactForces),
            steering: due.has(Output::Alarms),
        }
    }

    /// Steps between two messages of an output; 0 is off.
    pub fn interval(&self, output: Output) -> u64 {
        self.every[output as usize]
    }

    /// Rate of an output after rounding to whole steps (Hz); 0 is off.
    pub fn rate(&self, output: Output, time_step: f64) -> f64 {
        match self.every[output as usize] {
            0 => 0.0,
            every => 1.0 / (every as f64 * time_step),
        }
    }
}

/// The statistics whose interval ends with a snapshot: each begins anew after it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EndsInterval {
    /// Peaks, root mean squares and shocks of the contact forces.
    pub contacts: bool,
    /// Means, root mean squares and peaks of the bit.
    pub bit: bool,
    /// Means of what the bit does across the hole.
    pub steering: bool,
}

impl EndsInterval {
    /// All of them.
    pub const ALL: Self = Self {
        contacts: true,
        bit: true,
        steering: true,
    };
    /// None.
    pub const NONE: Self = Self {
        contacts: false,
        bit: false,
        steering: false,
    };
}

/// A set of outputs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[must_use]
pub struct Due(u16);

impl Due {
    /// Whether `output` is in the set.
    pub fn has(self, output: Output) -> bool {
        self.0 & (1 << output as usize) != 0
    }

    /// Whether the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The outputs in publishing order.
    pub fn iter(self) -> impl Iterator<Item = Output> {
        Output::ALL.into_iter().filter(move |output| self.has(*output))
    }
}

/// Model time on the rig's clock: the start plus one step for every step taken or skipped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timeline {
    /// The start (ns since 1970).
    pub start: i64,
    /// Model step (s).
    pub time_step: f64,
}

impl Timeline {
    /// The instant (ns since 1970) after `ticks` steps taken or skipped.
    pub fn at(&self, ticks: u64) -> i64 {
        self.start + (ticks as f64 * self.time_step * 1e9).round() as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn schedule() -> Schedule {
        Schedule::new(0.5e-3, |output| match output {
            Output::JointDeflections | Output::JointStates | Output::BitState => 50.0,
            Output::ContactForces | Output::Alarms => 25.0,
            Output::Whirl => 10.0,
            Output::ToolShape | Output::Ageing | Output::Reactions | Output::Transfer => 0.0,
        })
    }

    #[test]
    fn rates_are_kept_over_a_second() {
        let count = |output| (1..=2000).filter(|step| schedule().due(*step).has(output)).count();
        assert_eq!(count(Output::JointDeflections), 50);
        assert_eq!(count(Output::ContactForces), 25);
        assert_eq!(count(Output::Whirl), 10);
        assert_eq!(count(Output::ToolShape), 0);
        assert_eq!(schedule().rate(Output::Whirl, 0.5e-3), 10.0);
    }

    #[test]
    fn the_start_shows_everything_that_is_on() {
        assert_eq!(schedule().due(0).iter().count(), 6);
        assert!(schedule().due(1).is_empty());
    }

    #[test]
    fn an_odd_rate_becomes_a_whole_number_of_steps() {
        let odd = Schedule::new(0.5e-3, |_| 30.0);
        assert!((odd.rate(Output::Whirl, 0.5e-3) - 29.85).abs() < 0.01);
        assert_eq!(Schedule::new(0.5e-3, |_| 1e9).rate(Output::Whirl, 0.5e-3), 2000.0);
    }

    #[test]
    fn statistics_end_with_their_own_messages() {
        assert_eq!(schedule().ends_interval(80), EndsInterval::ALL);
        let bit = EndsInterval {
            bit: true,
            ..EndsInterval::NONE
        };
        assert_eq!(schedule().ends_interval(40), bit);
        assert_eq!(schedule().ends_interval(41), EndsInterval::NONE);
        for only in [Output::BitState, Output::ContactForces] {
            let off = Schedule::new(0.5e-3, |output| if output == only { 50.0 } else { 0.0 });
            let both = EndsInterval {
                steering: false,
                ..EndsInterval::ALL
            };
            assert_eq!(off.ends_interval(40), both);
        }
    }

    #[test]
    fn stamps_do_not_drift() {
        let timeline = Timeline {
            start: 1_000_000_000_000_000_000,
            time_step: 0.3e-3,
        };
        assert_eq!(timeline.at(0), timeline.start);
        assert_eq!(timeline.at(10_000_000), timeline.start + 3_000_000_000_000);
    }
}
