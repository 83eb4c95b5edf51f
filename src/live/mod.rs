//! Live over WebSocket, in the protocol of Foxglove and Lichtblick, with the very bytes that DDS and the bags have.
//!
//! - `hub`: the topics that are offered, the newest state of latched ones, who subscribes.
//! - `door`: who may come in: Host, Origin, subprotocol, number of clients; with the token, to where one may steer.
//! - `pump`: from the protocol's server to one viewer; what the viewer does not take is given up and counted.
//! - `steering`: parameters, services and inputs for who has shown the token; `token` is that secret.
//! - `server`: both behind one address, on a thread of its own (`flexdrill run --foxglove`) or in a runtime that is there.
//! - `player`: a bag as a source, with play, pause, seek and speed.
//!
//! A viewer that does not take its data loses the oldest, in its own queue: it slows nobody.

mod door;
mod hub;
mod player;
mod pump;
mod server;
mod steering;
mod token;

pub use door::Door;
pub(crate) use door::host_is_ours;
pub use hub::Hub;
pub(crate) use player::range;
pub use player::{Player, Playing, States};
pub use server::LiveServer;
pub(crate) use server::{door_to, listen, only_door, serve, start_protocol};
pub use steering::{InputTopic, OfferedService, Setting, Steered, Steering, Viewer};
pub use token::Token;
pub(crate) use token::fill_random;

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
    /// The system gives no secret.
    #[error("{0}")]
    Random(String),
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
