//! Live data over WebSocket, in the protocol of Foxglove and Lichtblick, with the same bytes that DDS and the bags
//! carry.
//!
//! This is the only crate that uses the crate `foxglove`. It knows bags and messages, but neither ROS nor the node:
//! what a viewer may change, the node offers through the trait [`Steered`].
//!
//! # Layout
//! - `hub`: the offered topics, the newest state of latched ones, and the subscribers.
//! - `gateway`: admits viewers by Host, Origin, subprotocol and number; a viewer with the token may steer.
//! - `session`: the conversation with one viewer. `backlog`: its queue, bounded in number, bytes and age.
//! - `steering`: parameters, services and inputs for viewers with the token. `token`: that secret. `wrong_tokens`:
//!   slows down and logs wrong ones.
//! - `connections`: the connections to the address, bounded in number, time and buffers.
//! - `server`: hub and gateway on a separate thread (`flexdrill run --foxglove`) or in an existing runtime.
//! - `player`: a bag as the source, with play, pause, seek and speed.
//!
//! A slow viewer loses its oldest messages and slows nothing else. The announced address is the only listening socket.

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

pub use connections::serve;
pub use gateway::{Gateway, host_is_ours};
pub use hub::Hub;
pub use player::{LatchedStates, Player, Playing, range};
pub use server::{LiveServer, listen, only_gateway};
pub use steering::{InputTopic, OfferedService, Setting, Steered, Steering, Viewer};
pub use token::{Token, TokenError, fill_random};
pub use wrong_tokens::WrongTokens;

/// Errors of the live server and of the player.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// The address is in use, or not one of this machine.
    #[error("{option} {address}: cannot listen: {source}; choose another port or another address of this machine")]
    Listen {
        /// The option that gave the address.
        option: &'static str,
        /// The address.
        address: std::net::SocketAddr,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// The operating system refused a thread or a socket.
    #[error("the live server's thread could not be started: {0}")]
    Thread(#[from] std::io::Error),
    /// The bag has no message.
    #[error("{path}: the bag has no message, so there is nothing to play", path = path.display())]
    EmptyBag {
        /// The bag.
        path: std::path::PathBuf,
    },
    /// The bag cannot be read.
    #[error(transparent)]
    Bag(#[from] flexdrill_bag::BagError),
}
