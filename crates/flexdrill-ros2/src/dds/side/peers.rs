//! The endpoints of other programs on the topics of the node, from DDS's discovery and the announcements of ROS 2 nodes.

use std::collections::BTreeMap;
use std::net::{IpAddr, SocketAddr};
use std::time::Instant;

use ros2_client::Gid;
use rustdds::discovery::DiscoveredReaderData;
use rustdds::policy::{Durability, Reliability};
use rustdds::{DomainParticipant, DomainParticipantStatusEvent, GUID, RTPSEntity as _};

use super::backlog;
use super::graph::{Entities, NodeGraph, Participant, Reader, Writer};
use super::logs::RepairWatch;
use super::raw::RawCdr;
use crate::dds::frames::{Peer, Peers};
use crate::dds::plan::{Guid, GuidPrefix, Plan, dds_topic_name};
use flexdrill_text::hex;

/// Most participants that are remembered, so that forged ones cannot exhaust memory.
const MOST_PARTICIPANTS: usize = 1024;

/// Most readers of which the time of discovery is kept.
const MOST_READERS: usize = 4096;

/// The known nodes and endpoints of other programs.
pub(super) struct PeerBook {
    announced: Reader<Participant>,
    nodes: BTreeMap<GuidPrefix, Vec<Entities>>,
    own: GuidPrefix,
    former: Vec<GuidPrefix>,
    own_name: String,
    read: Vec<String>,
    written: Vec<String>,
    /// The latest report to the node.
    reported: Option<Peers>,
    /// When each reader of the node's topics was discovered.
    found: BTreeMap<GUID, Instant>,
}

impl PeerBook {
    pub(super) fn new(graph: &mut NodeGraph, participant: &DomainParticipant, plan: &Plan) -> Result<Self, String> {
        let announced = graph.announcements()?;
        Ok(Self {
            announced,
            nodes: BTreeMap::new(),
            own: prefix(&participant.guid()),
            former: plan.former.clone(),
            own_name: format!("{}/{}", plan.namespace.trim_end_matches('/'), plan.node),
            read: plan.readers.iter().map(|plan| dds_topic_name(&plan.topic)).collect(),
            written: plan.writers.iter().map(|plan| dds_topic_name(&plan.topic)).collect(),
            reported: None,
            found: BTreeMap::new(),
        })
    }

    /// The present endpoints; none when they have not changed since the last call.
    pub(super) fn update(&mut self, participant: &DomainParticipant) -> Option<Peers> {
        // Announcements first: they name the nodes of the endpoints below.
        self.read_announcements();
        let reading = participant.discovered_readers();
        self.note_readers(&reading, Instant::now());
        let written = participant.discovered_writers();
        let present: Vec<GuidPrefix> = written
            .iter()
            .map(|writer| prefix(&writer.writer_proxy.remote_writer_guid))
            .collect();
        // Every node has at least the writer of its announcement.
        self.nodes.retain(|from, _| present.contains(from));
        // Own endpoints are left out, as a node is no second driver of its inputs.
        let writers = self.read.iter().map(|topic| {
            written
                .iter()
                .filter(|writer| writer.publication_topic_data.topic_name == *topic)
                .filter(|writer| self.is_other(&writer.writer_proxy.remote_writer_guid))
                .map(|writer| {
                    self.peer(
                        &writer.writer_proxy.remote_writer_guid,
                        &writer.writer_proxy.unicast_locator_list,
                    )
                })
                .collect()
        });
        let readers = self.written.iter().map(|topic| {
            let readers = reading
                .iter()
                .filter(|reader| reader.subscription_topic_data.topic_name == *topic)
                .filter(|reader| self.is_other(&reader.reader_proxy.remote_reader_guid));
            readers.count() as u32
        });
        // A namesake is another node of the same name. Earlier DDS processes of
        // this node had it too, and are known by their prefix.
        let namesakes = self.nodes.iter().filter(|(from, nodes)| {
            **from != self.own
                && !self.former.contains(from)
                && nodes.iter().any(|node| node.full_name() == self.own_name)
        });
        let peers = Peers {
            writers: writers.collect(),
            readers: readers.collect(),
            namesakes: namesakes
                .map(|(from, _)| {
                    // The identifier has the bytes of a GUID, whose endpoint part
                    // is empty here: it stands for a participant.
                    let mut id = [0; 16];
                    id[..12].copy_from_slice(from);
                    Peer {
                        id,
                        node: Some(self.own_name.clone()),
                        address: written
                            .iter()
                            .find(|writer| prefix(&writer.writer_proxy.remote_writer_guid) == *from)
                            .and_then(|writer| address(&writer.writer_proxy.unicast_locator_list)),
                    }
                })
                .collect(),
        };
        // Only a change is reported, because this runs several times a second.
        if self.reported.as_ref() == Some(&peers) {
            return None;
        }
        self.reported = Some(peers.clone());
        Some(peers)
    }

