//! The priority of threads that work on what a live run leaves of the processors.

/// Puts this thread into the class of idle work: any thread of the usual class that wakes up takes its processor at once.
/// With the lowest niceness alone the live run would wait for a slice to end, some milliseconds, which is a period of the
/// solver. It is a hint: where the system refuses, the thread keeps its priority.
pub fn idle() {
    #[cfg(target_os = "linux")]
    {
        let parameters = libc::sched_param { sched_priority: 0 };
        #[expect(unsafe_code, reason = "the standard library has no classes of priority")]
        // SAFETY: 0 names the calling thread, and `parameters` is a valid sched_param that outlives the call.
        let _refused = unsafe { libc::sched_setscheduler(0, libc::SCHED_IDLE, &raw const parameters) };
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #[test]
    fn only_the_calling_thread_becomes_idle() {
        #[expect(unsafe_code, reason = "the standard library has no classes of priority")]
        // SAFETY: 0 names the calling thread; the call reads nothing else.
        let class = || unsafe { libc::sched_getscheduler(0) };
        let before = class();
        let idle = std::thread::spawn(move || {
            super::idle();
            class()
        });
        assert_eq!((idle.join().unwrap(), class()), (libc::SCHED_IDLE, before));
    }
}
