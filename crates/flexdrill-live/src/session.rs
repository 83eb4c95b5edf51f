//! The conversation with one viewer, from the handshake to the end of the connection: its subscriptions and requests.
//!
//! The message types are those of the protocol's authors (`foxglove::ws_protocol`).

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use foxglove::ws_protocol::ParseError;
use foxglove::ws_protocol::client::{
    Advertise, ClientMessage, MessageData, PlaybackControlRequest, ServiceCallRequest,
};
use foxglove::ws_protocol::server::server_info::Capability;
use foxglove::ws_protocol::server::{ServerInfo, ServiceCallFailure, Status};
use futures::{SinkExt as _, StreamExt as _};
use tokio::io::{AsyncRead, AsyncWrite};
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::protocol::{Role, WebSocketConfig};
use tokio_tungstenite::tungstenite::{self, Bytes, Message};

use crate::backlog::{Backlog, Closed};
use crate::hub::Hub;
use crate::steering::{ClientChannel, ENCODING, Pilot};
use flexdrill_text::printable;

/// Longest message of a viewer (bytes), whole or in fragments: far above any that the node accepts. A longer one is
/// refused by its announced length, before any of it is stored.
pub(crate) const MOST_BYTES: usize = 64 << 10;
/// Size of the read buffer (bytes).
const READ: usize = 4 << 10;
/// Bytes collected before they are written to the socket.
const WRITE: usize = 16 << 10;
/// Largest number of topics that one viewer publishes on.
const MOST_CHANNELS: usize = 64;
/// Largest number of parameters in one request.
const MOST_NAMES: usize = 1000;
/// Time between two pings. A ping that is not acknowledged shows that the viewer's machine has vanished.
const PING: Duration = Duration::from_secs(10);
/// Longest quotation of a viewer's text in an answer (characters).
const MOST_ECHO: usize = 200;

/// Next number of a connection, unique in this process. No connection has the number 0.
static NUMBERS: AtomicU32 = AtomicU32::new(1);

/// The form in which topics are advertised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Subprotocol {
    /// Each with its definition.
    V1,
    /// With a table of definitions.
    V1_1,
}

/// One viewer.
pub(crate) struct Session {
    number: u32,
    hub: Arc<Hub>,
    backlog: Arc<Backlog>,
    /// Subscribed topics, by the viewer's ids.
    subscriptions: HashMap<u32, usize>,
    /// Topics that the viewer publishes on, by its ids.
    channels: HashMap<u32, ClientChannel>,
    /// Steering, if the viewer may steer.
    pilot: Option<Pilot>,
}

/// A new number for a connection.
pub(crate) fn next_number() -> u32 {
    NUMBERS.fetch_add(1, Ordering::Relaxed)
}

impl Session {
    /// The session of viewer `number`, whose messages are queued in `backlog`.
    pub fn new(number: u32, hub: &Arc<Hub>, backlog: Arc<Backlog>, pilot: Option<Pilot>) -> Self {
        Self {
            number,
            hub: Arc::clone(hub),
            backlog,
            subscriptions: HashMap::new(),
            channels: HashMap::new(),
            pilot,
        }
    }

    /// Serves the viewer until either side ends the connection.
    pub async fn run(mut self, stream: impl AsyncRead + AsyncWrite + Unpin, subprotocol: Subprotocol) {
        let config = WebSocketConfig::default()
            .read_buffer_size(READ)
            .write_buffer_size(WRITE)
            .max_message_size(Some(MOST_BYTES))
            .max_frame_size(Some(MOST_BYTES));
        let socket = WebSocketStream::from_raw_socket(stream, Role::Server, Some(config)).await;
        let (to, mut from) = socket.split();
        self.greet(subprotocol);
        let backlog = Arc::clone(&self.backlog);
        let reading = async {
            loop {
                match from.next().await {
                    Some(Ok(Message::Close(_)) | Err(_)) | None => return,
                    Some(Ok(message)) => self.handle(&message),
                }
            }
        };
        // The cause of the end is of no interest.
        tokio::select! {
            () = reading => {}
            () = send(to, &backlog) => {}
        }
    }

