//! Keeps a DDS process: starts it, feeds it, and starts another when it is not well.

use std::io;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use super::Shared;
use super::child::{Child, Told};
use super::clock_step::ClockWatch;
use super::health::{Health, Restart};
use crate::dds::plan::Plan;
use flexdrill_realtime::monotonic;

/// Longest time in which the process says nothing of its health, once it is up. It does five times a second.
pub(super) const SILENCE: Duration = Duration::from_millis(1500);
/// Longest time until it is up.
const COMING_UP: Duration = Duration::from_secs(5);
/// How often it is looked after while there is nothing to send.
const LOOK: Duration = Duration::from_millis(50);
/// A look that comes later than this stood still itself.
const HELD_UP: Duration = Duration::from_millis(500);
/// A life that was at least this long is followed by the next at once.
const LONG_LIFE: Duration = Duration::from_secs(10);
/// Waits before the next start when the lives before were short.
const PAUSES: [Duration; 5] = [
    Duration::ZERO,
    Duration::from_millis(250),
    Duration::from_millis(500),
    Duration::from_secs(1),
    Duration::from_secs(2),
];
/// Former participants that others are told apart from.
const MOST_FORMER: usize = 64;

/// The thread that keeps the process.
pub(super) struct Keeper {
    plan: Plan,
    shared: Arc<Shared>,
    clock: ClockWatch,
    life: u64,
    has_been_up: bool,
}

/// How a life ended.
enum End {
    /// The node ends.
    Wanted,
    /// It has to be started again, for this reason.
    Cause(String),
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

    /// Runs until the port is dropped; tells how the first start went, and ends when that failed.
    pub(super) fn run(mut self, told: &Sender<Result<(), String>>) {
        let mut short_lives = 0;
        loop {
            let began = Instant::now();
            self.life += 1;
            let cause = match self.live(&Told(told.clone())) {
                End::Wanted => return,
                End::Cause(cause) => cause,
            };
            if !self.has_been_up {
                // Who waited for that may have gone.
                let _ = told.send(Err(cause));
                return;
            }
            self.note(cause.clone());
            tracing::error!("DDS is started again: {cause}");
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
                std::thread::sleep(LOOK.min(pause));
            }
        }
    }

    fn note(&self, cause: String) {
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

    /// One life of the process.
    fn live(&mut self, told: &Told) -> End {
        let mut child = match Child::start(&self.plan, self.life, &self.shared, told) {
            Ok(child) => child,
            Err(error) => return End::Cause(format!("its process could not be started: {error}")),
        };
        let end = self.feed(&mut child);
        self.shared.outbox.close();
        self.shared.health().is_up = false;
        if let Some(prefix) = child.up() {
            // It may have come up and ended between two looks.
            self.has_been_up = true;
            if self.plan.former.len() == MOST_FORMER {
                self.plan.former.remove(0);
            }
            self.plan.former.push(prefix);
        }
        let end = match end {
            End::Wanted => {
                child.leave();
                End::Wanted
            }
            End::Cause(seen) => {
                let said = child.end(&self.shared.writers);
                End::Cause(said.unwrap_or(seen))
            }
        };
        // It may have come up at the very end.
        self.shared.outbox.close();
        self.shared.health().is_up = false;
        end
    }

    /// Feeds the process until it is not well or not wanted any more.
    fn feed(&mut self, child: &mut Child) -> End {
        let began = Instant::now();
        let mut looked = began;
        loop {
            let mut frames = self.shared.outbox.wait(LOOK);
            let stop = self.shared.stop.load(Ordering::Acquire);
            if stop {
                // What came between the two lines above was given before the end, such as the last reply.
                frames.extend(self.shared.outbox.wait(Duration::ZERO));
            }
            for frame in &frames {
                match child.send(frame) {
                    Ok(()) => {}
                    Err(error) if is_late(&error) => return End::Cause(silent(child)),
                    Err(error) => return End::Cause(format!("its process takes nothing any more ({error})")),
                }
            }
            if stop {
                return End::Wanted;
            }
            let now = Instant::now();
            if now.duration_since(looked) > HELD_UP {
                child.forgive();
            }
            looked = now;
            if child.has_ended() {
                return End::Cause("its process has ended".to_owned());
            }
            if let Some(step) = self.clock.step() {
                self.shared.health().clock_set_by = self.clock.total();
                return End::Cause(format!(
                    "the system's clock was set by {step:+.1} s, and the DDS library orders samples by it; stamps keep to \
                     the clock at the start"
                ));
            }
            if child.up().is_some() {
                if child.silent() > SILENCE {
                    return End::Cause(silent(child));
                }
            } else if began.elapsed() > COMING_UP {
                return End::Cause(format!("its process did not come up within {} s", COMING_UP.as_secs()));
            }
        }
    }
}

fn is_late(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

fn silent(child: &Child) -> String {
    format!(
        "its process has said nothing for {:.1} s: it is stopped, or starved",
        child.silent().as_secs_f64()
    )
}
