//! Filling a directory: points that have no result are computed, on some threads, and their results are written.
//!
//! Workers do not communicate. Each computes the points in a random order, so that two workers on the same points seldom
//! compute the same one; where they do, both write the same bytes.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::channel;

use crate::directory::{Directory, Found};
use crate::error::SweepError;
use crate::outcome::Outcome;
use crate::plan::Point;

/// A part of a plan's points: those whose number leaves `part` when divided by `of`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chunk {
    /// From 0.
    pub part: usize,
    /// At least 1.
    pub of: usize,
}

impl Chunk {
    /// All points.
    pub const WHOLE: Self = Self { part: 0, of: 1 };

    /// Whether a point is in it.
    pub const fn has(&self, number: usize) -> bool {
        number % self.of == self.part
    }
}

/// How far the work is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Points that this call had to compute at its beginning.
    pub all: usize,
    /// Points among these that have a result now.
    pub done: usize,
}

/// What a call of [`Directory::work`] did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Worked {
    /// Points that had a result before.
    pub present: usize,
    /// Points that were computed.
    pub ran: usize,
    /// Points that were left because the work was stopped.
    pub left: usize,
}

impl Directory {
    /// Computes the points of these numbers that have no result, on `jobs` threads. `run` computes one, and returns
    /// nothing when `stop` is set. `progress` hears of every point.
    ///
    /// # Errors
    /// When a result cannot be written or read, and, once all others are computed, when a result is damaged.
    pub fn work(
        &self,
        numbers: &[usize],
        jobs: usize,
        stop: &AtomicBool,
        run: impl Fn(&Point) -> Option<Outcome> + Sync,
        mut progress: impl FnMut(Progress),
    ) -> Result<Worked, SweepError> {
        // Points are sorted by state first, so that progress can give a total.
        let mut missing: Vec<&Point> = Vec::new();
        let mut damaged = Vec::new();
        let mut worked = Worked::default();
        for point in numbers.iter().filter_map(|number| self.points().get(*number)) {
            match self.find(point)? {
                Found::Missing => missing.push(point),
                Found::Done(_) => worked.present += 1,
                Found::Damaged(damage) => damaged.push((point, damage)),
            }
        }
        // Workers do not know of each other. In random order two of them rarely meet at a point.
        fastrand::shuffle(&mut missing);
        let all = missing.len();
        // A write that fails ends all threads: the disk is full for every one of them.
        let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
        let error: Mutex<Option<SweepError>> = Mutex::new(None);
        std::thread::scope(|scope| {
            let (sender, receiver) = channel::<bool>();
            for _ in 0..jobs.clamp(1, all.max(1)) {
                let (sender, missing, next, failed, error, run) =
                    (sender.clone(), &missing, &next, &failed, &error, &run);
                scope.spawn(move || {
                    while !stop.load(Ordering::Relaxed) && !failed.load(Ordering::Relaxed) {
                        let Some(point) = missing.get(next.fetch_add(1, Ordering::Relaxed)) else {
                            return;
                        };
                        // Another worker may have computed it meanwhile.
                        let ran = if self.has_file(point) {
                            false
                        } else {
                            // Nothing is written for a run that was stopped, as its result would be incomplete.
                            let Some(outcome) = run(point) else { return };
                            if let Err(why) = self.put(point, &outcome) {
                                failed.store(true, Ordering::Relaxed);
                                let mut error = error.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                                error.get_or_insert(why);
                                return;
                            }
                            true
                        };
                        // The receiver outlives all threads of this scope.
                        let _ = sender.send(ran);
                    }
                });
            }
            // The loop below ends with the last sender.
            drop(sender);
            let mut done = 0;
            for ran in receiver {
                done += 1;
                if ran {
                    worked.ran += 1;
                } else {
                    worked.present += 1;
                }
                progress(Progress { all, done });
            }
            // Whatever the threads left undone: stopped, or failed.
            worked.left = all - done;
        });
        if let Some(error) = error.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
            return Err(error);
        }
        // Damaged points are reported after the work, because they do not hinder the others.
        match damaged.first() {
            None => Ok(worked),
            Some((point, damage)) => Err(SweepError::DamagedPoint {
                path: self.file(point),
                reason: damage.to_string(),
                damaged: damaged.len(),
            }),
        }
    }
}
