//! Runs members on threads and gathers what they bring, in the order of their numbers.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};

use super::answer::{Answer, Gathered, Progress, answer, enough, told};
use super::goal::{Goal, MOST_RUN_UP};
use super::member::{DISTURBANCE, Ended, Horizon, Member, Watched};
use super::start::Start;
use flexdrill_core::twin::Run;

/// A member's end, on its way to the gatherer.
struct Report {
    candidate: usize,
    member: u32,
    result: Result<Member, Ended>,
}

/// Answers a goal that was checked ([`Goal::check`]) from `start`, on `threads` threads. `progress` hears of every member
/// that ends. Once `stop` is set the call returns within the computing time of a tenth of a second of model time.
///
/// The same goal from the same start gives the same answer, with any number of threads.
pub fn look_ahead(
    start: &Start,
    goal: &Goal,
    threads: usize,
    stop: &AtomicBool,
    progress: impl FnMut(Progress),
) -> Answer {
    look_further(start, goal, Members::default(), threads, stop, progress).0
}

/// Members of a goal that ended, by candidate and number.
#[derive(Debug, Clone, Default)]
pub struct Members(BTreeMap<(usize, u32), Result<Member, Ended>>);

/// The same where some members are known from a goal that differs in its number of members alone. Returns all that ended too.
pub fn look_further(
    start: &Start,
    goal: &Goal,
    known: Members,
    threads: usize,
    stop: &AtomicBool,
    mut progress: impl FnMut(Progress),
) -> (Answer, Members) {
    let candidates = goal.candidates.len();
    // All first members come before all second ones, so that every candidate has a first answer early.
    let tasks: Vec<(usize, u32)> = (0..goal.members)
        .flat_map(|member| (0..candidates).map(move |candidate| (candidate, member)))
        .filter(|task| !known.0.contains_key(task))
        .collect();
    // Whether a candidate can be reached is found once, before its members:
    // without an end of the run-up there is nothing to disturb.
    let run_ups = run_ups(start, goal, threads, stop);
    let mut gathered: Vec<Gathered> = run_ups
        .iter()
        .map(|run_up| Gathered {
            // A candidate whose run-up failed has no members to wait for.
            run_up: match run_up {
                Ok(there) => Ok(there.as_ref().map(|(_, time)| *time)),
                Err(why) => Err(why.clone()),
            },
            members: BTreeMap::new(),
            enough: run_up.is_err().then_some(0),
        })
        .collect();
    for ((candidate, member), result) in known.0 {
        if let Some(of) = gathered.get_mut(candidate) {
            of.members.insert(member, result);
            of.enough = of.enough.or_else(|| enough(&of.members, goal));
        }
    }
    // Workers read these flags without a lock. A late look costs a member too many, never the answer: `answer` counts
    // only the first `enough` members.
    let decided: Vec<AtomicBool> = gathered
        .iter()
        .map(|candidate| AtomicBool::new(candidate.enough.is_some()))
        .collect();
    // One counter hands out the tasks, so that a thread with quick members takes more of them.
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        let (sender, reports) = channel();
        for _ in 0..threads.clamp(1, tasks.len().max(1)) {
            let sender = sender.clone();
            scope.spawn(|| work(start, goal, &run_ups, &tasks, &next, &decided, stop, sender));
        }
        // The loop below ends when the last sender is dropped; this one would keep it open for ever.
        drop(sender);
        for report in reports {
            if stop.load(Ordering::Relaxed) {
                // What ends after the stop was cut short, and says nothing of its member.
                continue;
            }
            let of = &mut gathered[report.candidate];
            of.members.insert(report.member, report.result);
            if of.enough.is_none() {
                of.enough = enough(&of.members, goal);
                decided[report.candidate].store(of.enough.is_some(), Ordering::Relaxed);
            }
            // Reports come in the order of the threads. `enough` counts in the order
            // of the numbers, so the threads do not change the answer.
            progress(told(start, goal, &gathered));
        }
    });
    let answer = answer(start, goal, &gathered, stop.load(Ordering::Relaxed));
    let numbered = gathered.into_iter().enumerate();
    let ended = numbered.flat_map(|(candidate, of)| {
        let members = of.members.into_iter();
        members.map(move |(member, result)| ((candidate, member), result))
    });
    (answer, Members(ended.collect()))
}

/// The run at a candidate's speed and weight with the time (s) to get there, or why there is none; nothing where each member has a
/// state and a way that no other shares.
type RunUp = Result<Option<(Run, f64)>, Ended>;

