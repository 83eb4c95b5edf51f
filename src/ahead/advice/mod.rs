//! The smallest change of speed or weight that ends the alarms that stand, found by looking ahead.
//!
//! A change is chosen by members of one set of seeds and confirmed by members of another, which took no part in
//! choosing it: the count of those that chose it is the best of many. Only the confirming count is given to the
//! driller.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use super::engine::{Start, disturbed, on_threads};
use super::goal::{Candidate, MOST_RUN_UP};
use super::measured::{Measured, is_judged_at};
use super::member::{Called, Ended, LOOK, Watched};
use crate::alarms::{AlarmId, AlarmSet, Change, Knob, Leading, Tested, rule};
use flexdrill_config::{Advice, Config};
use flexdrill_core::twin::SimulationSettings;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// Members that choose a change, at most.
const MEMBERS: u32 = 14;
/// Most of them, and of those that confirm it, in which an alarm may go on or another may come. With two of the ten
/// that confirm it, a change that ends the alarms in eight of ten would pass in two searches of three; with one it
/// passes in three of eight.
const MOST_AGAINST: u32 = 1;
/// Members that choose a change where none of them is against: one that ends the alarms in half of all runs passes in
/// one search of 256.
const ALL_FOR: u32 = 8;
/// Members that confirm a change: a change that works in nineteen runs of twenty is confirmed in nine cases of ten, one
/// that works in half of them in one case of a hundred.
const CONFIRMING: u32 = 10;
/// Makes the seeds of the members that confirm a change others than those that chose it. Any number with bits all over
/// does.
const FRESH: u64 = 0x9e37_79b9_7f4a_7c15;
/// Changes that are tried, as parts of the present value, the smallest first. A larger raise than the last would be another
/// drilling programme.
const LOWER: [f64; 7] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];
const RAISE: [f64; 3] = [0.15, 0.3, 0.5];

