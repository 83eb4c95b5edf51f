//! The parent's end of DDS: handles that outlive the process behind them.
//!
//! A [`PortBuilder`] collects the endpoints, and [`PortBuilder::start`] starts the process. From then on a thread supervises
//! it: it restarts an ended process, publishes the newest state of every latched topic again, and reports the cause in
//! [`Health`] and in the log, from where it reaches diagnostics and alarms.

mod child;
mod clock_step;
mod health;
mod inbox;
mod keeper;
mod outbox;
mod run_delay;
mod seen_requests;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

pub use self::health::{Health, Restart};
use self::inbox::ReplyTo;
pub use self::inbox::{Inbox, Request, Sample};
use self::keeper::Keeper;
use self::outbox::{Outbox, Reply};
use self::seen_requests::{Arrival, SeenRequests, Verdict};
use super::frames::{Peer, Peers};
use super::plan::{Offer, Plan, ReaderPlan, ServicePlan, WriterPlan, service_topics};
use crate::dds::network::Network;
use flexdrill_clock::monotonic;
use flexdrill_text::Throttle;

/// Most samples that wait in an inbox.
const SAMPLES: usize = 256;
/// Most requests that wait in an inbox.
const REQUESTS: usize = 64;
/// Longest wait for the first start.
const START: Duration = Duration::from_secs(10);

/// Why DDS could not be started.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct StartError(String);

/// Counts the samples of one topic.
#[derive(Debug, Default)]
pub struct TopicCounters {
    /// Passed to DDS.
    pub sent: AtomicU64,
    /// Refused because a reader stalls, or lost while the DDS process was down.
    pub dropped: AtomicU64,
}

/// The state that the handles, the keeper and the reader of the process share.
struct Shared {
    outbox: Outbox,
    writers: Vec<Arc<TopicCounters>>,
    readers: Vec<Arc<Inbox<Sample>>>,
    services: Vec<Arc<Inbox<Request>>>,
    health: Mutex<Health>,
    peers: Mutex<Peers>,
    stop: AtomicBool,
    service_names: Vec<String>,
    /// Requests over all lives of the process.
    request_filter: Mutex<RequestFilter>,
    /// Requests without an answer yet.
    open: Arc<AtomicU64>,
}

/// Accepts each request once, and logs refusals.
struct RequestFilter {
    seen: SeenRequests,
    /// When the node was started (ns of the monotonic clock).
    began: u64,
    refusal_lines: Throttle,
}

/// Least time between two lines about refused requests (s).
const REFUSAL_INTERVAL: f64 = flexdrill_text::LOG_INTERVAL;

