//! Why the node could not run.

use std::path::PathBuf;

/// Why the node could not start, or ended badly.
#[derive(Debug, thiserror::Error)]
pub enum NodeError {
    /// A ROS 2 argument or name is wrong.
    #[error(transparent)]
    Args(#[from] flexdrill_ros2::args::ArgsError),
    /// DDS, in its own process, did not start.
    #[error(transparent)]
    Dds(#[from] flexdrill_ros2::dds::port::StartError),
    /// A part of the node could not be started or ended badly.
    #[error("{0}")]
    Stopped(String),
    /// The model could not be built.
    #[error(transparent)]
    Build(#[from] flexdrill_core::twin::BuildError),
    /// The recording.
    #[error(transparent)]
    Recording(#[from] crate::bag::BagError),
    /// The live server.
    #[error(transparent)]
    Live(#[from] crate::live::LiveError),
    /// The map of speed and weight.
    #[error(transparent)]
    Window(#[from] crate::safe_window::WindowError),
    /// A checkpoint cannot be read.
    #[error("checkpoint {path}: {why}", path = path.display())]
    Checkpoint {
        /// File of the checkpoint.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
}
