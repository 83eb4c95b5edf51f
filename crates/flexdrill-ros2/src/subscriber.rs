//! A node that only listens, for dashboards.

use std::marker::PhantomData;
use std::sync::Arc;

use super::JoinError;
use super::args::names::NodeIdentity;
use crate::dds::network::Network;
use crate::dds::port::{Inbox, Monitor, Port, PortBuilder, Sample};
use flexdrill_messages::topics::TopicInfo;
use flexdrill_messages::{Message, from_cdr_body};

/// A node without parameters, services and log topic, in the namespace of the twin to which it listens, before its start.
pub struct ListenerBuilder {
    port: PortBuilder,
    twin: NodeIdentity,
}

/// A listening node. Dropping it leaves the network.
pub struct Listener {
    port: Port,
}

/// One subscribed topic.
pub struct TopicReader<M> {
    inbox: Arc<Inbox<Sample>>,
    message: PhantomData<M>,
}

impl ListenerBuilder {
    /// A node called `name`.
    ///
    /// # Errors
    /// When a name is not allowed.
    pub fn new(network: &Network, namespace: &str, name: &str) -> Result<Self, JoinError> {
        let twin = NodeIdentity::new(namespace, name)?;
        Ok(Self {
            port: PortBuilder::new(network, &twin.namespace, &twin.name),
            twin,
        })
    }

    /// Absolute name of a topic of the twin.
    ///
    /// # Errors
    /// When the name is not allowed.
    pub fn topic_name(&self, topic: &TopicInfo) -> Result<String, JoinError> {
        Ok(self.twin.expand(topic.name)?)
    }

    /// Subscribes. A latched topic is read reliably and from its newest sample on; all others best effort,
    /// so that the twin keeps no samples for a mere listener.
    ///
    /// # Errors
    /// When the name is not allowed.
    pub fn subscribe<M: Message + 'static>(&mut self, topic: &TopicInfo) -> Result<TopicReader<M>, JoinError> {
        let name = self.topic_name(topic)?;
        Ok(TopicReader {
            inbox: self
                .port
                .subscription(&name, topic.kind.dds_type, topic.qos.transient_local),
            message: PhantomData,
        })
    }

    /// Joins the network.
    ///
    /// # Errors
    /// When DDS does not start.
    pub fn start(self) -> Result<Listener, JoinError> {
        Ok(Listener {
            port: self.port.start()?,
        })
    }
}

impl Listener {
    /// The state of DDS.
    pub fn monitor(&self) -> Monitor {
        self.port.monitor()
    }
}

impl<M: Message + 'static> TopicReader<M> {
    /// Passes every received message to `receive`, oldest first. Returns the number of samples that could not be decoded.
    pub fn drain(&self, mut receive: impl FnMut(M)) -> u64 {
        let mut unreadable = 0;
        while let Some(sample) = self.inbox.pop() {
            match sample {
                Sample::Body { body, .. } => match from_cdr_body::<M>(&body) {
                    Ok((message, _)) => receive(message),
                    Err(_) => unreadable += 1,
                },
                Sample::Unreadable(_) => unreadable += 1,
            }
        }
        unreadable
    }
}
