//! The runs of a map, in rounds that learn from those before.
//!
//! A fast map looks first: a run has its first member alone, and all members where a neighbour is of another class and the first
//! does not decide the run. These begin with the same first member, so that a run never contradicts its look. Looks are points of
//! their own plan, in the folder [`LOOKS`] of the map's directory.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use flexdrill_sweep::choice::{Choice, Class, Wanted};
use flexdrill_sweep::plan::{Fast, Grid, Plan, Point, Runs};
use flexdrill_sweep::{Directory, Found, Outcome, SweepError};

use super::study::Progress;

/// Folder of the first looks in a map's directory.
pub const LOOKS: &str = "looks";

/// Computes a point of a plan; nothing when it is stopped.
pub trait Compute: Fn(&Plan, &Point) -> Option<Outcome> + Sync {}
impl<T: Fn(&Plan, &Point) -> Option<Outcome> + Sync> Compute for T {}

/// How a map is computed.
pub struct Rounds<'a, C, K> {
    /// Largest share of the grid's runs, 0 to 1.
    pub share: f64,
    /// Threads.
    pub jobs: usize,
    /// Ends the work early.
    pub stop: &'a AtomicBool,
    /// Computes a point.
    pub compute: C,
    /// What a run says of its cell.
    pub class: K,
}

/// What was run.
pub struct Ran {
    /// The plan, as its file has it.
    pub plan: Plan,
    /// What the runs say of the cells between them.
    pub choice: Choice,
    /// By start, then by cell.
    pub outcomes: Vec<Vec<Option<Outcome>>>,
    /// Runs that have a first look alone.
    pub first_looks: usize,
}

/// The plan of the first looks of a map: the same with one member.
pub fn looks(plan: &Plan) -> Plan {
    Plan {
        runs: Runs {
            members: 1,
            ..plan.runs.clone()
        },
        ..plan.clone()
    }
}

/// A map that is being made.
struct Making {
    whole: Directory,
    /// None where each run has all its members at once.
    looks: Option<Directory>,
    choice: Choice,
    /// By start, then by cell.
    outcomes: Vec<Vec<Option<Outcome>>>,
    /// Whether a run has all its members, likewise.
    is_whole: Vec<Vec<bool>>,
    most: usize,
    done: usize,
    here: usize,
}

impl<C: Compute, K: Fn(&Outcome) -> Class> Rounds<'_, C, K> {
    /// Makes the runs of a map in a directory; results that are there are used. Returns nothing when it was stopped.
    ///
    /// # Errors
    /// When the directory has another plan, or a file cannot be written or read or is damaged.
    pub fn make(&self, out: &Path, plan: &Plan, mut progress: impl FnMut(Progress)) -> Result<Option<Ran>, SweepError> {
        let whole = Directory::create(out, plan)?;
        // The directory's plan, not the given one: it is what earlier runs were made for, and `create` has compared them.
        let plan = whole.plan().clone();
        let looks_first = plan.runs.members > 1 && plan.runs.fast.is_some();
        let looks = match looks_first {
            true => Some(Directory::create(&out.join(LOOKS), &looks(&plan))?),
            false => None,
        };
        let choice = Choice::new(plan.map.unwrap_or(Grid { columns: 0, rows: 0 }), plan.starts.len());
        let all = choice.all();
        let (starts, cells) = (plan.starts.len(), plan.rows.len());
        let mut making = Making {
            whole,
            looks,
            choice,
            outcomes: vec![vec![None; cells]; starts],
            is_whole: vec![vec![false; cells]; starts],
            // At least one run, at most all, also for shares that round to nothing.
            most: ((self.share * all as f64).round() as usize).clamp(1, all),
            done: 0,
            here: 0,
        };
        // Each round learns from the runs of the one before. Only whole rounds count,
        // so that threads and interruptions do not change the choice.
        loop {
            let wanted = if making.most == all {
                making.everything()
            } else {
                making.choice.next(making.most)
            };
            // Where nothing new is wanted, the boundary that the runs leave has all its members, which may move it.
            let known = !wanted.is_empty();
            if known && !self.run(&mut making, &wanted, looks_first, &mut progress)? {
                return Ok(None);
            }
            let deeper = making.next_to_others(known);
            if !known && deeper.is_empty() {
                break;
            }
            if !self.run(&mut making, &deeper, false, &mut progress)? {
                return Ok(None);
            }
        }
        let is_look = |(outcome, whole): (&Option<Outcome>, &bool)| outcome.is_some() && !whole;
        let runs = making.outcomes.iter().flatten().zip(making.is_whole.iter().flatten());
        Ok(Some(Ran {
            plan,
            first_looks: runs.filter(|run| is_look(*run)).count(),
            choice: making.choice,
            outcomes: making.outcomes,
        }))
    }

    /// Makes a round of runs, with their first members alone or with all. Returns whether all of them have a result.
    fn run(
        &self,
        making: &mut Making,
        wanted: &[Wanted],
        looks_first: bool,
        progress: &mut impl FnMut(Progress),
    ) -> Result<bool, SweepError> {
        let directory = match &making.looks {
            Some(looks) if looks_first => looks,
            _ => &making.whole,
        };
        let plan = directory.plan();
        let numbers: Vec<usize> = wanted.iter().map(|run| plan.number(run.cell, run.start, 0)).collect();
        // Runs with all their members come on top of the looks, as far as they are known.
        let most = making.most.max(making.done + numbers.len());
        let (before, here) = (making.done, making.here);
        let of_plan = &self.compute;
        let compute = |point: &Point| of_plan(plan, point);
        let worked = directory.work(&numbers, self.jobs, self.stop, compute, |work| {
            progress(Progress {
                // Work that was found in the directory counts as done, but not as run here: the estimate of the
                // remaining time needs both.
                done: before + numbers.len() - work.all + work.done,
                most,
                here: here + work.done,
            });
        })?;
        if self.stop.load(Ordering::Relaxed) {
            return Ok(false);
        }
        let mut found = Vec::with_capacity(numbers.len());
        for number in &numbers {
            // Without this result the choice cannot continue; the same call does so later.
            let Found::Done(outcome) = directory.find(&directory.points()[*number])? else {
                return Ok(false);
            };
            found.push(*outcome);
        }
        making.here += worked.ran;
        making.done += numbers.len();
        for (run, outcome) in wanted.iter().zip(found) {
            making.choice.learn(*run, (self.class)(&outcome));
            making.is_whole[run.start][run.cell] = !looks_first || making.is_decided(&outcome);
            making.outcomes[run.start][run.cell] = Some(outcome);
        }
        Ok(true)
    }
}

