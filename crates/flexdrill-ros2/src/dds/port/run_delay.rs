//! How long a process has waited for a processor.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

/// The time for which the threads of a process were ready and waited for a processor, counted from a mark. A process that is
/// stopped or waits for itself adds nothing. Systems without Linux's `/proc` report no wait.
pub(super) struct RunDelay {
    threads: PathBuf,
    /// Per thread, the wait since it began (ns).
    mark: BTreeMap<u32, u64>,
}

impl RunDelay {
    /// Counts from now.
    pub(super) fn of(process: u32) -> Self {
        let mut delay = Self {
            threads: PathBuf::from(format!("/proc/{process}/task")),
            mark: BTreeMap::new(),
        };
        delay.mark();
        delay
    }

    /// Counts from now.
    pub(super) fn mark(&mut self) {
        self.mark = self.read();
    }

    /// The wait since the mark of the thread that waited for longest.
    pub(super) fn since_mark(&self) -> Duration {
        let longest = self.read().into_iter().map(|(thread, now)| {
            let then = self.mark.get(&thread).copied().unwrap_or_default();
            now.saturating_sub(then)
        });
        Duration::from_nanos(longest.max().unwrap_or_default())
    }

    fn read(&self) -> BTreeMap<u32, u64> {
        let Ok(threads) = std::fs::read_dir(&self.threads) else {
            return BTreeMap::new();
        };
        threads
            .flatten()
            .filter_map(|thread| {
                let id = thread.file_name().to_str()?.parse().ok()?;
                // Time on a processor, time ready without one, and number of turns (Linux, sched-stats.rst).
                let text = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
                Some((id, text.split_whitespace().nth(1)?.parse().ok()?))
            })
            .collect()
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::time::Instant;

    use super::*;

    /// Two threads that are bound to one processor and have work wait for each other half of the time.
    #[test]
    fn a_thread_that_waits_for_a_processor_is_seen_and_one_that_sleeps_is_not() {
        let own = RunDelay::of(std::process::id());
        assert!(!own.mark.is_empty(), "the system has no schedstat");
        let mut command = std::process::Command::new("sleep");
        let mut sleeper = command.arg("30").spawn().unwrap();
        let sleeping = RunDelay::of(sleeper.id());
        let busy: Vec<_> = (0..2)
            .map(|_| {
                std::process::Command::new("taskset")
                    .args(["-c", "0", "sh", "-c", "while :; do :; done"])
                    .spawn()
                    .unwrap()
            })
            .collect();
        let delays: Vec<RunDelay> = busy.iter().map(|process| RunDelay::of(process.id())).collect();
        let most = || delays.iter().map(RunDelay::since_mark).max().unwrap();
        let deadline = Instant::now() + Duration::from_secs(20);
        while most() < Duration::from_millis(300) && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(50));
        }
        let (waited, slept) = (most(), sleeping.since_mark());
        for mut process in busy {
            process.kill().unwrap();
            process.wait().unwrap();
        }
        sleeper.kill().unwrap();
        sleeper.wait().unwrap();
        assert!(waited >= Duration::from_millis(300), "{waited:?}");
        assert!(slept < waited / 2, "{slept:?} of {waited:?}");
    }
}
