//! Errors of the dashboard.

use flexdrill_bag::BagError;
use flexdrill_live::{LiveError, TokenError};
use flexdrill_ros2::args::ArgsError;
use flexdrill_ros2::dds::port::StartError;

/// Why the dashboard did not start, or ended.
#[derive(Debug, thiserror::Error)]
pub enum DashboardError {
    /// The address cannot be used, or the bag cannot be played.
    #[error(transparent)]
    Live(#[from] LiveError),
    /// The operating system has no random numbers.
    #[error(transparent)]
    Random(#[from] TokenError),
    /// The bag cannot be read.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// The twin's namespace or name is wrong.
    #[error(transparent)]
    Name(#[from] ArgsError),
    /// DDS, in its own process, did not start.
    #[error(transparent)]
    Dds(#[from] StartError),
    /// The operating system refused a socket or a thread.
    #[error("the dashboard's server cannot run: {0}")]
    Io(#[from] std::io::Error),
    /// A task of the server failed.
    #[error("a task of the dashboard's server failed: {0}")]
    Task(#[from] tokio::task::JoinError),
}
