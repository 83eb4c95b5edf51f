//! DDS in a process of its own.
//!
//! Any packet from the network, a signal at the wrong moment or a clock that is set can end the DDS library. The twin must
//! not end with it. So DDS lives in a child process ([`side`]), which knows names, qualities of service and bytes, and
//! nothing else; this process holds a [`port`] to it: bounded queues, a watch over its life, and the newest state of every
//! latched topic, to be told again when it is started anew.
//!
//! - [`network`]: which part of the network it talks to; [`plan`]: what the child is to set up;
//! - [`frames`]: what goes over the socket between the two;
//! - [`port`]: this side of it; [`side`]: the child.

pub mod frames;
pub mod network;
pub mod plan;
pub mod port;
pub mod side;
