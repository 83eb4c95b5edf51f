//! The monotonic clock, as nanoseconds, and sleeping until an instant of it.

/// Nanoseconds of CLOCK_MONOTONIC.
#[cfg(target_os = "linux")]
pub fn now() -> u64 {
    read(libc::CLOCK_MONOTONIC)
}

#[cfg(target_os = "linux")]
fn read(clock: libc::clockid_t) -> u64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    #[expect(
        unsafe_code,
        reason = "the standard library has no clock of a thread's processor time"
    )]
    // SAFETY: `time` is a valid timespec that the call fills; both clocks asked for always exist on Linux, so that it
    // cannot fail.
    unsafe {
        libc::clock_gettime(clock, &raw mut time)
    };
    // Neither part is negative on these clocks.
    time.tv_sec.unsigned_abs() * 1_000_000_000 + time.tv_nsec.unsigned_abs()
}

/// Nanoseconds that this thread has had a processor; on other systems than Linux those of [`now`].
pub fn processor_time() -> u64 {
    #[cfg(target_os = "linux")]
    {
        read(libc::CLOCK_THREAD_CPUTIME_ID)
    }
    #[cfg(not(target_os = "linux"))]
    {
        now()
    }
}

/// Sleeps until `deadline` (ns of [`now`]); returns at once when it has passed. Signals do not shorten it.
#[cfg(target_os = "linux")]
pub fn sleep_until(deadline: u64) {
    let time = libc::timespec {
        // Fits: 2^64 ns are 584 years.
        tv_sec: (deadline / 1_000_000_000) as libc::time_t,
        tv_nsec: (deadline % 1_000_000_000) as libc::c_long,
    };
    loop {
        #[expect(
            unsafe_code,
            reason = "the standard library does not sleep until an absolute instant"
        )]
        // SAFETY: `time` is a valid timespec that outlives the call; the remaining time is not asked for.
        let result = unsafe {
            libc::clock_nanosleep(
                libc::CLOCK_MONOTONIC,
                libc::TIMER_ABSTIME,
                &raw const time,
                std::ptr::null_mut(),
            )
        };
        if result != libc::EINTR {
            return;
        }
    }
}

/// Nanoseconds since the first call.
#[cfg(not(target_os = "linux"))]
pub fn now() -> u64 {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    let elapsed = START.get_or_init(std::time::Instant::now).elapsed();
    u64::try_from(elapsed.as_nanos()).unwrap_or(u64::MAX)
}

/// Sleeps until `deadline` (ns of [`now`]); returns at once when it has passed.
#[cfg(not(target_os = "linux"))]
pub fn sleep_until(deadline: u64) {
    std::thread::sleep(std::time::Duration::from_nanos(deadline.saturating_sub(now())));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sleeps_to_the_deadline_and_not_for_the_past() {
        let start = now();
        sleep_until(start.saturating_sub(1));
        let deadline = start + 5_000_000;
        sleep_until(deadline);
        assert!(now() >= deadline);
    }
}
