//! A rig for demonstrations and tests: a node that publishes the two inputs.

use ros2_client::{Context, Node, NodeName, NodeOptions};

use super::NodeError;
use super::args::{NodeIdentity, Remapping};
use super::network::Network;
use super::publisher::{Offer, TopicPublisher, dds_topic_name};
use crate::messages::std_msgs::Float64;
use crate::messages::to_cdr_body;
use crate::messages::topics;
use flexdrill_core::inputs::InputKind;

/// Name of the node unless it is remapped.
pub const RIG_NODE_NAME: &str = "flexdrill_rig";
/// Rate for which the topics' histories are sized (Hz).
const RATE: f64 = 50.0;

/// The node; its parts are dropped in this order.
pub struct RigNode {
    publishers: Vec<TopicPublisher>,
    names: Vec<String>,
    _node: Node,
    context: Context,
}

impl RigNode {
    /// Joins the network.
    ///
    /// # Errors
    /// When DDS does not start or a name is not allowed.
    pub fn new(network: &Network, identity: &NodeIdentity, remapping: &Remapping) -> Result<Self, NodeError> {
        let failed = |why: String| NodeError::Node {
            node: identity.full_name(),
            why,
        };
        let context = network.start()?;
        let participant = context.domain_participant();
        let name = NodeName::new(&identity.namespace, &identity.name).map_err(|error| failed(error.to_string()))?;
        let options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
        let mut node = context
            .new_node(name, options)
            .map_err(|error| failed(error.to_string()))?;
        let (mut publishers, mut names) = (Vec::new(), Vec::new());
        for topic in [&topics::ROTARY_SPEED_RPM, &topics::WEIGHT_ON_BIT_KN] {
            let name = remapping.topic(identity, RIG_NODE_NAME, topic.name)?;
            let offer = Offer {
                reliable: true,
                latched: false,
                depth: 10,
                rate: RATE,
            };
            publishers.push(TopicPublisher::new(
                &mut node,
                &participant,
                &name,
                topic.kind.ros_type,
                offer,
            )?);
            names.push(name);
        }
        Ok(Self {
            publishers,
            names,
            _node: node,
            context,
        })
    }

    /// Publishes a sample (r/min or kN). False when there was no room for it.
    pub fn publish(&self, kind: InputKind, value: f64) -> bool {
        let body = to_cdr_body(&Float64 { data: value }).unwrap_or_default();
        self.publishers[kind.index()].publish(&body)
    }

    /// Absolute names of the topics, in the order of [`InputKind::ALL`].
    pub fn topics(&self) -> &[String] {
        &self.names
    }

    /// How many subscribers of the rotary speed are known.
    pub fn listeners(&self) -> usize {
        let topic = dds_topic_name(&self.names[0]);
        let readers = self.context.domain_participant().discovered_readers();
        readers
            .iter()
            .filter(|reader| reader.subscription_topic_data.topic_name == topic)
            .count()
    }
}
