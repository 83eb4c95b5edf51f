//! State of a recording, for other threads.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::{BagError, Losses};

/// How long a resolved problem stays visible: longer than any alarm's delay.
const NOTICE: Duration = Duration::from_secs(30);

/// Number of messages of a recording, by state.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    /// In the files.
    pub written: u64,
    /// Of these, confirmed by the disk.
    pub safe: u64,
    /// In no file.
    pub unwritten: u64,
    /// In a file that the disk failed to sync.
    pub refused: u64,
}

#[derive(Debug, Default)]
struct Problems {
    /// The problem that prevents writing now.
    error: Option<Problem>,
    /// The last resolved problem, and when it was resolved.
    past: Option<(Instant, Problem)>,
}

/// A problem of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// File and reason.
    pub text: String,
    /// The cause, as a sentence for the operator.
    pub cause: &'static str,
    /// What the person who runs the computer can do, as a sentence.
    pub remedy: &'static str,
}

impl Problem {
    fn of(error: &BagError) -> Self {
        Self {
            text: error.to_string(),
            cause: error.cause(),
            remedy: error.remedy(),
        }
    }
}

/// State of a recording; every method may be called from any thread.
#[derive(Debug, Default)]
pub struct RecordingHealth {
    offered: AtomicU64,
    flooded: AtomicU64,
    too_slow: AtomicU64,
    written: AtomicU64,
    safe: AtomicU64,
    unwritten: AtomicU64,
    refused: AtomicU64,
    problems: Mutex<Problems>,
    path: Mutex<PathBuf>,
}

impl RecordingHealth {
    /// Messages in the files, without those in the queue and in the open chunk.
    pub fn messages(&self) -> u64 {
        self.written.load(Ordering::Relaxed)
    }

    /// Messages lost, or in a file that the disk failed to sync.
    pub fn drops(&self) -> u64 {
        self.losses().total()
    }

    /// The same, by cause.
    pub fn losses(&self) -> Losses {
        Losses {
            flooded: self.flooded.load(Ordering::Relaxed),
            too_slow: self.too_slow.load(Ordering::Relaxed),
            unwritten: self.unwritten.load(Ordering::Relaxed),
            refused: self.refused.load(Ordering::Relaxed),
        }
    }

    /// Whether nothing can be written now.
    pub fn failed(&self) -> bool {
        self.problems().error.is_some()
    }

    /// Why nothing can be written now, as text for the operator.
    pub fn error(&self) -> Option<String> {
        self.problem().map(|problem| problem.text)
    }

    /// The same, with its cause.
    pub fn problem(&self) -> Option<Problem> {
        self.problems().error.clone()
    }

    /// A problem resolved in the last 30 s, as text for the operator.
    pub fn notice(&self) -> Option<String> {
        self.past_problem().map(|problem| problem.text)
    }

    /// The same, with its cause.
    pub fn past_problem(&self) -> Option<Problem> {
        let problems = self.problems();
        let (since, problem) = problems.past.as_ref()?;
        (since.elapsed() < NOTICE).then(|| problem.clone())
    }

    /// The file that is written now.
    pub fn path(&self) -> PathBuf {
        self.path.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Messages that never reached the recorder.
    pub(crate) fn not_handed_over(&self) -> u64 {
        self.flooded.load(Ordering::Relaxed) + self.too_slow.load(Ordering::Relaxed)
    }

    /// Messages that are neither lost nor confirmed by the disk.
    pub(crate) fn waiting(&self) -> u64 {
        let known = self.drops() + self.safe.load(Ordering::Relaxed);
        self.offered.load(Ordering::Relaxed).saturating_sub(known)
    }

    /// Counts a message; `room` states whether the queue accepted it.
    pub(crate) fn offer(&self, room: bool) {
        self.offered.fetch_add(1, Ordering::Relaxed);
        if !room {
            self.too_slow.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Counts samples that arrived faster than the node processes them.
    pub(crate) fn flood(&self, messages: u32) {
        self.offered.fetch_add(messages.into(), Ordering::Relaxed);
        self.flooded.fetch_add(messages.into(), Ordering::Relaxed);
    }

    pub(crate) fn set_counts(&self, counts: Counts) {
        self.written.store(counts.written, Ordering::Relaxed);
        self.safe.store(counts.safe, Ordering::Relaxed);
        self.unwritten.store(counts.unwritten, Ordering::Relaxed);
        self.refused.store(counts.refused, Ordering::Relaxed);
    }

    pub(crate) fn set_path(&self, path: &Path) {
        *self.path.lock().unwrap_or_else(PoisonError::into_inner) = path.to_owned();
    }

    pub(crate) fn set_error(&self, error: &BagError) {
        self.problems().error = Some(Problem::of(error));
    }

    /// The recording continues; the resolved problem stays visible for a while.
    pub(crate) fn clear_error(&self, past: Option<&BagError>) {
        let mut problems = self.problems();
        problems.error = None;
        problems.past = past.map(|error| (Instant::now(), Problem::of(error)));
    }

    fn problems(&self) -> MutexGuard<'_, Problems> {
        self.problems.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
