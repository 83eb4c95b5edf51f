//! Runs members on threads and gathers what they bring, in the order of their numbers.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};

use super::chance::{Band, Chance};
use super::goal::{Candidate, Ends, Goal, MOST_RUN_UP};
use super::member::{DISTURBANCE, Ended, Figure, Horizon, Member, Watched};
use super::set_point::{SetPoint, Wavering};
use crate::alarms::AlarmId;
use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{BuildError, QualityLevel, Run, RunInputs, Simulation};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_uncertainty::Readings;

/// Why no member can begin.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The tool cannot be built, or the state is not one of it.
    #[error("the state to look ahead from: {0}")]
    Build(#[from] BuildError),
}

/// Why a member has no tool.
#[derive(Debug, Clone, PartialEq)]
pub enum NoTool {
    /// What would have come is unknown: in words.
    Unknown(String),
    /// A stop was requested.
    Stopped,
}

/// Gives the state that a member of a number begins from; it looks at the flag that stops it.
type Tools = Arc<dyn Fn(u32, &AtomicBool) -> Result<Start, NoTool> + Send + Sync>;

/// The state that all members begin from, or each its own.
pub struct Start {
    config: Arc<Config>,
    run: Run,
    /// What the rig shows of speed and weight.
    readings: Readings,
    /// The tool of each member; none where all are of this one.
    tools: Option<Tools>,
    /// How the rig's inputs waver about what is set.
    wavering: Arc<[[f64; 4]]>,
}

impl Start {
    /// From a simulation of the configuration's tool: its present state, under what acts on it.
    pub fn new(config: Arc<Config>, simulation: Simulation, applied: &RunInputs) -> Self {
        Self {
            run: Run::resumed(simulation, applied),
            readings: Readings::default(),
            tools: None,
            config,
            wavering: Arc::default(),
        }
    }

    /// The same state on a rig whose sensors show something else than what acts.
    #[must_use]
    pub fn on_rig(self, readings: Readings) -> Self {
        Self { readings, ..self }
    }

    /// Members are other tools: `tools` gives the state that a member of a number begins from, the same for each candidate.
    #[must_use]
    pub fn with_tools(self, tools: impl Fn(u32, &AtomicBool) -> Result<Self, NoTool> + Send + Sync + 'static) -> Self {
        Self {
            tools: Some(Arc::new(tools)),
            ..self
        }
    }

    /// The same state on a rig whose driller has set `set_point`: a sample that wavers about it is no target, and members
    /// waver as the rig did within the last minute.
    #[must_use]
    pub fn about(mut self, set_point: &SetPoint) -> Self {
        if let Some(inputs) = set_point.inputs() {
            self.run.apply(&RunInputs {
                inputs,
                ..self.run.applied()
            });
            self.wavering = set_point.wavering();
        }
        self
    }

    /// From the bytes of a checkpoint. `tool` is a simulation of the configuration's tool in any state.
    ///
    /// # Errors
    /// When the checkpoint is one of another tool, or damaged.
    pub fn restored(
        config: Arc<Config>,
        tool: &Simulation,
        checkpoint: &[u8],
        applied: &RunInputs,
    ) -> Result<Self, StartError> {
        let mut simulation = tool.fork();
        simulation.restore(checkpoint).map_err(BuildError::from)?;
        Ok(Self::new(config, simulation, applied))
    }

    /// The configuration of the tool.
    pub fn config(&self) -> &Arc<Config> {
        &self.config
    }

    /// What acts on the model now.
    pub fn applied(&self) -> RunInputs {
        self.run.applied()
    }

    /// A run in this state.
    pub(super) fn run(&self) -> Run {
        self.run.fork()
    }

    /// The wavering of a member, which begins at its own look.
    pub(super) fn wavering(&self, of_goal: u64, candidate: usize, member: u32) -> Wavering {
        Wavering::from(&self.wavering, seed(of_goal, candidate, member))
    }