/// Model time over which a change is judged (s). An alarm must have ended within the first half and must not return in
/// the second: chaotic whirl that had ended came back within 15 to 21 s in four runs of five (`docs/measurements.md`),
/// and stick-slip and transfer are judged over windows of 10 s.
const HORIZON: f64 = 40.0;

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
    // Lowering first, so that among equal ranks the stable sort below keeps less before more.
    let parts = LOWER
        .map(|part| (part, -part))
        .into_iter()
        .chain(RAISE.map(|part| (part, part)));
    for (size, part) in parts {
        for (quantity, value, step, [least, most]) in [
            (
                Knob::Speed,
                rpm,
                1.0,
                [inputs.rotary_speed.min_rpm, inputs.rotary_speed.max_rpm],
            ),
            (
                Knob::Weight,
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
            // Rounding can give the present value or a change that is already in the list; a second run of either would
            // cost a look-ahead and decide nothing. The bounds are those of the inputs: the node would refuse a value
            // beyond.
            if to > 0.0 && to != value && (least..=most).contains(&to) && !known {
                found.push(Trial {
                    change: Change { quantity, to },
                    raises: part > 0.0,
                    size,
                });
            }
        }
    }
    // The rule names directions from the mechanics of the alarm. They
    // order the trials only, because the look-ahead decides.
    let named = |quantity, raises| match (quantity, raises) {
        (Knob::Speed, false) => rule.lower_rotary_speed_rpm.is_some(),
        (Knob::Speed, true) => rule.raise_rotary_speed_rpm.is_some(),
        (Knob::Weight, false) => rule.lower_weight_on_bit_kn.is_some(),
        (Knob::Weight, true) => rule.raise_weight_on_bit_kn.is_some(),
    };
    let rank = |trial: &Trial| {
        let quantity = trial.change.quantity;
        let (own, opposite) = (named(quantity, trial.raises), named(quantity, !trial.raises));
        // `false` sorts before `true`: against the rule last, then the size, then the rule's own direction first.
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

/// The changes that are tried against an alarm from a speed (r/min) and weight (kN): those to points at which it is
/// judged.
fn judged_trials(config: &Config, settings: &SimulationSettings, alarm: AlarmId, from: [f64; 2]) -> Vec<Trial> {
    let mut trials = trials(config, &rule(alarm, &config.alarms.advice), from[0], from[1]);
    trials.retain(|trial| is_judged_at(alarm, point(from, trial.change), settings));
    trials
}

/// What one member says of a change.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Outcome {
    /// The alarms that stood at the beginning and that cannot be said to have ended: they stand, the motion still calls
    /// for them, or they are not judged.
    open: AlarmSet,
    /// Whether another alarm came.
    came: bool,
}

impl Outcome {
    /// Whether it speaks against a change that is to end the alarms of `goal`.
    fn is_against(&self, goal: AlarmSet) -> bool {
        self.came || !self.open.common(goal).is_empty()
    }
}

/// A change with the members that have tried it, by their number.
struct Tried {
    trial: Trial,
    number: usize,
    outcomes: Vec<Option<Outcome>>,
}

impl Tried {
    /// What the first `until` members say of `goal`: how many have run, and how many are against.
    fn votes(&self, goal: AlarmSet, until: u32) -> Votes {
        let mut votes = Votes::default();
        for outcome in self.outcomes.iter().take(until as usize).flatten() {
            votes.of += 1;
            votes.against += u32::from(outcome.is_against(goal));
        }
        votes
    }

    /// Whether the first member speaks against it.
    fn is_doubtful(&self, goal: AlarmSet) -> bool {
        self.votes(goal, 1).against > 0
    }
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

/// A search that was stopped.
struct Stopped;

/// Speed (r/min) and weight (kN) after a change from `from`.
fn point(from: [f64; 2], change: Change) -> [f64; 2] {
    match change.quantity {
        Knob::Speed => [change.to, from[1]],
        Knob::Weight => [from[0], change.to],
    }
}

/// The runs of the model that try changes.
struct Runs<'a> {
    start: &'a Start,
    settings: SimulationSettings,
    leading: Leading,
    stop: &'a AtomicBool,
    /// Speed (r/min) and weight (kN).
    from: [f64; 2],
}

impl Runs<'_> {
    /// What the alarms of a member say.
    fn outcome(&self, alarms: &[Called]) -> Outcome {
        let called: AlarmSet = AlarmId::ALL
            .into_iter()
            .zip(alarms)
            .filter(|(_, called)| called.worst.is_some())
            .map(|(id, _)| id)
            .collect();
        let Leading { standing, shelved, .. } = self.leading;
        Outcome {
            open: called.common(standing),
            came: !called.is_within(standing.union(shelved)),
        }
    }

    /// A member's outcome; `None` where it was stopped. It parts from the others before the change: where a motion can
    /// continue or end, the path to the change decides which: with a shared path all members would end alike. A member that
    /// fails speaks against the change, because what would have followed is unknown.
    fn member(&self, trial: &Trial, seed: u64, number: usize, member: u32) -> Option<Outcome> {
        let config = self.start.config();
        let Leading { alarm, standing, .. } = self.leading;
        let run = disturbed(&self.start.run(), seed, number, member);
        let at = point(self.from, trial.change);
        let target = self.start.target(&Candidate {
            rotary_speed: at[0],
            weight_on_bit: at[1],
            speed_ramp: 0.0,
            weight_ramp: 0.0,
        });
        let judged = Watched::new(run, config, self.stop)
            .run_up(&target, MOST_RUN_UP)
            .and_then(|(there, _)| {
                // Without the end of the leading alarm no goal is reached, and the rest of the member says nothing
                // more.
                let is_out = |alarms: &[Called]| {
                    let outcome = self.outcome(alarms);
                    outcome.came || outcome.open.contains(alarm)
                };
                Watched::new(there, config, self.stop)
                    .wavering(self.start.wavering(seed, number, member))
                    .measured(Measured::new(self.settings.clone(), at, LOOK))
                    .judge(HORIZON, is_out)
            });
        match judged {
            Ok(member) => {
                let mut outcome = self.outcome(&member.alarms);
                if let Some(measured) = &member.measured {
                    let open = |id: &AlarmId| !measured.is_judged(*id) || measured.calls(*id, config);
                    outcome.open = outcome.open.union(standing.iter().filter(open).collect());
                }
                Some(outcome)
            }
            Err(Ended::Stopped) => None,
            Err(_) => Some(Outcome {
                open: standing,
                came: true,
            }),
        }
    }
}