    fn greet(&self, subprotocol: Subprotocol) {
        self.backlog.answer(&self.info());
        self.backlog
            .answer(self.hub.advertised(subprotocol == Subprotocol::V1_1));
        if let Some(pilot) = &self.pilot {
            self.backlog.answer(pilot.services());
        }
        self.hub.connect(self.number, &self.backlog);
    }

    fn info(&self) -> ServerInfo {
        let mut info = ServerInfo::new(concat!("flexdrill ", env!("CARGO_PKG_VERSION")));
        if self.pilot.is_some() {
            let capabilities = [
                Capability::ClientPublish,
                Capability::Services,
                Capability::Parameters,
                Capability::ParametersSubscribe,
            ];
            info = info
                .with_capabilities(capabilities)
                .with_supported_encodings([ENCODING]);
        }
        if let Some(player) = self.hub.player() {
            info = info
                .with_capabilities([Capability::Time, Capability::PlaybackControl])
                .with_playback_time_range(Some(player.range()));
        }
        info
    }

    fn handle(&mut self, message: &Message) {
        if !matches!(message, Message::Text(_) | Message::Binary(_)) {
            return;
        }
        match ClientMessage::try_from(message) {
            Ok(message) => self.dispatch(message),
            Err(ParseError::EmptyBinaryMessage) => {}
            Err(error) => self.refuse(format!("this message is not part of the protocol: {error}")),
        }
    }

    fn dispatch(&mut self, message: ClientMessage<'_>) {
        match message {
            // Each message of the client is answered or ignored as the protocol says. An error ends nothing, because
            // viewers of several versions connect.
            ClientMessage::Subscribe(message) => {
                for wanted in message.subscriptions {
                    self.subscribe(wanted.id, wanted.channel_id);
                }
            }
            ClientMessage::Unsubscribe(message) => {
                for subscription in message.subscription_ids {
                    // The hub counts subscriptions by topic, so that a topic without viewers costs nothing.
                    if let Some(topic) = self.subscriptions.remove(&subscription) {
                        self.hub.unsubscribe(self.number, topic);
                    }
                }
            }
            ClientMessage::Advertise(message) => self.advertise(message),
            ClientMessage::Unadvertise(message) => {
                for channel in message.channel_ids {
                    // The sentence is the protocol's own, which Foxglove shows in its list of problems.
                    if self.channels.remove(&channel).is_none() {
                        let why = format!("Client is not advertising channel: {channel}; ignoring unadvertisement");
                        self.backlog.answer(&Status::warning(why));
                    }
                }
            }
            ClientMessage::MessageData(message) => self.publish(&message),
            ClientMessage::GetParameters(message) => {
                // All requests on parameters need the right to steer, and a bound
                // on their number, since each name costs a search.
                if let Some(pilot) = self.parameters(message.parameter_names.len(), "parameters") {
                    pilot.get_parameters(&message.parameter_names, message.id);
                }
            }
            ClientMessage::SetParameters(message) => {
                if let Some(pilot) = self.parameters(message.parameters.len(), "parameters") {
                    pilot.set_parameters(message.parameters, message.id);
                }
            }
            ClientMessage::SubscribeParameterUpdates(message) => {
                if let Some(pilot) = self.parameters(message.parameter_names.len(), "parametersSubscribe") {
                    pilot.follow(message.parameter_names);
                }
            }
            ClientMessage::UnsubscribeParameterUpdates(message) => {
                if let Some(pilot) = self.parameters(message.parameter_names.len(), "parametersSubscribe") {
                    pilot.unfollow(&message.parameter_names);
                }
            }
            ClientMessage::ServiceCallRequest(request) => self.call(&request),
            ClientMessage::PlaybackControlRequest(request) => self.play(&request),
            // What the server has not announced is refused in words: a
            // viewer that waits for an answer would seem to hang.
            ClientMessage::SubscribeConnectionGraph | ClientMessage::UnsubscribeConnectionGraph => {
                self.refuse(unsupported("connectionGraph"));
            }
            ClientMessage::FetchAsset(_) => self.refuse(unsupported("assets")),
        }
    }

