//! The places of members: what is drawn for each, and the run that it becomes, on threads.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::engine::Slice;
use super::member::Member;
use flexdrill_core::twin::RunInputs;
use flexdrill_uncertainty::Member as Drawn;

/// What members run on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Threads {
    /// How many.
    pub count: usize,
    /// Whether their work is idle work, which takes what other work leaves of the processors.
    pub idle: bool,
}

/// A member, or why there is none.
pub(super) struct Place {
    pub(super) drawn: Result<Drawn, String>,
    pub(super) state: State,
    /// Whether it was drawn before anything was measured.
    pub(super) first: bool,
}

/// What has become of it.
pub(super) enum State {
    /// Built with the next slice.
    Unborn,
    Runs(Box<Member>),
    Failed,
}

impl Place {
    /// A member that is not built yet.
    pub(super) fn new(drawn: Result<Drawn, String>, first: bool) -> Self {
        Self {
            drawn,
            state: State::Unborn,
            first,
        }
    }

    /// The member that runs.
    pub(super) fn member(&self) -> Option<&Member> {
        match &self.state {
            State::Runs(member) => Some(member),
            _ => None,
        }
    }

    /// The same, to change it.
    pub(super) fn member_mut(&mut self) -> Option<&mut Member> {
        match &mut self.state {
            State::Runs(member) => Some(member),
            _ => None,
        }
    }

    pub(super) fn has_failed(&self) -> bool {
        matches!(self.state, State::Failed)
    }

    /// Runs a slice, at whose beginning `acts` acts; builds the tool first where it is new.
    pub(super) fn advance(&mut self, slice: &Slice<'_>, acts: &RunInputs) {
        if let State::Unborn = self.state {
            let built = self
                .drawn
                .as_ref()
                .map_err(String::clone)
                .and_then(|drawn| Member::new(drawn, acts));
            self.state = match built {
                Ok(member) => State::Runs(Box::new(member)),
                Err(_) => State::Failed,
            };
        }
        if let State::Runs(member) = &mut self.state
            && member.advance(slice).is_err()
        {
            // Its memory is large, and what it knows of the rig is not needed any more.
            self.state = State::Failed;
        }
    }
}

/// `work` on each of `items`.
pub(super) fn in_parallel<T: Send>(items: Vec<&mut T>, threads: Threads, work: impl Fn(&mut T) + Sync) {
    let items: Vec<Mutex<&mut T>> = items.into_iter().map(Mutex::new).collect();
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..threads.count.clamp(1, items.len().max(1)) {
            scope.spawn(|| {
                if threads.idle {
                    flexdrill_realtime::priority::idle();
                }
                while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
                    work(&mut item.lock().unwrap_or_else(PoisonError::into_inner));
                }
            });
        }
    });
}
