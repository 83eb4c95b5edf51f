//! Live over WebSocket, in the protocol of Foxglove and Lichtblick, with the very bytes that DDS and the bags have.
//!
//! - `hub`: the topics that are offered, the newest state of latched ones, who subscribes.
//! - `gateway`: who is admitted: Host, Origin, subprotocol, number of viewers; who shows the token may steer.
//! - `session`: the conversation with one viewer; `backlog`: what waits for it, bounded in number, bytes and age.
//! - `steering`: parameters, services and inputs for who has shown the token; `token` is that secret, `wrong_tokens` what
//!   happens to others.
//! - `connections`: connections to the address, bounded in number, time and buffers.
//! - `server`: all of it on a thread of its own (`flexdrill run --foxglove`) or in a runtime that exists.
//! - `player`: a bag as a source, with play, pause, seek and speed.
//!
//! A slow viewer loses its oldest messages and slows nothing else. There is one listening socket: the announced
//! address.

mod backlog;
mod connections;
mod gateway;
mod hub;
mod player;
mod server;
mod session;
mod steering;
mod token;
mod wrong_tokens;

pub(crate) use connections::serve;
pub use gateway::Gateway;
pub(crate) use gateway::host_is_ours;
pub use hub::Hub;
pub(crate) use player::range;
pub use player::{Player, Playing, States};
pub use server::LiveServer;
pub(crate) use server::{listen, only_gateway};
pub use steering::{InputTopic, OfferedService, Setting, Steered, Steering, Viewer};
pub use token::Token;
pub(crate) use token::fill_random;
pub(crate) use wrong_tokens::WrongTokens;

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
