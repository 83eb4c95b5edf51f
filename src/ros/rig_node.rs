//! A rig for demonstrations and tests: a node that publishes the two inputs.

use super::NodeError;
use super::args::{NodeIdentity, Remapping};
use crate::dds::network::Network;
use crate::dds::plan::Offer;
use crate::dds::port::{Port, PortBuilder, TopicPublisher};
use crate::messages::std_msgs::Float64;
use crate::messages::to_cdr_body;
use crate::messages::topics;
use flexdrill_core::inputs::InputKind;

/// Name of the node unless it is remapped.
pub const RIG_NODE_NAME: &str = "flexdrill_rig";
/// Rate for which the topics' histories are sized (Hz).
const RATE: f64 = 50.0;

/// The node.
pub struct RigNode {
    publishers: Vec<TopicPublisher>,
    names: Vec<String>,
    port: Port,
}

impl RigNode {
    /// Joins the network.
    ///
    /// # Errors
    /// When DDS does not start or a name is not allowed.
    pub fn new(network: &Network, identity: &NodeIdentity, remapping: &Remapping) -> Result<Self, NodeError> {
        let mut port = PortBuilder::new(network, &identity.namespace, &identity.name);
        let (mut publishers, mut names) = (Vec::new(), Vec::new());
        for topic in [&topics::ROTARY_SPEED_RPM, &topics::WEIGHT_ON_BIT_KN] {
            let name = remapping.topic(identity, RIG_NODE_NAME, topic.name)?;
            let offer = Offer {
                reliable: true,
                latched: false,
                depth: 10,
                rate: RATE,
                lifespan: None,
            };
            publishers.push(port.publisher(&name, topic.kind.dds_type, offer));
            names.push(name);
        }
        Ok(Self {
            publishers,
            names,
            port: port.start()?,
        })
    }

    /// Publishes a sample (r/min or kN). False when DDS is not up to take it.
    pub fn publish(&self, kind: InputKind, value: f64) -> bool {
        let body = to_cdr_body(&Float64 { data: value }).unwrap_or_default();
        self.publishers[kind.index()].publish(body);
        self.port.monitor().health().is_up
    }

    /// Absolute names of the topics, in the order of [`InputKind::ALL`].
    pub fn topics(&self) -> &[String] {
        &self.names
    }

    /// How many subscribers of the rotary speed are known.
    pub fn listeners(&self) -> u32 {
        self.port.monitor().readers(&self.publishers[0])
    }
}
