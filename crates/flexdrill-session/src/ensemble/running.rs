//! The ensemble on another thread: a node that feeds it never waits, and a replay waits where it is far ahead.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use super::engine::{Ensemble, Found, Generation, SLICE, Told};
use super::fork::Forks;
use super::place::Threads;
use flexdrill_ensemble::LEAST_MEMBERS;
use flexdrill_text::{counted, log_ending};

/// How far the ensemble may be behind the twin (s of model time) before other, fewer members begin.
const LATE: f64 = 30.0;
/// The same where the twin waits: what acts and what was measured is kept for so long.
const AHEAD: f64 = 10.0;
/// Most members that `auto` takes.
const MOST_BY_ITSELF: f64 = 64.0;
/// Share of the time that the twin leaves which members take: look-aheads need some, and members differ in cost.
const TAKEN: f64 = 0.75;
/// Processors that the twin's messages take, as the busiest demonstration does.
const MESSAGES: f64 = 0.25;
/// Members that may run on as the outermost of those drawn first: two for each of torque and hook load, which every rig
/// measures. They take the time of others.
const OUTERMOST: f64 = 4.0;
/// Longest wait for the members of now: they are handed over between two slices.
const PATIENCE: Duration = Duration::from_secs(3);
/// Time between two looks for news.
const POLL: Duration = Duration::from_millis(50);

/// How the ensemble keeps up.
#[derive(Debug, Clone)]
pub enum Pace {
    /// The twin runs by a clock and never waits. Where the ensemble falls too far behind, other members begin.
    Clock,
    /// The twin waits for the ensemble. The members are these generations, those of a recorded run, or where none is given
    /// as many as the configuration asks for; `auto` is none, as a run that waits leaves no time.
    Waits(Vec<Generation>),
}

/// An ensemble that runs.
pub struct Running {
    told: Option<Sender<Told>>,
    found: Receiver<Found>,
    thread: Option<JoinHandle<()>>,
    shared: Arc<Shared>,
    waits: bool,
    /// Ticks of a slice, and the last multiple of it that was told.
    slice: u64,
    told_until: u64,
    ahead: u64,
}

#[derive(Default)]
struct Shared {
    stop: AtomicBool,
    /// Ticks up to which all that can be computed is computed.
    at: Mutex<u64>,
    moved: Condvar,
    /// Those who wait for the members of now.
    asking: Mutex<Vec<Sender<Result<Forks, String>>>>,
}

/// Where a look-ahead has the members of now from. It waits for the ensemble; nothing waits for it.
#[derive(Clone)]
pub struct Forking(Arc<Shared>);

impl Forking {
    /// The members of now, each forked between two slices.
    ///
    /// # Errors
    /// Why there are none to look ahead from, in words.
    pub fn ask(&self) -> Result<Forks, String> {
        let (sender, found) = channel();
        self.0
            .asking
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(sender);
        found
            .recv_timeout(PATIENCE)
            .unwrap_or_else(|_| Err("the plausible tools did not answer on this busy computer".to_owned()))
    }
}

impl Running {
    /// Starts an ensemble.
    ///
    /// # Errors
    /// When there is no thread for it.
    pub fn start(ensemble: Ensemble, pace: Pace) -> std::io::Result<Self> {
        let (told, hears) = channel();
        let (finds, found) = channel();
        let shared = Arc::<Shared>::default();
        let (slice, ahead) = (ensemble.ticks_of(SLICE), ensemble.ticks_of(AHEAD));
        let waits = matches!(pace, Pace::Waits(_));
        let mut worker = Worker {
            ensemble,
            pace,
            threads: Threads {
                count: std::thread::available_parallelism().map_or(1, usize::from),
                // A twin that waits for members has nothing else to do.
                idle: !waits,
            },
            shared: Arc::clone(&shared),
            begun: false,
        };
        let thread = std::thread::Builder::new()
            .name("ensemble".to_owned())
            .spawn(move || worker.run(&hears, &finds))?;
        Ok(Self {
            told: Some(told),
            found,
            thread: Some(thread),
            shared,
            waits,
            slice,
            told_until: 0,
            ahead,
        })
    }

    /// Where look-aheads have the members of now from.
    pub fn forking(&self) -> Forking {
        Forking(Arc::clone(&self.shared))
    }

    /// The members of now. A run that waits has them in their state at the end of the last slice that it has come to, so that
    /// they are the same each time.
    ///
    /// # Errors
    /// Why there are none to look ahead from, in words.
    pub fn forks(&self) -> Result<Forks, String> {
        if self.waits {
            self.wait_for(self.told_until);
        }
        self.forking().ask()
    }

    /// Tells the ensemble what acts or what was compared.
    pub fn tell(&self, told: Told) {
        if let Some(sender) = &self.told {
            // The thread outlives this sender unless it has panicked, and then there are no more bands.
            let _ = sender.send(told);
        }
    }

    /// The twin has come to these ticks, all that acts before them was told. Waits where the ensemble is far behind and the
    /// twin is to wait.
    pub fn reached(&mut self, ticks: u64) {
        let until = ticks / self.slice * self.slice;
        if until == self.told_until {
            return;
        }
        self.told_until = until;
        self.tell(Told::Reached(ticks));
        if self.waits {
            self.wait_for(until.saturating_sub(self.ahead));
        }
    }

