//! How a search spends its members: the largest change of a direction first, then between the changes that end the alarms
//! and those that do not, then fresh members for the smallest that ends them.

use std::fmt;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use super::trials::{Trial, ladders};
use crate::ahead::chance::Chance;
use crate::ahead::engine::on_threads;
use crate::alarms::{AlarmSet, Leading, Tested};
use flexdrill_text::counted;

/// Members that confirm a change: one that works in nineteen runs of twenty is confirmed in nine cases of ten, one that works
/// in half of them in one case of a hundred.
const CONFIRMING: u32 = 10;
/// Most of them in which an alarm may go on or another may come. With two, a change that ends the alarms in eight of ten
/// runs would pass in two searches of three; with one it passes in three of eight.
const MOST_AGAINST: u32 = 1;
/// Fewest confirming members that may give a first answer.
pub const LEAST_CONFIRMING: u32 = 4;
/// Numbers of confirming members after which it is asked whether a first answer can be given.
const ASKED_AFTER: [u32; 3] = [LEAST_CONFIRMING, 8, CONFIRMING];
/// A first answer is given once the lower end of the 95 % interval (Wilson) of its share is above this: the change then
/// ends the alarms more often than not. Four of four are the fewest (51 %), seven of eight the fewest with one against.
const MORE_OFTEN_THAN_NOT: f64 = 0.5;
/// Changes that are screened together, whatever the number of threads, so that threads do not change what is tried.
const TOGETHER: usize = 2;
/// Makes the seeds of the members that confirm a change others than those that chose it. Any number with bits all over
/// does.
const FRESH: u64 = 0x9e37_79b9_7f4a_7c15;
/// Time that alarms have to end (s), and that they have where no change ends them within it. Stick-slip is judged over
/// windows of 10 s and held for 5 s.
const WITHIN: f64 = 20.0;
const SLOWLY_WITHIN: f64 = 60.0;
/// Time for which an alarm that has ended must stay away (s), one and a half of the windows of stick-slip and transfer, and
/// the least time of a member: a chaotic whirl that had ended came back within 15 to 21 s of the change in four runs of
/// five (`docs/measurements.md`).
const LASTING: f64 = 15.0;
const LEAST: f64 = 25.0;
/// Least time of the members that confirm a first answer (s): the driller has it by then, and they can take the time that
/// alarms need to return slowly.
const LEAST_OF_LATER: f64 = 40.0;

/// How long alarms have to end in a member, and must stay away then (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub within: f64,
    /// 0 for a member that only chooses.
    pub lasting: f64,
    /// Least time of the member (s).
    pub least: f64,
}

impl Span {
    /// Of a member that chooses a change: it ends with the alarms.
    const fn choosing(within: f64) -> Self {
        Self {
            within,
            lasting: 0.0,
            least: 0.0,
        }
    }

    /// Of a member that confirms a change, by its number.
    const fn confirming(within: f64, number: u32) -> Self {
        Self {
            within,
            lasting: LASTING,
            least: if number < ASKED_AFTER[0] { LEAST } else { LEAST_OF_LATER },
        }
    }
}

/// What one member says of a change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outcome {
    /// The alarms that stood at the beginning and that cannot be said to have ended: they stand, the motion still calls
    /// for them, or they are not judged.
    pub open: AlarmSet,
    /// Whether another alarm came.
    pub came: bool,
    /// Whether one of those that came is destructive, that is of high priority.
    pub destroys: bool,
    /// Model time that the member took (s).
    pub seconds: f64,
}

impl Outcome {
    /// Whether it speaks against a change that is to end the alarms of `goal`.
    pub fn is_against(&self, goal: AlarmSet) -> bool {
        self.came || self.destroys || !self.open.common(goal).is_empty()
    }

    /// How many members it counts for, against a change: a destructive alarm ends it alone.
    fn weight(&self, goal: AlarmSet) -> u32 {
        match (self.destroys, self.is_against(goal)) {
            (true, _) => MOST_AGAINST + 1,
            (false, against) => u32::from(against),
        }
    }
}

