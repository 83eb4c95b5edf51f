//! The DDS process: joins the network as one node, writes what it is given, hands over what it hears.
//!
//! It keeps no state that matters. Whatever is wrong with DDS in it, it ends, and the node starts another one.

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

/// Name of the subcommand that the node starts itself with.
pub const SUBCOMMAND: &str = "dds-side";

/// Samples kept for a moment in which the process is busy.
const DEPTH: i32 = 64;
/// How often refused samples are tried again.
const TICK: Duration = Duration::from_millis(10);
/// How often the node is told that DDS is alive.
const BEAT: Duration = Duration::from_millis(200);
/// How often it is looked who else is out there.
const LOOK: Duration = Duration::from_millis(500);
/// Broken announcements together from which on discovery may be jammed; a few can be on one network that mixes versions.
const MOST_BROKEN: u32 = 10;
/// How long they must have ended: while they come a fresh start jams too.
const CALM: Duration = Duration::from_millis(500);
/// How long an end waits for the replies that the node has given to reach their clients.
pub const LAST_REPLIES: Duration = Duration::from_secs(2);
/// Replies that may wait for their client to be known.
const REPLIES: usize = 256;

/// Why the process ends.
#[derive(Debug, thiserror::Error)]
enum SideError {
    #[error("the node's socket: {0}")]
    Socket(#[from] io::Error),
    #[error("the first frame says nothing to set up")]
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
    Sick(String),
}

/// Runs until the node says so or goes, or DDS is not well. Its standard input is a socket to the node.
pub fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let told = format!("error: {error}; this subcommand is for flexdrill's own use\n");
            // Where nobody reads it, nobody is told.
            let _ = io::stderr().write_all(told.as_bytes());
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
    // The node tells why; two tellings of it would confuse.
    if let Err(error) = serve(&plan, from, &outlet) {
        outlet.send(FromSide::Failed(error.to_string()));
    }
    outlet.finish();
    Ok(())
}

fn serve(plan: &Plan, from: BufReader<UnixStream>, outlet: &Outlet) -> Result<(), SideError> {
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
    let book = PeerBook::new(&mut graph, &participant, plan).map_err(|why| SideError::Topic {
        topic: graph::DISCOVERY_TOPIC.to_owned(),
        why,
    })?;
    graph.announce();
    let book = Arc::new(Mutex::new(book));
    let pulse = Pulse::new(&participant).map_err(|why| SideError::Sick(format!("the pulse: {why}")))?;
    let own = participant_prefix(&participant);
    let static_peers = StaticPeers::start(&plan.network, own, outlet)
        .map_err(|why| SideError::Sick(format!("the peers are not called: {why}")))?;
    let has_peers = static_peers.is_some();
    outlet.send(FromSide::Up(own));

    let writers = Arc::new(Mutex::new(writers));
    let (answers, answered) = mpsc::channel(REPLIES);
    let end = Arc::new(Notify::new());
    let inlet = Inlet {
        writers: Arc::clone(&writers),
        answers,
        end: Arc::clone(&end),
    };
    std::thread::Builder::new()
        .name("from the node".into())
        .spawn(move || inlet.run(from))?;
    let minder = Minder {
        writers,
        graph,
        participant: participant.clone(),
        book: Arc::clone(&book),
        pulse,
        static_peers,
        outlet: outlet.clone(),
    };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build()?;
    let result = runtime.block_on(async {
        let mut listening: FuturesUnordered<_> = subscriptions
            .iter()
            .enumerate()
            .map(|(index, subscription)| hear(index as u16, subscription, outlet))
            .collect();
        let serving = replies::serve(&servers, answered, &book, outlet);
        let last_replies = async {
            end.notified().await;
            tokio::time::sleep(LAST_REPLIES).await;
        };
        tokio::select! {
            // All replies are with their clients, or it has taken too long.
            served = serving => served,
            () = last_replies => Ok(()),
            sick = minder.mind() => Err(sick),
            Some(()) = listening.next() => Err(SideError::Sick("a subscription ended".into())),
        }
    });
    if let Err(error) = &result {
        outlet.send(FromSide::Failed(error.to_string()));
        outlet.finish();
        // DDS that is sick cannot leave the network in order, and would hang or complain of each endpoint.
        std::process::exit(1);
    }
    // The subscriptions and servers go before the participant that they belong to.
    drop((subscriptions, servers));
    drop(participant);
    if has_peers {
        static_peers::let_them_hear();
    }
    result
}

