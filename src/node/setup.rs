//! The settings of a node, and the result of its run.

use std::net::SocketAddr;
use std::path::PathBuf;

use super::life::LifeSetup;
use super::{DEFAULT_NODE_NAME, NodeError};
use crate::bag::Recording;
use crate::live::Token;
use flexdrill_config::Config;
use flexdrill_messages::TwinStatus;
use flexdrill_messages::topics::TopicInfo;
use flexdrill_ros2::args::{ArgsError, NodeIdentity, Remapping};
use flexdrill_ros2::dds::network::Network;
use flexdrill_ros2::service::ServiceMapping;

/// All settings of a node.
#[derive(Debug, Clone)]
pub struct NodeSetup {
    /// Configuration, overrides included.
    pub config: Config,
    /// File of the configuration.
    pub config_file: String,
    /// Domain and reach.
    pub network: Network,
    /// Name and namespace, remapped.
    pub identity: NodeIdentity,
    /// Rules for topics and services.
    pub remapping: Remapping,
    /// Form of the services.
    pub mapping: ServiceMapping,
    /// File to record to.
    pub record: Option<PathBuf>,
    /// Where viewers connect, in Foxglove's protocol; none without viewers.
    pub live: Option<LiveAddress>,
    /// `/clock` paces the model.
    pub use_sim_time: bool,
    /// Log lines on `/rosout`.
    pub rosout: bool,
    /// Checkpoint to start from.
    pub checkpoint: Option<PathBuf>,
    /// File that keeps the alarms' state over a restart.
    pub alarm_state: Option<PathBuf>,
    /// File that keeps the surveys over a restart.
    pub survey_state: Option<PathBuf>,
    /// The table of the joints' lives that the run is added to.
    pub life: Option<LifeSetup>,
    /// A managed node: it begins unconfigured and follows `~/change_state`.
    pub lifecycle: bool,
    /// Model time after which it ends, or wall time for which model time may stand still (s).
    pub duration: Option<f64>,
}

/// The address for viewers, and which of them may steer.
#[derive(Debug, Clone)]
pub struct LiveAddress {
    /// Address to listen at.
    pub address: SocketAddr,
    /// Origins of web pages that may view, in addition to this machine's own, such as `https://viewer.example`.
    pub origins: Vec<String>,
    /// A viewer with this token may steer; without a token no viewer may.
    pub token: Option<Token>,
}

/// The result of a node's run.
#[derive(Debug)]
pub struct RunSummary {
    /// The last status.
    pub status: TwinStatus,
    /// The finished recording.
    pub recording: Option<Recording>,
}

impl NodeSetup {
    /// The absolute name of a topic.
    ///
    /// # Errors
    /// When a remapped name is not allowed.
    pub fn topic_name(&self, topic: &TopicInfo) -> Result<String, NodeError> {
        Ok(self.remapping.topic(&self.identity, DEFAULT_NODE_NAME, topic.name)?)
    }

    /// The absolute name of a service, `~/name` being private to the node.
    ///
    /// # Errors
    /// When a remapped name is not allowed.
    pub fn service_name(&self, name: &str) -> Result<String, ArgsError> {
        self.remapping.service(&self.identity, DEFAULT_NODE_NAME, name)
    }
}
