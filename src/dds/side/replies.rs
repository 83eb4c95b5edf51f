//! Services: requests are handed over with a ticket; a reply comes back with it.

use std::collections::{BTreeMap, HashSet};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use futures::StreamExt as _;
use futures::stream::FuturesUnordered;
use ros2_client::qos::{History, WhenFull};
use ros2_client::{Name, Node, QosProfile, RmwRequestId, Server, ServiceMapping as Wire, ServiceTypeName};
use rustdds::{DomainParticipant, GUID};
use tokio::sync::mpsc;

use super::outlet::Outlet;
use super::peers::PeerBook;
use super::raw::RawCdr;
use crate::dds::frames::{FromSide, LogLevel};
use crate::dds::plan::{MOST_REPLY, ServicePlan};

/// Requests and replies kept per service; several clients may ask at once.
const DEPTH: usize = 64;
/// Requests of a service that may be open.
const MOST_OPEN: usize = 256;
/// Clients of a service that are remembered.
const MOST_CLIENTS: usize = 1024;
/// Longest wait for a new client's reply reader to be discovered.
const CLIENT_WAIT: Duration = Duration::from_millis(500);
/// Discovery knows a reader some time before our writer is matched with it, on another thread; nothing tells when. Paid
/// once per client.
const MATCH_WAIT: Duration = Duration::from_millis(100);

/// A reply of the node.
pub(super) struct Answer {
    pub(super) service: u16,
    pub(super) ticket: u64,
    pub(super) body: Vec<u8>,
}

/// A service's server.
pub(super) struct ServiceServer {
    server: Server<RawCdr, RawCdr>,
    name: String,
    participant: DomainParticipant,
}

impl ServiceServer {
    pub(super) fn new(node: &mut Node, participant: &DomainParticipant, plan: &ServicePlan) -> Result<Self, String> {
        let mut parts = plan.ros_type.split('/');
        let package = parts.next().unwrap_or_default();
        let service_type = ServiceTypeName::new(package, parts.next_back().unwrap_or_default());
        let name = Name::parse(&plan.name).map_err(|error| error.to_string())?;
        let qos = QosProfile::publisher_default()
            .reliability_reliable(WhenFull::Fail)
            .history(History::KeepLast { depth: DEPTH });
        // The crate's enhanced mapping is the one that leaves the bytes alone.
        let server = node
            .create_server(Wire::Enhanced, &name, &service_type, qos.clone(), qos)
            .map_err(|error| error.to_string())?;
        Ok(Self {
            server,
            name: plan.name.clone(),
            participant: participant.clone(),
        })
    }

    /// Hands requests over and sends what comes back, for as long as it is polled.
    async fn serve(&self, service: u16, mut answers: mpsc::Receiver<Answer>, book: &Mutex<PeerBook>, outlet: &Outlet) {
        let mut requests = self.server.receive_request_stream();
        let mut open: BTreeMap<u64, RmwRequestId> = BTreeMap::new();
        let mut known = HashSet::new();
        let mut next = 0;
        loop {
            tokio::select! {
                received = requests.next() => match received {
                    None => return,
                    Some(Err(error)) => outlet.log(
                        LogLevel::Warning,
                        format!("service {}: a request could not be received: {error}", self.name),
                    ),
                    Some(Ok((id, RawCdr(body)))) => {
                        if open.len() == MOST_OPEN {
                            open.pop_first();
                        }
                        let client = GUID::from(id.writer_gid);
                        open.insert(next, id);
                        outlet.send(FromSide::Request {
                            service,
                            ticket: next,
                            client: book.lock().unwrap_or_else(PoisonError::into_inner).writer(client, &self.participant),
                            body,
                        });
                        next += 1;
                    }
                },
                Some(answer) = answers.recv() => {
                    let Some(id) = open.remove(&answer.ticket) else { continue };
                    if known.len() >= MOST_CLIENTS {
                        known.clear();
                    }
                    if known.insert(GUID::from(id.writer_gid)) {
                        self.wait_for_client(&id).await;
                    }
                    self.reply(id, answer.body, outlet);
                }
            }
        }
    }

    fn reply(&self, id: RmwRequestId, body: Vec<u8>, outlet: &Outlet) {
        let length = body.len();
        if length > MOST_REPLY {
            return outlet.log(
                LogLevel::Error,
                format!(
                    "service {}: a reply of {length} bytes was not sent, it is longer than {MOST_REPLY}; ask for less at once",
                    self.name
                ),
            );
        }
        if let Err(error) = self.server.send_response(id, RawCdr(body)) {
            outlet.log(
                LogLevel::Warning,
                format!("service {}: the reply was not sent: {error}", self.name),
            );
        }
    }

    /// A client's request can arrive before DDS has matched its reply reader; a reply sent then would be lost.
    async fn wait_for_client(&self, id: &RmwRequestId) {
        let client = GUID::from(id.writer_gid).prefix;
        let topic = format!("rr{}Reply", self.name);
        let known = || {
            self.participant.discovered_readers().iter().any(|reader| {
                reader.subscription_topic_data.topic_name == topic
                    && reader.reader_proxy.remote_reader_guid.prefix == client
            })
        };
        let deadline = tokio::time::Instant::now() + CLIENT_WAIT;
        while !known() && tokio::time::Instant::now() < deadline {
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
        tokio::time::sleep(MATCH_WAIT).await;
    }
}

/// Runs all servers; each waits for its own clients only.
pub(super) async fn serve(
    servers: &[ServiceServer],
    mut answers: mpsc::Receiver<Answer>,
    book: &Mutex<PeerBook>,
    outlet: &Outlet,
) {
    let (senders, receivers): (Vec<_>, Vec<_>) = servers.iter().map(|_| mpsc::channel(DEPTH)).unzip();
    let mut serving: FuturesUnordered<_> = servers
        .iter()
        .zip(receivers)
        .enumerate()
        .map(|(index, (server, answers))| server.serve(index as u16, answers, book, outlet))
        .collect();
    loop {
        tokio::select! {
            // Without services there is nothing to wait for here.
            Some(()) = serving.next() => return,
            answer = answers.recv() => match answer {
                Some(answer) => {
                    if let Some(sender) = senders.get(usize::from(answer.service)) {
                        let _ = sender.try_send(answer);
                    }
                }
                // The node has gone; the process ends for that.
                None => return std::future::pending().await,
            },
        }
    }
}
