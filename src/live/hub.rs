//! The topics that are offered live: who subscribes to them, and the newest state of latched ones for viewers that come
//! later.

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

use super::backlog::{Backlog, Data};
use super::player::Player;
use crate::bag::Topic;
use flexdrill_text::printable;

/// A viewer's subscription to a topic.
struct Subscriber {
    /// Number of the connection.
    viewer: u32,
    /// The viewer's own number of the subscription.
    subscription: u32,
    backlog: Arc<Backlog>,
}

/// What is known of a topic. Its lock is held while a message goes out, so that a new subscriber never gets an older
/// state after a newer one.
#[derive(Default)]
struct State {
    /// The newest message of a latched topic, with its instant (ns since 1970).
    newest: Option<(u64, Bytes)>,
    subscribers: Vec<Subscriber>,
}

struct Offered {
    is_latched: bool,
    state: Mutex<State>,
    subscribers: AtomicUsize,
}

/// All topics of one server. A topic's channel id in the protocol is its number plus one.
pub struct Hub {
    topics: Vec<Offered>,
    /// What is advertised: with each channel's definition, and with a table of definitions.
    advertised: [Utf8Bytes; 2],
    viewers: Mutex<Vec<(u32, Arc<Backlog>)>>,
    player: Mutex<Option<Arc<Player>>>,
}

impl Hub {
    /// Offers these topics, to be published by their number in this order.
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

    /// Whether a message on this topic would be used.
    pub fn wants(&self, topic: usize) -> bool {
        self.topics
            .get(topic)
            .is_some_and(|offered| offered.is_latched || offered.subscribers.load(Ordering::Relaxed) > 0)
    }

    /// Sends CDR with its header to all who subscribe; `log_time` in ns since 1970. Never waits for a viewer.
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

    /// Forgets the states of latched topics: time has gone backwards.
    pub(super) fn forget(&self) {
        for offered in &self.topics {
            locked(&offered.state).newest = None;
        }
    }

    /// How many viewers there are.
    pub fn clients(&self) -> u64 {
        locked(&self.viewers).len() as u64
    }

    /// What a viewer of `foxglove.sdk.v1`, or with `with_table` of v1.1, is sent first of all topics.
    pub(super) fn advertised(&self, with_table: bool) -> Message {
        Message::Text(self.advertised[usize::from(with_table)].clone())
    }

    /// Adds a viewer, which is sent the state of the player where a recording is played.
    pub(super) fn connect(&self, viewer: u32, backlog: &Arc<Backlog>) {
        locked(&self.viewers).push((viewer, Arc::clone(backlog)));
        if let Some(player) = self.player() {
            player.greet(backlog);
        }
    }

    /// Removes a viewer with its subscriptions.
    pub(super) fn disconnect(&self, viewer: u32) {
        locked(&self.viewers).retain(|(number, _)| *number != viewer);
        for topic in 0..self.topics.len() {
            self.unsubscribe(viewer, topic);
        }
    }

    /// Subscribes a viewer to a topic; a latched topic's newest state follows at once. Whether there is such a topic.
    pub(super) fn subscribe(&self, viewer: u32, topic: usize, subscription: u32, backlog: &Arc<Backlog>) -> bool {
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
    pub(super) fn unsubscribe(&self, viewer: u32, topic: usize) {
        let Some(offered) = self.topics.get(topic) else { return };
        let mut state = locked(&offered.state);
        state.subscribers.retain(|subscriber| subscriber.viewer != viewer);
        offered.subscribers.store(state.subscribers.len(), Ordering::Relaxed);
    }

    /// Who answers requests to play, pause and seek.
    pub(super) fn set_player(&self, player: Arc<Player>) {
        *locked(&self.player) = Some(player);
    }

    pub(super) fn player(&self) -> Option<Arc<Player>> {
        locked(&self.player).clone()
    }

    /// Sends all viewers the time of the recording that is played (ns since 1970).
    pub(super) fn broadcast_time(&self, time: u64) {
        for (_, backlog) in locked(&self.viewers).iter() {
            backlog.time(time);
        }
    }

    /// Sends all viewers how the recording is played.
    pub(super) fn broadcast_playback(&self, state: &PlaybackState) {
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
