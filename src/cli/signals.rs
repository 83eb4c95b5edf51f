//! Ctrl-C and SIGTERM: the first asks for an orderly end, the second forces it.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use futures::future::select_all;
use tokio::signal::unix::{Signal, SignalKind, signal};

/// Exit code after a forced end, as shells know it from SIGINT.
const FORCED: i32 = 130;

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

/// Done when the process is first asked to end. After that, another signal ends it at once.
///
/// # Errors
/// When the handlers cannot be installed.
pub(super) fn shutdown() -> io::Result<impl Future<Output = ()>> {
    let mut signals = Signals::listen([SignalKind::interrupt(), SignalKind::terminate()])?;
    Ok(async move {
        signals.next().await;
        tokio::spawn(async move {
            signals.next().await;
            eprintln!("ended at once");
            std::process::exit(FORCED);
        });
    })
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
        Signals::listen([SignalKind::interrupt(), SignalKind::terminate(), SignalKind::hangup()])?
    };
    std::thread::spawn(move || {
        runtime.block_on(signals.next());
        flag.store(true, Ordering::Relaxed);
    });
    Ok(stop)
}