impl Making {
    /// Every run that has no result.
    fn everything(&self) -> Vec<Wanted> {
        if self.choice.runs() > 0 {
            return Vec::new();
        }
        let cells = self.whole.plan().rows.len();
        let starts = 0..self.whole.plan().starts.len();
        let all = starts.flat_map(|start| (0..cells).map(move |cell| Wanted { start, cell }));
        all.collect()
    }

    /// Whether a first look with its alarm decides the run of all members.
    fn is_decided(&self, look: &Outcome) -> bool {
        let runs = &self.whole.plan().runs;
        let decides = |fast: &Fast| fast.decides(look.any_alarm[fast.first_alarm as usize], runs.members);
        runs.fast.as_ref().is_some_and(decides)
    }

    /// First looks next to another class: of runs, or with all that is inferred too. What failed has failed.
    fn next_to_others(&mut self, known: bool) -> Vec<Wanted> {
        if self.looks.is_none() {
            return Vec::new();
        }
        let mut next = self.choice.next_to_others(known);
        next.retain(|run| !self.is_whole[run.start][run.cell]);
        next
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicUsize;

    use super::*;
    use crate::ahead::Chance;
    use flexdrill_alarms::Priority;
    use flexdrill_sweep::map::{AlarmCount, Start};
    use flexdrill_sweep::plan::{FORMAT, Running};

    const COLUMNS: usize = 10;
    const ROWS: usize = 8;
    const TOOLS: u32 = 5;
    const LIMIT: f64 = 0.1;

    fn plan(fast: bool) -> Plan {
        let first_alarm = Priority::Low;
        let fast = fast.then_some(Fast {
            first_alarm,
            calm_after: 30.0,
            limit: LIMIT,
            turns: TOOLS,
        });
        let cells = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| vec![column.into(), row.into()]));
        Plan {
            format: FORMAT,
            runs: Runs {
                program: "a test".to_owned(),
                arithmetic: "fused".to_owned(),
                configuration: String::new(),
                hash: "0".repeat(64),
                horizon: 60.0,
                members: TOOLS,
                run_all: false,
                fast,
                plausible: true,
                running: Running { rpm: 100.0, time: 10.0 },
                alarms: vec!["shock".to_owned()],
                figures: Vec::new(),
            },
            keys: vec!["a".to_owned(), "b".to_owned()],
            rows: cells.collect(),
            starts: Start::ALL.to_vec(),
            seeds: vec![1],
            map: Some(Grid {
                columns: COLUMNS,
                rows: ROWS,
            }),
        }
    }

    /// A world in which tool k has an alarm from column 5 + k / 2 on, a column earlier from running, and where all fail in a
    /// corner.
    fn world(start: Start, row: usize, tool: u32) -> Class {
        let (x, y) = (row % COLUMNS, row / COLUMNS);
        let from = 5.0 + 0.5 * f64::from(tool) - if start == Start::Running { 1.0 } else { 0.0 };
        match (x, y) {
            (0..=2, 0..=2) => Class::Unknown,
            (x, _) if x as f64 >= from => Class::Expected,
            _ => Class::Clear,
        }
    }

    /// Members in turn until they decide, as a look-ahead runs them.
    fn compute(plan: &Plan, point: &Point) -> Outcome {
        let (mut members, mut failed, mut seen) = (0, 0, 0);
        for member in 0..plan.runs.members {
            members += 1;
            match world(point.start, point.row, plan.tool(point.row, member)) {
                Class::Unknown => failed += 1,
                Class::Expected => seen += 1,
                Class::Clear => {}
            }
            let decides = plan.runs.fast.is_some_and(|fast| fast.decides(seen, plan.runs.members));
            if decides || Chance::new(seen, members - failed).decided().is_some() {
                break;
            }
        }
        let of = members - failed;
        let count = AlarmCount {
            alarm: "shock".to_owned(),
            priority: Priority::Low,
            seen,
            of,
            interval: Chance::new(seen, of).interval,
            first: Some(7.0),
        };
        Outcome {
            members,
            failed,
            failure: String::new(),
            run_up: Some(2.0),
            model_time: f64::from(of),
            begun: Vec::new(),
            any_alarm: [seen, 0, 0],
            alarms: if seen > 0 { vec![count] } else { Vec::new() },
            figures: Vec::new(),
            quality: [of, 0, 0],
        }
    }

    fn class(outcome: &Outcome) -> Class {
        match (outcome.any_alarm[0], outcome.failed, outcome.ended()) {
            (seen, _, ended) if ended > 0 && f64::from(seen) / f64::from(ended) > LIMIT => Class::Expected,
            (_, 0, ended) if ended > 0 => Class::Clear,
            _ => Class::Unknown,
        }
    }

    /// What all tools together say of a cell.
    fn truth(start: Start, row: usize) -> Class {
        let of: Vec<Class> = (0..TOOLS).map(|tool| world(start, row, tool)).collect();
        let count = |class| of.iter().filter(|of| **of == class).count() as f64;
        match (count(Class::Expected), count(Class::Unknown)) {
            (expected, failed) if expected / (of.len() as f64 - failed) > LIMIT => Class::Expected,
            (_, 0.0) => Class::Clear,
            _ => Class::Unknown,
        }
    }

    fn made(folder: &Path, plan: &Plan, jobs: usize, stop: &AtomicBool, stop_at: usize) -> Option<Ran> {
        let count = AtomicUsize::new(0);
        let rounds = Rounds {
            share: 0.4,
            jobs,
            stop,
            compute: |plan: &Plan, point: &Point| {
                if count.fetch_add(1, Ordering::Relaxed) == stop_at {
                    stop.store(true, Ordering::Relaxed);
                    return None;
                }
                Some(compute(plan, point))
            },
            class,
        };
        rounds.make(folder, plan, |_| ()).unwrap()
    }

    fn members(ran: &Ran) -> u32 {
        ran.outcomes
            .iter()
            .flatten()
            .flatten()
            .map(|outcome| outcome.members)
            .sum()
    }

    #[test]
    fn a_map_that_looks_first_has_the_classes_of_all_tools() {
        let [fast, slow, again] = [(); 3].map(|()| tempfile::tempdir().unwrap());
        let stop = AtomicBool::new(false);
        let mut ran = made(fast.path(), &plan(true), 1, &stop, usize::MAX).unwrap();
        for (start, runs) in Start::ALL.into_iter().zip(&ran.outcomes) {
            for (cell, outcome) in runs.iter().enumerate() {
                let Some(outcome) = outcome else { continue };
                assert_eq!(class(outcome), truth(start, cell), "{start:?} {cell}: {outcome:?}");
            }
        }
        // Nothing that fails, and nothing with an alarm, is inferred clear.
        for (number, start) in Start::ALL.into_iter().enumerate() {
            for (cell, inferred) in ran.choice.inferred(number).into_iter().enumerate() {
                let clear = inferred.is_some_and(|of| of.class() == Some(Class::Clear));
                assert!(!clear || truth(start, cell) == Class::Clear, "{start:?} {cell}");
            }
        }
        assert!(ran.first_looks > 0);
        let whole = made(slow.path(), &plan(false), 1, &stop, usize::MAX).unwrap();
        assert_eq!(whole.first_looks, 0);
        // Two runs in five lie at the boundary for the most part, where all members run: a quarter is saved at least.
        assert!(
            4 * members(&ran) < 3 * members(&whole),
            "{} {}",
            members(&ran),
            members(&whole)
        );
        // Interrupted, and continued on other threads: the same.
        assert!(made(again.path(), &plan(true), 2, &stop, 23).is_none());
        stop.store(false, Ordering::Relaxed);
        let continued = made(again.path(), &plan(true), 3, &stop, usize::MAX).unwrap();
        assert_eq!(
            (continued.outcomes, continued.first_looks),
            (ran.outcomes, ran.first_looks)
        );
    }

    #[test]
    fn the_first_members_of_neighbours_are_other_tools() {
        let plan = plan(true);
        for row in 0..ROWS {
            for column in 0..COLUMNS - 1 {
                let cell = row * COLUMNS + column;
                assert_ne!(plan.tool(cell, 0), plan.tool(cell + 1, 0), "{cell}");
                if row + 1 < ROWS {
                    assert_ne!(plan.tool(cell, 0), plan.tool(cell + COLUMNS, 0), "{cell}");
                }
            }
        }
        // The members of a cell are all tools, each once.
        let mut all: Vec<u32> = (0..TOOLS).map(|member| plan.tool(17, member)).collect();
        all.sort_unstable();
        assert_eq!(all, [0, 1, 2, 3, 4]);
    }
}
