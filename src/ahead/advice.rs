//! The smallest change of speed or weight that ends an alarm, found by looking ahead.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use super::engine::{Start, disturbed, on_threads};
use super::goal::{Candidate, MOST_RUN_UP};
use super::member::{Called, Ended, Watched};
use crate::alarms::{AlarmId, Change, Quantity, Tested, rule};
use flexdrill_config::{Advice, Config};
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// Members that a change has to convince.
const MEMBERS: u32 = 20;
/// Most of them in which the alarm may go on, or another may come. With two, a change that ends the alarm in eight of ten
/// would pass in one search of five, and following it would fail twice in ten times; with one it passes in one of fifteen.
const MOST_AGAINST: u32 = 1;
/// Members that convince where none of them is against: such a change passes in one search of twenty, and the 95 %
/// interval (Wilson) of 14 in 14 begins at 78 %, that of 19 in 20 at 76 %.
const ALL_FOR: u32 = 14;
/// Changes that are tried, as parts of the present value, the smallest first. A larger raise than the last would be another
/// drilling programme.
const LOWER: [f64; 7] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];
const RAISE: [f64; 3] = [0.15, 0.3, 0.5];

/// Model time over which a change is judged (s). An alarm must have ended within the first half: whirl, shock and loads
/// with their windows and delays do in some seconds. Stick-slip and transfer are judged over windows of 10 s.
const fn horizon(alarm: AlarmId) -> f64 {
    match alarm {
        AlarmId::StickSlip | AlarmId::WeightTransfer | AlarmId::TorqueTransfer => 30.0,
        _ => 20.0,
    }
}

/// A change to be tried.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Trial {
    change: Change,
    raises: bool,
    /// Part of the present value.
    size: f64,
}

/// The changes that are tried from a speed (r/min) and a weight (kN), in this order: first those that the rule of the alarm
/// does not speak against, then the smallest. Where two are equally small, the rule's own comes first, then less before
/// more, and speed before weight: less speed takes energy out of every motion of the tool.
fn trials(config: &Config, rule: &Advice, rpm: f64, kn: f64) -> Vec<Trial> {
    let inputs = &config.inputs;
    let mut found = Vec::new();
    let parts = LOWER
        .map(|part| (part, -part))
        .into_iter()
        .chain(RAISE.map(|part| (part, part)));
    for (size, part) in parts {
        for (quantity, value, step, [least, most]) in [
            (
                Quantity::Speed,
                rpm,
                1.0,
                [inputs.rotary_speed.min_rpm, inputs.rotary_speed.max_rpm],
            ),
            (
                Quantity::Weight,
                kn,
                0.5,
                [inputs.weight_on_bit.min_kn, inputs.weight_on_bit.max_kn],
            ),
        ] {
            // What a driller can set: whole turns per minute, half kilonewtons.
            let to = (value * (1.0 + part) / step).round() * step;
            let known = found
                .iter()
                .any(|trial: &Trial| trial.change == Change { quantity, to });
            if to > 0.0 && to != value && (least..=most).contains(&to) && !known {
                found.push(Trial {
                    change: Change { quantity, to },
                    raises: part > 0.0,
                    size,
                });
            }
        }
    }
    let named = |quantity, raises| match (quantity, raises) {
        (Quantity::Speed, false) => rule.lower_rotary_speed_rpm.is_some(),
        (Quantity::Speed, true) => rule.raise_rotary_speed_rpm.is_some(),
        (Quantity::Weight, false) => rule.lower_weight_on_bit_kn.is_some(),
        (Quantity::Weight, true) => rule.raise_weight_on_bit_kn.is_some(),
    };
    let rank = |trial: &Trial| {
        let quantity = trial.change.quantity;
        let (own, opposite) = (named(quantity, trial.raises), named(quantity, !trial.raises));
        (opposite && !own, trial.size, !own)
    };
    found.sort_by(|a, b| {
        let ((a_against, a_size, a_other), (b_against, b_size, b_other)) = (rank(a), rank(b));
        a_against
            .cmp(&b_against)
            .then(a_size.total_cmp(&b_size))
            .then(a_other.cmp(&b_other))
    });
    found
}

/// A search from one state.
struct Search<'a> {
    start: &'a Start,
    alarm: AlarmId,
    standing: &'a [AlarmId],
    seed: u64,
    threads: usize,
    stop: &'a AtomicBool,
    rpm: f64,
    kn: f64,
}

/// What the members of a trial say.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Votes {
    of: u32,
    against: u32,
}

impl Votes {
    /// Whether they decide, and how.
    fn decided(self) -> Option<bool> {
        match self {
            Self { against, .. } if against > MOST_AGAINST => Some(false),
            Self { of, against: 0 } if of >= ALL_FOR => Some(true),
            Self { of, .. } if of >= MEMBERS => Some(true),
            _ => None,
        }
    }
}