impl Shared {
    fn health(&self) -> MutexGuard<'_, Health> {
        self.health.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn peers(&self) -> MutexGuard<'_, Peers> {
        self.peers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a request may be carried out: it is new, and was not sent to an earlier node. Otherwise the reason, which is
    /// logged; `None` for a request that arrives again and has been taken.
    fn judge(&self, service: usize, client: &Peer, sequence: i64, sent: Option<i64>) -> Option<Result<(), String>> {
        let mut filter = self.request_filter.lock().unwrap_or_else(PoisonError::into_inner);
        let steady = monotonic::now();
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        let arrival = Arrival {
            client: client.id,
            sequence,
            sent,
            now: now.map_or(0, |since| since.as_nanos() as i64),
            up: steady.saturating_sub(filter.began),
        };
        let why = match filter.seen.judge(&arrival) {
            Verdict::New => return Some(Ok(())),
            Verdict::Repeated => {
                tracing::debug!("request {sequence} of {client} arrived again and is not carried out again");
                return None;
            }
            Verdict::Older(by) => format!(
                "it was sent {by:.1} s before this node was started. If it was sent later, the clocks of the two machines \
                 differ: synchronise them, or send it again half a minute after the start"
            ),
            Verdict::WithoutTime => {
                "it does not state when it was sent, and so soon after the start it may have been sent to an earlier node. \
                 Send it again half a minute after the start"
                    .to_owned()
            }
            Verdict::Forgotten => {
                "its client was forgotten among too many clients, so that it may have been carried out before. Send it again"
                    .to_owned()
            }
        };
        if let Some(more) = filter.refusal_lines.ending(steady as f64 * 1e-9) {
            let service = self.service_names.get(service).map_or("?", String::as_str);
            tracing::warn!("service {service}: a request of {client} is not carried out: {why}{more}");
        }
        Some(Err(why))
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

    /// Adds a topic to publish on, by its absolute name and its DDS type, such as `std_msgs::msg::dds_::Float64_`.
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

    /// Adds a topic to read. A latched one also delivers the samples written before.
    pub fn subscription(&mut self, topic: &str, dds_type: &str, latched: bool) -> Arc<Inbox<Sample>> {
        self.read(ReaderPlan {
            topic: topic.to_owned(),
            dds_type: dds_type.to_owned(),
            latched,
            reliable: latched,
        })
    }

    /// Adds a topic to read of which no sample may be lost on the way. Publishers that are best effort do not match.
    pub fn reliable_subscription(&mut self, topic: &str, dds_type: &str) -> Arc<Inbox<Sample>> {
        self.read(ReaderPlan {
            topic: topic.to_owned(),
            dds_type: dds_type.to_owned(),
            latched: false,
            reliable: true,
        })
    }

    fn read(&mut self, plan: ReaderPlan) -> Arc<Inbox<Sample>> {
        self.plan.readers.push(plan);
        let inbox = Arc::new(Inbox::new(SAMPLES));
        self.readers.push(Arc::clone(&inbox));
        inbox
    }

    /// Adds a service to serve, by its absolute name and its type, such as `std_srvs/srv/Trigger`.
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

    /// Adds a service to call, by its absolute name and its type, such as `std_srvs/srv/Trigger`. The publisher sends requests;
    /// the inbox receives the replies to all clients.
    pub fn client(&mut self, name: &str, ros_type: &str) -> (TopicPublisher, Arc<Inbox<Sample>>) {
        let [requests, replies] = service_topics(name, ros_type);
        let offer = Offer::usual(1.0);
        let publisher = self.publisher(&requests.0, &requests.1, offer);
        let inbox = self.read(ReaderPlan {
            topic: replies.0,
            dds_type: replies.1,
            latched: false,
            reliable: true,
        });
        (publisher, inbox)
    }

    /// The services so far, for clients within this process: absolute name, type, and inbox.
    pub fn services(&self) -> impl Iterator<Item = (&str, &str, &Arc<Inbox<Request>>)> {
        let named = self.plan.services.iter().zip(&self.services);
        named.map(|(plan, inbox)| (plan.name.as_str(), plan.ros_type.as_str(), inbox))
    }

    /// Starts DDS.
    ///
    /// # Errors
    /// When the process or DDS in it cannot be started.
    pub fn start(self) -> Result<Port, StartError> {
        let service_names = self.plan.services.iter().map(|service| service.name.clone()).collect();
        let shared = Arc::new(Shared {
            service_names,
            request_filter: Mutex::new(RequestFilter {
                seen: SeenRequests::default(),
                began: monotonic::now(),
                refusal_lines: Throttle::new(REFUSAL_INTERVAL),
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
        let (report, first_start) = std::sync::mpsc::channel();
        let thread = std::thread::Builder::new()
            .name("dds keeper".into())
            .spawn(move || keeper.run(&report))
            .map_err(|error| StartError(format!("the keeper's thread could not be started: {error}")))?;
        let port = Port {
            shared,
            thread: Some(thread),
        };
        match first_start.recv_timeout(START) {
            Ok(Ok(())) => Ok(port),
            Ok(Err(why)) => Err(StartError(why)),
            Err(_) => Err(StartError(format!(
                "the DDS process did not answer within {} s",
                START.as_secs()
            ))),
        }
    }
}

/// DDS of a running node. Dropping it leaves the network in order.
pub struct Port {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Port {
    /// The state of DDS.
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

/// Reports the state of DDS and the endpoints of other programs.
#[derive(Clone)]
pub struct Monitor(Arc<Shared>);

impl Monitor {
    /// The state of DDS.
    pub fn health(&self) -> Health {
        self.0.health().clone()
    }

    /// The writers of each subscription, in the order in which the subscriptions were added.
    pub fn writers(&self) -> Vec<Vec<Peer>> {
        self.0.peers().writers.clone()
    }

    /// Number of requests over DDS that have no answer yet.
    pub fn open_requests(&self) -> u64 {
        self.0.open.load(Ordering::Acquire)
    }

    /// Other nodes of the same name.
    pub fn namesakes(&self) -> Vec<Peer> {
        self.0.peers().namesakes.clone()
    }

    /// Number of readers of a publisher.
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
    /// Publishes a CDR body without its header. Never waits; a message that finds the queue full is counted as dropped.
    pub fn publish(&self, body: Vec<u8>) {
        self.outbox.publish(self.writer, body);
    }

    /// The samples so far.
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
    /// Waits for the next request.
    pub async fn next(&self) -> Request {
        self.inbox.next().await
    }

    /// Answers a request with a CDR body, through the present DDS process or the next one.
    pub fn reply(&self, request: Request, body: Vec<u8>) {
        match request.reply_to {
            ReplyTo::Dds(to) => self.outbox.reply(Reply {
                service: self.service,
                to,
                body,
            }),
            // The client may not wait any more.
            ReplyTo::Local(answer) => drop(answer.send(body)),
        }
    }
}