/// A search from one state.
struct Search<M> {
    leading: Leading,
    /// Speed (r/min) and weight (kN).
    from: [f64; 2],
    seed: u64,
    threads: usize,
    /// Runs a member of a trial by seed, number of the trial and number of the member; `None` where it was stopped.
    member: M,
}

impl<M: Fn(&Trial, u64, usize, u32) -> Option<Outcome> + Sync> Search<M> {
    /// Runs members of `numbers` that are missing, until so many are against that the change is out for `goal`; the
    /// others need not run then, whichever they are.
    fn run_members(
        &self,
        tried: &Tried,
        seed: u64,
        goal: AlarmSet,
        numbers: &[u32],
        against: u32,
    ) -> Result<Vec<(u32, Outcome)>, Stopped> {
        let against = AtomicU32::new(against);
        let found = on_threads(numbers, self.threads, |member| {
            if against.load(Ordering::Relaxed) > MOST_AGAINST {
                return Some(None);
            }
            let outcome = (self.member)(&tried.trial, seed, tried.number, *member)?;
            against.fetch_add(u32::from(outcome.is_against(goal)), Ordering::Relaxed);
            Some(Some((*member, outcome)))
        });
        let found: Option<Vec<Option<(u32, Outcome)>>> = found.into_iter().collect();
        Ok(found.ok_or(Stopped)?.into_iter().flatten().collect())
    }

    /// Runs members until they decide whether the change is chosen for `goal`.
    fn is_chosen(&self, tried: &mut Tried, goal: AlarmSet) -> Result<bool, Stopped> {
        for until in [ALL_FOR, MEMBERS] {
            let votes = tried.votes(goal, until);
            if votes.against <= MOST_AGAINST {
                let missing: Vec<u32> = (0..until)
                    .filter(|member| !matches!(tried.outcomes.get(*member as usize), Some(Some(_))))
                    .collect();
                for (member, outcome) in self.run_members(tried, self.seed, goal, &missing, votes.against)? {
                    let member = member as usize;
                    if tried.outcomes.len() <= member {
                        tried.outcomes.resize(member + 1, None);
                    }
                    tried.outcomes[member] = Some(outcome);
                }
            }
            if let Some(decided) = tried.votes(goal, until).decided() {
                return Ok(decided);
            }
        }
        Ok(false)
    }

    /// Confirms a change by members that took no part in choosing it. What it was not chosen for and ends in all of
    /// them but one is among what it ends.
    fn confirmed(&self, tried: &Tried, goal: AlarmSet) -> Result<Option<Tested>, Stopped> {
        let numbers: Vec<u32> = (0..CONFIRMING).collect();
        let members = self.run_members(tried, self.seed ^ FRESH, goal, &numbers, 0)?;
        if members.len() < CONFIRMING as usize {
            return Ok(None);
        }
        let standing = self.leading.standing;
        let against =
            |alarms: AlarmSet| members.iter().filter(|(_, outcome)| outcome.is_against(alarms)).count() as u32;
        let mut ends = goal;
        for id in standing.without(goal).iter() {
            let with = ends.union([id].into_iter().collect());
            if against(with) <= MOST_AGAINST {
                ends = with;
            }
        }
        Ok((against(ends) <= MOST_AGAINST).then(|| Tested {
            ends,
            stays: standing.without(ends),
            from: self.from,
            change: tried.trial.change,
            ended: CONFIRMING - against(ends),
            of: CONFIRMING,
        }))
    }

