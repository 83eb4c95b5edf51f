//! A rig for demonstrations and tests: a node that publishes the inputs and what is measured besides.

use super::received::plain_topic;
use flexdrill_core::inputs::InputKind;
use flexdrill_messages::std_msgs::Float64;
use flexdrill_messages::{RigMeasured, RigSurvey, to_cdr_body, topics};
use flexdrill_ros2::JoinError;
use flexdrill_ros2::args::{NodeIdentity, Remapping};
use flexdrill_ros2::dds::network::Network;
use flexdrill_ros2::dds::plan::Offer;
use flexdrill_ros2::dds::port::{Port, PortBuilder, TopicPublisher};

/// Name of the node unless it is remapped.
pub const RIG_NODE_NAME: &str = "flexdrill_rig";
/// The rate for which the topics' histories are sized (Hz).
const RATE: f64 = 50.0;

/// A node that publishes the rig's inputs and what it measures besides.
pub struct RigNode {
    /// By [`InputKind::ALL`], then `rig/measured` and `rig/survey`.
    publishers: Vec<TopicPublisher>,
    names: Vec<String>,
    port: Port,
}

impl RigNode {
    /// Joins the network.
    ///
    /// # Errors
    /// When DDS does not start or a name is not allowed.
    pub fn new(network: &Network, identity: &NodeIdentity, remapping: &Remapping) -> Result<Self, JoinError> {
        let mut port = PortBuilder::new(network, &identity.namespace, &identity.name);
        let (mut publishers, mut names) = (Vec::new(), Vec::new());
        for topic in InputKind::ALL
            .map(plain_topic)
            .into_iter()
            .chain([&topics::RIG_MEASURED, &topics::RIG_SURVEY])
        {
            let name = remapping.topic(identity, RIG_NODE_NAME, topic.name)?;
            let offer = Offer::usual(RATE);
            publishers.push(port.publisher(&name, topic.kind.dds_type, offer));
            names.push(name);
        }
        Ok(Self {
            publishers,
            names,
            port: port.start()?,
        })
    }

    /// Publishes a sample, in the unit of its topic. Returns false while DDS is down.
    pub fn publish(&self, kind: InputKind, value: f64) -> bool {
        let body = to_cdr_body(&Float64 { data: value }).unwrap_or_default();
        self.publishers[kind.index()].publish(body);
        self.port.monitor().health().is_up
    }

    /// Publishes measured values. Returns false while DDS is down.
    pub fn publish_measured(&self, message: &RigMeasured) -> bool {
        self.publishers[InputKind::COUNT].publish(to_cdr_body(message).unwrap_or_default());
        self.port.monitor().health().is_up
    }

    /// Publishes a survey. Returns false while DDS is down.
    pub fn publish_survey(&self, message: &RigSurvey) -> bool {
        self.publishers[InputKind::COUNT + 1].publish(to_cdr_body(message).unwrap_or_default());
        self.port.monitor().health().is_up
    }

    /// Absolute names of the topics, in the order of [`InputKind::ALL`], then those of `rig/measured` and `rig/survey`.
    pub fn topics(&self) -> &[String] {
        &self.names
    }

    /// Number of known subscribers of the rotary speed.
    pub fn subscribers(&self) -> u32 {
        self.port.monitor().readers(&self.publishers[0])
    }
}
