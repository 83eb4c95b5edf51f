//! The writer of a topic, and readers that do not acknowledge samples.
//!
//! RustDDS keeps a reliable writer's samples until the slowest reader has acknowledged them, whatever the history depth
//! is; a full history refuses the newest sample, for all readers. A topic here has a resource limit and never waits. When
//! it refuses samples, the writer is replaced: healthy readers continue with the new one within moments, and a stalled
//! reader loses its pending samples.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use rustdds::dds::WriteError;
use rustdds::policy::{Durability, History, Lifespan, Reliability, ResourceLimits};
use rustdds::{DomainParticipant, QosPolicies, QosPolicyBuilder, RTPSEntity as _, Timestamp};

use super::graph::{NodeGraph, Writer};
use super::logs::RepairWatch;
use super::peers::PeerBook;
use super::raw::RawCdr;
use crate::dds::frames::Stall;
use crate::dds::plan::{Offer, WriterPlan, dds_topic_name};

/// Time for which a writer may refuse samples before it is replaced. The other readers wait as long; a healthy reader that
/// is matched acknowledges within 0.1 s.
const PATIENCE: Duration = Duration::from_millis(400);
/// Time after its discovery in which a reader counts as not matched yet. A reader of this library needs up to four seconds
/// on a busy machine, for each new writer.
const SETTLING: Duration = Duration::from_secs(5);
/// Most states of a latched topic that wait until the previous one is acknowledged.
const WAITING: usize = 16;
/// Most replaced writers before the process is restarted: each one is announced to every participant.
pub(super) const MOST_REPLACEMENTS: u32 = 200;

pub(super) struct TopicWriter {
    plan: WriterPlan,
    writer: Writer<RawCdr>,
    waiting: VecDeque<Vec<u8>>,
    refusing: Option<Refusing>,
    sent: u64,
    dropped: u64,
    replacements: u32,
}

/// A writer that refuses samples, and the readers that are observed meanwhile.
struct Refusing {
    /// When the writer is replaced.
    until: Instant,
    watch: RepairWatch,
}

impl TopicWriter {
    pub(super) fn new(graph: &mut NodeGraph, plan: WriterPlan) -> Result<Self, String> {
        let writer = create(graph, &plan)?;
        Ok(Self {
            plan,
            writer,
            waiting: VecDeque::new(),
            refusing: None,
            sent: 0,
            dropped: 0,
            replacements: 0,
        })
    }

    /// Samples accepted by DDS, and samples refused.
    pub(super) fn written(&self) -> (u64, u64) {
        (self.sent, self.dropped)
    }

    /// How often the writer was replaced.
    pub(super) fn replacements(&self) -> u32 {
        self.replacements
    }

    /// Publishes a sample. The newest states of a latched topic wait for room.
    pub(super) fn publish(&mut self, body: Vec<u8>) {
        if self.plan.offer.latched {
            if self.waiting.len() == WAITING {
                self.waiting.pop_front();
                self.dropped += 1;
            }
            self.waiting.push_back(body);
            self.flush();
        } else {
            self.dropped += u64::from(self.write(body).is_err());
        }
    }

    /// Writes waiting samples, and replaces the writer when readers have not acknowledged samples for too long.
    pub(super) fn maintain(
        &mut self,
        now: Instant,
        graph: &mut NodeGraph,
        participant: &DomainParticipant,
        book: &mut PeerBook,
    ) -> Option<Stall> {
        self.flush();
        let refusing = self.refusing.as_mut().filter(|refusing| now >= refusing.until)?;
        if let Some(found) = book.newest_reader(&self.plan.topic, participant, now)
            && now < found + SETTLING
        {
            refusing.until = found + SETTLING;
            return None;
        }
        let refusing = self.refusing.take()?;
        let (readers, is_certain) = book.stalled(&self.writer, &self.plan.topic, participant, &refusing.watch);
        // Where the new writer cannot be created, the old one remains until the next attempt.
        let renewed = create(graph, &self.plan).ok()?;
        graph.forget_writer(self.writer.guid());
        self.writer = renewed;
        graph.announce();
        self.replacements += 1;
        // Only the newest state counts.
        while self.waiting.len() > 1 {
            self.waiting.pop_front();
            self.dropped += 1;
        }
        self.flush();
        Some(Stall {
            topic: self.plan.topic.clone(),
            readers,
            is_certain,
        })
    }

    fn flush(&mut self) {
        while let Some(body) = self.waiting.pop_front() {
            if let Err(refused) = self.write(body) {
                self.waiting.push_front(refused);
                return;
            }
        }
    }

    /// # Errors
    /// Returns the body when DDS has no room for it.
    fn write(&mut self, body: Vec<u8>) -> Result<(), Vec<u8>> {
        match self.writer.write(RawCdr(body), Some(Timestamp::now())) {
            Ok(()) => {
                self.sent += 1;
                self.refusing = None;
                Ok(())
            }
            Err(WriteError::WouldBlock { data }) => {
                self.refusing.get_or_insert_with(|| Refusing {
                    until: Instant::now() + PATIENCE,
                    watch: RepairWatch::begin(),
                });
                Err(data.0)
            }
            // Another attempt would fail, too.
            Err(_) => {
                self.dropped += 1;
                Ok(())
            }
        }
    }
}

fn create(graph: &mut NodeGraph, plan: &WriterPlan) -> Result<Writer<RawCdr>, String> {
    graph.writer(&dds_topic_name(&plan.topic), &plan.dds_type, &policies(plan.offer))
}

fn policies(offer: Offer) -> QosPolicies {
    let builder = match offer.lifespan {
        Some(seconds) => QosPolicyBuilder::new().lifespan(Lifespan {
            duration: rustdds::Duration::from_frac_seconds(seconds),
        }),
        None => QosPolicyBuilder::new(),
    };
    builder
        .reliability(if offer.reliable {
            Reliability::Reliable {
                max_blocking_time: rustdds::Duration::ZERO,
            }
        } else {
            Reliability::BestEffort
        })
        .durability(if offer.latched {
            Durability::TransientLocal
        } else {
            Durability::Volatile
        })
        .history(History::KeepLast { depth: offer.depth })
        .resource_limits(ResourceLimits {
            max_samples: offer.max_samples(),
            max_instances: 1,
            max_samples_per_instance: offer.max_samples(),
        })
        .build()
}
