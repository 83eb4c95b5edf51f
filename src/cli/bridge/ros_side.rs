//! The ROS 2 side of every bridge: its options, and what a node needs to join the network.

use clap::Args;

use super::super::WrongUse;
use crate::bridge::{BridgeNode, Outgoing};
use crate::dds::network::Network;
use crate::ros::args::{NodeIdentity, RosArgs};
use crate::ros::logging;

/// Where the bridge joins ROS 2.
#[derive(Debug, Args)]
pub(super) struct RosSideArgs {
    /// DDS domain, 0 to 232; overrides ROS_DOMAIN_ID.
    #[arg(long, value_name = "ID")]
    domain: Option<u16>,
    /// Namespace of the bridge and of the twin's topics.
    #[arg(long, value_name = "NS", default_value = "/")]
    namespace: String,
}

/// What a node needs to join the network.
pub(super) struct RosSide {
    args: RosArgs,
    pub(super) network: Network,
    pub(super) identity: NodeIdentity,
    /// Name of the node unless it is remapped.
    name: &'static str,
}

impl RosSideArgs {
    /// Starts the log and reads the network.
    ///
    /// # Errors
    /// When an option or a variable of ROS 2 is wrong.
    pub(super) fn start(&self, ros_args: &[String], name: &'static str) -> anyhow::Result<RosSide> {
        let args = RosArgs::parse(ros_args).map_err(WrongUse::new)?;
        logging::start(&args);
        let (network, notes) = Network::read(self.domain, |name| std::env::var(name).ok()).map_err(WrongUse::new)?;
        let identity = args.remapping.identity(&self.namespace, name).map_err(WrongUse::new)?;
        for note in notes {
            tracing::warn!("{note}");
        }
        Ok(RosSide {
            args,
            network,
            identity,
            name,
        })
    }
}

impl RosSide {
    /// The node, with the topics that it publishes and receives, and the name and type of its service.
    ///
    /// # Errors
    /// When a remapped name is not allowed, or DDS cannot be started.
    pub(super) fn node(
        &self,
        sends: &[Outgoing],
        receives: &[&'static flexdrill_messages::topics::TopicInfo],
        serves: Option<(&str, &str)>,
    ) -> anyhow::Result<BridgeNode> {
        let remapping = &self.args.remapping;
        Ok(BridgeNode::new(
            &self.network,
            &self.identity,
            remapping,
            self.name,
            sends,
            receives,
            serves,
        )?)
    }
}
