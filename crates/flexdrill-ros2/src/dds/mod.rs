//! DDS in a separate process.
//!
//! A packet from the network, a signal at the wrong moment or a change of the system's clock can end the DDS library. The
//! program must survive that. Therefore DDS runs in a child process ([`side`]), which handles names, qualities of service
//! and bytes, and nothing else. This process holds a [`port`] to it: bounded queues, supervision of the child, and the
//! newest state of every latched topic, which a restarted child publishes again.
//!
//! - [`network`]: the domain and the reach; [`plan`]: the endpoints that the child creates;
//! - [`frames`]: the protocol on the socket between the two processes;
//! - [`port`]: the parent's end; [`side`]: the child.

pub mod frames;
pub mod network;
pub mod plan;
pub mod port;
pub mod side;
