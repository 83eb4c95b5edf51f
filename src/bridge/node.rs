//! The ROS 2 side of a bridge: it publishes what a rig sends, and receives the twin's figures.

use std::sync::Arc;

use flexdrill_messages::diagnostic_msgs::DiagnosticArray;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{Message, to_cdr_body};
use flexdrill_ros2::JoinError;
use flexdrill_ros2::args::{NodeIdentity, Remapping};
use flexdrill_ros2::dds::network::Network;
use flexdrill_ros2::dds::plan::Offer;
use flexdrill_ros2::dds::port::{Inbox, Port, PortBuilder, Sample, TopicPublisher};
use flexdrill_ros2::service::{Dialect, ServiceMapping, ServiceServer};

/// The rate for which the topics' histories are sized (Hz): rigs send once a second, some ten times.
const RATE: f64 = 20.0;

/// What a bridge publishes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outgoing {
    /// `rig/inputs`.
    Inputs,
    /// `rig/measured`.
    Measured,
    /// `rig/survey`.
    Survey,
    /// `/diagnostics`.
    Diagnostics,
}

impl Outgoing {
    /// What a rig sends, and the state of the bridge.
    pub const OF_A_RIG: [Self; 4] = [Self::Inputs, Self::Measured, Self::Survey, Self::Diagnostics];

    const fn topic(self) -> &'static TopicInfo {
        match self {
            Self::Inputs => &topics::RIG_INPUTS,
            Self::Measured => &topics::RIG_MEASURED,
            Self::Survey => &topics::RIG_SURVEY,
            Self::Diagnostics => &topics::DIAGNOSTICS,
        }
    }
}

/// A bridge's node.
pub struct BridgeNode {
    publishers: Vec<(Outgoing, TopicPublisher)>,
    names: Vec<String>,
    received: Vec<(&'static TopicInfo, Arc<Inbox<Sample>>)>,
    /// The service and its absolute name, until it is taken.
    server: Option<(String, ServiceServer)>,
    port: Port,
}

impl BridgeNode {
    /// Joins the network, to publish `sends`, to receive the twin's topics `receives`, and to serve `serves`: the name and type
    /// of a service.
    ///
    /// # Errors
    /// When DDS does not start or a name is not allowed.
    pub fn new(
        network: &Network,
        identity: &NodeIdentity,
        remapping: &Remapping,
        default_name: &str,
        sends: &[Outgoing],
        receives: &[&'static TopicInfo],
        serves: Option<(&str, &str)>,
    ) -> Result<Self, JoinError> {
        let mut port = PortBuilder::new(network, &identity.namespace, &identity.name);
        let (mut publishers, mut names) = (Vec::new(), Vec::new());
        for outgoing in sends {
            let topic = outgoing.topic();
            let name = remapping.topic(identity, default_name, topic.name)?;
            let offer = Offer::usual(RATE);
            publishers.push((*outgoing, port.publisher(&name, topic.kind.dds_type, offer)));
            names.push(name);
        }
        let mut received = Vec::new();
        for topic in receives {
            let name = remapping.topic(identity, default_name, topic.name)?;
            let inbox = port.subscription(&name, topic.kind.dds_type, topic.qos.transient_local);
            received.push((*topic, inbox));
        }
        let mut server = None;
        if let Some((private, ros_type)) = serves {
            let name = remapping.service(identity, default_name, private)?;
            // Clients of both kinds are answered, as the twin does by default.
            let rmw = std::env::var("RMW_IMPLEMENTATION").ok();
            let mapping = ServiceMapping::Auto(Dialect::of_rmw(rmw.as_deref()));
            let served = ServiceServer::new(&mut port, &name, ros_type, mapping);
            server = Some((name, served));
        }
        Ok(Self {
            publishers,
            names,
            received,
            server,
            port: port.start()?,
        })
    }

    /// Publishes a message. Returns false while DDS is down, and for what this node does not send.
    pub fn publish<M: Message>(&self, on: Outgoing, message: &M) -> bool {
        let Some((_, publisher)) = self.publishers.iter().find(|(outgoing, _)| *outgoing == on) else {
            return false;
        };
        let Ok(body) = to_cdr_body(message) else { return false };
        publisher.publish(body);
        self.port.monitor().health().is_up
    }

    /// Publishes diagnostics.
    pub fn diagnose(&self, array: &DiagnosticArray) {
        self.publish(Outgoing::Diagnostics, array);
    }

    /// The service with its absolute name; none after the first call.
    pub fn take_server(&mut self) -> Option<(String, ServiceServer)> {
        self.server.take()
    }

    /// Absolute names of the topics that it publishes, in the order of `sends`.
    pub fn topics(&self) -> &[String] {
        &self.names
    }

    /// Hands on what the twin has sent since the last call, oldest first within a topic. `take` returns whether it could
    /// read the message. Returns how many could not be read.
    pub fn take(&self, mut take: impl FnMut(&'static TopicInfo, &[u8]) -> bool) -> u64 {
        let mut unreadable = 0;
        for (topic, inbox) in &self.received {
            while let Some(sample) = inbox.pop() {
                let taken = match sample {
                    Sample::Body { body, .. } => take(topic, &body),
                    Sample::Unreadable(_) => false,
                };
                unreadable += u64::from(!taken);
            }
        }
        unreadable
    }
}
