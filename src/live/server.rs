//! Hub and door behind one address.

use std::collections::VecDeque;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use axum::Router;
use axum::extract::Request;
use axum::serve::ListenerExt as _;
use foxglove::websocket::Capability;
use foxglove::{WebSocketServer, WebSocketServerHandle};
use tokio::net::TcpListener;
use tokio::sync::{Notify, oneshot};

use super::LiveError;
use super::Token;
use super::door::{Door, SteeredWay};
use super::hub::Hub;
use super::pump::BACKLOG;
use super::steering::{ENCODING, Steering};
use crate::told::printable;

/// Bytes that wait for the live thread; then the oldest goes: some seconds of all outputs of the default tool.
const MOST_BYTES: usize = 8 << 20;

/// Starts the protocol's server on a port that only this machine reaches, in the runtime that this is called in. `range` is
/// the time of a bag (ns since 1970).
///
/// # Errors
/// When it cannot listen.
pub(crate) async fn start_protocol(
    hub: &Arc<Hub>,
    range: Option<(u64, u64)>,
) -> Result<WebSocketServerHandle, LiveError> {
    let mut server = protocol_of(hub).listener(Arc::clone(hub) as _);
    if let Some((start, end)) = range {
        server = server.capabilities([Capability::Time]).playback_time_range(start, end);
    }
    Ok(server.start().await?)
}

/// The same, for viewers that steer.
///
/// # Errors
/// When it cannot listen.
async fn start_steered(hub: &Arc<Hub>, steering: &Arc<Steering>) -> Result<Arc<WebSocketServerHandle>, LiveError> {
    let server = protocol_of(hub)
        .listener(Arc::clone(steering) as _)
        .capabilities([Capability::ClientPublish])
        .supported_encodings([ENCODING])
        .services(steering.services())
        .parameter_handler(Arc::clone(steering) as _);
    let protocol = Arc::new(server.start().await?);
    steering.set_protocol(&protocol);
    Ok(protocol)
}

fn protocol_of(hub: &Hub) -> WebSocketServer {
    WebSocketServer::new()
        .name(concat!("flexdrill ", env!("CARGO_PKG_VERSION")))
        .bind(Ipv4Addr::LOCALHOST.to_string(), 0)
        .context(hub.context())
        .message_backlog_size(BACKLOG)
}

/// The door to a protocol's server.
pub(crate) fn door_to(server: &WebSocketServerHandle, origins: &[String]) -> Arc<Door> {
    Door::new((Ipv4Addr::LOCALHOST, server.port()).into(), origins)
}

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

/// Answers requests until `end` is done.
///
/// # Errors
/// When the listener cannot be used.
pub(crate) async fn serve(
    listener: std::net::TcpListener,
    router: Router,
    end: impl Future<Output = ()>,
) -> std::io::Result<()> {
    let listener = TcpListener::from_std(listener)?.tap_io(|stream| {
        // Small messages go out as they come; that it cannot be set costs a little time only.
        let _ = stream.set_nodelay(true);
    });
    let serving = axum::serve(listener, router.into_make_service_with_connect_info::<SocketAddr>());
    tokio::select! {
        result = serving.into_future() => result,
        () = end => Ok(()),
    }
}

/// All that comes to the address goes through the door.
pub(crate) fn only_door(door: Arc<Door>) -> Router {
    Router::new().fallback(move |request: Request| Arc::clone(&door).enter(request))
}

/// The protocol's servers, which serve as long as these are kept.
type Protocols = (WebSocketServerHandle, Option<Arc<WebSocketServerHandle>>);

/// The server for who looks, the one for who steers, and the door to both.
async fn start_both(
    hub: &Arc<Hub>,
    steering: Option<(Token, Arc<Steering>)>,
    origins: &[String],
) -> Result<(Arc<Door>, Protocols), LiveError> {
    let here = |server: &WebSocketServerHandle| SocketAddr::from((Ipv4Addr::LOCALHOST, server.port()));
    let looked = start_protocol(hub, None).await?;
    let (way, steered) = match steering {
        None => (None, None),
        Some((token, steering)) => {
            let server = start_steered(hub, &steering).await?;
            let way = SteeredWay {
                token,
                target: here(&server),
                steering,
            };
            (Some(way), Some(server))
        }
    };
    Ok((Door::with(here(&looked), way, origins), (looked, steered)))
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
                self.hub.publish(message.topic, message.log_time, &message.cdr);
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
    /// Listens at `address`, which `option` gave; viewers in pages of `origins` may come in too, and who shows the token may
    /// steer.
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
        let (told, started) = std::sync::mpsc::channel();
        let (given, origins) = (Arc::clone(&shared), origins.to_vec());
        let work = move || {
            runtime.block_on(async {
                let started = start_both(&given.hub, steering, &origins).await;
                let (door, protocols) = match started {
                    Ok(started) => started,
                    Err(error) => return drop(told.send(Err(error))),
                };
                let router = only_door(door);
                // Who waits for it is there.
                let _ = told.send(Ok(()));
                let served = tokio::select! {
                    served = serve(listener, router, async { drop(ended.await) }) => served,
                    () = given.hand_over() => Ok(()),
                };
                if let Err(error) = served {
                    tracing::error!("the live server ended: {}", printable(&error.to_string()));
                }
                // Their tasks end with the runtime.
                drop(protocols);
            });
        };
        let thread = std::thread::Builder::new().name("live".into()).spawn(work)?;
        // So that what is wrong is known before the node runs. Without an answer the thread has gone.
        started
            .recv()
            .unwrap_or_else(|_| Err(std::io::Error::other("it ended at once").into()))?;
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

    /// Hands over CDR with its header, if anybody may want it. Never waits for a client; what there is no room for is counted.
    pub fn publish(&self, topic: usize, log_time: i64, cdr: &[u8]) {
        if self.shared.hub.wants(topic) {
            self.shared.push(Waiting {
                topic,
                log_time: u64::try_from(log_time).unwrap_or(0),
                cdr: cdr.to_vec(),
            });
        }
    }

    /// How many clients there are.
    pub fn clients(&self) -> u64 {
        self.shared.hub.clients()
    }

    /// Messages that the live thread had no time for. What a client does not take is not among them.
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
