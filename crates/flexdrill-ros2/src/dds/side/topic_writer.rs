//! A topic that is written, and readers that do not take.
//!
//! RustDDS keeps a reliable writer's samples until the slowest reader has acknowledged them, whatever the history depth
//! says; a full history refuses the newest sample, for all readers. A topic here has a resource limit and never waits. When
//! it refuses, the writer is made anew: those who take go on with the new one within moments, and who does not take has
//! lost what it left lying.

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

/// How long a writer may refuse before it is made anew. Others wait as long; a healthy reader that has found it acknowledges
/// within 0.1 s.
const PATIENCE: Duration = Duration::from_millis(400);
/// A reader that was found so short ago is not there yet: it acknowledges once it has found the writer too. Of this library
/// that takes up to four seconds on a busy machine, and begins anew with each writer that it must find.
const SETTLING: Duration = Duration::from_secs(5);
/// States of a latched topic that may wait for the one before to be acknowledged.
const WAITING: usize = 16;
/// Every participant on the network is sent each new writer, so after this many the process begins afresh.
pub(super) const MOST_RENEWALS: u32 = 200;

/// Writes one topic.
pub(super) struct TopicWriter {
    plan: WriterPlan,
    writer: Writer<RawCdr>,
    waiting: VecDeque<Vec<u8>>,
    refusing: Option<Refusing>,
    sent: u64,
    dropped: u64,
    renewals: u32,
}

/// A writer that refuses, and what is learned meanwhile.
struct Refusing {
    /// Then it is made anew.
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
            renewals: 0,
        })
    }

    /// Samples taken by DDS, and samples refused.
    pub(super) fn written(&self) -> (u64, u64) {
        (self.sent, self.dropped)
    }

    /// How often the writer was made anew.
    pub(super) fn renewals(&self) -> u32 {
        self.renewals
    }

    /// Publishes; the newest state of a latched topic waits until there is room.
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

    /// Writes what waits and, when readers have not taken for too long, makes the writer anew.
    pub(super) fn tend(
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
        // A new writer that cannot be made leaves the old one, to be tried again.
        let renewed = create(graph, &self.plan).ok()?;
        graph.forget_writer(self.writer.guid());
        self.writer = renewed;
        graph.announce();
        self.renewals += 1;
        // Of states only the newest counts.
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
    /// Gives the body back when there is no room for it.
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
            // Of no use to try again.
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