    /// The program of a writer, as far as it is known.
    pub(super) fn writer(&mut self, guid: GUID, participant: &DomainParticipant) -> Peer {
        self.read_announcements();
        let written = participant.discovered_writers();
        let found = written
            .iter()
            .find(|writer| writer.writer_proxy.remote_writer_guid == guid);
        match found {
            Some(writer) => self.peer(&guid, &writer.writer_proxy.unicast_locator_list),
            None => self.peer(&guid, &[] as &[SocketAddr]),
        }
    }

    /// Reads new announcements of nodes.
    fn read_announcements(&mut self) {
        self.announced.drain_read_notifications();
        while let Ok(Some(announced)) = self.announced.try_take_one() {
            let announced = announced.into_value();
            let from = prefix(&GUID::from(announced.gid));
            if self.nodes.len() < MOST_PARTICIPANTS || self.nodes.contains_key(&from) {
                self.nodes.insert(from, announced.nodes);
            }
        }
    }

    /// When the newest reliable reader of a topic was discovered; none where there is none.
    pub(super) fn newest_reader(
        &mut self,
        topic: &str,
        participant: &DomainParticipant,
        now: Instant,
    ) -> Option<Instant> {
        let readers = participant.discovered_readers();
        self.note_readers(&readers, now);
        let topic = dds_topic_name(topic);
        let waited_for = readers.iter().filter(|reader| {
            let data = &reader.subscription_topic_data;
            data.topic_name == topic && data.qos().is_reliable()
        });
        let found = waited_for.filter_map(|reader| self.found.get(&reader.reader_proxy.remote_reader_guid));
        found.max().copied()
    }

    /// Notes new readers, and forgets those that have left.
    fn note_readers(&mut self, readers: &[DiscoveredReaderData], now: Instant) {
        let present = readers
            .iter()
            .filter(|reader| self.written.contains(&reader.subscription_topic_data.topic_name))
            .map(|reader| reader.reader_proxy.remote_reader_guid);
        let known = std::mem::take(&mut self.found);
        let noted = |guid| (guid, known.get(&guid).copied().unwrap_or(now));
        self.found = present.take(MOST_READERS).map(noted).collect();
    }

    /// The stalled readers of a writer: those to which samples were sent again meanwhile, or whose socket on this machine
    /// has unread packets; else all reliable readers. The flag states whether the readers are certain.
    pub(super) fn stalled(
        &self,
        writer: &Writer<RawCdr>,
        topic: &str,
        participant: &DomainParticipant,
        watch: &RepairWatch,
    ) -> (Vec<Peer>, bool) {
        let topic = dds_topic_name(topic);
        let readers: Vec<_> = participant
            .discovered_readers()
            .into_iter()
            .filter(|reader| reader.subscription_topic_data.topic_name == topic)
            .filter(|reader| reader.subscription_topic_data.qos().is_reliable())
            .filter(|reader| prefix(&reader.reader_proxy.remote_reader_guid) != prefix(&writer.guid()))
            .collect();
        let describe = |reader: &DiscoveredReaderData| {
            self.peer(
                &reader.reader_proxy.remote_reader_guid,
                &reader.reader_proxy.unicast_locator_list,
            )
        };
        let lags = |reader: &&DiscoveredReaderData| {
            watch.has_seen(&format!("{:?}", reader.reader_proxy.remote_reader_guid))
                || backlog::piles_up(&sockets(&reader.reader_proxy.unicast_locator_list))
        };
        let lagging: Vec<Peer> = readers.iter().filter(lags).map(describe).collect();
        if !lagging.is_empty() {
            return (lagging, true);
        }
        (readers.iter().map(describe).collect(), readers.len() == 1)
    }

