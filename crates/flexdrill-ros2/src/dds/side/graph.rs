//! The node in ROS 2's graph: its endpoints, and their announcement.
//!
//! The endpoints are RustDDS's own. A node of ros2-client would add a second, latched writer of `/parameter_events`, which
//! makes `ros2 topic echo` and `ros2 bag record` warn of mixed qualities of service, and would hide the time at which a
//! request was sent.

use ros2_client::Gid;
use rustdds::no_key::{DataWriterCdr, SimpleDataReaderCdr};
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{
    DomainParticipant, GUID, Publisher, QosPolicies, QosPolicyBuilder, RTPSEntity as _, Subscriber, Timestamp, Topic,
    TopicKind,
};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::dds::plan::Plan;
use flexdrill_messages::generated::TYPES;

/// The topic on which ROS 2 nodes announce their endpoints.
pub(super) const DISCOVERY_TOPIC: &str = "ros_discovery_info";
const DISCOVERY_TYPE: &str = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
/// Hash of that type after REP-2016, since Jazzy; Humble sends none.
const DISCOVERY_HASH: &str = "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e";
/// Most announcements of other nodes that wait.
const DISCOVERY_DEPTH: i32 = 64;

/// The writer of a topic.
pub(super) type Writer<M> = DataWriterCdr<M>;
/// The reader of a topic.
pub(super) type Reader<M> = SimpleDataReaderCdr<M>;

/// `rmw_dds_common/msg/ParticipantEntitiesInfo`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Participant {
    pub(super) gid: Gid,
    pub(super) nodes: Vec<Entities>,
}

/// `rmw_dds_common/msg/NodeEntitiesInfo`.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Entities {
    pub(super) namespace: String,
    pub(super) name: String,
    pub(super) readers: Vec<Gid>,
    pub(super) writers: Vec<Gid>,
}

impl Entities {
    pub(super) fn full_name(&self) -> String {
        format!("{}/{}", self.namespace.trim_end_matches('/'), self.name)
    }
}

/// The node's endpoints.
pub(super) struct NodeGraph {
    participant: DomainParticipant,
    publisher: Publisher,
    subscriber: Subscriber,
    announcer: Writer<Participant>,
    node: Entities,
}

impl NodeGraph {
    /// A node without endpoints of its own, not announced yet.
    ///
    /// # Errors
    /// The error of RustDDS.
    pub(super) fn new(participant: &DomainParticipant, plan: &Plan) -> Result<Self, String> {
        // Each topic has its own qualities of service.
        let none = QosPolicyBuilder::new().build();
        let publisher = participant.create_publisher(&none).map_err(text)?;
        let subscriber = participant.create_subscriber(&none).map_err(text)?;
        let qualities = discovery_qualities(1);
        let topic = participant
            .create_topic(
                DISCOVERY_TOPIC.to_owned(),
                DISCOVERY_TYPE.to_owned(),
                &announced(&qualities, DISCOVERY_TYPE),
                TopicKind::NoKey,
            )
            .map_err(text)?;
        let announcer: Writer<Participant> = publisher.create_datawriter_no_key(&topic, None).map_err(text)?;
        let node = Entities {
            namespace: plan.namespace.clone(),
            name: plan.node.clone(),
            readers: Vec::new(),
            writers: vec![announcer.guid().into()],
        };
        Ok(Self {
            participant: participant.clone(),
            publisher,
            subscriber,
            announcer,
            node,
        })
    }

    fn topic(&self, name: &str, dds_type: &str, qualities: &QosPolicies) -> Result<Topic, String> {
        let qualities = announced(qualities, dds_type);
        let topic = self
            .participant
            .create_topic(name.to_owned(), dds_type.to_owned(), &qualities, TopicKind::NoKey);
        topic.map_err(text)
    }

    /// Creates the writer of a topic, by the DDS names of topic and type.
    ///
    /// # Errors
    /// The error of RustDDS.
    pub(super) fn writer<M: Serialize>(
        &mut self,
        topic: &str,
        dds_type: &str,
        qualities: &QosPolicies,
    ) -> Result<Writer<M>, String> {
        let topic = self.topic(topic, dds_type, qualities)?;
        let writer: Writer<M> = self.publisher.create_datawriter_no_key(&topic, None).map_err(text)?;
        self.node.writers.push(writer.guid().into());
        Ok(writer)
    }

    /// Creates the reader of a topic, by the DDS names of topic and type.
    ///
    /// # Errors
    /// The error of RustDDS.
    pub(super) fn reader<M: DeserializeOwned + 'static>(
        &mut self,
        topic: &str,
        dds_type: &str,
        qualities: &QosPolicies,
    ) -> Result<Reader<M>, String> {
        let topic = self.topic(topic, dds_type, qualities)?;
        let reader: Reader<M> = self
            .subscriber
            .create_simple_datareader_no_key(&topic, None)
            .map_err(text)?;
        self.node.readers.push(reader.guid().into());
        Ok(reader)
    }

    /// Creates the reader of the announcements of nodes.
    ///
    /// # Errors
    /// The error of RustDDS.
    pub(super) fn announcements(&mut self) -> Result<Reader<Participant>, String> {
        self.reader(DISCOVERY_TOPIC, DISCOVERY_TYPE, &discovery_qualities(DISCOVERY_DEPTH))
    }

    /// Removes a writer from the announcement.
    pub(super) fn forget_writer(&mut self, writer: GUID) {
        let writer = Gid::from(writer);
        self.node.writers.retain(|known| *known != writer);
    }

    /// Announces the node with all its endpoints.
    pub(super) fn announce(&self) {
        self.send(vec![self.node.clone()]);
    }

    fn send(&self, nodes: Vec<Entities>) {
        let announcement = Participant {
            gid: self.participant.guid().into(),
            nodes,
        };
        if let Err(error) = self.announcer.write(announcement, Some(Timestamp::now())) {
            log::error!("the node could not be announced to ROS 2: {error}");
        }
    }
}

impl Drop for NodeGraph {
    /// Announces that the participant has no node.
    fn drop(&mut self) {
        self.send(Vec::new());
    }
}

/// Qualities of service that announce the hash of the type, as ROS 2's own programs do since Iron. Programs on
/// rmw_cyclonedds log a warning for each endpoint without any user data; those of types that are not ROS 2's have some.
fn announced(qualities: &QosPolicies, dds_type: &str) -> QosPolicies {
    let known = TYPES.iter().find(|info| info.dds_type == dds_type);
    let hash = known.map(|info| info.rihs01);
    let data = match hash.or((dds_type == DISCOVERY_TYPE).then_some(DISCOVERY_HASH)) {
        Some(hash) => format!("typehash={hash};"),
        None => "source=flexdrill;".to_owned(),
    };
    qualities.clone().with_user_data(data.into_bytes())
}

fn discovery_qualities(depth: i32) -> QosPolicies {
    QosPolicyBuilder::new()
        .reliability(Reliability::Reliable {
            max_blocking_time: rustdds::Duration::ZERO,
        })
        .durability(Durability::TransientLocal)
        .history(History::KeepLast { depth })
        .build()
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