    /// What acts from here on under a candidate.
    pub(super) fn target(&self, candidate: &Candidate) -> RunInputs {
        let applied = self.run.applied();
        let mut slew = applied.slew;
        if candidate.speed_ramp > 0.0 {
            slew[0] = rpm_to_rad_per_s(candidate.speed_ramp);
        }
        if candidate.weight_ramp > 0.0 {
            slew[1] = kn_to_n(candidate.weight_ramp);
        }
        self.readings.acting(&RunInputs {
            inputs: Inputs {
                rotary_speed: rpm_to_rad_per_s(candidate.rotary_speed),
                weight_on_bit: kn_to_n(candidate.weight_on_bit),
                ..applied.inputs
            },
            slew,
            ..applied
        })
    }
}

/// The chance of one alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlarmChance {
    /// Which.
    pub id: AlarmId,
    /// Of this priority or a higher one.
    pub priority: Priority,
    /// How often.
    pub chance: Chance,
    /// Median over the members that saw it of the time to the first of it (s); NaN where none did.
    pub first: f64,
}

/// The answer on one candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateAnswer {
    /// Which.
    pub candidate: Candidate,
    /// Time of the run-up (s); NaN where it failed.
    pub run_up: f64,
    /// Members that count: those up to the first number at which every alarm is decided.
    pub members: u32,
    /// Members that failed among them: what would have come is unknown.
    pub failed: u32,
    /// Why the first of these failed; empty where none did.
    pub failure: String,
    /// Whether the test decided every alarm.
    pub decided: bool,
    /// Alarms that a member saw, by [`AlarmId::ALL`] and from the lowest priority.
    pub alarms: Vec<AlarmChance>,
    /// Chance that a member saw any alarm of the tool.
    pub any_alarm: Chance,
    /// Members that saw any alarm of the tool with this priority or a higher one, by [`Priority::ALL`].
    pub any_by_priority: [u32; 3],
    /// By [`Figure::ALL`].
    pub figures: [Band; Figure::ALL.len()],
    /// Members by the worst quality of their motion: good, degraded, poor.
    pub quality: [u32; 3],
}

/// The answer on all candidates.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// In the order of the goal.
    pub candidates: Vec<CandidateAnswer>,
    /// Whether it was stopped: then only the members that had ended count.
    pub stopped: bool,
}

/// How far a look-ahead is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Members that ended.
    pub done: u32,
    /// Members that may have to run yet.
    pub remaining: u32,
    /// What they say so far.
    pub answer: Answer,
}

/// A member's end, on its way to the gatherer.
struct Report {
    candidate: usize,
    member: u32,
    result: Result<Member, Ended>,
}

/// What is known of one candidate.
struct Gathered {
    /// The run at the candidate's speed and weight, or why there is none, and the time to get there (s).
    run_up: Result<f64, Ended>,
    /// Members by number.
    members: BTreeMap<u32, Result<Member, Ended>>,
    /// Members that count, once that is decided.
    enough: Option<u32>,
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
    mut progress: impl FnMut(Progress),
) -> Answer {
    let candidates = goal.candidates.len();
    // All first members come before all second ones, so that every candidate has a first answer early.
    let tasks: Vec<(usize, u32)> = (0..goal.members)
        .flat_map(|member| (0..candidates).map(move |candidate| (candidate, member)))
        .collect();
    // Whether a candidate can be reached is found once, before its members:
    // without an end of the run-up there is nothing to disturb.
    let run_ups = run_ups(start, goal, threads, stop);
    let mut gathered: Vec<Gathered> = run_ups
        .iter()
        .map(|run_up| Gathered {
            // A candidate whose run-up failed has no members to wait for.
            run_up: run_up.as_ref().map(|(_, time)| *time).map_err(Clone::clone),
            members: BTreeMap::new(),
            enough: run_up.is_err().then_some(0),
        })
        .collect();
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
            progress(told(goal, &gathered));
        }
    });
    answer(goal, &gathered, stop.load(Ordering::Relaxed))
}

