//! Service servers. A request is forwarded to the node with what its client knows it by, and the node's reply carries the
//! same, so that any DDS process of the node can send it.

use std::cell::RefCell;
use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use futures::StreamExt as _;
use futures::stream::FuturesUnordered;
use rustdds::no_key::DeserializedCacheChange;
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{
    DomainParticipant, GUID, QosPolicyBuilder, SampleIdentity, SequenceNumber, Timestamp, WriteOptionsBuilder,
};
use tokio::sync::mpsc;

use super::graph::{NodeGraph, Reader, Writer};
use super::outlet::Outlet;
use super::peers::PeerBook;
use super::raw::RawCdr;
use super::{LAST_REPLIES, SideError};
use crate::dds::frames::{FromSide, LogLevel, RequestId};
use crate::dds::plan::{MOST_REPLY, ServicePlan, service_topics};

/// Requests and replies kept per service, for several clients at once.
const DEPTH: i32 = 64;
/// Most clients of a service that are remembered.
const MOST_CLIENTS: usize = 1024;
/// Longest wait for a new client's reply reader to be discovered. To a process that has just joined the network all clients
/// are new, and a busy client answers its announcement after a while. Replies to other clients do not wait for it.
const CLIENT_WAIT: Duration = Duration::from_secs(3);
/// Time from the discovery of a reader until our writer is matched with it, on another thread that does not report it. Each
/// client waits once.
const MATCH_WAIT: Duration = Duration::from_millis(100);
/// Time after which a client has a reply: a lost datagram is sent again within some 100 ms.
const DELIVERY: Duration = Duration::from_secs(1);

/// A reply of the node.
pub(super) struct Answer {
    pub(super) service: u16,
    pub(super) to: RequestId,
    pub(super) body: Vec<u8>,
}

/// A service's server.
pub(super) struct ServiceServer {
    requests: Reader<RawCdr>,
    replies: Writer<RawCdr>,
    name: String,
    participant: DomainParticipant,
}

impl ServiceServer {
    pub(super) fn new(
        graph: &mut NodeGraph,
        participant: &DomainParticipant,
        plan: &ServicePlan,
    ) -> Result<Self, String> {
        let qualities = QosPolicyBuilder::new()
            .reliability(Reliability::Reliable {
                max_blocking_time: rustdds::Duration::ZERO,
            })
            .durability(Durability::Volatile)
            .history(History::KeepLast { depth: DEPTH })
            .build();
        let [(requests, request_type), (replies, reply_type)] = service_topics(&plan.name, &plan.ros_type);
        Ok(Self {
            requests: graph.reader(&requests, &request_type, &qualities)?,
            replies: graph.writer(&replies, &reply_type, &qualities)?,
            name: plan.name.clone(),
            participant: participant.clone(),
        })
    }

    /// Forwards requests and sends replies. Returns true when the queue of answers is closed and the last replies have
    /// reached their clients, and false when the subscription has ended.
    async fn serve(
        &self,
        service: u16,
        mut answers: mpsc::Receiver<Answer>,
        book: &Mutex<PeerBook>,
        outlet: &Outlet,
    ) -> bool {
        let mut requests = Box::pin(self.requests.as_async_stream());
        // Clients whose reply found them are known, so that later replies need not wait for discovery.
        let known = RefCell::new(HashSet::new());
        let mut answering = FuturesUnordered::new();
        let mut delivering = FuturesUnordered::new();
        let mut replied: Option<tokio::time::Instant> = None;
        loop {
            tokio::select! {
                received = requests.next() => match received {
                    None => return false,
                    Some(Err(error)) => outlet.log(
                        LogLevel::Warning,
                        format!("service {}: a request could not be received: {error}", self.name),
                    ),
                    Some(Ok(request)) => {
                        let id = request_id(&request);
                        let client = request.writer_guid();
                        outlet.send(FromSide::Request {
                            service,
                            // The client is looked up when its request arrives, since it may leave before the reply.
                            id,
                            client: book.lock().unwrap_or_else(PoisonError::into_inner).writer(client, &self.participant),
                            sequence: i64::from(request.sequence_number),
                            sent: request.source_timestamp().and_then(nanoseconds),
                            body: request.into_value().0,
                        });
                    }
                },
                answer = answers.recv() => {
                    // A closed channel means that the node ends: no more answers
                    // come, and those begun are completed below.
                    let Some(answer) = answer else { break };
                    answering.push(self.answer(answer, &known, outlet));
                }
                // A reply was handed to DDS. It counts as delivered only after some time, in which it may be repeated.
                Some(to) = answering.next() => {
                    replied = Some(tokio::time::Instant::now());
                    delivering.push(async move {
                        tokio::time::sleep(DELIVERY).await;
                        to
                    });
                }
                Some(to) = delivering.next() => outlet.send(FromSide::Replied { service, to }),
            }
        }
        // Answers that wait for their client's discovery are completed before the end.
        while answering.next().await.is_some() {
            replied = Some(tokio::time::Instant::now());
        }
        if let Some(replied) = replied {
            // Older replies have arrived, or their clients have left.
            let _ =
                tokio::time::timeout_at(replied + LAST_REPLIES, self.replies.async_wait_for_acknowledgments()).await;
        }
        true
    }

