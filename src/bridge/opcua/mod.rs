//! `flexdrill bridge opcua`: the twin as a server of OPC UA, and a rig's server as a source.

mod diagnosis;
mod rig;
mod server;

use std::time::Duration;

use flexdrill_realtime::monotonic;
use flexdrill_text::Throttles;

pub use rig::RigBridge;
pub use server::ServerBridge;

/// Time between two messages on `/diagnostics`.
const DIAGNOSTICS: Duration = Duration::from_secs(1);
/// Least time between two log lines of one cause (s).
const LOG_INTERVAL: f64 = 10.0;
/// Events that wait for the bridge; beyond them they are dropped and counted, or the sender waits.
pub const QUEUE: usize = 4096;

/// Log lines, limited by cause.
struct Log(Throttles<&'static str>);

impl Log {
    fn new() -> Self {
        Self(Throttles::new(LOG_INTERVAL))
    }

    fn info(&mut self, cause: &'static str, text: impl FnOnce() -> String) {
        if let Some(more) = self.0.ending(cause, monotonic::now() as f64 * 1e-9) {
            tracing::info!("opcua: {}{more}", text());
        }
    }

    fn warn(&mut self, cause: &'static str, text: impl FnOnce() -> String) {
        if let Some(more) = self.0.ending(cause, monotonic::now() as f64 * 1e-9) {
            tracing::warn!("opcua: {}{more}", text());
        }
    }
}
