//! Passes the messages of DDS to the page, unchanged, and to the board.

use crate::DashboardError;
use std::sync::Arc;

use crate::board::Board;
use crate::now;
use flexdrill_bag::Topic;
use flexdrill_live::Hub;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_ros2::args::NodeIdentity;
use flexdrill_ros2::dds::plan::Guid;
use flexdrill_ros2::dds::port::{Inbox, PortBuilder, Sample};

/// Header of plain little-endian CDR, which bags and live data have and DDS does not pass on.
pub(crate) const CDR_HEADER: [u8; 4] = [0, 1, 0, 0];

/// The subscriptions.
pub(crate) struct Listener {
    topics: Vec<(&'static TopicInfo, Topic, Arc<Inbox<Sample>>)>,
}

impl Listener {
    /// Subscribes at `port` to all topics of the twin and of its rig. Latched topics are read reliably, all others best
    /// effort, because a passive reader must not make the twin keep samples.
    pub fn new(port: &mut PortBuilder, twin: &NodeIdentity) -> Result<Self, DashboardError> {
        let mut subscribed = Vec::new();
        for topic in topics::ALL.iter().filter(|topic| topic.name != topics::CLOCK.name) {
            let name = twin.expand(topic.name)?;
            let inbox = port.subscription(&name, topic.kind.dds_type, topic.qos.transient_local);
            subscribed.push((topic, Topic::new(name, &topic.kind, topic.qos), inbox));
        }
        Ok(Self { topics: subscribed })
    }

    /// The topics, in the order of their indices.
    pub fn topics(&self) -> impl Iterator<Item = &Topic> {
        self.topics.iter().map(|(_, topic, _)| topic)
    }

    /// Passes on all messages, in tasks of the current runtime.
    pub fn listen(self, hub: &Arc<Hub>, board: &Arc<Board>) {
        for (number, (topic, _, inbox)) in self.topics.into_iter().enumerate() {
            tokio::spawn(forward(number, topic, inbox, Arc::clone(hub), Arc::clone(board)));
        }
    }
}

async fn forward(
    number: usize,
    topic: &'static TopicInfo,
    inbox: Arc<Inbox<Sample>>,
    hub: Arc<Hub>,
    board: Arc<Board>,
) {
    let mut newest: Option<(Guid, i64)> = None;
    loop {
        let Sample::Body { writer, body } = inbox.next().await else {
            continue;
        };
        let (time, body) = if topic.name == topics::SESSION.name {
            // Parsing a configuration takes time, so a thread other than the server's does it.
            let board = Arc::clone(&board);
            let read = tokio::task::spawn_blocking(move || (board.observe(topic, &body, now()), body));
            let Ok(observed) = read.await else { continue };
            observed
        } else {
            (board.observe(topic, &body, now()), body)
        };
        // DDS may deliver older states of a latched topic after its newest.
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
