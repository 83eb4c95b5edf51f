//! The DDS process. It joins the network as one node, publishes the messages of the node, and forwards received ones.
//!
//! It has no state that would be missed. On any failure of DDS it ends, and the node starts another one.

mod backlog;
mod graph;
mod limits;
mod logs;
mod outlet;
mod peers;
mod pulse;
mod raw;
mod replies;
mod static_peers;
mod topic_writer;

use std::io::{self, BufReader, Write as _};
use std::os::fd::AsFd as _;
use std::os::unix::net::UnixStream;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use futures::StreamExt as _;
use futures::stream::FuturesUnordered;
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{DomainParticipant, QosPolicyBuilder, StatusEvented as _};
use tokio::sync::{Notify, mpsc};

use self::graph::{NodeGraph, Reader};
use self::outlet::Outlet;
use self::peers::PeerBook;
use self::pulse::Pulse;
use self::raw::RawCdr;
use self::replies::{Answer, ServiceServer};
use self::static_peers::StaticPeers;
use self::topic_writer::TopicWriter;
use super::frames::{self, Beat, FromSide, LogLevel, ToSide};
use super::plan::{Plan, ReaderPlan, dds_topic_name};
use crate::dds::network::NetworkError;

/// Name of the hidden subcommand with which the program starts itself as the DDS process.
pub const SUBCOMMAND: &str = "dds-side";

/// Most samples of a topic that wait while the process is busy.
const DEPTH: i32 = 64;
/// How often refused samples are written again.
const TICK: Duration = Duration::from_millis(10);
/// How often the process reports to the node that DDS works.
const BEAT: Duration = Duration::from_millis(200);
/// How often the endpoints of other programs are read from discovery.
const DISCOVERY_INTERVAL: Duration = Duration::from_millis(500);
/// Number of broken announcements at once that can jam discovery. Fewer occur on a network that mixes versions.
const MOST_BROKEN: u32 = 10;
/// Time without broken announcements before a restart: an earlier one would jam, too.
const CALM: Duration = Duration::from_millis(500);
/// Longest wait at the end until the last replies have reached their clients.
pub const LAST_REPLIES: Duration = Duration::from_secs(2);
/// Most replies that wait to be taken by their services: as many as the node keeps for the next process.
const REPLIES: usize = 1024;

