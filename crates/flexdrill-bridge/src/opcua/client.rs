//! A client of a rig's server, which subscribes to its nodes and comes back after a loss.

use std::path::PathBuf;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use ::opcua::client::{
    Client, ClientBuilder, DataChangeCallback, IdentityToken, Session, SessionActivity, SessionPollResult,
};
use ::opcua::crypto::SecurityPolicy;
use ::opcua::types::{
    AttributeId, DataChangeFilter, DataChangeTrigger, DeadbandType, EndpointDescription, ExtensionObject,
    MessageSecurityMode, MonitoredItemCreateRequest, MonitoringMode, MonitoringParameters, NodeId, NumericRange,
    QualifiedName, ReadValueId, StatusCode, TimestampsToReturn,
};
use futures::StreamExt as _;
use tokio::sync::mpsc;
use tokio::time::timeout;

use super::mapping::{self, NodeMapping};
use super::nanoseconds;
use super::values::RawValue;
use crate::lines::{BackOff, now};

/// Time between two questions whether the server lives; one without an answer ends the connection.
const KEEP_ALIVE: Duration = Duration::from_secs(2);
/// Time for an answer.
const ANSWER: Duration = Duration::from_secs(4);
/// Time until a connection has its subscription.
const CONNECT: Duration = Duration::from_secs(15);
/// Shortest and longest wait before another attempt; it doubles from one to the next.
pub const WAIT: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(30)];

/// Where and as whom.
#[derive(Debug, Clone)]
pub struct Place {
    /// `opc.tcp://HOST:PORT`, with a path if the server has one.
    pub url: String,
    /// Whether the connection is encrypted.
    pub encrypt: bool,
    /// Name and password; anonymous without.
    pub user: Option<(String, String)>,
    /// Folder with our certificate and those that we trust.
    pub keys: PathBuf,
    /// URI of this program, as in its certificate.
    pub application_uri: String,
}

/// What happens at the client.
#[derive(Debug, Clone)]
pub enum RigEvent {
    /// A connection has its subscription.
    Opened {
        /// Its number, counted from 1.
        connection: u64,
        /// Nodes that are followed.
        nodes: usize,
        /// The security policy in use.
        policy: String,
    },
    /// The server refuses to follow a node.
    NotFollowed {
        /// Its id in the mapping.
        node: String,
        /// The reason, in words for a log.
        status: StatusCode,
    },
    /// A value came.
    Value(RawValue),
    /// The server lives (ns since 1970).
    Alive(i64),
    /// A connection ended.
    Closed {
        /// Its number.
        connection: u64,
        /// The reason, in words for a log.
        why: String,
    },
    /// No connection; another attempt follows.
    Waiting {
        /// The reason, in words for a log.
        why: String,
        /// Until the next attempt.
        wait: Duration,
    },
}

/// Follows the nodes of a mapping.
pub struct RigClient {
    place: Place,
    nodes: Vec<(String, Option<String>, NodeId)>,
    interval: Duration,
    events: mpsc::Sender<RigEvent>,
    /// Values that came faster than they were taken.
    lost: Arc<AtomicU64>,
}

/// Why a connection ended.
struct Ended {
    why: String,
    brought: bool,
}

fn in_words<E: std::fmt::Display>(what: &str) -> impl Fn(E) -> String {
    move |error| format!("{what}: {error}")
}

impl RigClient {
    /// A client; what happens is sent to `events`.
    pub fn new(place: Place, mapping: &NodeMapping, events: mpsc::Sender<RigEvent>) -> Self {
        let nodes = mapping.nodes.keys().filter_map(|id| {
            let (uri, node) = mapping::parse(id)?;
            Some((id.clone(), uri.map(str::to_owned), node))
        });
        Self {
            place,
            nodes: nodes.collect(),
            interval: Duration::from_secs_f64(mapping.interval_s),
            events,
            lost: Arc::default(),
        }
    }