    /// Waits until there is nothing left to compute up to these ticks, or the thread has ended.
    fn wait_for(&self, ticks: u64) {
        let mut at = self.shared.at.lock().unwrap_or_else(PoisonError::into_inner);
        while *at < ticks && self.thread.as_ref().is_some_and(|thread| !thread.is_finished()) {
            let waited = self.shared.moved.wait_timeout(at, POLL);
            at = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// The next bands that are ready.
    pub fn take(&mut self) -> Option<Found> {
        self.found.try_recv().ok()
    }

    /// Ends the run: computes all that is left, where the twin waits. [`Running::take`] has the rest.
    pub fn finish(&mut self) {
        self.told = None;
        if self.waits
            && let Some(thread) = self.thread.take()
        {
            // A panic of the thread was reported where it happened.
            let _ = thread.join();
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Relaxed);
        self.told = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// What the thread has.
struct Worker {
    ensemble: Ensemble,
    pace: Pace,
    threads: Threads,
    shared: Arc<Shared>,
    /// Whether the first members have begun.
    begun: bool,
}

impl Worker {
    fn run(&mut self, hears: &Receiver<Told>, finds: &Sender<Found>) {
        let mut ended = false;
        while !self.shared.stop.load(Ordering::Relaxed) {
            // All that is there is heard before the next slice, so that a late ensemble knows how late it is.
            while let Ok(told) = hears.try_recv() {
                self.ensemble.hear(told);
            }
            self.begin();
            self.hand_over();
            let [at, reached] = self.ensemble.ticks();
            let is_due = self.begun && self.ensemble.is_due();
            // Before the first members there is nothing to wait for, nor where all that was heard is computed.
            *self.shared.at.lock().unwrap_or_else(PoisonError::into_inner) = if is_due { at } else { reached };
            self.shared.moved.notify_all();
            if is_due {
                let found = self.ensemble.slice(self.threads, &self.shared.stop);
                if let Some(found) = found
                    && !self.shared.stop.load(Ordering::Relaxed)
                    && finds.send(found).is_err()
                {
                    return;
                }
            } else if ended {
                return;
            } else {
                match hears.recv_timeout(POLL) {
                    Ok(told) => self.ensemble.hear(told),
                    Err(RecvTimeoutError::Timeout) => {}
                    // What was heard is computed to its end.
                    Err(RecvTimeoutError::Disconnected) => ended = true,
                }
            }
        }
    }

    /// Gives the members of now to those who have asked for them.
    fn hand_over(&self) {
        let asking = std::mem::take(&mut *self.shared.asking.lock().unwrap_or_else(PoisonError::into_inner));
        for sender in asking {
            // One who no longer waits needs no answer.
            let _ = sender.send(self.ensemble.fork());
        }
    }

    /// Begins the members that are to begin now.
    fn begin(&mut self) {
        let [at, reached] = self.ensemble.ticks();
        if let Pace::Waits(recorded) = &mut self.pace
            && !recorded.is_empty()
        {
            // Those of a recorded run begin where they began.
            let next = recorded.first().map(|generation| generation.begun);
            if next.is_some_and(|begun| begun < reached && (!self.begun || begun <= at)) {
                self.ensemble.begin(recorded.remove(0));
                self.begun = true;
            }
            return;
        }
        if !self.begun {
            let Some(begun) = self.ensemble.first().filter(|begun| *begun < reached) else {
                return;
            };
            let generation = self.number(begun);
            self.ensemble.begin(generation);
            self.begun = true;
            return;
        }
        let late = reached.saturating_sub(at);
        let members = self.ensemble.generation().members;
        if matches!(self.pace, Pace::Clock) && members > 0 && late > self.ensemble.ticks_of(LATE) {
            let fewer = members * 3 / 4;
            let (members, why) = if f64::from(fewer) >= LEAST_MEMBERS {
                (fewer, String::new())
            } else {
                let why = format!(
                    "the computer has fallen {LATE:.0} s behind with {}, and bands need {LEAST_MEMBERS:.0}",
                    counted(members.into(), "plausible tool")
                );
                (0, why)
            };
            if let Some(more) = log_ending("the plausible tools fell behind") {
                let what = match members {
                    0 => why.clone(),
                    _ => format!("the plausible tools fell {LATE:.0} s behind the twin; {members} of them begin again"),
                };
                tracing::warn!("{what}. Close other programs, or set ensemble.members lower for the next run{more}");
            }
            let begun = self.ensemble.latest();
            self.ensemble.begin(Generation { begun, members, why });
        }
    }

    /// The first members, as many as are asked for or as the computer runs.
    fn number(&mut self, begun: u64) -> Generation {
        let of = |members, why| Generation { begun, members, why };
        if let Some(members) = self.ensemble.asked() {
            return of(members, String::new());
        }
        let cost = match self.ensemble.cost() {
            Ok(cost) => cost,
            Err(why) => return of(0, format!("the cost of a plausible tool is not known: {why}")),
        };
        let cores = self.threads.count as f64;
        let left = (cores - cost - MESSAGES).max(0.0) * TAKEN;
        let members = ((left / cost).floor() - OUTERMOST).clamp(0.0, MOST_BY_ITSELF);
        let speed = format!(
            "{} at {:.1} times real time",
            counted(self.threads.count as u64, "processor"),
            1.0 / cost
        );
        if members < LEAST_MEMBERS {
            let why = format!(
                "this computer runs {} in the time that the twin leaves ({speed}), and bands need {LEAST_MEMBERS:.0}",
                counted(members as u64, "plausible tool")
            );
            tracing::warn!("{why}");
            return of(0, why);
        }
        tracing::info!("{members:.0} plausible tools run with the twin ({speed})");
        of(members as u32, String::new())
    }
}