/// A change with the members that have tried it.
struct Tried {
    trial: Trial,
    number: usize,
    /// The member that chooses or drops it.
    first: Option<Outcome>,
    /// Time that its alarms have to end (s).
    within: f64,
    /// Members that took no part in choosing it, by number.
    fresh: [Option<Outcome>; CONFIRMING as usize],
    /// What it was not confirmed for.
    refuted: Option<AlarmSet>,
}

impl Tried {
    fn survives(&self, goal: AlarmSet) -> bool {
        self.refuted != Some(goal) && self.first.is_some_and(|first| !first.is_against(goal))
    }

    /// The fresh members that have run.
    fn ran(&self) -> impl Iterator<Item = &Outcome> {
        self.fresh.iter().flatten()
    }

    /// How many of them a change that is to end `goal` has against it.
    fn against(&self, goal: AlarmSet) -> u32 {
        self.ran().map(|outcome| outcome.weight(goal)).sum()
    }
}

/// A search that was stopped.
pub(super) struct Stopped;

/// How far a search is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchProgress {
    /// Model time of its members so far (s).
    pub seconds: f64,
    /// A first answer while more members confirm it; none before, or where they have refuted it.
    pub first: Option<Tested>,
}

/// What a search found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Searched {
    /// The change; none where no change that was tried ends the leading alarm.
    pub tested: Option<Tested>,
    /// Changes that were tried.
    pub changes: usize,
    /// Model time of its members (s).
    pub seconds: f64,
    /// Model time until the first answer that more members did not refute (s); NaN without one.
    pub until_first: f64,
}

impl fmt::Display for Searched {
    /// What it took and found, for a log.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let changes = counted(self.changes as u64, "change");
        write!(f, "{changes} and {:.0} s of model time: ", self.seconds)?;
        match self.tested {
            Some(tested) => write!(f, "{tested}"),
            None => f.write_str(
                "nothing from 0.3 to 2 times the speed, or 0.3 to 1.5 times the weight, ends it in 9 of 10 runs",
            ),
        }
    }
}

/// A search from one state.
pub(super) struct Search<M> {
    pub leading: Leading,
    /// Speed (r/min) and weight (kN).
    pub from: [f64; 2],
    pub seed: u64,
    pub threads: usize,
    /// Runs a member of a trial over a span, by seed, number of the trial and number of the member; `None` where it was
    /// stopped.
    pub member: M,
}

/// The changes of a search, and what it hears.
struct Course<'a> {
    tried: Vec<Tried>,
    /// Model time so far (ms): members add to it from their threads.
    spent: AtomicU64,
    until_first: f64,
    hear: &'a mut dyn FnMut(SearchProgress),
}

impl Course<'_> {
    fn seconds(&self) -> f64 {
        self.spent.load(Ordering::Relaxed) as f64 / 1e3
    }

    fn tell(&mut self, first: Option<Tested>) {
        let seconds = self.seconds();
        (self.hear)(SearchProgress { seconds, first });
    }
}

impl<M: Fn(&Trial, u64, usize, u32, Span) -> Option<Outcome> + Sync> Search<M> {
    /// Searches among the trials. `hear` hears of each round of members.
    ///
    /// # Errors
    /// When a member was stopped.
    pub fn run(&self, trials: &[Trial], hear: &mut dyn FnMut(SearchProgress)) -> Result<Searched, Stopped> {
        let tried = (0..).zip(trials).map(|(number, trial)| Tried {
            trial: *trial,
            number,
            first: None,
            within: WITHIN,
            fresh: [None; CONFIRMING as usize],
            refuted: None,
        });
        let mut course = Course {
            tried: tried.collect(),
            spent: AtomicU64::new(0),
            until_first: f64::NAN,
            hear,
        };
        let tested = self.found(trials, &mut course)?;
        Ok(Searched {
            tested,
            changes: course.tried.iter().filter(|tried| tried.first.is_some()).count(),
            seconds: course.seconds(),
            until_first: if tested.is_some() { course.until_first } else { f64::NAN },
        })
    }