    fn is_other(&self, guid: &GUID) -> bool {
        prefix(guid) != self.own
    }

    fn peer(&self, guid: &GUID, locators: &[impl Clone + Into<SocketAddr>]) -> Peer {
        let id: Guid = guid.to_bytes();
        let node = self.nodes.get(&prefix(guid)).and_then(|nodes| {
            let has = |gids: &[Gid]| gids.iter().any(|gid| gid.to_bytes16() == id);
            nodes
                .iter()
                .find(|node| has(&node.writers) || has(&node.readers))
                .or_else(|| nodes.first().filter(|_| nodes.len() == 1))
        });
        Peer {
            id,
            node: node.map(Entities::full_name),
            address: address(locators),
        }
    }
}

/// The log line for an endpoint that does not match ours because of the qualities of service.
pub(super) fn incompatible(event: &DomainParticipantStatusEvent, participant: &DomainParticipant) -> Option<String> {
    match event {
        DomainParticipantStatusEvent::RemoteReaderQosIncompatible {
            remote_reader,
            requested_qos,
            offered_qos,
            ..
        } => {
            let readers = participant.discovered_readers();
            let reader = readers
                .iter()
                .find(|reader| reader.reader_proxy.remote_reader_guid == *remote_reader)?;
            Some(format!(
                "a reader of {} (id {}) receives nothing: it requests {}, and the twin offers {}",
                ros_name(&reader.subscription_topic_data.topic_name),
                hex(&remote_reader.to_bytes()),
                qualities(requested_qos),
                qualities(offered_qos)
            ))
        }
        DomainParticipantStatusEvent::RemoteWriterQosIncompatible {
            remote_writer,
            requested_qos,
            offered_qos,
            ..
        } => {
            let writers = participant.discovered_writers();
            let writer = writers
                .iter()
                .find(|writer| writer.writer_proxy.remote_writer_guid == *remote_writer)?;
            Some(format!(
                "a writer of {} (id {}) is not received: it offers {}, and the twin requests {}",
                ros_name(&writer.publication_topic_data.topic_name),
                hex(&remote_writer.to_bytes()),
                qualities(offered_qos),
                qualities(requested_qos)
            ))
        }
        _ => None,
    }
}

fn ros_name(dds_name: &str) -> &str {
    dds_name.strip_prefix("rt").unwrap_or(dds_name)
}

fn qualities(qos: &rustdds::QosPolicies) -> String {
    let reliability = match qos.reliability() {
        Some(Reliability::Reliable { .. }) => "reliable",
        _ => "best effort",
    };
    let durability = match qos.durability() {
        None | Some(Durability::Volatile) => "volatile",
        Some(Durability::TransientLocal) => "transient local",
        Some(Durability::Transient) => "transient",
        Some(Durability::Persistent) => "persistent",
    };
    format!("{reliability}, {durability}")
}

fn prefix(guid: &GUID) -> GuidPrefix {
    let mut prefix = [0; 12];
    prefix.copy_from_slice(&guid.to_bytes()[..12]);
    prefix
}

pub(super) fn sockets(locators: &[impl Clone + Into<SocketAddr>]) -> Vec<SocketAddr> {
    let sockets = locators.iter().map(|locator| locator.clone().into());
    // A locator that is no UDP address becomes one with port 0.
    sockets.filter(|socket: &SocketAddr| socket.port() != 0).collect()
}

/// The first address that other machines can reach, else the first.
fn address(locators: &[impl Clone + Into<SocketAddr>]) -> Option<String> {
    let addresses: Vec<IpAddr> = sockets(locators).iter().map(SocketAddr::ip).collect();
    addresses
        .iter()
        .find(|address| !address.is_loopback())
        .or(addresses.first())
        .map(ToString::to_string)
}
