//! A hub and its gateway behind one address.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use axum::Router;
use axum::extract::Request;
use tokio::sync::{Notify, oneshot};

use super::connections::serve;
use super::gateway::Gateway;
use super::hub::Hub;
use super::steering::Steering;
use super::{LiveError, Token};
use flexdrill_text::printable;

/// Bytes that wait for the live thread; then the oldest message goes: some seconds of all outputs of the default tool.
const MOST_BYTES: usize = 8 << 20;

/// Listens at `address`, which `option` gave.
///
/// # Errors
/// When the address is in use or not of this machine.
pub(crate) fn listen(option: &'static str, address: SocketAddr) -> Result<std::net::TcpListener, LiveError> {
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

/// All requests to the address go to the gateway.
pub(crate) fn only_gateway(gateway: Arc<Gateway>) -> Router {
    Router::new().fallback(move |request: Request| Arc::clone(&gateway).enter(request))
}

/// A message on its way to the live thread.
struct Waiting {
    topic: usize,
    log_time: u64,
    cdr: Vec<u8>,
}

#[derive(Default)]
struct Queue {
    waiting: VecDeque<Waiting>,
    bytes: usize,
}

/// What the publisher and the live thread share.
struct Shared {
    hub: Arc<Hub>,
    queue: Mutex<Queue>,
    came: Notify,
    dropped: AtomicU64,
}

impl Shared {
    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn push(&self, message: Waiting) {
        {
            let mut queue = self.queue();
            queue.bytes += message.cdr.len();
            queue.waiting.push_back(message);
            while queue.bytes > MOST_BYTES
                && let Some(oldest) = queue.waiting.pop_front()
            {
                queue.bytes -= oldest.cdr.len();
                self.dropped.fetch_add(1, Ordering::Relaxed);
            }
        }
        self.came.notify_one();
    }

    async fn hand_over(&self) {
        loop {
            self.came.notified().await;
            let waiting = {
                let mut queue = self.queue();
                queue.bytes = 0;
                std::mem::take(&mut queue.waiting)
            };
            for message in waiting {
                self.hub.publish(message.topic, message.log_time, message.cdr);
            }
        }
    }
}

/// A hub behind an address, on a thread of its own, fed by a thread that must not wait.
pub struct LiveServer {
    shared: Arc<Shared>,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
    address: SocketAddr,
}

impl LiveServer {
    /// Listens at `address`, which `option` gave; viewers in pages of `origins` are admitted too, and who shows the
    /// token may steer.
    ///
    /// # Errors
    /// When it cannot.
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
            came: Notify::new(),
            dropped: AtomicU64::new(0),
        });
        let (end, ended) = oneshot::channel();
        let router = only_gateway(Gateway::new(&shared.hub, steering, origins));
        let given = Arc::clone(&shared);
        let work = move || {
            runtime.block_on(async {
                let served = tokio::select! {
                    served = serve(listener, router, async { drop(ended.await) }) => served,
                    () = given.hand_over() => Ok(()),
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

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Hands over CDR with its header, if the topic is wanted. Never blocks; dropped messages are counted.
    pub fn publish(&self, topic: usize, log_time: i64, cdr: &[u8]) {
        if self.shared.hub.wants(topic) {
            self.shared.push(Waiting {
                topic,
                log_time: u64::try_from(log_time).unwrap_or(0),
                cdr: cdr.to_vec(),
            });
        }
    }

    /// How many viewers there are.
    pub fn clients(&self) -> u64 {
        self.shared.hub.clients()
    }

    /// Messages that the live thread had no time for. What a slow viewer loses is not among them.
    pub fn dropped(&self) -> u64 {
        self.shared.dropped.load(Ordering::Relaxed)
    }
}

impl Drop for LiveServer {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            // It has nothing to wait for.
            let _ = thread.join();
        }
    }
}
