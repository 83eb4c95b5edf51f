//! Supervises the DDS process: starts it, sends it messages, and restarts it when it fails.

use std::io;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use super::Shared;
use super::child::{Child, StartReport};
use super::clock_step::ClockWatch;
use super::health::{Health, Restart};
use crate::dds::plan::Plan;
use flexdrill_clock::monotonic;

/// Longest silence of a process that is up. It reports its health five times a second. The time for which it waits for a
/// processor does not count: a restart would make a busy machine busier.
pub(super) const SILENCE: Duration = Duration::from_millis(1500);
/// Longest silence for whatever reason: a lease of ROS 2's participants lasts 10 s, after which they drop this one.
pub(super) const LONGEST_SILENCE: Duration = Duration::from_secs(10);
/// Longest time until a process is up.
const START_UP: Duration = Duration::from_secs(5);
/// How often an idle process is checked.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);
/// A longer time between two checks means that this process stood still itself.
const OWN_DELAY: Duration = Duration::from_millis(500);
/// After a life of at least this length the next process starts at once.
const LONG_LIFE: Duration = Duration::from_secs(10);
/// Pauses before the next start, by the number of short lives in a row.
const PAUSES: [Duration; 5] = [
    Duration::ZERO,
    Duration::from_millis(250),
    Duration::from_millis(500),
    Duration::from_secs(1),
    Duration::from_secs(2),
];
/// Most former participants that are kept.
const MOST_FORMER: usize = 64;

/// The supervisor of the process, on a separate thread.
pub(super) struct Keeper {
    plan: Plan,
    shared: Arc<Shared>,
    clock: ClockWatch,
    life: u64,
    has_been_up: bool,
}

/// How a life ended.
enum End {
    /// The port was dropped.
    Requested,
    /// The process must be restarted, for this reason.
    Failed(String),
}

impl Keeper {
    pub(super) fn new(plan: Plan, shared: Arc<Shared>) -> Self {
        Self {
            plan,
            shared,
            clock: ClockWatch::new(),
            life: 0,
            has_been_up: false,
        }
    }

    /// Runs until the port is dropped. Reports the result of the first start, and ends where that failed.
    pub(super) fn run(mut self, report: &Sender<Result<(), String>>) {
        let mut short_lives = 0;
        loop {
            let began = Instant::now();
            self.life += 1;
            let cause = match self.run_process(&StartReport(report.clone())) {
                End::Requested => return,
                End::Failed(cause) => cause,
            };
            if !self.has_been_up {
                // The receiver may have given up waiting.
                let _ = report.send(Err(cause));
                return;
            }
            self.note_restart(cause.clone());
            tracing::error!("DDS is restarted: {cause}");
            short_lives = if began.elapsed() >= LONG_LIFE {
                0
            } else {
                short_lives + 1
            };
            let pause = PAUSES[short_lives.min(PAUSES.len() - 1)];
            let until = Instant::now() + pause;
            while Instant::now() < until {
                if self.shared.stop.load(Ordering::Acquire) {
                    return;
                }
                std::thread::sleep(CHECK_INTERVAL.min(pause));
            }
        }
    }

    fn note_restart(&self, cause: String) {
        let mut health = self.shared.health();
        health.restarts += 1;
        if health.newest.len() == Health::KEPT {
            health.newest.remove(0);
        }
        health.newest.push(Restart {
            at: monotonic::now(),
            cause,
        });
    }

    fn run_process(&mut self, report: &StartReport) -> End {
        let mut child = match Child::start(&self.plan, self.life, &self.shared, report) {
            Ok(child) => child,
            Err(error) => return End::Failed(format!("its process could not be started: {error}")),
        };
        let end = self.feed(&mut child);
        self.shared.outbox.close();
        self.shared.health().is_up = false;
        if let Some(prefix) = child.up() {
            // The process may have started and ended between two checks.
            self.has_been_up = true;
            if self.plan.former.len() == MOST_FORMER {
                self.plan.former.remove(0);
            }
            self.plan.former.push(prefix);
        }
        let end = match end {
            End::Requested => {
                child.leave();
                End::Requested
            }
            End::Failed(observed) => {
                let reported = child.end(&self.shared.writers);
                End::Failed(reported.unwrap_or(observed))
            }
        };
        // The process may have opened the queue just before its end.
        self.shared.outbox.close();
        self.shared.health().is_up = false;
        end
    }

    /// Sends queued messages to the process until it fails or the port is dropped.
    fn feed(&mut self, child: &mut Child) -> End {
        let began = Instant::now();
        let mut checked = began;
        loop {
            // The wait is bounded, because the checks below must also run without messages.
            let mut frames = self.shared.outbox.wait(CHECK_INTERVAL);
            let stop = self.shared.stop.load(Ordering::Acquire);
            if stop {
                // A message between the two lines above, such as the last reply, belongs to the run.
                frames.extend(self.shared.outbox.wait(Duration::ZERO));
            }
            // Every frame is sent, or the process is given up: a part of a frame would shift all that follow.
            for frame in &frames {
                match child.send(frame) {
                    Ok(()) => {}
                    Err(error) if is_late(&error) => return End::Failed(silent(child)),
                    Err(error) => return End::Failed(format!("its process does not read its socket ({error})")),
                }
            }
            if stop {
                return End::Requested;
            }
            let now = Instant::now();
            // If this thread itself was away, for example while the machine slept, the child's silence proves nothing.
            if now.duration_since(checked) > OWN_DELAY {
                child.restart_silence();
            }
            checked = now;
            // Ended, clock, silence: in the order of how certain the cause is.
            if child.has_ended() {
                return End::Failed("its process has ended".to_owned());
            }
            if let Some(step) = self.clock.step() {
                self.shared.health().clock_set_by = self.clock.total();
                return End::Failed(format!(
                    "the system's clock was set by {step:+.1} s, and the DDS library orders samples by it; stamps keep the \
                     clock of the start"
                ));
            }
            // A process that has not come up has no heartbeat, and has its own limit.
            if child.up().is_some() {
                if child.is_silent() {
                    return End::Failed(silent(child));
                }
            } else if began.elapsed() > START_UP {
                return End::Failed(format!("its process did not start within {} s", START_UP.as_secs()));
            }
        }
    }
}

fn is_late(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

fn silent(child: &Child) -> String {
    let (silent, waited) = (child.silent().as_secs_f64(), child.waited().as_secs_f64());
    format!(
        "its process has not reported for {silent:.1} s, of which it waited {waited:.1} s for a processor: it is stopped, or \
         the machine is overloaded"
    )
}
