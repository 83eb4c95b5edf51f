//! Ctrl-C and SIGTERM: the first asks for an orderly end, the second forces it.

use tokio::signal::unix::{SignalKind, signal};

/// Exit code after a forced end, as shells know it from SIGINT.
const FORCED: i32 = 130;

/// Done when the process is first told to end. After that, another signal ends it at once.
///
/// # Errors
/// When the handlers cannot be installed.
pub(super) fn shutdown() -> std::io::Result<impl Future<Output = ()>> {
    let mut interrupt = signal(SignalKind::interrupt())?;
    let mut terminate = signal(SignalKind::terminate())?;
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
        }
        tokio::spawn(async move {
            tokio::select! {
                _ = interrupt.recv() => {}
                _ = terminate.recv() => {}
            }
            eprintln!("ended at once");
            std::process::exit(FORCED);
        });
    })
}
