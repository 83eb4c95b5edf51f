//! Ctrl-C, SIGTERM and a closed terminal: the first signal requests an orderly end, a later one forces it. Reaching a
//! file size limit becomes an error of the write.

use crate::cli::output::tell;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use futures::future::select_all;
use tokio::signal::unix::{Signal, SignalKind, signal};

/// Exit code after an end by a signal that left a result unfinished, as shells know it from SIGINT.
pub(super) const ENDED: u8 = 130;

/// A signal this soon after the first is the same request: a supervisor signals both the process and its group.
const SAME_REQUEST: Duration = Duration::from_secs(2);

/// Time after the first request within which an orderly end completes: the solver's last step, the last messages, and
/// the end of a recording on a disk that does not respond. Beyond it something hangs.
const ORDERLY_END: Duration = Duration::from_secs(20);

/// Effect of a further signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Request {
    /// It belongs to the first request.
    Same,
    /// The program ends when the recording has ended.
    Wait,
    /// The program ends at once.
    Force,
}

/// The effect of a signal at a time after the first.
fn meaning(after: Duration, recording: bool) -> Request {
    if after < SAME_REQUEST {
        Request::Same
    } else if recording && after < ORDERLY_END {
        Request::Wait
    } else {
        Request::Force
    }
}

/// Listens to several signals at once.
struct Signals(Vec<Signal>);

impl Signals {
    fn listen(kinds: impl IntoIterator<Item = SignalKind>) -> io::Result<Self> {
        kinds.into_iter().map(signal).collect::<Result<_, _>>().map(Self)
    }

    /// Completes at the next signal.
    async fn next(&mut self) {
        select_all(self.0.iter_mut().map(|signal| Box::pin(signal.recv()))).await;
    }
}

/// The signals that request the end. SIGHUP is not among them if the process ignores it, as under nohup.
fn requests() -> Vec<SignalKind> {
    let mut kinds = vec![SignalKind::interrupt(), SignalKind::terminate()];
    if !ignores_hangup(&std::fs::read_to_string("/proc/self/status").unwrap_or_default()) {
        kinds.push(SignalKind::hangup());
    }
    kinds
}

/// Whether a process ignores SIGHUP, by the first bit of the mask in its status.
fn ignores_hangup(status: &str) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask & 1 == 1)
}

/// Completes at the first request to end. Afterwards another request ends the process at once; during a recording it
/// ends when the recording is complete or cannot be completed.
///
/// # Errors
/// When the handlers cannot be installed.
pub(super) fn shutdown(recording: bool) -> io::Result<impl Future<Output = ()>> {
    let mut signals = Signals::listen(requests())?;
    Ok(async move {
        signals.next().await;
        let first = Instant::now();
        tokio::spawn(async move {
            let mut forced = false;
            loop {
                let left = ORDERLY_END.saturating_sub(first.elapsed());
                tokio::select! {
                    () = signals.next() => {}
                    () = tokio::time::sleep(left), if forced => break,
                }
                match meaning(first.elapsed(), recording) {
                    Request::Same => {}
                    Request::Wait if forced => {}
                    Request::Wait => {
                        forced = true;
                        tell!(
                            "writing the end of the recording; this takes at most {} s",
                            left.as_secs()
                        );
                    }
                    Request::Force => break,
                }
            }
            tell!("forced to end");
            std::process::exit(i32::from(ENDED));
        });
    })
}

/// Makes reaching a file size limit (`ulimit -f`) an error of the write, as on a full disk, instead of the end of the
/// process.
///
/// # Errors
/// When the handler cannot be installed.
pub(super) fn outlive_file_size_limit() -> io::Result<()> {
    // The flag is never read: any handler prevents the signal from ending the process.
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::new(AtomicBool::new(false))).map(drop)
}

/// A flag that SIGINT, SIGTERM and SIGHUP set, so that the terminal is always restored.
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

/// As [`stop_flag`], for a command that writes a recording: another signal ends the program at once only when the end of the
/// recording takes too long.
///
/// # Errors
/// When the handlers cannot be installed.
pub(super) fn stop_recording() -> io::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let requested = {
        let _entered = runtime.enter();
        shutdown(true)?
    };
    std::thread::spawn(move || {
        runtime.block_on(async {
            requested.await;
            flag.store(true, Ordering::Relaxed);
            // The runtime listens to further signals.
            std::future::pending::<()>().await;
        });
    });
    Ok(stop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn under_nohup_a_closed_terminal_ends_nothing() {
        assert!(ignores_hangup("Name:\tflexdrill\nSigIgn:\t0000000000001001\n"));
        assert!(!ignores_hangup("SigIgn:\t0000000000001000\n"));
        assert!(!ignores_hangup(""));
    }

    #[test]
    fn signals_close_together_are_one_request_and_a_recording_is_completed() {
        let after = |seconds: f64, recording| meaning(Duration::from_secs_f64(seconds), recording);
        for recording in [false, true] {
            assert_eq!(after(0.0, recording), Request::Same);
            assert_eq!(after(1.9, recording), Request::Same);
            assert_eq!(after(21.0, recording), Request::Force);
        }
        assert_eq!(after(2.1, false), Request::Force);
        assert_eq!(after(2.1, true), Request::Wait);
        assert_eq!(after(19.0, true), Request::Wait);
    }
}