/// Why the process ends.
#[derive(Debug, thiserror::Error)]
enum SideError {
    #[error("the node's socket: {0}")]
    Socket(#[from] io::Error),
    #[error("the first frame has no endpoints to create")]
    NoPlan,
    #[error(transparent)]
    Network(#[from] NetworkError),
    #[error("node {node}: {why}")]
    Node { node: String, why: String },
    #[error("topic {topic}: {why}")]
    Topic { topic: String, why: String },
    #[error("service {service}: {why}")]
    Service { service: String, why: String },
    #[error("{0}")]
    Unhealthy(String),
}

/// Runs until the node ends it or closes the socket, or DDS fails. The standard input is the socket to the node.
pub fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let text = format!("error: {error}; this subcommand is for flexdrill's own use\n");
            // There is no other output for a failure to write this.
            let _ = io::stderr().write_all(text.as_bytes());
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), SideError> {
    let socket = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
    let mut from = BufReader::new(socket.try_clone()?);
    let Some(ToSide::Begin(plan)) = frames::read(&mut from)? else {
        return Err(SideError::NoPlan);
    };
    limits::set();
    let outlet = Outlet::start(socket)?;
    logs::start(&outlet);
    // The node logs the reason; a line of this process would repeat it.
    if let Err(error) = serve(&plan, from, &outlet) {
        outlet.send(FromSide::Failed(error.to_string()));
    }
    outlet.finish();
    Ok(())
}

fn serve(plan: &Plan, from: BufReader<UnixStream>, outlet: &Outlet) -> Result<(), SideError> {
    // Everything is built before `Up` is sent: the node then publishes,
    // and an endpoint that is missing would lose messages.
    let participant = plan.network.start()?;
    let mut graph = NodeGraph::new(&participant, plan).map_err(|why| SideError::Node {
        node: format!("{}/{}", plan.namespace.trim_end_matches('/'), plan.node),
        why,
    })?;
    let mut subscriptions = Vec::new();
    for reader in &plan.readers {
        subscriptions.push(subscribe(&mut graph, reader)?);
    }
    let mut servers = Vec::new();
    for service in &plan.services {
        // Errors name the topic or service: the node only sees this text.
        let failed = |why| SideError::Service {
            service: service.name.clone(),
            why,
        };
        servers.push(ServiceServer::new(&mut graph, &participant, service).map_err(failed)?);
    }
    let mut writers = Vec::new();
    for writer in &plan.writers {
        let failed = |why| SideError::Topic {
            topic: writer.topic.clone(),
            why,
        };
        writers.push(TopicWriter::new(&mut graph, writer.clone()).map_err(failed)?);
    }
    // The book of peers is a subscription too, and needs the graph before it is announced.
    let book = PeerBook::new(&mut graph, &participant, plan).map_err(|why| SideError::Topic {
        topic: graph::DISCOVERY_TOPIC.to_owned(),
        why,
    })?;
    // The graph is announced once, complete. Tools then see the node with all its endpoints.
    graph.announce();
    let book = Arc::new(Mutex::new(book));
    let pulse = Pulse::new(&participant).map_err(|why| SideError::Unhealthy(format!("the pulse: {why}")))?;
    // Static peers forward our announcements, which they recognise by this prefix.
    let own = participant_prefix(&participant);
    let static_peers = StaticPeers::start(&plan.network, own, outlet)
        .map_err(|why| SideError::Unhealthy(format!("the peers are not called: {why}")))?;
    let has_peers = static_peers.is_some();
    outlet.send(FromSide::Up(own));

    // Writers are shared by two threads: one publishes what the node sends, the other replaces writers that are stuck.
    let writers = Arc::new(Mutex::new(writers));
    let (answers, answered) = mpsc::channel(REPLIES);
    let end = Arc::new(Notify::new());
    let inlet = Inlet {
        writers: Arc::clone(&writers),
        answers,
        end: Arc::clone(&end),
    };
    // The socket is read by a separate thread, because its reads block.
    std::thread::Builder::new()
        .name("from the node".into())
        .spawn(move || inlet.run(from))?;
    let maintenance = Maintenance {
        writers,
        graph,
        participant: participant.clone(),
        book: Arc::clone(&book),
        pulse,
        static_peers,
        outlet: outlet.clone(),
    };
    // One thread is enough for forwarding; DDS has its own.
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build()?;
    let result = runtime.block_on(async {
        let mut forwarding: FuturesUnordered<_> = subscriptions
            .iter()
            .enumerate()
            .map(|(index, subscription)| forward(index as u16, subscription, outlet))
            .collect();
        let serving = replies::serve(&servers, answered, &book, outlet);
        // At the end the node closes the socket first. Clients get this
        // much time for the replies that are on their way.
        let last_replies = async {
            end.notified().await;
            tokio::time::sleep(LAST_REPLIES).await;
        };
        tokio::select! {
            // The last replies have reached their clients, or time is up.
            served = serving => served,
            () = last_replies => Ok(()),
            failure = maintenance.run() => Err(failure),
            Some(()) = forwarding.next() => Err(SideError::Unhealthy("a subscription ended".into())),
        }
    });
    if let Err(error) = &result {
        outlet.send(FromSide::Failed(error.to_string()));
        outlet.finish();
        // A failed DDS library cannot leave the network: it would hang, or log an error for each endpoint.
        std::process::exit(1);
    }
    // The endpoints must be dropped before their participant.
    drop((subscriptions, servers, book));
    drop(participant);
    // The forwarder sends the participant's farewell to the peers as well, which takes a moment.
    if has_peers {
        static_peers::wait_for_delivery();
    }
    result
}

fn participant_prefix(participant: &DomainParticipant) -> super::plan::GuidPrefix {
    use rustdds::RTPSEntity as _;
    let mut prefix = [0; 12];
    prefix.copy_from_slice(&participant.guid().to_bytes()[..12]);
    prefix
}

/// Subscribes best effort, so that every writer matches, unless the plan requests reliability; a latched topic reliably and
/// from its newest sample on.
fn subscribe(graph: &mut NodeGraph, plan: &ReaderPlan) -> Result<Reader<RawCdr>, SideError> {
    let policies = QosPolicyBuilder::new()
        .reliability(if plan.latched || plan.reliable {
            Reliability::Reliable {
                max_blocking_time: rustdds::Duration::ZERO,
            }
        } else {
            Reliability::BestEffort
        })
        .durability(if plan.latched {
            Durability::TransientLocal
        } else {
            Durability::Volatile
        })
        .history(History::KeepLast { depth: DEPTH })
        .build();
    graph
        .reader(&dds_topic_name(&plan.topic), &plan.dds_type, &policies)
        .map_err(|why| SideError::Topic {
            topic: plan.topic.clone(),
            why,
        })
}

/// Forwards all samples of a subscription to the node.
async fn forward(reader: u16, subscription: &Reader<RawCdr>, outlet: &Outlet) {
    let mut samples = Box::pin(subscription.as_async_stream());
    while let Some(sample) = samples.next().await {
        outlet.send(match sample {
            Ok(sample) => FromSide::Sample {
                reader,
                writer: sample.writer_guid().to_bytes(),
                body: sample.into_value().0,
            },
            Err(error) => FromSide::Unreadable {
                reader,
                why: error.to_string(),
            },
        });
    }
}

/// Reads the frames of the node.
struct Inlet {
    writers: Arc<Mutex<Vec<TopicWriter>>>,
    answers: mpsc::Sender<Answer>,
    end: Arc<Notify>,
}

impl Inlet {
    fn run(self, mut from: BufReader<UnixStream>) {
        // The process ends with the node, and on a frame that it cannot read.
        while let Ok(Some(frame)) = frames::read(&mut from) {
            match frame {
                ToSide::Publish { writer, body } => {
                    if let Some(writer) = locked(&self.writers).get_mut(usize::from(writer)) {
                        writer.publish(body);
                    }
                }
                ToSide::Reply { service, to, body } => {
                    // The node keeps a reply that finds the queue full, but sends it to the next process only.
                    let _ = self.answers.try_send(Answer { service, to, body });
                }
                ToSide::Begin(_) | ToSide::End => break,
            }
        }
        self.end.notify_one();
        // Dropping `self` closes the queue of answers.
    }
}

/// The periodic work of the process.
struct Maintenance {
    writers: Arc<Mutex<Vec<TopicWriter>>>,
    graph: NodeGraph,
    participant: DomainParticipant,
    book: Arc<Mutex<PeerBook>>,
    pulse: Pulse,
    static_peers: Option<StaticPeers>,
    outlet: Outlet,
}

impl Maintenance {
    /// Runs until DDS fails, and returns the failure.
    async fn run(mut self) -> SideError {
        let mut tick = tokio::time::interval(TICK);
        tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
        let (mut next_beat, mut next_discovery) = (Instant::now(), Instant::now());
        let events = self.participant.status_listener();
        loop {
            tick.tick().await;
            let now = Instant::now();
            self.maintain_writers(now);
            while let Some(event) = events.try_recv_status() {
                if let Some(text) = peers::incompatible(&event, &self.participant) {
                    self.outlet.log(LogLevel::Warning, text);
                }
            }
            if now >= next_beat {
                next_beat = now + BEAT;
                if let Err(why) = self.beat(now) {
                    return SideError::Unhealthy(why);
                }
            }
            if now >= next_discovery {
                next_discovery = now + DISCOVERY_INTERVAL;
                if let Some(peers) = &self.static_peers {
                    peers.update(&self.participant);
                }
                let peers = locked(&self.book).update(&self.participant);
                if let Some(peers) = peers {
                    self.outlet.send(FromSide::Peers(peers));
                }
            }
        }
    }