impl Search<'_> {
    fn candidate(&self, change: Change) -> Candidate {
        let (rotary_speed, weight_on_bit) = match change.quantity {
            Quantity::Speed => (change.to, self.kn),
            Quantity::Weight => (self.rpm, change.to),
        };
        Candidate {
            rotary_speed,
            weight_on_bit,
            speed_ramp: 0.0,
            weight_ramp: 0.0,
        }
    }

    /// Whether alarms speak against a change: the one that is to end, or another that does not stand.
    fn is_against(&self, alarms: &[Called]) -> bool {
        let mut seen = AlarmId::ALL.into_iter().zip(alarms);
        seen.any(|(id, called)| called.worst.is_some() && (id == self.alarm || !self.standing.contains(&id)))
    }

    /// Whether a member speaks against the change. It parts from the others before the change: where a motion can go on or
    /// end, the way decides which, and one way for all would decide for all. A member that fails is against: what would
    /// have come is unknown.
    fn vote(&self, trial: &Trial, number: usize, member: u32) -> Option<bool> {
        let config = self.start.config();
        let run = disturbed(&self.start.run(), self.seed, number, member);
        let target = self.start.target(&self.candidate(trial.change));
        let judged = Watched::new(run, config, self.stop)
            .run_up(&target, MOST_RUN_UP)
            .and_then(|(there, _)| {
                Watched::new(there, config, self.stop).judge(horizon(self.alarm), |alarms| self.is_against(alarms))
            });
        match judged {
            Ok(member) => Some(self.is_against(&member.alarms)),
            Err(Ended::Stopped) => None,
            Err(_) => Some(true),
        }
    }

    /// Runs members until they decide. `None` where the search is stopped.
    fn confirm(&self, trial: &Trial, number: usize, mut votes: Votes) -> Option<Votes> {
        for until in [ALL_FOR, MEMBERS] {
            if votes.decided().is_some() {
                return Some(votes);
            }
            // Once the change is out, by whichever members, the others need not run.
            let against = AtomicU32::new(votes.against);
            let members: Vec<u32> = (votes.of..until).collect();
            let found = on_threads(&members, self.threads, |member| {
                if against.load(Ordering::Relaxed) > MOST_AGAINST {
                    return Some(None);
                }
                let vote = self.vote(trial, number, *member)?;
                against.fetch_add(u32::from(vote), Ordering::Relaxed);
                Some(Some(vote))
            });
            for vote in found {
                if let Some(vote) = vote? {
                    votes.of += 1;
                    votes.against += u32::from(vote);
                }
            }
        }
        Some(votes)
    }

    fn found(&self, trial: &Trial, votes: Votes) -> Tested {
        Tested {
            alarm: self.alarm,
            from: [self.rpm, self.kn],
            change: trial.change,
            ended: votes.of - votes.against,
            of: votes.of,
        }
    }

    /// First every trial has one member, in order, and one that this member does not speak against is confirmed at once.
    /// The others come after all of these.
    fn run(&self, trials: &[Trial]) -> Option<Tested> {
        let numbered: Vec<(usize, Trial)> = trials.iter().copied().enumerate().collect();
        let mut doubtful = Vec::new();
        for some in numbered.chunks(self.threads.max(1)) {
            let first = on_threads(some, self.threads, |(number, trial)| self.vote(trial, *number, 0));
            for ((number, trial), vote) in some.iter().zip(first) {
                let votes = Votes {
                    of: 1,
                    against: u32::from(vote?),
                };
                if votes.against > 0 {
                    doubtful.push((*number, *trial, votes));
                    continue;
                }
                let votes = self.confirm(trial, *number, votes)?;
                if votes.decided() == Some(true) {
                    return Some(self.found(trial, votes));
                }
            }
        }
        for (number, trial, votes) in doubtful {
            let votes = self.confirm(&trial, number, votes)?;
            if votes.decided() == Some(true) {
                return Some(self.found(&trial, votes));
            }
        }
        None
    }
}

/// The smallest change that ends `alarm` from `start`, where `standing` are the alarms that stand; `None` where none of those
/// tried does, or `stop` was set. The same start and seed give the same answer, with any number of threads.
pub fn search(
    start: &Start,
    alarm: AlarmId,
    standing: &[AlarmId],
    seed: u64,
    threads: usize,
    stop: &AtomicBool,
) -> Option<Tested> {
    let inputs = start.applied().inputs;
    let (rpm, kn) = (rad_per_s_to_rpm(inputs.rotary_speed), n_to_kn(inputs.weight_on_bit));
    let search = Search {
        start,
        alarm,
        standing,
        seed,
        threads,
        stop,
        rpm,
        kn,
    };
    let config = start.config();
    search.run(&trials(config, &rule(alarm, &config.alarms.advice), rpm, kn))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(rule: &Advice) -> Vec<(Quantity, f64)> {
        let config = Config::from_text("default.yaml", include_str!("../../config/default.yaml")).unwrap();
        let trials = trials(&config, rule, 60.0, 20.0);
        trials
            .iter()
            .map(|trial| (trial.change.quantity, trial.change.to))
            .collect()
    }

    #[test]
    fn the_smallest_come_first_and_those_against_the_rule_last() {
        let order = order(&Advice {
            lower_weight_on_bit_kn: Some(8.0),
            raise_rotary_speed_rpm: Some(80.0),
            ..Advice::default()
        });
        assert_eq!(order.len(), 20);
        let first = [(Quantity::Weight, 18.0), (Quantity::Speed, 69.0)];
        assert_eq!(order[..2], first);
        assert_eq!(order[order.len() - 1], (Quantity::Speed, 18.0));
        let against = order
            .iter()
            .position(|(quantity, to)| *quantity == Quantity::Speed && *to < 60.0);
        assert_eq!(against, Some(10), "{order:?}");
    }

    #[test]
    fn without_a_rule_less_comes_before_more() {
        let order = order(&Advice::default());
        let first = [
            (Quantity::Speed, 54.0),
            (Quantity::Weight, 18.0),
            (Quantity::Speed, 69.0),
        ];
        assert_eq!(order[..3], first);
    }

    #[test]
    fn two_members_against_decide_and_so_do_fourteen_without_one() {
        let decided = |of, against| Votes { of, against }.decided();
        assert_eq!(
            [decided(1, 0), decided(13, 0), decided(14, 1), decided(19, 1)],
            [None; 4]
        );
        assert_eq!([decided(2, 2), decided(20, 2)], [Some(false); 2]);
        assert_eq!([decided(14, 0), decided(20, 1)], [Some(true); 2]);
    }
}
