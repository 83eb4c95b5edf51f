//! How a recording is doing, for those who watch it from another thread.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::{BagError, Losses};

/// How long a trouble that is over is still told of: long enough for any alarm's delay.
const NOTICE: Duration = Duration::from_secs(30);

/// Messages of a recording.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Counts {
    /// In the files.
    pub written: u64,
    /// Of these, on the disk for certain.
    pub safe: u64,
    /// In no file.
    pub unwritten: u64,
    /// In a file that the disk refused to keep.
    pub refused: u64,
}

#[derive(Debug, Default)]
struct Trouble {
    /// Why nothing can be written.
    error: Option<Problem>,
    /// What was wrong last, and until when.
    past: Option<(Instant, Problem)>,
}

/// What is wrong with a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// File and reason.
    pub text: String,
    /// Why, in a sentence.
    pub cause: &'static str,
}

impl Problem {
    fn of(error: &BagError) -> Self {
        Self {
            text: error.to_string(),
            cause: error.cause(),
        }
    }
}

/// How the recording is doing.
#[derive(Debug, Default)]
pub struct RecordingHealth {
    offered: AtomicU64,
    flooded: AtomicU64,
    too_slow: AtomicU64,
    written: AtomicU64,
    safe: AtomicU64,
    unwritten: AtomicU64,
    refused: AtomicU64,
    trouble: Mutex<Trouble>,
    path: Mutex<PathBuf>,
}

impl RecordingHealth {
    /// Messages in the files; those of the last moments are still on their way there.
    pub fn messages(&self) -> u64 {
        self.written.load(Ordering::Relaxed)
    }

    /// Messages lost, or in a file that the disk refused.
    pub fn drops(&self) -> u64 {
        self.losses().total()
    }

    /// The same by cause.
    pub fn losses(&self) -> Losses {
        Losses {
            flooded: self.flooded.load(Ordering::Relaxed),
            too_slow: self.too_slow.load(Ordering::Relaxed),
            unwritten: self.unwritten.load(Ordering::Relaxed),
            refused: self.refused.load(Ordering::Relaxed),
        }
    }

    /// Whether nothing can be written at present.
    pub fn failed(&self) -> bool {
        self.trouble().error.is_some()
    }

    /// Why nothing can be written, for a person.
    pub fn error(&self) -> Option<String> {
        self.problem().map(|problem| problem.text)
    }

    /// The same with its cause.
    pub fn problem(&self) -> Option<Problem> {
        self.trouble().error.clone()
    }

    /// What was wrong a moment ago, when the recording goes on since.
    pub fn notice(&self) -> Option<String> {
        self.past_problem().map(|problem| problem.text)
    }

    /// The same with its cause.
    pub fn past_problem(&self) -> Option<Problem> {
        let trouble = self.trouble();
        let (since, problem) = trouble.past.as_ref()?;
        (since.elapsed() < NOTICE).then(|| problem.clone())
    }

    /// The file that is recorded to.
    pub fn path(&self) -> PathBuf {
        self.path.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Messages that did not get as far as the recorder.
    pub(super) fn not_handed_over(&self) -> u64 {
        self.flooded.load(Ordering::Relaxed) + self.too_slow.load(Ordering::Relaxed)
    }

    /// Messages that are neither lost nor on the disk for certain.
    pub(super) fn waiting(&self) -> u64 {
        let known = self.drops() + self.safe.load(Ordering::Relaxed);
        self.offered.load(Ordering::Relaxed).saturating_sub(known)
    }

    /// Counts a message that is to be recorded; `room` says whether it is on its way.
    pub(super) fn offer(&self, room: bool) {
        self.offered.fetch_add(1, Ordering::Relaxed);
        if !room {
            self.too_slow.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Counts samples that came faster than they were taken.
    pub(super) fn flood(&self, messages: u32) {
        self.offered.fetch_add(messages.into(), Ordering::Relaxed);
        self.flooded.fetch_add(messages.into(), Ordering::Relaxed);
    }

    pub(super) fn set_counts(&self, counts: Counts) {
        self.written.store(counts.written, Ordering::Relaxed);
        self.safe.store(counts.safe, Ordering::Relaxed);
        self.unwritten.store(counts.unwritten, Ordering::Relaxed);
        self.refused.store(counts.refused, Ordering::Relaxed);
    }

    pub(super) fn set_path(&self, path: &Path) {
        *self.path.lock().unwrap_or_else(PoisonError::into_inner) = path.to_owned();
    }

    pub(super) fn set_error(&self, error: &BagError) {
        self.trouble().error = Some(Problem::of(error));
    }

    /// It goes on; what was wrong is still told for a while.
    pub(super) fn clear_error(&self, past: Option<&BagError>) {
        let mut trouble = self.trouble();
        trouble.error = None;
        trouble.past = past.map(|error| (Instant::now(), Problem::of(error)));
    }

    fn trouble(&self) -> MutexGuard<'_, Trouble> {
        self.trouble.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