    /// Sends an answer once its client can receive it; the request that it answers.
    async fn answer(&self, answer: Answer, known: &RefCell<HashSet<GUID>>, outlet: &Outlet) -> RequestId {
        let client = GUID::from_bytes(answer.to.writer);
        if !known.borrow().contains(&client) {
            self.wait_for_client(client).await;
            let mut known = known.borrow_mut();
            if known.len() >= MOST_CLIENTS {
                known.clear();
            }
            known.insert(client);
        }
        let identity = SampleIdentity {
            writer_guid: client,
            sequence_number: SequenceNumber::from(answer.to.number),
        };
        self.reply(identity, answer.body, outlet);
        answer.to
    }

    fn reply(&self, identity: SampleIdentity, body: Vec<u8>, outlet: &Outlet) {
        let length = body.len();
        if length > MOST_REPLY {
            return outlet.log(
                LogLevel::Error,
                format!(
                    "service {}: a reply of {length} bytes was not sent, because it is longer than {MOST_REPLY}; request less at once",
                    self.name
                ),
            );
        }
        let options = WriteOptionsBuilder::new()
            .source_timestamp(Timestamp::now())
            .related_sample_identity(identity)
            .build();
        if let Err(error) = self.replies.write_with_options(RawCdr(body), options) {
            outlet.log(
                LogLevel::Warning,
                format!("service {}: the reply was not sent: {error}", self.name),
            );
        }
    }

    /// A client's request can arrive before DDS has matched its reply reader; a reply sent then would be lost.
    async fn wait_for_client(&self, client: GUID) {
        let client = client.prefix;
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

/// What the client finds in the reply: the identity that the request states, or else that of the request's own sample.
fn request_id(request: &DeserializedCacheChange<RawCdr>) -> RequestId {
    let (writer, number) = match request.related_sample_identity() {
        // Fast DDS leaves the number unknown; it is the request's number.
        Some(given) if given.sequence_number == SequenceNumber::UNKNOWN => (given.writer_guid, request.sequence_number),
        Some(given) => (given.writer_guid, given.sequence_number),
        None => (request.writer_guid(), request.sequence_number),
    };
    RequestId {
        writer: writer.to_bytes(),
        number: i64::from(number),
    }
}

/// An instant in ns since 1970; none for the special values that are no instant.
fn nanoseconds(stamp: Timestamp) -> Option<i64> {
    if stamp == Timestamp::INVALID || stamp == Timestamp::INFINITE {
        return None;
    }
    let ticks = stamp.to_ticks();
    // Whole seconds, and 2^32nd parts of one.
    let (seconds, parts) = (ticks >> 32, ticks & 0xffff_ffff);
    Some((seconds * 1_000_000_000 + ((parts * 1_000_000_000) >> 32)) as i64)
}

/// Runs all servers, each of which waits for its own clients only. Ends after the last reply was sent.
///
/// # Errors
/// When a service has ended before.
pub(super) async fn serve(
    servers: &[ServiceServer],
    mut answers: mpsc::Receiver<Answer>,
    book: &Mutex<PeerBook>,
    outlet: &Outlet,
) -> Result<(), SideError> {
    let (senders, receivers): (Vec<_>, Vec<_>) = servers.iter().map(|_| mpsc::channel(super::REPLIES)).unzip();
    let mut serving: FuturesUnordered<_> = servers
        .iter()
        .zip(receivers)
        .enumerate()
        .map(|(index, (server, answers))| server.serve(index as u16, answers, book, outlet))
        .collect();
    let ended = || SideError::Unhealthy("a service ended".into());
    loop {
        tokio::select! {
            // The pattern does not match where there are no services.
            Some(_) = serving.next() => return Err(ended()),
            answer = answers.recv() => match answer {
                Some(answer) => {
                    if let Some(sender) = senders.get(usize::from(answer.service)) {
                        let _ = sender.try_send(answer);
                    }
                }
                None => break,
            },
        }
    }
    // The servers end when the queues are closed and the waiting replies are sent.
    drop(senders);
    while let Some(is_done) = serving.next().await {
        if !is_done {
            return Err(ended());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_nanoseconds_since_1970() {
        let half = Timestamp::from_ticks((1_700_000_000 << 32) | (1 << 31));
        assert_eq!(nanoseconds(half), Some(1_700_000_000_500_000_000));
        assert_eq!(nanoseconds(Timestamp::INVALID), None);
        assert_eq!(nanoseconds(Timestamp::INFINITE), None);
    }
}