    fn maintain_writers(&mut self, now: Instant) {
        let (mut writers, mut book) = (locked(&self.writers), locked(&self.book));
        for writer in writers.iter_mut() {
            let stalled = writer.maintain(now, &mut self.graph, &self.participant, &mut book);
            if let Some(stall) = stalled {
                self.outlet.send(FromSide::Stalled(stall));
            }
        }
    }

    fn beat(&mut self, now: Instant) -> Result<(), String> {
        self.pulse.check(now)?;
        let memory = limits::resident();
        limits::judge(memory)?;
        if let Some((broken, calm)) = logs::broken_announcements(now)
            && broken >= MOST_BROKEN
            && calm >= CALM
        {
            return Err(format!(
                "{broken} broken announcements came at once: the library's discovery jams on them and would find no new \
                 participant"
            ));
        }
        let replacements: u32 = self.with_writers(|writer| writer.replacements()).iter().sum();
        if replacements > topic_writer::MOST_REPLACEMENTS {
            return Err(format!(
                "its writers were replaced {replacements} times for readers that do not acknowledge samples; it is restarted"
            ));
        }
        let written = self.with_writers(TopicWriter::written);
        self.outlet.send(FromSide::Beat(Beat { written, memory }));
        Ok(())
    }

    fn with_writers<T>(&self, read: impl Fn(&TopicWriter) -> T) -> Vec<T> {
        locked(&self.writers).iter().map(read).collect()
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
