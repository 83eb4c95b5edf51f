//! The ROS 2 side of a bridge: it publishes what a rig sends, and receives the twin's figures.

use std::sync::Arc;

use flexdrill_bridge::TwinFigures;
use flexdrill_messages::diagnostic_msgs::DiagnosticArray;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{Message, to_cdr_body};
use flexdrill_ros2::JoinError;
use flexdrill_ros2::args::{NodeIdentity, Remapping};
use flexdrill_ros2::dds::network::Network;
use flexdrill_ros2::dds::plan::Offer;
use flexdrill_ros2::dds::port::{Inbox, Port, PortBuilder, Sample, TopicPublisher};

/// The rate for which the topics' histories are sized (Hz): rigs send once a second, some ten times.
const RATE: f64 = 20.0;

/// What a bridge publishes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outgoing {
    /// `rig/inputs`.
    Inputs,
    /// `rig/measured`.
    Measured,
    /// `/diagnostics`.
    Diagnostics,
}

impl Outgoing {
    const ALL: [Self; 3] = [Self::Inputs, Self::Measured, Self::Diagnostics];

    const fn topic(self) -> &'static TopicInfo {
        match self {
            Self::Inputs => &topics::RIG_INPUTS,
            Self::Measured => &topics::RIG_MEASURED,
            Self::Diagnostics => &topics::DIAGNOSTICS,
        }
    }
}

/// A bridge's node.
pub struct BridgeNode {
    publishers: Vec<TopicPublisher>,
    names: Vec<String>,
    figures: Vec<(&'static TopicInfo, Arc<Inbox<Sample>>)>,
    port: Port,
}

impl BridgeNode {
    /// Joins the network. `receives` says whether the twin's figures are wanted.
    ///
    /// # Errors
    /// When DDS does not start or a name is not allowed.
    pub fn new(
        network: &Network,
        identity: &NodeIdentity,
        remapping: &Remapping,
        default_name: &str,
        receives: bool,
    ) -> Result<Self, JoinError> {
        let mut port = PortBuilder::new(network, &identity.namespace, &identity.name);
        let (mut publishers, mut names) = (Vec::new(), Vec::new());
        for topic in Outgoing::ALL.map(Outgoing::topic) {
            let name = remapping.topic(identity, default_name, topic.name)?;
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
        let mut figures = Vec::new();
        for topic in TwinFigures::TOPICS.into_iter().filter(|_| receives) {
            let name = remapping.topic(identity, default_name, topic.name)?;
            figures.push((
                topic,
                port.subscription(&name, topic.kind.dds_type, topic.qos.transient_local),
            ));
        }
        Ok(Self {
            publishers,
            names,
            figures,
            port: port.start()?,
        })
    }

    /// Publishes a message. Returns false while DDS is down.
    pub fn publish<M: Message>(&self, on: Outgoing, message: &M) -> bool {
        let Ok(body) = to_cdr_body(message) else { return false };
        self.publishers[on as usize].publish(body);
        self.port.monitor().health().is_up
    }

    /// Publishes diagnostics.
    pub fn diagnose(&self, array: &DiagnosticArray) {
        self.publish(Outgoing::Diagnostics, array);
    }

    /// Absolute names of the topics of the rig's values.
    pub fn topics(&self) -> &[String] {
        &self.names[..2]
    }

    /// Takes what the twin has sent since the last call. Returns how many messages could not be read.
    pub fn take_figures(&self, twin: &mut TwinFigures) -> u64 {
        let mut unreadable = 0;
        for (topic, inbox) in &self.figures {
            while let Some(sample) = inbox.pop() {
                let taken = match sample {
                    Sample::Body { body, .. } => twin.take(topic.name, &body).is_ok(),
                    Sample::Unreadable(_) => false,
                };
                unreadable += u64::from(!taken);
            }
        }
        unreadable
    }
}
