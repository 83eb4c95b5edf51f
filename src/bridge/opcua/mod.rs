//! `flexdrill bridge opcua`: the twin as a server of OPC UA, and a rig's server as a source.

mod diagnosis;
mod rig;
mod server;

use std::time::Duration;

use flexdrill_text::log_ending;

pub use rig::RigBridge;
pub use server::ServerBridge;

/// Time between two messages on `/diagnostics`.
const DIAGNOSTICS: Duration = Duration::from_secs(1);
/// Events that wait for the bridge; beyond them they are dropped and counted, or the sender waits.
pub const QUEUE: usize = 4096;

/// One line per cause in ten seconds.
fn info(cause: &'static str, text: impl FnOnce() -> String) {
    if let Some(more) = log_ending(cause) {
        tracing::info!("opcua: {}{more}", text());
    }
}

/// One warning per cause in ten seconds.
fn warn(cause: &'static str, text: impl FnOnce() -> String) {
    if let Some(more) = log_ending(cause) {
        tracing::warn!("opcua: {}{more}", text());
    }
}
