//! The ROS 2 node.

pub mod args;
pub mod client;
pub mod lifecycle;
pub mod loggers;
pub mod logging;

pub mod node;
pub mod parameters;
pub mod replies;
pub mod rig_node;
pub mod service;
pub mod subscriber;
pub mod type_description;

/// Name of the node unless it is remapped.
pub const DEFAULT_NODE_NAME: &str = "flexdrill";

/// Why the node could not be brought up.
#[derive(Debug, thiserror::Error)]
pub enum NodeError {
    /// Wrong ROS 2 arguments.
    #[error(transparent)]
    Args(#[from] args::ArgsError),
    /// DDS, in its own process, could not be brought up.
    #[error(transparent)]
    Dds(#[from] crate::dds::port::StartError),
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
    /// A checkpoint that cannot be read.
    #[error("checkpoint {path}: {why}", path = path.display())]
    Checkpoint {
        /// File or folder that it is about.
        path: std::path::PathBuf,
        /// What is wrong.
        why: String,
    },
}