fn participant_prefix(participant: &DomainParticipant) -> super::plan::GuidPrefix {
    use rustdds::RTPSEntity as _;
    let mut prefix = [0; 12];
    prefix.copy_from_slice(&participant.guid().to_bytes()[..12]);
    prefix
}

/// Reads best effort, so that any writer matches, unless the plan says otherwise; a latched topic reliably and from its newest
/// sample on.
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

/// Hands over all that a subscription hears.
async fn hear(reader: u16, subscription: &Reader<RawCdr>, outlet: &Outlet) {
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

/// What the node says.
struct Inlet {
    writers: Arc<Mutex<Vec<TopicWriter>>>,
    answers: mpsc::Sender<Answer>,
    end: Arc<Notify>,
}

impl Inlet {
    fn run(self, mut from: BufReader<UnixStream>) {
        // The end of the node and nonsense from it are the end here too.
        while let Ok(Some(frame)) = frames::read(&mut from) {
            match frame {
                ToSide::Publish { writer, body } => {
                    if let Some(writer) = locked(&self.writers).get_mut(usize::from(writer)) {
                        writer.publish(body);
                    }
                }
                ToSide::Reply { service, ticket, body } => {
                    // More than that at once: the client asks again.
                    let _ = self.answers.try_send(Answer { service, ticket, body });
                }
                ToSide::Begin(_) | ToSide::End => break,
            }
        }
        self.end.notify_one();
        // The end of the answers: dropped with `self`.
    }
}

/// What is done at regular times.
struct Minder {
    writers: Arc<Mutex<Vec<TopicWriter>>>,
    graph: NodeGraph,
    participant: DomainParticipant,
    book: Arc<Mutex<PeerBook>>,
    pulse: Pulse,
    static_peers: Option<StaticPeers>,
    outlet: Outlet,
}

impl Minder {
    /// Runs until DDS is sick; why.
    async fn mind(mut self) -> SideError {
        let mut tick = tokio::time::interval(TICK);
        tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
        let (mut next_beat, mut next_look) = (Instant::now(), Instant::now());
        let events = self.participant.status_listener();
        loop {
            tick.tick().await;
            let now = Instant::now();
            self.tend_writers(now);
            while let Some(event) = events.try_recv_status() {
                if let Some(text) = peers::incompatible(&event, &self.participant) {
                    self.outlet.log(LogLevel::Warning, text);
                }
            }
            if now >= next_beat {
                next_beat = now + BEAT;
                if let Err(why) = self.beat(now) {
                    return SideError::Sick(why);
                }
            }
            if now >= next_look {
                next_look = now + LOOK;
                if let Some(peers) = &self.static_peers {
                    peers.look(&self.participant);
                }
                let peers = locked(&self.book).look(&self.participant);
                if let Some(peers) = peers {
                    self.outlet.send(FromSide::Peers(peers));
                }
            }
        }
    }

    fn tend_writers(&mut self, now: Instant) {
        let (mut writers, mut book) = (locked(&self.writers), locked(&self.book));
        for writer in writers.iter_mut() {
            let stalled = writer.tend(now, &mut self.graph, &self.participant, &mut book);
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
                "{broken} broken announcements came together: the library's discovery jams on them and would hear of \
                 nobody new"
            ));
        }
        let renewals: u32 = self.with_writers(|writer| writer.renewals()).iter().sum();
        if renewals > topic_writer::MOST_RENEWALS {
            return Err(format!(
                "its writers were made anew {renewals} times for readers that do not take; it begins afresh"
            ));
        }
        let written = self.with_writers(TopicWriter::written);
        self.outlet.send(FromSide::Beat(Beat { written, memory }));
        Ok(())
    }

    fn with_writers<T>(&self, what: impl Fn(&TopicWriter) -> T) -> Vec<T> {
        locked(&self.writers).iter().map(what).collect()
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