    fn found(&self, trials: &[Trial], course: &mut Course<'_>) -> Result<Option<Tested>, Stopped> {
        let standing = self.leading.standing;
        let ladders = ladders(trials);
        // The largest change of a direction says with one member whether the direction helps at all. Two directions that the
        // rule names come first, those that it speaks against last.
        for pair in ladders.chunks(TOGETHER) {
            let largest: Vec<usize> = pair.iter().filter_map(|ladder| ladder.last().copied()).collect();
            self.screen(course, &largest, WITHIN)?;
            let mut helping: Vec<&Vec<usize>> = (pair.iter().zip(&largest))
                .filter(|(_, largest)| course.tried[**largest].survives(standing))
                .map(|(ladder, _)| ladder)
                .collect();
            // Where both help, more speed or weight drills faster than less of the other.
            helping.sort_by_key(|ladder| ladder.last().is_some_and(|largest| !trials[*largest].raises));
            for ladder in helping {
                if let Some(tested) = self.smallest(course, ladder)? {
                    return Ok(Some(tested));
                }
            }
        }
        // What helps need not grow with the change: before nothing is said to end the alarms, each change has had a member.
        let rest: Vec<usize> = (0..trials.len())
            .filter(|index| course.tried[*index].first.is_none())
            .collect();
        for pair in rest.chunks(TOGETHER) {
            self.screen(course, pair, WITHIN)?;
            if let Some(tested) = self.first_confirmed(course, pair.iter().copied(), standing)? {
                return Ok(Some(tested));
            }
        }
        // The largest changes again, with more time: a motion may take most of a minute to end.
        let slow: Vec<usize> = (ladders.iter().filter_map(|ladder| ladder.last().copied()))
            .filter(|index| course.tried[*index].first.is_some_and(|first| !first.came))
            .filter(|index| course.tried[*index].refuted.is_none())
            .collect();
        for pair in slow.chunks(TOGETHER) {
            self.screen(course, pair, SLOWLY_WITHIN)?;
            if let Some(tested) = self.first_confirmed(course, pair.iter().copied(), standing)? {
                return Ok(Some(tested));
            }
        }
        // No change ends all: one that ends those that some change ends, then one that ends the leading alarm.
        for goal in self.goals(&course.tried) {
            if let Some(tested) = self.first_confirmed(course, 0..trials.len(), goal)? {
                return Ok(Some(tested));
            }
        }
        Ok(None)
    }

    /// Gives each of these changes its first member.
    fn screen(&self, course: &mut Course<'_>, which: &[usize], within: f64) -> Result<(), Stopped> {
        let (tried, spent) = (&course.tried, &course.spent);
        let span = Span::choosing(within);
        let firsts = on_threads(which, self.threads, |index| {
            let Tried { trial, number, .. } = &tried[*index];
            timed((self.member)(trial, self.seed, *number, 0, span), spent)
        });
        for (index, first) in which.iter().zip(firsts) {
            let tried = &mut course.tried[*index];
            (tried.first, tried.within) = (Some(first.ok_or(Stopped)?), within);
        }
        course.tell(None);
        Ok(())
    }

    /// The smallest change of a direction, whose largest one survives, that is confirmed.
    fn smallest(&self, course: &mut Course<'_>, ladder: &[usize]) -> Result<Option<Tested>, Stopped> {
        let standing = self.leading.standing;
        // Rungs from `least` on are open: those below it do not survive. `top` does.
        let (mut least, mut top) = (0, ladder.len().saturating_sub(1));
        while least < top {
            let rungs = between(least, top);
            let which: Vec<usize> = rungs.iter().map(|rung| ladder[*rung]).collect();
            self.screen(course, &which, WITHIN)?;
            let survives = |rung: &usize| course.tried[ladder[*rung]].survives(standing);
            let survivor = rungs.iter().copied().find(survives);
            let below = survivor.unwrap_or(top);
            least = (rungs.iter().copied().filter(|rung| *rung < below).max()).map_or(least, |failed| failed + 1);
            top = below;
        }
        // Where the smallest is refuted, the next larger one of the same direction is the next smallest.
        for index in &ladder[top.min(ladder.len())..] {
            if course.tried[*index].first.is_none() {
                self.screen(course, &[*index], WITHIN)?;
            }
            if let Some(tested) = self.first_confirmed(course, [*index], standing)? {
                return Ok(Some(tested));
            }
        }
        Ok(None)
    }

