//! Ctrl-C, SIGTERM and a terminal that goes away: the first asks for an orderly end, a later one insists. A file size
//! limit is an error of a write.

use crate::cli::output::tell;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use futures::future::select_all;
use tokio::signal::unix::{Signal, SignalKind, signal};

/// Exit code after a forced end, as shells know it from SIGINT.
const FORCED: i32 = 130;

/// Signals that come this soon after the first are the same request: a supervisor sends one to the process and one to
/// its group.
const SAME_REQUEST: Duration = Duration::from_secs(2);

/// Time after the first request within which everything has ended or hangs: the solver's last step, what is left to be
/// published, and the end of a recording on a disk that does not answer.
const ORDERLY_END: Duration = Duration::from_secs(20);

/// What a request to end means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Request {
    /// The first was meant.
    Same,
    /// The end of the recording is on its way, and is waited for.
    Wait,
    /// At once.
    Insist,
}

/// What a request means that comes so long after the first.
fn meaning(after: Duration, recording: bool) -> Request {
    if after < SAME_REQUEST {
        Request::Same
    } else if recording && after < ORDERLY_END {
        Request::Wait
    } else {
        Request::Insist
    }
}

/// Listens to several signals at once.
struct Signals(Vec<Signal>);

impl Signals {
    fn listen(kinds: impl IntoIterator<Item = SignalKind>) -> io::Result<Self> {
        kinds.into_iter().map(signal).collect::<Result<_, _>>().map(Self)
    }

    /// Done at the next of them.
    async fn next(&mut self) {
        select_all(self.0.iter_mut().map(|signal| Box::pin(signal.recv()))).await;
    }
}

/// Signals that ask for the end. That of a terminal that goes away is left alone where it is ignored, as under nohup.
fn requests() -> Vec<SignalKind> {
    let mut kinds = vec![SignalKind::interrupt(), SignalKind::terminate()];
    if !ignores_hangup(&std::fs::read_to_string("/proc/self/status").unwrap_or_default()) {
        kinds.push(SignalKind::hangup());
    }
    kinds
}

/// Whether a process's status says that it ignores SIGHUP, the first of its mask.
fn ignores_hangup(status: &str) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask & 1 == 1)
}

/// Done when the process is first asked to end. After that, another request ends it at once; while it is recording,
/// once the end of the recording is written or cannot be.
///
/// # Errors
/// When the handlers cannot be installed.
pub(super) fn shutdown(recording: bool) -> io::Result<impl Future<Output = ()>> {
    let mut signals = Signals::listen(requests())?;
    Ok(async move {
        signals.next().await;
        let first = Instant::now();
        tokio::spawn(async move {
            let mut insisted = false;
            loop {
                let left = ORDERLY_END.saturating_sub(first.elapsed());
                tokio::select! {
                    () = signals.next() => {}
                    () = tokio::time::sleep(left), if insisted => break,
                }
                match meaning(first.elapsed(), recording) {
                    Request::Same => {}
                    Request::Wait if insisted => {}
                    Request::Wait => {
                        insisted = true;
                        tell!(
                            "the end of the recording is being written; that takes at most {} s",
                            left.as_secs()
                        );
                    }
                    Request::Insist => break,
                }
            }
            tell!("ended at once");
            std::process::exit(FORCED);
        });
    })
}

/// A file that reaches the limit of its size (`ulimit -f`) is an error of that write, as on a full disk, and not the
/// end of the process.
///
/// # Errors
/// When the handler cannot be installed.
pub(super) fn outlive_file_size_limit() -> io::Result<()> {
    // Nobody asks for the flag: a handler that does nothing of note is all that is needed.
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::new(AtomicBool::new(false))).map(drop)
}

/// A flag that SIGINT, SIGTERM and SIGHUP set, so that a terminal is always given back as it was.
///
/// # Errors
/// When the handlers cannot be installed.
pub(super) fn stop_flag() -> io::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let mut signals = {
        let _entered = runtime.enter();
        Signals::listen(requests())?
    };
    std::thread::spawn(move || {
        runtime.block_on(signals.next());
        flag.store(true, Ordering::Relaxed);
    });
    Ok(stop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn under_nohup_a_terminal_that_goes_away_ends_nothing() {
        assert!(ignores_hangup("Name:\tflexdrill\nSigIgn:\t0000000000001001\n"));
        assert!(!ignores_hangup("SigIgn:\t0000000000001000\n"));
        assert!(!ignores_hangup(""));
    }

    #[test]
    fn signals_close_together_are_one_request_and_a_recording_is_always_ended() {
        let after = |seconds: f64, recording| meaning(Duration::from_secs_f64(seconds), recording);
        for recording in [false, true] {
            assert_eq!(after(0.0, recording), Request::Same);
            assert_eq!(after(1.9, recording), Request::Same);
            assert_eq!(after(21.0, recording), Request::Insist);
        }
        assert_eq!(after(2.1, false), Request::Insist);
        assert_eq!(after(2.1, true), Request::Wait);
        assert_eq!(after(19.0, true), Request::Wait);
    }
}