    /// The number of values that came faster than they were taken.
    pub fn lost(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.lost)
    }

    /// Connects, and connects again, for as long as it is polled and `events` has a receiver.
    pub async fn run(&self) {
        let mut back_off = BackOff::new(WAIT);
        let mut connection = 0;
        loop {
            let ended = self.connect(&mut connection).await;
            if ended.brought {
                back_off.reset();
            }
            let wait = back_off.next_wait();
            let waiting = RigEvent::Waiting { why: ended.why, wait };
            if self.events.send(waiting).await.is_err() {
                return;
            }
            tokio::time::sleep(wait).await;
        }
    }

    fn client(&self) -> Result<Client, String> {
        ClientBuilder::new()
            .application_name("flexdrill")
            .application_uri(self.place.application_uri.clone())
            .product_uri("urn:flexdrill")
            .pki_dir(&self.place.keys)
            .certificate_path("own/cert.der")
            .private_key_path("private/private.pem")
            .trust_server_certs(false)
            .session_name("flexdrill bridge")
            .session_retry_limit(0)
            .keep_alive_interval(KEEP_ALIVE)
            .max_failed_keep_alive_count(1)
            .request_timeout(ANSWER)
            .recreate_subscriptions(false)
            .client()
            .map_err(|errors| errors.join("; "))
    }

    /// The endpoint that fits, with the address under which we reach the server: servers often give another one.
    async fn endpoint(&self, client: &Client) -> Result<EndpointDescription, String> {
        let asked = client.get_server_endpoints_from_url(self.place.url.as_str());
        let endpoints = asked.await.map_err(in_words("its endpoints"))?;
        let mode = if self.place.encrypt {
            MessageSecurityMode::SignAndEncrypt
        } else {
            MessageSecurityMode::None
        };
        let fits = |endpoint: &&EndpointDescription| {
            endpoint.security_mode == mode && policy_of(endpoint) != SecurityPolicy::Unknown
        };
        let count = endpoints.len();
        let best = endpoints
            .iter()
            .filter(fits)
            .max_by_key(|endpoint| endpoint.security_level);
        let mut best = best.cloned().ok_or_else(|| {
            let wanted = if self.place.encrypt { "with" } else { "without" };
            format!("none of its {count} endpoints is one {wanted} encryption")
        })?;
        best.endpoint_url = self.place.url.as_str().into();
        Ok(best)
    }

    async fn connect(&self, connection: &mut u64) -> Ended {
        // Whether values came decides on the wait before the next attempt; until then every end is a failure.
        let failed = |why: String| Ended { why, brought: false };
        let mut client = match self.client() {
            Ok(client) => client,
            Err(why) => return failed(why),
        };
        // Each stage has its own time limit. A server that accepts TCP and
        // then says nothing would hold the client for ever.
        let endpoint = match timeout(CONNECT, self.endpoint(&client)).await {
            Ok(Ok(endpoint)) => endpoint,
            Ok(Err(why)) => return failed(why),
            Err(_) => return failed(format!("no answer within {} s", CONNECT.as_secs())),
        };
        let policy = policy_of(&endpoint).to_string();
        let identity = match &self.place.user {
            Some((name, password)) => IdentityToken::new_user_name(name.clone(), password.clone()),
            None => IdentityToken::Anonymous,
        };
        // The endpoint is used as chosen, so that encryption is never given up for a connection.
        let (session, event_loop) = match client.connect_to_endpoint_directly(endpoint, identity) {
            Ok(session) => session,
            Err(error) => return failed(error.to_string()),
        };
        // The event loop must be polled for the session to advance, so subscribing runs next to it and not before it.
        let mut happens = pin!(event_loop.enter());
        let mut following = pin!(timeout(CONNECT, self.follow(&session)));
        let mut brought = false;
        let why = loop {
            tokio::select! {
                // The first sign of a loss ends this connection. The crate's own reconnecting is not used, because
                // subscriptions might come back without values and nothing would show it.
                event = happens.next() => match event {
                    None => break "the session ended".to_owned(),
                    Some(Err(status)) => break status.to_string(),
                    Some(Ok(SessionPollResult::ConnectionLost(status) | SessionPollResult::ReconnectFailed(status))) => {
                        break status.to_string();
                    }
                    Some(Ok(SessionPollResult::SessionActivity(SessionActivity::KeepAliveSucceeded))) => {
                        // A full queue has values in it, which show life as well.
                        let _ = self.events.try_send(RigEvent::Alive(now()));
                    }
                    Some(Ok(SessionPollResult::SessionActivity(SessionActivity::KeepAliveFailed(status)))) => {
                        break format!("it does not answer: {status}");
                    }
                    Some(Ok(_)) => {}
                },
                followed = &mut following, if !brought => {
                    // A server may answer and not offer subscriptions; the user then needs to know which stage failed.
                    let followed = followed.unwrap_or_else(|_| Err(format!("no subscription within {} s", CONNECT.as_secs())));
                    match followed {
                        Ok(nodes) => {
                            *connection += 1;
                            let opened = RigEvent::Opened { connection: *connection, nodes, policy: policy.clone() };
                            if self.events.send(opened).await.is_err() {
                                return failed(String::new());
                            }
                            brought = true;
                        }
                        Err(why) => break why,
                    }
                }
            }
        };
        // Only an `Opened` has its `Closed`: the bridge counts connections by them.
        if brought {
            let closed = RigEvent::Closed {
                connection: *connection,
                why: why.clone(),
            };
            // Without a receiver the client ends.
            let _ = self.events.send(closed).await;
        }
        Ended { why, brought }
    }

    /// Subscribes to the nodes. Returns how many the server follows.
    async fn follow(&self, session: &Arc<Session>) -> Result<usize, String> {
        // Before the session is active the server refuses all services.
        session.wait_for_connection().await;
        let (events, lost) = (self.events.clone(), Arc::clone(&self.lost));
        let callback = DataChangeCallback::new(move |value, item| {
            // The handle 0 would be replaced by one of the crate's own.
            let Some(node) = usize::try_from(item.client_handle())
                .ok()
                .and_then(|handle| handle.checked_sub(1))
            else {
                return;
            };
            let raw = RawValue {
                node,
                source_time: value.source_timestamp.as_ref().and_then(nanoseconds),
                status: value.status.unwrap_or(StatusCode::Good),
                value: value.value,
                arrived: now(),
            };
            // The callback runs in the crate's task and must not wait: a full queue costs the value, which is counted.
            if events.try_send(RigEvent::Value(raw)).is_err() {
                lost.fetch_add(1, Ordering::Relaxed);
            }
        });
        let subscription = session
            .create_subscription(self.interval, 100, 10, 0, 0, true, callback)
            .await
            .map_err(in_words("a subscription"))?;
        // A node that the server does not have must not cost the others.
        let mut missing = Vec::new();
        let mut items = Vec::new();
        for (index, (id, uri, node)) in self.nodes.iter().enumerate() {
            let mut node = node.clone();
            // The mapping names namespaces by URI, because their indexes may change with each start of the server.
            if let Some(uri) = uri {
                let Ok(namespace) = session.get_namespace_index(uri).await else {
                    missing.push((id.clone(), StatusCode::BadNodeIdUnknown));
                    continue;
                };
                node.namespace = namespace;
            }
            items.push((id, self.item(index, node)));
        }
        // One request for all items, since some servers bound the number of requests.
        let requests = items.iter().map(|(_, item)| item.clone()).collect::<Vec<_>>();
        if !requests.is_empty() {
            let created = session
                .create_monitored_items(subscription, TimestampsToReturn::Both, requests)
                .await
                .map_err(in_words("its nodes"))?;
            let refused = items.iter().zip(&created).filter_map(|((id, _), created)| {
                let status = created.result.status_code;
                status.is_bad().then(|| ((*id).clone(), status))
            });
            missing.extend(refused);
        }
        // The counts say how many; these events say which.
        for (node, status) in &missing {
            let refused = RigEvent::NotFollowed {
                node: node.clone(),
                status: *status,
            };
            let _ = self.events.try_send(refused);
        }
        Ok(self.nodes.len() - missing.len())
    }

    fn item(&self, index: usize, node: NodeId) -> MonitoredItemCreateRequest {
        // A new source timestamp is news too: it shows that the sensor lives.
        let filter = DataChangeFilter {
            trigger: DataChangeTrigger::StatusValueTimestamp,
            deadband_type: DeadbandType::None as u32,
            deadband_value: 0.0,
        };
        MonitoredItemCreateRequest {
            item_to_monitor: ReadValueId {
                node_id: node,
                attribute_id: AttributeId::Value as u32,
                index_range: NumericRange::None,
                data_encoding: QualifiedName::null(),
            },
            monitoring_mode: MonitoringMode::Reporting,
            requested_parameters: MonitoringParameters {
                client_handle: u32::try_from(index + 1).unwrap_or(u32::MAX),
                sampling_interval: self.interval.as_secs_f64() * 1e3,
                filter: ExtensionObject::from_message(filter),
                // The newest value is the one that counts.
                queue_size: 1,
                discard_oldest: true,
            },
        }
    }
}

fn policy_of(endpoint: &EndpointDescription) -> SecurityPolicy {
    SecurityPolicy::from_uri(endpoint.security_policy_uri.as_ref())
}
