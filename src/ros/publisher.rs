//! Publishers whose history is bounded and that never wait.
//!
//! RustDDS keeps a reliable writer's samples until the slowest reader has acknowledged them, whatever the history depth
//! says, and its asynchronous write waits without a limit when a reader stalls. So a topic here has a resource limit,
//! long enough in time for a dead reader to be dropped by DDS (about 10 s), and a write that finds no room gives up at
//! once and is counted.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use ros2_client::{MessageTypeName, Node, Publisher};
use rustdds::policy::{Durability, History, Reliability, ResourceLimits};
use rustdds::{Duration, QosPolicies, QosPolicyBuilder, TopicKind};

use super::NodeError;
use super::raw::RawCdr;

/// Time that a reader may stall before writes are refused (s): longer than the lease after which DDS drops a dead one.
const STALL_TIME: f64 = 15.0;

/// How a topic is offered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offer {
    /// Resend what was lost.
    pub reliable: bool,
    /// Keep the last sample for those who come later.
    pub latched: bool,
    /// History depth as announced to readers.
    pub depth: i32,
    /// Highest rate of publication (Hz), for the size of the history.
    pub rate: f64,
}

impl Offer {
    /// Most samples kept for readers that have not acknowledged.
    pub fn max_samples(&self) -> i32 {
        if self.latched {
            // Late joiners are given all that is kept, so keep no more than is meant.
            self.depth.max(1)
        } else {
            ((self.rate * STALL_TIME).ceil() as i32).clamp(32, 8192)
        }
    }

    fn policies(&self) -> QosPolicies {
        QosPolicyBuilder::new()
            .reliability(if self.reliable {
                Reliability::Reliable {
                    max_blocking_time: Duration::ZERO,
                }
            } else {
                Reliability::BestEffort
            })
            .durability(if self.latched {
                Durability::TransientLocal
            } else {
                Durability::Volatile
            })
            .history(History::KeepLast { depth: self.depth })
            .resource_limits(ResourceLimits {
                max_samples: self.max_samples(),
                max_instances: 1,
                max_samples_per_instance: self.max_samples(),
            })
            .build()
    }
}

/// What became of the samples of one topic.
#[derive(Debug, Default)]
pub struct TopicCounters {
    /// Handed to DDS.
    pub sent: AtomicU64,
    /// Refused because a reader stalls and the history is full.
    pub dropped: AtomicU64,
}

/// Publishes encoded messages on one topic.
pub struct TopicPublisher {
    publisher: Publisher<RawCdr>,
    counters: Arc<TopicCounters>,
}

impl TopicPublisher {
    /// Creates the topic and its writer. `topic` is absolute, `type_name` as `package/msg/Type`.
    ///
    /// # Errors
    /// When DDS refuses the topic or the writer.
    pub fn new(
        node: &mut Node,
        participant: &rustdds::DomainParticipant,
        topic: &str,
        type_name: &str,
        offer: Offer,
    ) -> Result<Self, NodeError> {
        let failed = |source| NodeError::Topic {
            topic: topic.to_owned(),
            source,
        };
        let handle = participant
            .create_topic(
                dds_topic_name(topic),
                dds_type_name(type_name),
                &offer.policies(),
                TopicKind::NoKey,
            )
            .map_err(|error| failed(error.into()))?;
        let publisher = node.create_publisher(&handle, None).map_err(failed)?;
        Ok(Self {
            publisher,
            counters: Arc::default(),
        })
    }

    /// Publishes a CDR body. False when there was no room; the sample is then counted as dropped.
    pub fn publish(&self, body: &[u8]) -> bool {
        let sent = self.publisher.publish(RawCdr(body.to_vec())).is_ok();
        let counter = if sent {
            &self.counters.sent
        } else {
            &self.counters.dropped
        };
        counter.fetch_add(1, Ordering::Relaxed);
        sent
    }

    /// What became of the samples so far.
    pub fn counters(&self) -> Arc<TopicCounters> {
        Arc::clone(&self.counters)
    }
}

/// The DDS name of an absolute ROS topic: `/a/b` is `rt/a/b`.
pub fn dds_topic_name(topic: &str) -> String {
    format!("rt{topic}")
}

/// The DDS name of a ROS message type: `std_msgs/msg/Float64` is `std_msgs::msg::dds_::Float64_`.
pub fn dds_type_name(type_name: &str) -> String {
    let mut parts = type_name.split('/');
    let package = parts.next().unwrap_or_default();
    let name = parts.next_back().unwrap_or_default();
    MessageTypeName::new(package, name).dds_msg_type()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_on_the_wire() {
        assert_eq!(dds_topic_name("/rig_7/twin/status"), "rt/rig_7/twin/status");
        assert_eq!(
            dds_type_name("flexdrill/msg/TwinStatus"),
            "flexdrill::msg::dds_::TwinStatus_"
        );
    }

    #[test]
    fn history_outlasts_a_stall_and_latched_topics_keep_one() {
        let offer = Offer {
            reliable: true,
            latched: false,
            depth: 10,
            rate: 50.0,
        };
        assert_eq!(offer.max_samples(), 750);
        assert_eq!(
            Offer {
                latched: true,
                depth: 1,
                ..offer
            }
            .max_samples(),
            1
        );
    }
}