    /// What a change is to end, in the order in which that is searched for: all alarms that stand; those of them that
    /// some change may end; the leading one alone.
    fn goals(&self, tried: &[Tried]) -> Vec<AlarmSet> {
        let Leading { alarm, standing, .. } = self.leading;
        // Only members that were judged to their end have the other alarms.
        let firsts = tried
            .iter()
            .filter_map(|tried| tried.outcomes.first().copied().flatten());
        let to_their_end = firsts.filter(|outcome| !outcome.came && !outcome.open.contains(alarm));
        let lasting = to_their_end
            .map(|outcome| outcome.open)
            .reduce(AlarmSet::common)
            .unwrap_or_default();
        let mut goals = vec![standing.without(lasting), [alarm].into_iter().collect()];
        goals.dedup();
        goals
    }

    /// First every trial has one member, in order, and one that this member does not speak against is chosen and
    /// confirmed at once. The others come after all of these, and then those that leave some of the alarms.
    fn run(&self, trials: &[Trial]) -> Result<Option<Tested>, Stopped> {
        let standing = self.leading.standing;
        let mut tried: Vec<Tried> = (0..)
            .zip(trials)
            .map(|(number, trial)| Tried {
                trial: *trial,
                number,
                outcomes: Vec::new(),
            })
            .collect();
        for some in tried.chunks_mut(self.threads.max(1)) {
            let firsts = on_threads(some, self.threads, |tried| {
                (self.member)(&tried.trial, self.seed, tried.number, 0)
            });
            for (tried, first) in some.iter_mut().zip(firsts) {
                tried.outcomes.push(Some(first.ok_or(Stopped)?));
            }
            for tried in some.iter_mut().filter(|tried| !tried.is_doubtful(standing)) {
                if let Some(tested) = self.tested(tried, standing)? {
                    return Ok(Some(tested));
                }
            }
        }
        for goal in self.goals(&tried) {
            for is_doubtful in [false, true] {
                for tried in tried.iter_mut().filter(|tried| tried.is_doubtful(goal) == is_doubtful) {
                    // These were chosen and not confirmed, or not chosen.
                    if goal == standing && !is_doubtful {
                        continue;
                    }
                    if let Some(tested) = self.tested(tried, goal)? {
                        return Ok(Some(tested));
                    }
                }
            }
        }
        Ok(None)
    }

    fn tested(&self, tried: &mut Tried, goal: AlarmSet) -> Result<Option<Tested>, Stopped> {
        if self.is_chosen(tried, goal)? {
            self.confirmed(tried, goal)
        } else {
            Ok(None)
        }
    }
}

/// The smallest change that ends the alarms that stand, from `start`; where none of those tried does, one that ends the
/// leading alarm, with those that stay; `None` where none of those tried does that either, or `stop` was set. A change
/// to a point at which the leading alarm is not judged is not tried: it would silence the alarm. The same start and
/// seed give the same answer, with any number of threads.
pub fn search(start: &Start, leading: &Leading, seed: u64, threads: usize, stop: &AtomicBool) -> Option<Tested> {
    let inputs = start.applied().inputs;
    let from = [rad_per_s_to_rpm(inputs.rotary_speed), n_to_kn(inputs.weight_on_bit)];
    let config = start.config();
    let settings = config.simulation();
    let trials = judged_trials(config, &settings, leading.alarm, from);
    let runs = Runs {
        start,
        settings,
        leading: *leading,
        stop,
        from,
    };
    let search = Search {
        leading: *leading,
        from,
        seed,
        threads,
        member: |trial: &Trial, seed, number, member| runs.member(trial, seed, number, member),
    };
    search.run(&trials).unwrap_or(None)
}

#[cfg(test)]
mod tests;
