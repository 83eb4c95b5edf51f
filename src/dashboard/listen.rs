//! What comes over DDS goes to the page as it is, and to the board.

use std::sync::Arc;

use super::board::Board;
use super::now;
use crate::bag::Topic;
use crate::dds::plan::Guid;
use crate::dds::port::{Inbox, PortBuilder, Sample};
use crate::live::Hub;
use crate::messages::topics::{self, TopicInfo};
use crate::ros::args::NodeIdentity;

/// What a CDR body of DDS is preceded by in a bag and live: plain, little endian.
pub(super) const CDR_HEADER: [u8; 4] = [0, 1, 0, 0];

/// The topics that are listened to.
pub(super) struct Ears {
    topics: Vec<(&'static TopicInfo, Topic, Arc<Inbox<Sample>>)>,
}

impl Ears {
    /// At `port`: all topics of a twin of this namespace and what the rig sends it. Latched topics are read reliably,
    /// all others best effort: who only looks must not make the twin keep samples.
    pub fn new(port: &mut PortBuilder, twin: &NodeIdentity) -> anyhow::Result<Self> {
        let mut heard = Vec::new();
        for topic in topics::ALL.iter().filter(|topic| topic.name != topics::CLOCK.name) {
            let name = twin.expand(topic.name)?;
            let inbox = port.subscription(&name, topic.kind.dds_type, topic.qos.transient_local);
            heard.push((topic, Topic::new(name, &topic.kind, topic.qos), inbox));
        }
        Ok(Self { topics: heard })
    }

    /// The topics, in the order of their numbers.
    pub fn topics(&self) -> impl Iterator<Item = &Topic> {
        self.topics.iter().map(|(_, topic, _)| topic)
    }

    /// Hands over all that comes, in tasks of the runtime that this is called in.
    pub fn listen(self, hub: &Arc<Hub>, board: &Arc<Board>) {
        for (number, (topic, _, inbox)) in self.topics.into_iter().enumerate() {
            tokio::spawn(hear(number, topic, inbox, Arc::clone(hub), Arc::clone(board)));
        }
    }
}

async fn hear(number: usize, topic: &'static TopicInfo, inbox: Arc<Inbox<Sample>>, hub: Arc<Hub>, board: Arc<Board>) {
    let mut newest: Option<(Guid, i64)> = None;
    loop {
        let Sample::Body { writer, body } = inbox.next().await else {
            continue;
        };
        let (time, body) = if topic.name == topics::SESSION.name {
            // A configuration takes time to read; the thread that serves pages does not wait for it.
            let board = Arc::clone(&board);
            let read = tokio::task::spawn_blocking(move || (board.observe(topic, &body, now()), body));
            let Ok(observed) = read.await else { continue };
            observed
        } else {
            (board.observe(topic, &body, now()), body)
        };
        // A latched topic may bring older states after its newest.
        if topic.qos.transient_local && newest.is_some_and(|(from, last)| from == writer && time < last) {
            continue;
        }
        newest = Some((writer, time));
        if hub.wants(number) {
            let cdr = [CDR_HEADER.as_slice(), &body].concat();
            hub.publish(number, u64::try_from(time).unwrap_or(0), cdr);
        }
    }
}
