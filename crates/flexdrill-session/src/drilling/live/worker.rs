//! The thread that computes the next metres: idle work, of which nothing waits but a replay.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use super::answer::{Ahead, Question, compute};
use flexdrill_config::Config;
use flexdrill_hole::Survey;

/// What is to be computed.
pub struct Asked {
    /// Ticks of the means.
    pub ticks: u64,
    /// Weight at the bit (N).
    pub weight: f64,
    /// Surveys of the hole.
    pub surveys: Arc<[Survey]>,
    /// The tool in its hole.
    pub config: Arc<Config>,
}

/// What was computed.
pub struct Found {
    /// Ticks of the means.
    pub ticks: u64,
    /// The next metres, or why they are not known.
    pub ahead: Result<Ahead, String>,
}

/// The thread.
pub struct Worker {
    asks: Option<Sender<Asked>>,
    found: Receiver<Found>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread, whose plausible tools have the draws of a seed. As `idle` work it takes what other work leaves of
    /// the processors.
    ///
    /// # Errors
    /// When there is no thread.
    pub fn start(seed: u64, idle: bool) -> std::io::Result<Self> {
        let (asks, asked) = channel::<Asked>();
        let (finds, found) = channel();
        let stop = Arc::<AtomicBool>::default();
        let stopped = Arc::clone(&stop);
        let thread = std::thread::Builder::new()
            .name("hole_ahead".to_owned())
            .spawn(move || {
                if idle {
                    flexdrill_realtime::priority::idle();
                }
                for asked in asked {
                    let Asked { ticks, weight, .. } = asked;
                    let question = Question {
                        weight,
                        seed,
                        searches: true,
                        surveys: &asked.surveys,
                    };
                    let ahead = compute(&asked.config, question, &stopped);
                    if stopped.load(Ordering::Relaxed) || finds.send(Found { ticks, ahead }).is_err() {
                        return;
                    }
                }
            })?;
        Ok(Self {
            asks: Some(asks),
            found,
            stop,
            thread: Some(thread),
        })
    }

    /// Asks for the next metres.
    pub fn ask(&self, asked: Asked) {
        if let Some(asks) = &self.asks {
            // A thread that has panicked is noticed where its answer is missing.
            let _ = asks.send(asked);
        }
    }

    /// The next answer, waited for or only if it is there. `Err` once the thread has ended without one.
    ///
    /// # Errors
    /// When there will be no more answers.
    pub fn take(&self, wait: bool) -> Result<Option<Found>, Ended> {
        use std::sync::mpsc::TryRecvError;
        if wait {
            return self.found.recv().map(Some).map_err(|_| Ended);
        }
        match self.found.try_recv() {
            Ok(found) => Ok(Some(found)),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(Ended),
        }
    }
}

/// The thread has ended.
#[derive(Debug)]
pub struct Ended;

impl Drop for Worker {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        self.asks = None;
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was reported where it happened.
            let _ = thread.join();
        }
    }
}
