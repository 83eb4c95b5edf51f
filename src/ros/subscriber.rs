//! A client's side: a node that only listens, as a dashboard does.

use std::marker::PhantomData;

use ros2_client::{Context, Node, NodeName, NodeOptions, Subscription};
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{Duration, QosPolicyBuilder, TopicKind};

use super::NodeError;
use super::args::names::NodeIdentity;
use super::network::Network;
use super::publisher::{dds_topic_name, dds_type_name};
use crate::messages::Message;
use crate::messages::topics::TopicInfo;

/// A node without parameters, services or log topic, in the namespace of the twin it listens to.
pub struct Listener {
    context: Context,
    node: Node,
    twin: NodeIdentity,
}

/// One subscribed topic.
pub struct TopicReader<M> {
    subscription: Subscription<M>,
    message: PhantomData<M>,
}

impl Listener {
    /// Joins the network as `name`.
    ///
    /// # Errors
    /// When DDS does not start or a name is not allowed.
    pub fn new(network: &Network, namespace: &str, name: &str) -> Result<Self, NodeError> {
        let twin = NodeIdentity::new(namespace, name)?;
        let failed = |why: String| NodeError::Node {
            node: twin.full_name(),
            why,
        };
        let context = network.start()?;
        let node_name = NodeName::new(&twin.namespace, name).map_err(|error| failed(format!("{error:?}")))?;
        let options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
        let node = context
            .new_node(node_name, options)
            .map_err(|error| failed(format!("{error:?}")))?;
        Ok(Self { context, node, twin })
    }

    /// Absolute name of a topic of the twin.
    ///
    /// # Errors
    /// When the name is not allowed.
    pub fn topic_name(&self, topic: &TopicInfo) -> Result<String, NodeError> {
        Ok(self.twin.expand(topic.name)?)
    }

    /// Subscribes. A latched topic is read reliably and from its newest sample on; all others best effort: who only
    /// looks must not make the twin keep samples.
    ///
    /// # Errors
    /// When DDS refuses the topic or the reader.
    pub fn subscribe<M: Message + 'static>(&mut self, topic: &TopicInfo) -> Result<TopicReader<M>, NodeError> {
        let name = self.topic_name(topic)?;
        let failed = |source| NodeError::Topic {
            topic: name.clone(),
            source,
        };
        let latched = topic.qos.transient_local;
        let policies = QosPolicyBuilder::new()
            .reliability(if latched {
                Reliability::Reliable {
                    max_blocking_time: Duration::ZERO,
                }
            } else {
                Reliability::BestEffort
            })
            .durability(if latched {
                Durability::TransientLocal
            } else {
                Durability::Volatile
            })
            .history(History::KeepLast { depth: 10 })
            .build();
        let handle = self
            .context
            .domain_participant()
            .create_topic(
                dds_topic_name(&name),
                dds_type_name(topic.kind.ros_type),
                &policies,
                TopicKind::NoKey,
            )
            .map_err(|error| failed(error.into()))?;
        let subscription = self.node.create_subscription(&handle, None).map_err(failed)?;
        Ok(TopicReader {
            subscription,
            message: PhantomData,
        })
    }
}

impl<M: Message + 'static> TopicReader<M> {
    /// Hands over every sample that has arrived, oldest first, and says how many could not be read.
    pub fn drain(&self, mut take: impl FnMut(M)) -> u64 {
        let mut unreadable = 0;
        loop {
            match self.subscription.take() {
                Ok(Some((message, _))) => take(message),
                Ok(None) => return unreadable,
                // The reader has moved past the bad sample, so this ends.
                Err(_) if unreadable < 1000 => unreadable += 1,
                Err(_) => return unreadable,
            }
        }
    }
}
