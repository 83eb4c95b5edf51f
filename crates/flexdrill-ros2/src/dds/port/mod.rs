//! The node's side of DDS: handles that outlive the process behind them.
//!
//! Endpoints are named to a [`PortBuilder`]; [`PortBuilder::start`] brings the process up. From then on a thread keeps it:
//! whatever ends it, it is started again, told the newest state of every latched topic, and what happened is told in
//! [`Health`], in the log and, through them, in diagnostics and alarms.

mod child;
mod clock_step;
mod health;
mod inbox;
mod keeper;
mod outbox;
mod taken;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

pub use self::health::{Health, Restart};
use self::inbox::ReplyTo;
pub use self::inbox::{Inbox, Request, Sample};
use self::keeper::Keeper;
use self::outbox::Outbox;
use self::taken::{Arrival, TakenRequests, Verdict};
use super::frames::{Peer, Peers, ToSide};
use super::plan::{Offer, Plan, ReaderPlan, ServicePlan, WriterPlan, service_topics};
use crate::dds::network::Network;
use flexdrill_realtime::monotonic;
use flexdrill_text::Throttle;

/// Samples that wait for a part of the node that is busy.
const SAMPLES: usize = 256;
/// Requests that wait.
const REQUESTS: usize = 64;
/// Longest wait for the first start.
const START: Duration = Duration::from_secs(10);

/// Why DDS could not be brought up.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct StartError(String);

/// What became of the samples of one topic.
#[derive(Debug, Default)]
pub struct TopicCounters {
    /// Handed to DDS.
    pub sent: AtomicU64,
    /// Refused because a reader stalls, or lost while the DDS process was down.
    pub dropped: AtomicU64,
}

/// What the handles, the keeper and the process's reader share.
struct Shared {
    outbox: Outbox,
    writers: Vec<Arc<TopicCounters>>,
    readers: Vec<Arc<Inbox<Sample>>>,
    services: Vec<Arc<Inbox<Request>>>,
    health: Mutex<Health>,
    peers: Mutex<Peers>,
    stop: AtomicBool,
    /// Names of the services.
    service_names: Vec<String>,
    /// Requests over all lives of the process.
    taken: Mutex<Taken>,
    /// Requests without an answer yet.
    open: Arc<AtomicU64>,
}

/// Requests that were taken, and how often refusals are logged.
struct Taken {
    requests: TakenRequests,
    /// When the node was started (ns of the monotonic clock).
    began: u64,
    refusals: Throttle,
}

/// Least time between two lines on refused requests (s).
const REFUSALS: f64 = 1.0;

impl Shared {
    fn health(&self) -> MutexGuard<'_, Health> {
        self.health.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn peers(&self) -> MutexGuard<'_, Peers> {
        self.peers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a request is to be carried out: it is new, and not meant for a node before this one. Why not is logged.
    fn is_to_be_taken(&self, service: usize, client: &Peer, sequence: i64, sent: Option<i64>) -> bool {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let steady = monotonic::now();
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        let arrival = Arrival {
            client: client.id,
            sequence,
            sent,
            now: now.map_or(0, |since| since.as_nanos() as i64),
            up: steady.saturating_sub(taken.began),
        };
        let why = match taken.requests.judge(&arrival) {
            Verdict::New => return true,
            Verdict::Repeated => {
                tracing::debug!("request {sequence} of {client} arrived again and is not carried out again");
                return false;
            }
            Verdict::Older(by) => format!(
                "it was sent {by:.1} s before this node was started. If it was sent later, the clocks of the two machines \
                 differ: synchronise them"
            ),
            Verdict::WithoutTime => {
                "it does not say when it was sent, so soon after the start it may be meant for a node before this one. Send \
                 it again half a minute after the start"
                    .to_owned()
            }
            Verdict::Forgotten => {
                "it is older than what is remembered of so many clients, so it may have been carried out. Send it again"
                    .to_owned()
            }
        };
        if let Some(more) = taken.refusals.ending(steady as f64 * 1e-9) {
            let service = self.service_names.get(service).map_or("?", String::as_str);
            tracing::warn!("service {service}: a request of {client} is not carried out: {why}{more}");
        }
        false
    }
}