/// The run-up to each candidate, in the order of the goal.
fn run_ups(start: &Start, goal: &Goal, threads: usize, stop: &AtomicBool) -> Vec<RunUp> {
    if start.is_made() {
        return goal.candidates.iter().map(|_| Ok(None)).collect();
    }
    on_threads(&goal.candidates, threads, |candidate| {
        let watched = Watched::new(start.run(), start.config(), stop);
        watched.run_up(&start.target(candidate), MOST_RUN_UP).map(Some)
    })
}

/// Longest run-up to a candidate that each member makes itself (s). Where a motion can continue or end, the run-up decides
/// which: with a shared one, all members would end alike (`docs/measurements.md`, chaotic whirl). A longer run-up is made
/// once: its end is far from the motion at its beginning.
const OWN_WAY: f64 = 10.0;

/// Takes tasks until none is left.
#[expect(clippy::too_many_arguments, reason = "what all workers share, by reference")]
fn work(
    start: &Start,
    goal: &Goal,
    run_ups: &[RunUp],
    tasks: &[(usize, u32)],
    next: &AtomicUsize,
    decided: &[AtomicBool],
    stop: &AtomicBool,
    reports: Sender<Report>,
) {
    yield_to_others();
    while !stop.load(Ordering::Relaxed) {
        let Some(&(candidate, member)) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) else {
            return;
        };
        let Ok(there) = &run_ups[candidate] else {
            continue;
        };
        if decided[candidate].load(Ordering::Relaxed) {
            continue;
        }
        // A way that was made once is that of the tool that all members share.
        let shared = there.as_ref().filter(|(_, way)| *way > OWN_WAY && start.is_shared());
        let shared = shared.map(|(there, _)| there);
        let result = start.with_tool(member, stop, |start| {
            judged(start, goal, candidate, member, shared, stop)
        });
        let report = Report {
            candidate,
            member,
            result,
        };
        if reports.send(report).is_err() {
            return;
        }
    }
}

/// One member: on its way from `start`, or from the end of a way that was made once, then judged.
fn judged(
    start: &Start,
    goal: &Goal,
    candidate: usize,
    member: u32,
    shared: Option<&Run>,
    stop: &AtomicBool,
) -> Result<Member, Ended> {
    let fork = disturbed(shared.unwrap_or(start.state()), goal.seed, candidate, member);
    let (there, way) = match shared {
        Some(_) => (fork, 0.0),
        None => {
            let watched = Watched::new(fork, start.config(), stop);
            watched.run_up(&start.target(&goal.candidates[candidate]), MOST_RUN_UP)?
        }
    };
    let wavering = start.wavering(goal.seed, candidate, member);
    let watched = Watched::new(there, start.config(), stop)
        .wavering(wavering)
        .ending(goal.ends);
    let ends = goal.ends.priority();
    let judged = watched.judge(Horizon::Of(goal.horizon), |alarms| {
        ends.is_some_and(|least| alarms.iter().any(|called| called.worst >= Some(least)))
    })?;
    Ok(Member { way, ..judged })
}

/// A member's own run: `run` with the disturbance of its number.
pub(super) fn disturbed(run: &Run, of_goal: u64, candidate: usize, member: u32) -> Run {
    let mut fork = run.fork();
    let mut random = fastrand::Rng::with_seed(seed(of_goal, candidate, member));
    fork.disturb(|| DISTURBANCE * (2.0 * random.f64() - 1.0));
    fork
}

/// `work` on each of `items`, on `threads` threads of idle work; the results in the order of the items.
pub(super) fn on_threads<T: Sync, R: Send>(items: &[T], threads: usize, work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let mut found: Vec<(usize, R)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.clamp(1, items.len().max(1)))
            .map(|_| {
                scope.spawn(|| {
                    yield_to_others();
                    let mut own = Vec::new();
                    loop {
                        let index = next.fetch_add(1, Ordering::Relaxed);
                        let Some(item) = items.get(index) else {
                            return own;
                        };
                        own.push((index, work(item)));
                    }
                })
            })
            .collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    found.sort_by_key(|(index, _)| *index);
    found.into_iter().map(|(_, result)| result).collect()
}

/// The seed of a member: neighbours differ in all bits once the generator has mixed them.
pub(super) fn seed(seed: u64, candidate: usize, member: u32) -> u64 {
    fastrand::Rng::with_seed(seed ^ ((candidate as u64) << 32 | u64::from(member))).u64(..)
}

/// Whether members run as idle work.
static YIELDS: AtomicBool = AtomicBool::new(true);

/// Lets the members run at the priority of the process, for a process that has no live run: as idle work a sweep would
/// make no progress on a busy machine.
pub fn keep_priority() {
    YIELDS.store(false, Ordering::Relaxed);
}

/// Makes this thread's work idle work: the look-ahead takes what the live run leaves. The answer is the same without.
fn yield_to_others() {
    if YIELDS.load(Ordering::Relaxed) {
        flexdrill_realtime::priority::idle();
    }
}
