//! The twin's outputs on an MQTT broker: JSON documents with units, and Sparkplug B. Nothing that a broker sends reaches
//! the twin: the one message that is read asks a Sparkplug node to introduce itself again.
//!
//! # Layout
//! - [`broker`]: address, user and encryption, and what to do when a connection fails.
//! - [`link`]: one connection, which comes back after a loss and is fed by a [`Source`].
//! - [`documents`]: the source of JSON documents: the newest of each topic. [`json`]: their contents.
//! - [`sparkplug`]: the source of a Sparkplug node: births, data, deaths.

pub mod broker;
pub mod documents;
pub mod json;
pub mod link;
pub mod sparkplug;

use std::time::Instant;

pub use broker::{Broker, BrokerError, Tls};
pub use documents::Documents;
pub use link::{LinkCounts, LinkEvent, LinkTimes, Shared};
pub use sparkplug::SparkplugNode;

/// Largest payload that is sent (bytes). Brokers refuse or cut off larger ones; the documents are below a tenth of it.
pub const LARGEST_PAYLOAD: usize = 1 << 20;

/// A message for a broker.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Topic.
    pub topic: String,
    /// Payload.
    pub payload: Vec<u8>,
    /// The broker acknowledges it (QoS 1); otherwise it is sent once (QoS 0).
    pub acknowledged: bool,
    /// The broker keeps it for later subscribers.
    pub retained: bool,
}

/// What a connection sends. It is asked whenever the connection can take a message, so that nothing old is queued.
pub trait Source: Send {
    /// Name of the client. A broker ends an older connection of the same name and publishes its will.
    fn client_id(&self) -> String;
    /// What the broker publishes when the next connection is lost. Called before every attempt to connect.
    fn will(&mut self) -> Message;
    /// Topics to subscribe to.
    fn subscriptions(&self) -> Vec<String>;
    /// A connection was made.
    fn connected(&mut self, now: Instant);
    /// It is lost.
    fn disconnected(&mut self);
    /// The next message, if there is one.
    fn next(&mut self, now: Instant) -> Option<Message>;
    /// A message of a subscribed topic arrived. Returns what was done with it, for the log.
    fn received(&mut self, topic: &str, payload: &[u8]) -> String;
    /// The last message of an orderly end.
    fn farewell(&mut self) -> Message;
}

/// Whether a word can be a level of a topic: not empty, no separator, no wildcard, no control character.
pub fn is_level(word: &str) -> bool {
    !word.is_empty() && word.len() <= 128 && !word.chars().any(|c| c.is_control() || "/+#".contains(c))
}
