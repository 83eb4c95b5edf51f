//! The publishers of all output topics.

use std::sync::atomic::Ordering;

use super::{DEFAULT_NODE_NAME, NodeError};
use crate::health::status::OutputCount;
use flexdrill_config::Config;
use flexdrill_messages::topics::{self, Cadence, TopicInfo};
use flexdrill_ros2::args::{NodeIdentity, Remapping};
use flexdrill_ros2::dds::plan::Offer;
use flexdrill_ros2::dds::port::{PortBuilder, TopicPublisher};

/// The rate for which the histories of topics without a rate are sized (Hz).
const CHANGES_RATE: f64 = 50.0;
/// Bytes of the CDR header, which DDS writes itself.
const CDR_HEADER: usize = 4;

/// An output topic.
struct Entry {
    topic: &'static TopicInfo,
    name: String,
    publisher: TopicPublisher,
}

/// All output topics of the node.
pub struct Publishers {
    entries: Vec<Entry>,
}

impl Publishers {
    /// Creates every topic that the node publishes.
    ///
    /// # Errors
    /// When a remapped name is not allowed.
    pub fn new(
        port: &mut PortBuilder,
        config: &Config,
        identity: &NodeIdentity,
        remapping: &Remapping,
    ) -> Result<Self, NodeError> {
        let mut entries = Vec::new();
        for topic in topics::ALL.iter().filter(|topic| topic.cadence != Cadence::Received) {
            let name = remapping.topic(identity, DEFAULT_NODE_NAME, topic.name)?;
            let offer = Offer {
                reliable: topic.qos.reliable,
                latched: topic.qos.transient_local,
                depth: topic.qos.depth as i32,
                rate: rate(config, topic).max(CHANGES_RATE),
                lifespan: None,
            };
            let publisher = port.publisher(&name, topic.kind.dds_type, offer);
            entries.push(Entry { topic, name, publisher });
        }
        Ok(Self { entries })
    }

    /// Publishes CDR with its header.
    pub fn publish(&self, topic: &TopicInfo, cdr: &[u8]) {
        let body = cdr.get(CDR_HEADER..).unwrap_or_default();
        if let Some(entry) = self.entry(topic) {
            entry.publisher.publish(body.to_vec());
        }
    }

    /// The absolute name of a topic.
    pub fn name(&self, topic: &TopicInfo) -> &str {
        self.entry(topic).map_or(topic.name, |entry| &entry.name)
    }

    /// The messages of every topic so far.
    pub fn counts(&self) -> impl Iterator<Item = OutputCount<'_>> {
        self.entries.iter().map(|entry| {
            let counters = entry.publisher.counters();
            OutputCount {
                topic: &entry.name,
                sent: counters.sent.load(Ordering::Relaxed),
                dropped: counters.dropped.load(Ordering::Relaxed),
            }
        })
    }

    fn entry(&self, topic: &TopicInfo) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.topic.name == topic.name)
    }
}

fn rate(config: &Config, topic: &TopicInfo) -> f64 {
    let rates = &config.outputs.rates;
    match topic.cadence {
        Cadence::Rate("joint_deflections") => rates.joint_deflections,
        Cadence::Rate("contact_forces") => rates.contact_forces,
        Cadence::Rate("whirl") => rates.whirl,
        Cadence::Rate("bit_state") => rates.bit_state,
        Cadence::Rate("status") => rates.status,
        Cadence::Rate("tool_shape") => rates.tool_shape,
        Cadence::Rate("ageing") => rates.ageing,
        Cadence::Rate("reactions") => rates.reactions,
        Cadence::Rate("transfer") => rates.transfer,
        Cadence::Rate("joint_states") => rates.joint_states,
        Cadence::Rate("diagnostics") => rates.diagnostics,
        Cadence::Rate(_) | Cadence::OnChange | Cadence::Received => 0.0,
    }
}