/// The run at a candidate's speed and weight with the time (s) to get there, or why there is none.
type RunUp = Result<(Run, f64), Ended>;

/// The run-up to each candidate, in the order of the goal.
fn run_ups(start: &Start, goal: &Goal, threads: usize, stop: &AtomicBool) -> Vec<RunUp> {
    on_threads(&goal.candidates, threads, |candidate| {
        let watched = Watched::new(start.run.fork(), &start.config, stop);
        watched.run_up(&start.target(candidate), MOST_RUN_UP)
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
        let Ok((there, way)) = &run_ups[candidate] else {
            continue;
        };
        if decided[candidate].load(Ordering::Relaxed) {
            continue;
        }
        // A way that was made once is that of the tool that all members share.
        let shared = (*way > OWN_WAY && start.tools.is_none()).then_some(there);
        let result = with_tool(start, member, stop, |start| {
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

/// Lends the state that a member begins from.
fn with_tool<T>(
    start: &Start,
    member: u32,
    stop: &AtomicBool,
    work: impl FnOnce(&Start) -> Result<T, Ended>,
) -> Result<T, Ended> {
    match &start.tools {
        None => work(start),
        Some(tools) => match tools(member, stop) {
            Ok(own) => work(&own),
            Err(NoTool::Unknown(why)) => Err(Ended::NoTool(why)),
            Err(NoTool::Stopped) => Err(Ended::Stopped),
        },
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
    let fork = disturbed(shared.unwrap_or(&start.run), goal.seed, candidate, member);
    let there = match shared {
        Some(_) => fork,
        None => {
            let watched = Watched::new(fork, &start.config, stop);
            watched
                .run_up(&start.target(&goal.candidates[candidate]), MOST_RUN_UP)?
                .0
        }
    };
    let wavering = start.wavering(goal.seed, candidate, member);
    let watched = Watched::new(there, &start.config, stop).wavering(wavering);
    let ends = goal.ends.priority();
    watched.judge(Horizon::Of(goal.horizon), |alarms| {
        ends.is_some_and(|least| alarms.iter().any(|called| called.worst >= Some(least)))
    })
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
fn seed(seed: u64, candidate: usize, member: u32) -> u64 {
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

/// The number of members that are enough, if the first ones that ended are; all of them where all ended.
fn enough(members: &BTreeMap<u32, Result<Member, Ended>>, goal: &Goal) -> Option<u32> {
    let mut seen = vec![0; AlarmId::ALL.len()];
    let (mut any, mut of) = (0, 0);
    for (number, (member, result)) in (0..goal.members).zip(members) {
        if number != *member {
            return None;
        }
        if let Ok(result) = result {
            of += 1;
            any += u32::from(result.saw(goal.ends));
            for (seen, called) in seen.iter_mut().zip(&result.alarms) {
                *seen += u32::from(called.worst.is_some());
            }
        }
        let decided = || match goal.ends {
            Ends::Horizon => seen.iter().all(|&seen| Chance::new(seen, of).decided().is_some()),
            Ends::FirstAlarm(_) => Chance::new(any, of).decided().is_some(),
        };
        if number + 1 == goal.members || (!goal.run_all && decided()) {
            return Some(number + 1);
        }
    }
    None
}

fn told(goal: &Goal, gathered: &[Gathered]) -> Progress {
    let done = gathered.iter().map(|candidate| candidate.members.len() as u32).sum();
    let remaining = gathered
        .iter()
        .filter(|candidate| candidate.enough.is_none())
        .map(|candidate| goal.members.saturating_sub(candidate.members.len() as u32))
        .sum();
    Progress {
        done,
        remaining,
        answer: answer(goal, gathered, false),
    }
}

fn answer(goal: &Goal, gathered: &[Gathered], stopped: bool) -> Answer {
    Answer {
        candidates: goal
            .candidates
            .iter()
            .zip(gathered)
            .map(|(candidate, gathered)| summed(candidate, gathered, goal.ends))
            .collect(),
        stopped,
    }
}

fn summed(candidate: &Candidate, gathered: &Gathered, ends: Ends) -> CandidateAnswer {
    let counted = gathered.enough.map_or(gathered.members.len(), |enough| enough as usize);
    let results: Vec<&Result<Member, Ended>> = gathered.members.values().take(counted).collect();
    let members: Vec<&Member> = results.iter().filter_map(|result| result.as_ref().ok()).collect();
    let of = members.len() as u32;
    let failures = results.iter().filter_map(|result| result.as_ref().err());
    let failure = gathered.run_up.as_ref().err().or_else(|| failures.clone().next());
    let of_quality = |level: QualityLevel| members.iter().filter(|member| member.quality == level).count() as u32;
    let mut seen = vec![0; AlarmId::ALL.len()];
    for member in &members {
        for (seen, called) in seen.iter_mut().zip(&member.alarms) {
            *seen += u32::from(called.worst.is_some());
        }
    }
    // A member that ended with an alarm has no figures of its whole horizon.
    let whole = members.iter().filter(|member| !member.saw(ends));
    let saw = of - whole.clone().count() as u32;
    CandidateAnswer {
        candidate: *candidate,
        run_up: *gathered.run_up.as_ref().unwrap_or(&f64::NAN),
        members: counted as u32,
        failed: failures.count() as u32,
        failure: failure.map_or(String::new(), sentence),
        decided: match ends {
            Ends::Horizon => seen.iter().all(|&seen| Chance::new(seen, of).decided().is_some()),
            Ends::FirstAlarm(_) => Chance::new(saw, of).decided().is_some(),
        },
        alarms: alarm_chances(&members),
        any_alarm: any_alarm(&members),
        any_by_priority: Priority::ALL.map(|least| {
            let saw = |member: &&&Member| member.alarms.iter().any(|called| called.worst >= Some(least));
            members.iter().filter(saw).count() as u32
        }),
        figures: Figure::ALL.map(|figure| Band::of(whole.clone().map(|member| member.figures[figure as usize]))),
        quality: [QualityLevel::Good, QualityLevel::Degraded, QualityLevel::Poor].map(of_quality),
    }
}

/// The alarms that a member saw, by [`AlarmId::ALL`] and from the lowest priority.
pub(super) fn alarm_chances(members: &[&Member]) -> Vec<AlarmChance> {
    let mut alarms = Vec::new();
    for id in AlarmId::ALL {
        for priority in [Priority::Low, Priority::Medium, Priority::High] {
            let called = members.iter().map(|member| member.alarms[id as usize]);
            let firsts: Vec<f64> = called
                .filter(|called| called.worst >= Some(priority))
                .map(|called| called.first)
                .collect();
            if !firsts.is_empty() {
                alarms.push(AlarmChance {
                    id,
                    priority,
                    chance: Chance::new(firsts.len() as u32, members.len() as u32),
                    first: Band::of(firsts.into_iter()).quantiles[1],
                });
            }
        }
    }
    alarms
}

/// The chance that a member saw any alarm.
pub(super) fn any_alarm(members: &[&Member]) -> Chance {
    let any = |member: &&&Member| member.alarms.iter().any(|called| called.worst.is_some());
    Chance::new(members.iter().filter(any).count() as u32, members.len() as u32)
}

/// Why a member ended early.
pub(super) fn sentence(ended: &Ended) -> String {
    match ended {
        Ended::Failed(failure) => format!("a step failed, so that the rest is unknown: {failure}"),
        Ended::NoTool(why) => why.clone(),
        Ended::NotReached => format!(
            "speed or weight did not reach the candidate's within {MOST_RUN_UP} s; give a faster ramp or a nearer candidate"
        ),
        Ended::Stopped => "stopped".to_owned(),
    }
}
