//! The topics that are offered live, and the newest state of latched ones for clients that come later.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use foxglove::websocket::{ChannelView, Client, PlaybackControlRequest, PlaybackState, ServerListener};
use foxglove::{ChannelBuilder, ChannelId, Context, FoxgloveError, PartialMetadata, RawChannel, Schema, SinkId};

use super::player::Player;
use crate::bag::Topic;

/// The newest message of a latched topic, with its instant (ns since 1970).
type Newest = Option<(u64, Vec<u8>)>;

/// One topic.
struct Offered {
    channel: Arc<RawChannel>,
    /// Of latched topics. Held while a message goes out, so that a new client never hears an older state after a newer.
    newest: Option<Mutex<Newest>>,
}

/// All topics of one server.
pub struct Hub {
    context: Arc<Context>,
    topics: Vec<Offered>,
    number: BTreeMap<u64, usize>,
    clients: AtomicU64,
    player: Mutex<Option<Arc<Player>>>,
}

impl Hub {
    /// Offers these topics, to be published by their number in this order.
    ///
    /// # Errors
    /// When the library refuses a channel.
    pub fn new<'a>(topics: impl IntoIterator<Item = &'a Topic>) -> Result<Arc<Self>, FoxgloveError> {
        let context = Context::new();
        let mut offered = Vec::new();
        let mut number = BTreeMap::new();
        for topic in topics {
            let schema = (!topic.schema.is_empty()).then(|| {
                Schema::new(
                    &topic.ros_type,
                    &topic.schema_encoding,
                    topic.schema.clone().into_bytes(),
                )
            });
            let channel = ChannelBuilder::new(&topic.name)
                .context(&context)
                .message_encoding(&topic.encoding)
                .schema(schema)
                .build_raw()?;
            number.insert(u64::from(channel.id()), offered.len());
            let latched = topic.qos.iter().any(|qos| qos.transient_local);
            offered.push(Offered {
                channel,
                newest: latched.then(Mutex::default),
            });
        }
        Ok(Arc::new(Self {
            context,
            topics: offered,
            number,
            clients: AtomicU64::new(0),
            player: Mutex::default(),
        }))
    }

    /// Whether a message on this topic would go anywhere.
    pub fn wants(&self, topic: usize) -> bool {
        self.topics
            .get(topic)
            .is_some_and(|offered| offered.newest.is_some() || offered.channel.has_sinks())
    }

    /// Sends CDR with its header to all who subscribe; `log_time` in ns since 1970. Never waits for a client.
    pub fn publish(&self, topic: usize, log_time: u64, cdr: &[u8]) {
        let Some(offered) = self.topics.get(topic) else { return };
        let mut newest = offered.newest.as_ref().map(locked);
        if let Some(newest) = &mut newest {
            **newest = Some((log_time, cdr.to_vec()));
        }
        offered.channel.log_with_meta(cdr, at(log_time));
    }

    /// Forgets the states of latched topics: time has gone backwards.
    pub(super) fn forget(&self) {
        for newest in self.topics.iter().filter_map(|offered| offered.newest.as_ref()) {
            *locked(newest) = None;
        }
    }

    /// How many clients there are.
    pub fn clients(&self) -> u64 {
        self.clients.load(Ordering::Relaxed)
    }

    pub(super) fn context(&self) -> &Arc<Context> {
        &self.context
    }

    /// Who answers requests to play, pause and seek.
    pub(super) fn set_player(&self, player: Arc<Player>) {
        *locked(&self.player) = Some(player);
    }

    fn tell_newest(&self, channel: ChannelId, sink: SinkId) {
        let offered = self
            .number
            .get(&u64::from(channel))
            .and_then(|number| self.topics.get(*number));
        let Some((offered, newest)) = offered.and_then(|offered| Some((offered, offered.newest.as_ref()?))) else {
            return;
        };
        let newest = locked(newest);
        if let Some((log_time, cdr)) = newest.as_ref() {
            offered.channel.log_with_meta_to_sink(cdr, at(*log_time), Some(sink));
        }
    }
}

impl ServerListener for Hub {
    fn on_subscribe(&self, client: Client, channel: ChannelView) {
        if let Some(sink) = client.sink_id() {
            self.tell_newest(channel.id(), sink);
        }
    }

    fn on_client_connect(&self) {
        self.clients.fetch_add(1, Ordering::Relaxed);
        if let Some(player) = locked(&self.player).as_ref() {
            player.greet();
        }
    }

    fn on_client_disconnect(&self) {
        self.clients.fetch_sub(1, Ordering::Relaxed);
    }

    fn on_playback_control_request(&self, request: PlaybackControlRequest) -> Option<PlaybackState> {
        let player = locked(&self.player).clone()?;
        Some(player.control(&request))
    }
}

fn at(log_time: u64) -> PartialMetadata {
    PartialMetadata::with_log_time(log_time)
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
