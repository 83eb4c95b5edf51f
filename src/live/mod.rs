//! Live over WebSocket, in the protocol of Foxglove and Lichtblick, with the very bytes that DDS and the bags have.
//!
//! - `hub`: the topics that are offered, the newest state of latched ones, who subscribes.
//! - `door`: who may come in: Host, Origin, subprotocol, number of clients.
//! - `server`: both behind one address, on a thread of its own (`flexdrill run --foxglove`) or in a runtime that is there.
//! - `player`: a bag as a source, with play, pause, seek and speed.
//!
//! The crate `foxglove` keeps, per client, a queue that drops its oldest message: a client that does not take slows nobody.

mod door;
mod hub;
mod player;
mod server;

pub use door::Door;
pub(crate) use door::host_is_ours;
pub use hub::Hub;
pub(crate) use player::range;
pub use player::{Player, Playing, States};
pub use server::LiveServer;
pub(crate) use server::{door_to, listen, only_door, serve, start_protocol};

/// Why nothing can be shown live.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// The address is in use, or not one of this machine.
    #[error("{option} {address}: {source}; is another program there? Give another port")]
    Listen {
        /// Option that gave it.
        option: &'static str,
        /// As given.
        address: std::net::SocketAddr,
        /// Of the system.
        source: std::io::Error,
    },
    /// The protocol's own server did not start.
    #[error("the server of the Foxglove protocol did not start: {0}")]
    Protocol(#[from] foxglove::FoxgloveError),
    /// The system gives no thread or runtime.
    #[error("the live server's thread could not be started: {0}")]
    Thread(#[from] std::io::Error),
    /// Nothing in the bag can be played.
    #[error("{path}: no message in it, so there is nothing to play", path = path.display())]
    EmptyBag {
        /// The bag.
        path: std::path::PathBuf,
    },
    /// The bag.
    #[error(transparent)]
    Bag(#[from] crate::bag::BagError),
}