/// Collects the endpoints of a node.
pub struct PortBuilder {
    plan: Plan,
    outbox: Outbox,
    writers: Vec<Arc<TopicCounters>>,
    readers: Vec<Arc<Inbox<Sample>>>,
    services: Vec<Arc<Inbox<Request>>>,
}

impl PortBuilder {
    /// A node without endpoints.
    pub fn new(network: &Network, namespace: &str, node: &str) -> Self {
        Self {
            plan: Plan {
                network: network.clone(),
                namespace: namespace.to_owned(),
                node: node.to_owned(),
                writers: Vec::new(),
                readers: Vec::new(),
                services: Vec::new(),
                former: Vec::new(),
            },
            outbox: Outbox::default(),
            writers: Vec::new(),
            readers: Vec::new(),
            services: Vec::new(),
        }
    }

    /// A topic to publish on: its absolute name, its type as `std_msgs::msg::dds_::Float64_`.
    pub fn publisher(&mut self, topic: &str, dds_type: &str, offer: Offer) -> TopicPublisher {
        let counters = Arc::new(TopicCounters::default());
        let writer = self.plan.writers.len() as u16;
        self.plan.writers.push(WriterPlan {
            topic: topic.to_owned(),
            dds_type: dds_type.to_owned(),
            offer,
        });
        self.outbox.add(offer, Arc::clone(&counters));
        self.writers.push(Arc::clone(&counters));
        TopicPublisher {
            outbox: self.outbox.clone(),
            writer,
            counters,
        }
    }

    /// A topic to listen to. A latched one is asked for what was written before.
    pub fn subscription(&mut self, topic: &str, dds_type: &str, latched: bool) -> Arc<Inbox<Sample>> {
        self.read(ReaderPlan {
            topic: topic.to_owned(),
            dds_type: dds_type.to_owned(),
            latched,
            reliable: latched,
        })
    }

    fn read(&mut self, plan: ReaderPlan) -> Arc<Inbox<Sample>> {
        self.plan.readers.push(plan);
        let inbox = Arc::new(Inbox::new(SAMPLES));
        self.readers.push(Arc::clone(&inbox));
        inbox
    }

    /// A service to serve: its absolute name, its type as `std_srvs/srv/Trigger`.
    pub fn service(&mut self, name: &str, ros_type: &str) -> Requests {
        let service = self.plan.services.len() as u16;
        self.plan.services.push(ServicePlan {
            name: name.to_owned(),
            ros_type: ros_type.to_owned(),
        });
        let inbox = Arc::new(Inbox::new(REQUESTS));
        self.services.push(Arc::clone(&inbox));
        Requests {
            outbox: self.outbox.clone(),
            service,
            inbox,
        }
    }

    /// A service to call: its absolute name, its type as `std_srvs/srv/Trigger`. Requests go out on the publisher, replies to
    /// all clients come to the inbox.
    pub fn client(&mut self, name: &str, ros_type: &str) -> (TopicPublisher, Arc<Inbox<Sample>>) {
        let [requests, replies] = service_topics(name, ros_type);
        let offer = Offer {
            reliable: true,
            latched: false,
            depth: 10,
            rate: 1.0,
            lifespan: None,
        };
        let publisher = self.publisher(&requests.0, &requests.1, offer);
        let inbox = self.read(ReaderPlan {
            topic: replies.0,
            dds_type: replies.1,
            latched: false,
            reliable: true,
        });
        (publisher, inbox)
    }

    /// The services so far, for who asks within this process: absolute name, type, and where requests are put.
    pub fn services(&self) -> impl Iterator<Item = (&str, &str, &Arc<Inbox<Request>>)> {
        let named = self.plan.services.iter().zip(&self.services);
        named.map(|(plan, inbox)| (plan.name.as_str(), plan.ros_type.as_str(), inbox))
    }