    fn subscribe(&mut self, subscription: u32, channel: u64) {
        // Channel ids begin at 1.
        let topic = usize::try_from(channel).unwrap_or(usize::MAX).wrapping_sub(1);
        if self.subscriptions.contains_key(&subscription) {
            self.refuse(format!(
                "subscription id {subscription} is in use; this subscription is ignored"
            ));
        } else if self.subscriptions.values().any(|known| *known == topic) {
            let why = format!("channel {channel} is already subscribed to; this subscription is ignored");
            self.backlog.answer(&Status::warning(why));
        } else if self.hub.subscribe(self.number, topic, subscription, &self.backlog) {
            self.subscriptions.insert(subscription, topic);
        } else {
            self.refuse(format!("there is no channel {channel}"));
        }
    }

    fn advertise(&mut self, message: Advertise<'_>) {
        let Some(pilot) = &self.pilot else {
            return self.refuse(unsupported("clientPublish"));
        };
        for channel in message.channels {
            let id = channel.id;
            if self.channels.contains_key(&id) {
                let why = format!("Client is already advertising channel: {id}; ignoring advertisement");
                self.backlog.answer(&Status::warning(why));
                continue;
            }
            if self.channels.len() == MOST_CHANNELS {
                let why = format!(
                    "channel {id} is ignored: {MOST_CHANNELS} channels are advertised, the largest number allowed"
                );
                return self.refuse(why);
            }
            let channel = ClientChannel {
                topic: echo(&channel.topic),
                encoding: echo(&channel.encoding),
                schema_name: echo(&channel.schema_name),
            };
            if let Err(why) = pilot.input(&channel) {
                self.backlog.answer(&Status::error(why));
            }
            self.channels.insert(id, channel);
        }
    }

    fn publish(&self, message: &MessageData<'_>) {
        let published = match (&self.pilot, self.channels.get(&message.channel_id)) {
            (Some(pilot), Some(channel)) => pilot.publish(channel, &message.data),
            _ => Err(format!("Unknown channel ID: {}", message.channel_id)),
        };
        if let Err(why) = published {
            self.refuse(why);
        }
    }

    /// The steering of this viewer. Refuses the request when the viewer may not steer, or names too many parameters.
    fn parameters(&self, names: usize, capability: &str) -> Option<&Pilot> {
        if names > MOST_NAMES {
            self.refuse(format!(
                "the request names {names} parameters; at most {MOST_NAMES} are allowed"
            ));
            return None;
        }
        if self.pilot.is_none() {
            self.refuse(unsupported(capability));
        }
        self.pilot.as_ref()
    }

    fn call(&self, request: &ServiceCallRequest<'_>) {
        match &self.pilot {
            Some(pilot) => pilot.call(request),
            None => {
                let why = "Server does not support services";
                self.backlog
                    .answer(&ServiceCallFailure::new(request.service_id, request.call_id, why));
            }
        }
    }

    fn play(&self, request: &PlaybackControlRequest) {
        match self.hub.player() {
            // All viewers get the answer, which contains the request's id.
            Some(_) if request.request_id.len() > MOST_ECHO => {
                self.refuse(format!("the request's id is longer than {MOST_ECHO} bytes"));
            }
            Some(player) => player.control(request, &self.hub),
            None => self.refuse(unsupported("playbackControl")),
        }
    }

    fn refuse(&self, why: String) {
        self.backlog.answer(&Status::error(why));
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.hub.disconnect(self.number);
    }
}

/// The refusal, in the words of Foxglove's own server.
fn unsupported(capability: &str) -> String {
    format!("Server does not support {capability} capability")
}

/// A viewer's text, cut and escaped so that answers may quote it.
fn echo(text: &str) -> String {
    let short: String = text.chars().take(MOST_ECHO).collect();
    printable(&short).into_owned()
}

/// Sends the viewer's queue until the connection must be closed.
async fn send<S>(mut to: S, backlog: &Backlog)
where
    S: futures::Sink<Message, Error = tungstenite::Error> + Unpin,
{
    let mut ping = tokio::time::interval(PING);
    ping.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        match backlog.try_next() {
            Err(Closed) => return,
            Ok(Some(message)) => {
                if to.feed(message).await.is_err() {
                    return;
                }
            }
            Ok(None) => {
                if to.flush().await.is_err() {
                    return;
                }
                tokio::select! {
                    () = backlog.filled() => {}
                    _ = ping.tick() => {
                        if to.feed(Message::Ping(Bytes::new())).await.is_err() {
                            return;
                        }
                    }
                }
            }
        }
    }
}
