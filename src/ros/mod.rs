//! The ROS 2 node.

pub mod args;
pub mod logging;
pub mod network;
pub mod node;
pub mod parameters;
pub mod publisher;
pub mod raw;
pub mod rig_node;
pub mod service;
pub mod subscriber;

use ros2_client::CreateError;

/// Name of the node unless it is remapped.
pub const DEFAULT_NODE_NAME: &str = "flexdrill";

/// Why the node could not be brought up.
#[derive(Debug, thiserror::Error)]
pub enum NodeError {
    /// Wrong ROS 2 arguments.
    #[error(transparent)]
    Args(#[from] args::ArgsError),
    /// Wrong network settings, or DDS did not start.
    #[error(transparent)]
    Network(#[from] network::NetworkError),
    /// The node itself could not be created.
    #[error("node {node}: {why}")]
    Node {
        /// Absolute name.
        node: String,
        /// What is wrong.
        why: String,
    },
    /// A topic or its endpoint could not be created.
    #[error("topic {topic}: {source}")]
    Topic {
        /// Absolute name.
        topic: String,
        /// From DDS.
        source: CreateError,
    },
    /// A service's name is not usable.
    #[error("service {service}: {why}")]
    ServiceName {
        /// Absolute name.
        service: String,
        /// What is wrong.
        why: String,
    },
    /// A service could not be created.
    #[error("service {service}: {source}")]
    Service {
        /// Absolute name.
        service: String,
        /// From DDS.
        source: CreateError,
    },
    /// A part of the node could not be started or ended badly.
    #[error("{0}")]
    Stopped(String),
    /// The model could not be built.
    #[error(transparent)]
    Build(#[from] flexdrill_core::twin::BuildError),
    /// The recording.
    #[error(transparent)]
    Recording(#[from] crate::bag::BagError),
    /// A checkpoint that cannot be read.
    #[error("checkpoint {path}: {why}", path = path.display())]
    Checkpoint {
        /// File or folder that it is about.
        path: std::path::PathBuf,
        /// What is wrong.
        why: String,
    },
}
