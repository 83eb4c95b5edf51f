//! Many runs on threads. Each is computed by itself, so that the number of threads changes nothing but the time.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use flexdrill_core::dynamics::StepFailure;

use crate::recorder::Recorder;
use crate::twin::{Plan, Twin};

/// Time between two calls of the caller's watch.
const WATCH: Duration = Duration::from_millis(50);

/// Steps between two looks at the signal to stop: some hundredths of a second of computing time.
const STRIDE: u64 = 100;

/// One run.
pub struct Member<'a> {
    /// Advanced in place.
    pub twin: &'a mut Twin,
    /// Its inputs.
    pub plan: Plan,
    /// Its samples.
    pub recorder: Recorder,
}

/// How a run ended.
pub struct Outcome {
    /// Its samples, up to a failure.
    pub recorder: Recorder,
    /// Why it ended early.
    pub failure: Option<StepFailure>,
    /// Whether all steps were taken, or it failed. Otherwise it was stopped.
    pub ended: bool,
}

/// Runs the members on `threads` threads and returns how each ended, in their order. `watch` is called on the calling
/// thread every 50 ms with the number of members that ended; when it returns false, the runs stop.
pub fn rollout(members: Vec<Member<'_>>, threads: usize, mut watch: impl FnMut(usize) -> bool) -> Vec<Outcome> {
    let count = members.len();
    let waiting: Vec<Mutex<Option<Member<'_>>>> = members.into_iter().map(|member| Mutex::new(Some(member))).collect();
    let outcomes: Vec<Mutex<Option<Outcome>>> = (0..count).map(|_| Mutex::new(None)).collect();
    let (next, ended, stop) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicBool::new(false));
    let caller = std::thread::current();
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(slot) = waiting.get(index) else { return };
            let Some(member) = take(slot) else { return };
            let outcome = run(member, &stop);
            if let Ok(mut place) = outcomes[index].lock() {
                *place = Some(outcome);
            }
            ended.fetch_add(1, Ordering::Release);
            caller.unpark();
        }
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.clamp(1, count.max(1))).map(|_| scope.spawn(work)).collect();
        // A thread that panicked ends without its members; the scope then passes the panic on.
        let working =
            || ended.load(Ordering::Acquire) < count && !workers.iter().all(std::thread::ScopedJoinHandle::is_finished);
        while working() {
            if !watch(ended.load(Ordering::Acquire)) {
                stop.store(true, Ordering::Relaxed);
            }
            std::thread::park_timeout(WATCH);
        }
    });
    outcomes.into_iter().filter_map(|slot| take(&slot)).collect()
}

fn take<T>(slot: &Mutex<Option<T>>) -> Option<T> {
    slot.lock().ok()?.take()
}

fn run(member: Member<'_>, stop: &AtomicBool) -> Outcome {
    let Member {
        twin,
        plan,
        mut recorder,
    } = member;
    let (mut done, mut failure) = (0, None);
    while done < plan.steps && !stop.load(Ordering::Relaxed) {
        match twin.follow(&plan, done, STRIDE, Some(&mut recorder)) {
            Ok(now) => done = now,
            Err(at) => {
                failure = Some(at);
                break;
            }
        }
    }
    Outcome {
        recorder,
        ended: failure.is_some() || done >= plan.steps,
        failure,
    }
}
