//! The topics offered live, their subscribers, and the newest state of latched topics for viewers that connect later.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use foxglove::websocket::PlaybackState;
use foxglove::ws_protocol::JsonMessage as _;
use foxglove::ws_protocol::schema::Schema;
use foxglove::ws_protocol::server::Advertise;
use foxglove::ws_protocol::server::advertise::Channel;
use foxglove::ws_protocol::server::advertise_schema_table::SchemaTable;
use tokio_tungstenite::tungstenite::{Message, Utf8Bytes};

use crate::backlog::{Backlog, Data};
use crate::player::Player;
use flexdrill_bag::Topic;
use flexdrill_text::printable;

/// A viewer's subscription to a topic.
struct Subscriber {
    /// Number of the connection.
    viewer: u32,
    /// The viewer's id of the subscription.
    subscription: u32,
    backlog: Arc<Backlog>,
}

/// State of a topic. Its lock is held while a message is sent, so that a new subscriber never gets an older state after
/// a newer one.
#[derive(Default)]
struct TopicState {
    /// The newest message of a latched topic, with its log time (ns since 1970).
    newest: Option<(u64, Bytes)>,
    subscribers: Vec<Subscriber>,
}

struct Offered {
    is_latched: bool,
    state: Mutex<TopicState>,
    subscribers: AtomicUsize,
}

/// All topics of one server. A topic's channel id in the protocol is its index plus one.
pub struct Hub {
    topics: Vec<Offered>,
    /// The advertisement of all topics: with a definition in each channel, and with a table of definitions.
    advertised: [Utf8Bytes; 2],
    viewers: Mutex<Vec<(u32, Arc<Backlog>)>>,
    player: Mutex<Option<Arc<Player>>>,
}

impl Hub {
    /// A hub with these topics; [`Hub::publish`] takes their index in this order.
    pub fn new<'a>(topics: impl IntoIterator<Item = &'a Topic>) -> Arc<Self> {
        let mut offered = Vec::new();
        let mut channels = Vec::new();
        for topic in topics {
            offered.push(Offered {
                is_latched: topic.qos.iter().any(|qos| qos.transient_local),
                state: Mutex::default(),
                subscribers: AtomicUsize::new(0),
            });
            let mut channel = Channel::builder(offered.len() as u64, &topic.name, &topic.encoding);
            if !topic.schema.is_empty() {
                channel = channel.with_schema(Schema::new(
                    &topic.ros_type,
                    &topic.schema_encoding,
                    topic.schema.as_bytes(),
                ));
            }
            match channel.build() {
                Ok(channel) => channels.push(channel),
                Err(error) => tracing::warn!(
                    "{} ({}) is not offered to viewers: {error}",
                    printable(&topic.name),
                    printable(&topic.ros_type)
                ),
            }
        }
        let inline = Advertise::new(channels);
        let table = SchemaTable::default().deduplicate(&inline).to_string();
        Arc::new(Self {
            topics: offered,
            advertised: [inline.to_string().into(), table.into()],
            viewers: Mutex::default(),
            player: Mutex::default(),
        })
    }

    /// Whether the hub needs messages of this topic: it is latched, or a viewer subscribes to it.
    pub fn wants(&self, topic: usize) -> bool {
        self.topics
            .get(topic)
            .is_some_and(|offered| offered.is_latched || offered.subscribers.load(Ordering::Relaxed) > 0)
    }

    /// Sends a message (CDR with its header) to all subscribers; `log_time` in ns since 1970. Never waits for a viewer.
    pub fn publish(&self, topic: usize, log_time: u64, cdr: impl Into<Bytes>) {
        let Some(offered) = self.topics.get(topic) else { return };
        let cdr = cdr.into();
        let mut state = locked(&offered.state);
        for subscriber in &state.subscribers {
            subscriber.send(topic, offered.is_latched, log_time, cdr.clone());
        }
        if offered.is_latched {
            state.newest = Some((log_time, cdr));
        }
    }

    /// Clears the states of latched topics, because time has gone backwards.
    pub(crate) fn clear_latched(&self) {
        for offered in &self.topics {
            locked(&offered.state).newest = None;
        }
    }

    /// Number of connected viewers.
    pub fn clients(&self) -> u64 {
        locked(&self.viewers).len() as u64
    }

    /// The advertisement of all topics for `foxglove.sdk.v1`, or with `with_table` for v1.1.
    pub(crate) fn advertised(&self, with_table: bool) -> Message {
        Message::Text(self.advertised[usize::from(with_table)].clone())
    }

    /// Adds a viewer, and sends it the state of the player if there is one.
    pub(crate) fn connect(&self, viewer: u32, backlog: &Arc<Backlog>) {
        locked(&self.viewers).push((viewer, Arc::clone(backlog)));
        if let Some(player) = self.player() {
            player.greet(backlog);
        }
    }

    /// Removes a viewer with its subscriptions.
    pub(crate) fn disconnect(&self, viewer: u32) {
        locked(&self.viewers).retain(|(number, _)| *number != viewer);
        for topic in 0..self.topics.len() {
            self.unsubscribe(viewer, topic);
        }
    }

    /// Subscribes a viewer to a topic; a latched topic's newest state follows at once. Returns whether the topic
    /// exists.
    pub(crate) fn subscribe(&self, viewer: u32, topic: usize, subscription: u32, backlog: &Arc<Backlog>) -> bool {
        let Some(offered) = self.topics.get(topic) else {
            return false;
        };
        let mut state = locked(&offered.state);
        let subscriber = Subscriber {
            viewer,
            subscription,
            backlog: Arc::clone(backlog),
        };
        if let Some((log_time, cdr)) = &state.newest {
            subscriber.send(topic, true, *log_time, cdr.clone());
        }
        state.subscribers.push(subscriber);
        offered.subscribers.store(state.subscribers.len(), Ordering::Relaxed);
        true
    }

    /// Ends a viewer's subscription to a topic.
    pub(crate) fn unsubscribe(&self, viewer: u32, topic: usize) {
        let Some(offered) = self.topics.get(topic) else { return };
        let mut state = locked(&offered.state);
        state.subscribers.retain(|subscriber| subscriber.viewer != viewer);
        offered.subscribers.store(state.subscribers.len(), Ordering::Relaxed);
    }

    /// Sets the player, which handles requests to play, pause and seek.
    pub(crate) fn set_player(&self, player: Arc<Player>) {
        *locked(&self.player) = Some(player);
    }

    pub(crate) fn player(&self) -> Option<Arc<Player>> {
        locked(&self.player).clone()
    }

    /// Sends the time of the recording to all viewers (ns since 1970).
    pub(crate) fn broadcast_time(&self, time: u64) {
        for (_, backlog) in locked(&self.viewers).iter() {
            backlog.time(time);
        }
    }

    /// Sends the state of the player to all viewers.
    pub(crate) fn broadcast_playback(&self, state: &PlaybackState) {
        for (_, backlog) in locked(&self.viewers).iter() {
            backlog.answer(state);
        }
    }
}

impl Subscriber {
    fn send(&self, topic: usize, is_latched: bool, log_time: u64, cdr: Bytes) {
        self.backlog.data(Data {
            topic,
            is_latched,
            subscription: self.subscription,
            log_time,
            cdr,
        });
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
