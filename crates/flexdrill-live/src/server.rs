//! A hub and its gateway behind one address.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use axum::Router;
use axum::extract::Request;
use tokio::sync::{Notify, oneshot};

use crate::connections::serve;
use crate::gateway::Gateway;
use crate::hub::Hub;
use crate::steering::Steering;
use crate::{LiveError, Token};
use flexdrill_text::printable;

/// Largest size of the queue to the live thread (bytes), beyond which the oldest messages are dropped: some seconds of
/// all outputs of the default tool.
const MOST_BYTES: usize = 8 << 20;

/// Listens at `address`; an error names `option`, which gave it.
///
/// # Errors
/// When the address is in use or does not belong to this machine.
pub fn listen(option: &'static str, address: SocketAddr) -> Result<std::net::TcpListener, LiveError> {
    let failed = |source| LiveError::Listen {
        option,
        address,
        source,
    };
    let listener = std::net::TcpListener::bind(address).map_err(failed)?;
    listener.set_nonblocking(true).map_err(failed)?;
    if !address.ip().is_loopback() {
        tracing::warn!("{option} {address}: any machine that reaches this address can read the live data");
    }
    Ok(listener)
}

/// A router that passes every request to the gateway.
pub fn only_gateway(gateway: Arc<Gateway>) -> Router {
    Router::new().fallback(move |request: Request| Arc::clone(&gateway).enter(request))
}

/// A queued message for the live thread.
struct Queued {
    topic: usize,
    log_time: u64,
    cdr: Vec<u8>,
}

#[derive(Default)]
struct Queue {
    messages: VecDeque<Queued>,
    bytes: usize,
}

/// State shared by the publisher and the live thread.
struct Shared {
    hub: Arc<Hub>,
    queue: Mutex<Queue>,
    arrived: Notify,
    dropped: AtomicU64,
}

impl Shared {
    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, message: Queued) {
        {
            let mut queue = self.queue();
            queue.bytes += message.cdr.len();
            queue.messages.push_back(message);
            while queue.bytes > MOST_BYTES
                && let Some(oldest) = queue.messages.pop_front()
            {
                queue.bytes -= oldest.cdr.len();
                self.dropped.fetch_add(1, Ordering::Relaxed);
            }
        }
        self.arrived.notify_one();
    }

    async fn forward(&self) {
        loop {
            self.arrived.notified().await;
            let messages = {
                let mut queue = self.queue();
                queue.bytes = 0;
                std::mem::take(&mut queue.messages)
            };
            for message in messages {
                self.hub.publish(message.topic, message.log_time, message.cdr);
            }
        }
    }
}

/// A hub and its gateway on a separate thread. The publisher, which must not wait, feeds it through a queue.
pub struct LiveServer {
    shared: Arc<Shared>,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
    address: SocketAddr,
}

impl LiveServer {
    /// Listens at `address`; an error names `option`, which gave it. Pages of `origins` are admitted too, and with
    /// `steering` a viewer with the token may steer.
    ///
    /// # Errors
    /// When it cannot listen, or the system refuses a thread.
    pub fn start(
        option: &'static str,
        address: SocketAddr,
        hub: Arc<Hub>,
        origins: &[String],
        steering: Option<(Token, Arc<Steering>)>,
    ) -> Result<Self, LiveError> {
        let listener = listen(option, address)?;
        let address = listener.local_addr()?;
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let shared = Arc::new(Shared {
            hub,
            queue: Mutex::default(),
            arrived: Notify::new(),
            dropped: AtomicU64::new(0),
        });
        let (end, ended) = oneshot::channel();
        let router = only_gateway(Gateway::new(&shared.hub, steering, origins));
        let given = Arc::clone(&shared);
        let work = move || {
            runtime.block_on(async {
                let served = tokio::select! {
                    served = serve(listener, router, async { drop(ended.await) }) => served,
                    () = given.forward() => Ok(()),
                };
                if let Err(error) = served {
                    tracing::error!("the live server ended: {}", printable(&error.to_string()));
                }
            });
        };
        let thread = std::thread::Builder::new().name("live".into()).spawn(work)?;
        Ok(Self {
            shared,
            end: Some(end),
            thread: Some(thread),
            address,
        })
    }

    /// The address that it listens at.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Queues a message (CDR with its header) if the hub needs it. Never blocks; dropped messages are counted.
    pub fn publish(&self, topic: usize, log_time: i64, cdr: &[u8]) {
        if self.shared.hub.wants(topic) {
            self.shared.push(Queued {
                topic,
                log_time: u64::try_from(log_time).unwrap_or(0),
                cdr: cdr.to_vec(),
            });
        }
    }

    /// Number of connected viewers.
    pub fn clients(&self) -> u64 {
        self.shared.hub.clients()
    }

    /// Messages dropped because the live thread got no processor time. Losses of slow viewers are not included.
    pub fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }
}

impl Drop for LiveServer {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            // The thread ends at once, because it waits for nothing else.
            let _ = thread.join();
        }
    }
}