    /// Brings DDS up.
    ///
    /// # Errors
    /// When the process cannot be started, or DDS in it.
    pub fn start(self) -> Result<Port, StartError> {
        let service_names = self.plan.services.iter().map(|service| service.name.clone()).collect();
        let shared = Arc::new(Shared {
            service_names,
            taken: Mutex::new(Taken {
                requests: TakenRequests::default(),
                began: monotonic::now(),
                refusals: Throttle::new(REFUSALS),
            }),
            open: Arc::default(),
            outbox: self.outbox,
            writers: self.writers,
            readers: self.readers,
            services: self.services,
            health: Mutex::default(),
            peers: Mutex::default(),
            stop: AtomicBool::new(false),
        });
        let keeper = Keeper::new(self.plan, Arc::clone(&shared));
        let (told, first) = std::sync::mpsc::channel();
        let thread = std::thread::Builder::new()
            .name("dds keeper".into())
            .spawn(move || keeper.run(&told))
            .map_err(|error| StartError(format!("the keeper's thread could not be started: {error}")))?;
        let port = Port {
            shared,
            thread: Some(thread),
        };
        match first.recv_timeout(START) {
            Ok(Ok(())) => Ok(port),
            Ok(Err(why)) => Err(StartError(why)),
            Err(_) => Err(StartError(format!(
                "the DDS process has said nothing for {} s",
                START.as_secs()
            ))),
        }
    }
}

/// DDS while the node is up. Dropped, it leaves the network in order.
pub struct Port {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Port {
    /// How DDS is.
    pub fn monitor(&self) -> Monitor {
        Monitor(Arc::clone(&self.shared))
    }
}

impl Drop for Port {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::Release);
        self.shared.outbox.wake();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Tells how DDS is and who is out there.
#[derive(Clone)]
pub struct Monitor(Arc<Shared>);

impl Monitor {
    /// How DDS is.
    pub fn health(&self) -> Health {
        self.0.health().clone()
    }

    /// Who writes what the subscriptions read, one list per subscription in the order in which they were made.
    pub fn writers(&self) -> Vec<Vec<Peer>> {
        self.0.peers().writers.clone()
    }

    /// Requests of clients that have no answer yet.
    pub fn open_requests(&self) -> u64 {
        self.0.open.load(Ordering::Acquire)
    }

    /// Other nodes of the same name.
    pub fn namesakes(&self) -> Vec<Peer> {
        self.0.peers().namesakes.clone()
    }

    /// How many readers a publisher has.
    pub fn readers(&self, publisher: &TopicPublisher) -> u32 {
        let peers = self.0.peers();
        peers.readers.get(usize::from(publisher.writer)).copied().unwrap_or(0)
    }
}

/// Publishes encoded messages on one topic.
#[derive(Clone)]
pub struct TopicPublisher {
    outbox: Outbox,
    writer: u16,
    counters: Arc<TopicCounters>,
}

impl TopicPublisher {
    /// Publishes a CDR body, without its header. Never waits; what there is no room for is counted as dropped.
    pub fn publish(&self, body: Vec<u8>) {
        self.outbox.publish(self.writer, body);
    }

    /// What became of the samples so far.
    pub fn counters(&self) -> &TopicCounters {
        &self.counters
    }
}

/// The requests of one service.
pub struct Requests {
    outbox: Outbox,
    service: u16,
    inbox: Arc<Inbox<Request>>,
}

impl Requests {
    /// Waits for the next one.
    pub async fn next(&self) -> Request {
        self.inbox.next().await
    }

    /// Answers it with a CDR body. A request that came through a process that has ended meanwhile is not answered.
    pub fn reply(&self, request: Request, body: Vec<u8>) {
        match request.reply_to {
            ReplyTo::Dds { life, ticket } => self.outbox.reply(
                life,
                ToSide::Reply {
                    service: self.service,
                    ticket,
                    body,
                },
            ),
            // Who asked may have gone.
            ReplyTo::Local(answer) => drop(answer.send(body)),
        }
    }
}