    /// The first of these changes that survives for `goal` and is confirmed.
    fn first_confirmed(
        &self,
        course: &mut Course<'_>,
        which: impl IntoIterator<Item = usize>,
        goal: AlarmSet,
    ) -> Result<Option<Tested>, Stopped> {
        for index in which {
            if course.tried[index].survives(goal)
                && let Some(tested) = self.confirmed(course, index, goal)?
            {
                return Ok(Some(tested));
            }
        }
        Ok(None)
    }

    /// Confirms a change by members that took no part in choosing it. A first answer is heard as soon as they say more
    /// often than not.
    fn confirmed(&self, course: &mut Course<'_>, index: usize, goal: AlarmSet) -> Result<Option<Tested>, Stopped> {
        let mut heard = false;
        for until in ASKED_AFTER {
            let Course { tried, spent, .. } = &*course;
            let this = &tried[index];
            let numbers: Vec<u32> = (0..until)
                .filter(|number| this.fresh[*number as usize].is_none())
                .collect();
            let against = AtomicU32::new(this.against(goal));
            // Members run until so many are against that the change is out; the others need not run then, whichever they
            // are.
            let ran = on_threads(&numbers, self.threads, |number| {
                if against.load(Ordering::Relaxed) > MOST_AGAINST {
                    return Some(None);
                }
                let span = Span::confirming(this.within, *number);
                let outcome = (self.member)(&this.trial, self.seed ^ FRESH, this.number, *number, span);
                let outcome = timed(outcome, spent)?;
                against.fetch_add(outcome.weight(goal), Ordering::Relaxed);
                Some(Some(outcome))
            });
            let this = &mut course.tried[index];
            for (number, ran) in numbers.iter().zip(ran) {
                if let Some(outcome) = ran.ok_or(Stopped)? {
                    this.fresh[*number as usize] = Some(outcome);
                }
            }
            if this.against(goal) > MOST_AGAINST {
                this.refuted = Some(goal);
                course.until_first = f64::NAN;
                course.tell(None);
                return Ok(None);
            }
            let tested = self.tested(this, goal);
            let is_often = Chance::new(tested.ended, tested.of).interval[0] > MORE_OFTEN_THAN_NOT;
            if until == CONFIRMING || is_often {
                if !heard {
                    course.until_first = course.seconds();
                }
                heard = true;
                course.tell(Some(tested));
            } else {
                course.tell(None);
            }
        }
        Ok(Some(self.tested(&course.tried[index], goal)))
    }

    /// What the fresh members of a change say. What it was not chosen for and ends in all of them but one is among what it
    /// ends.
    fn tested(&self, tried: &Tried, goal: AlarmSet) -> Tested {
        let standing = self.leading.standing;
        let mut ends = goal;
        for id in standing.without(goal).iter() {
            let with = ends.union([id].into_iter().collect());
            if tried.against(with) <= MOST_AGAINST {
                ends = with;
            }
        }
        let of = tried.ran().count() as u32;
        Tested {
            ends,
            stays: standing.without(ends),
            from: self.from,
            change: tried.trial.change,
            ended: of - tried.against(ends).min(of),
            of,
            tools: 0,
        }
    }

    /// What a change is to end where none ends all alarms: those of them that some change may end; the leading one alone.
    fn goals(&self, tried: &[Tried]) -> Vec<AlarmSet> {
        let Leading { alarm, standing, .. } = self.leading;
        // Only members that ended the leading alarm have run long enough to say something of the others.
        let firsts = tried.iter().filter_map(|tried| tried.first);
        let lasting = firsts
            .filter(|outcome| !outcome.came && !outcome.open.contains(alarm))
            .map(|outcome| outcome.open)
            .reduce(AlarmSet::common)
            .unwrap_or_default();
        let mut goals = vec![standing.without(lasting), [alarm].into_iter().collect()];
        goals.dedup();
        goals
    }
}

/// Up to two rungs within `least..top`, which part it into pieces as equal as can be.
fn between(least: usize, top: usize) -> Vec<usize> {
    let open = top - least;
    let mut rungs = vec![least + open / 3, least + 2 * open / 3];
    rungs.dedup();
    rungs
}

/// Adds the time of a member to that of its search.
fn timed(outcome: Option<Outcome>, spent: &AtomicU64) -> Option<Outcome> {
    if let Some(outcome) = &outcome {
        spent.fetch_add((1e3 * outcome.seconds).round() as u64, Ordering::Relaxed);
    }
    outcome
}
