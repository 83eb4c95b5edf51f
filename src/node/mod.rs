//! The node. A run has four stages: `prepare` checks names and files and declares all endpoints, `start` brings DDS and
//! the threads up, `wait` lasts until the end of the run, `end` stops them in order.
//!
//! - the solver's thread: [`flexdrill_realtime`];
//! - the publisher's thread: [`publish`]; the recorder's thread: [`RecordingThread`](crate::bag::RecordingThread);
//! - tokio tasks: inputs ([`receive`]), `/clock` (`clock_topic`), services and parameters ([`control`]).

pub mod alarms;
mod clock_topic;
pub mod clocks;
mod confirmed;
pub mod control;
pub mod demonstration_rig;
mod duration;
mod error;
mod following;
mod host;
pub mod inputs;
pub mod life;
mod lifecycle;
pub mod parameters;
mod prepare;
pub mod publish;
pub mod publishers;
pub mod receive;
pub mod received;
mod running;
mod set_point;
mod setup;
mod simulator;
mod states;
pub mod surveys;
mod thinned;
mod turns;
pub mod viewers;
mod what_if;
mod what_if_messages;

use std::future::Future;

pub use self::error::NodeError;
use self::prepare::PreparedNode;
pub use self::setup::{LiveAddress, NodeSetup, RunSummary};
use flexdrill_ros2::logging;

/// Name of the node unless it is remapped.
pub const DEFAULT_NODE_NAME: &str = "flexdrill";

/// Runs a node until `shutdown` is ready or the configured duration has passed.
///
/// # Errors
/// When DDS, the model or the recording cannot be started, or the recording could not be finished.
pub async fn run(setup: NodeSetup, shutdown: impl Future<Output = ()>) -> Result<RunSummary, NodeError> {
    let result = run_stages(setup, shutdown).await;
    // A node that failed to start has connected the log to its topic, too.
    logging::disconnect();
    result
}

async fn run_stages(setup: NodeSetup, shutdown: impl Future<Output = ()>) -> Result<RunSummary, NodeError> {
    let mut node = PreparedNode::new(setup)?.start().await?;
    let outcome = node.wait(shutdown).await;
    let summary = node.end().await?;
    outcome.map(|()| summary)
}
