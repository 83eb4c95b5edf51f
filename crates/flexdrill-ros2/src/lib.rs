//! A ROS 2 client layer without a ROS installation: names and arguments, topics, services, parameters, `/rosout`.
//!
//! This crate alone depends on ros2-client and RustDDS; everything above it handles names, CDR bytes and the types of
//! `flexdrill-messages`. DDS runs in a child process ([`dds`]): the program that uses this crate must run
//! [`dds::side::main`] for the hidden subcommand [`dds::side::SUBCOMMAND`]. The crate knows nothing of the model.
//!
//! # Layout
//! - [`dds`]: the DDS process, and the [`dds::port`] to it.
//! - [`args`]: `--ros-args`, names and remapping. [`parameters`]: declared parameters and their services.
//! - [`service`]: service servers. [`replies`]: replies that are too long to send. [`client`]: calls of other nodes'
//!   services. [`subscriber`]: a node that only listens. [`action`] and [`goal_book`]: servers of actions.
//! - [`logging`]: log lines on standard error and `/rosout`. [`loggers`] and [`type_description`]: the services that
//!   every ROS 2 node has.

pub mod action;
pub mod args;
pub mod client;
pub mod dds;
pub mod goal_book;
pub mod loggers;
pub mod logging;
pub mod parameters;
pub mod replies;
pub mod service;
pub mod subscriber;
pub mod type_description;

/// Why a node could not join the network.
#[derive(Debug, thiserror::Error)]
pub enum JoinError {
    /// A name or an argument is wrong.
    #[error(transparent)]
    Args(#[from] args::ArgsError),
    /// DDS, in its own process, did not start.
    #[error(transparent)]
    Dds(#[from] dds::port::StartError),
}
