//! One connection to a broker, which comes back after a loss.
//!
//! The connection asks its [`Source`] for a message whenever it can take one. Nothing waits in a queue meanwhile: after a
//! slow or a lost connection the newest values are sent.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rumqttc::{
    AsyncClient, ConnectionError, Event, EventLoop, NetworkOptions, Packet, PublishOptions, QoS, SubscribeReasonCode,
};
use tokio::sync::{Notify, mpsc, watch};

use super::{Broker, LARGEST_PAYLOAD, Message, Source};
use crate::lines::BackOff;

/// Messages with the library that the broker has not acknowledged, at most.
const IN_FLIGHT: u16 = 8;

/// Times of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinkTimes {
    /// Longest time to connect, and for the network to take a message.
    pub connect: Duration,
    /// Shortest and longest wait before another attempt; it doubles from one to the next.
    pub wait: [Duration; 2],
    /// A connection that lasted this long was good: the next wait is the shortest again.
    pub good: Duration,
    /// Longest time for the last message of an orderly end.
    pub farewell: Duration,
}

impl Default for LinkTimes {
    fn default() -> Self {
        Self {
            connect: Duration::from_secs(10),
            wait: [Duration::from_millis(500), Duration::from_secs(30)],
            good: Duration::from_secs(5),
            farewell: Duration::from_secs(2),
        }
    }
}

/// What happens to a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LinkEvent {
    /// It was made.
    Connected,
    /// It was lost, or could not be made; another attempt follows.
    Waiting {
        /// Why, and what to do.
        why: String,
        /// Until the next attempt.
        wait: Duration,
    },
    /// The broker sent a message, or refused something.
    Note(String),
}

/// What a connection carried since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LinkCounts {
    /// There is a connection.
    pub is_open: bool,
    /// Connections made.
    pub made: u64,
    /// Messages handed to a connection.
    pub sent: u64,
    /// Messages that the broker acknowledged; those of Sparkplug ask for none.
    pub acknowledged: u64,
    /// Bytes of the payloads sent.
    pub bytes: u64,
    /// Messages not sent, because they are larger than [`LARGEST_PAYLOAD`].
    pub too_large: u64,
    /// Messages received.
    pub received: u64,
}

/// A source that a connection and others share.
pub struct Shared<S> {
    source: Mutex<S>,
    work: Notify,
    is_open: AtomicBool,
    made: AtomicU64,
    sent: AtomicU64,
    acknowledged: AtomicU64,
    bytes: AtomicU64,
    too_large: AtomicU64,
    received: AtomicU64,
}

impl<S: Source> Shared<S> {
    /// Shares a source.
    pub fn new(source: S) -> Self {
        Self {
            source: Mutex::new(source),
            work: Notify::new(),
            is_open: AtomicBool::new(false),
            made: AtomicU64::new(0),
            sent: AtomicU64::new(0),
            acknowledged: AtomicU64::new(0),
            bytes: AtomicU64::new(0),
            too_large: AtomicU64::new(0),
            received: AtomicU64::new(0),
        }
    }

    /// Changes the source; the connection then asks it for messages. Never waits for a network.
    pub fn update<T>(&self, change: impl FnOnce(&mut S) -> T) -> T {
        let result = change(&mut self.lock());
        self.work.notify_one();
        result
    }

    /// What the connection carried.
    pub fn counts(&self) -> LinkCounts {
        let read = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        LinkCounts {
            is_open: self.is_open.load(Ordering::Relaxed),
            made: read(&self.made),
            sent: read(&self.sent),
            acknowledged: read(&self.acknowledged),
            bytes: read(&self.bytes),
            too_large: read(&self.too_large),
            received: read(&self.received),
        }
    }

    /// The source after a panic of another holder is as good as before: it is whole between its methods.
    fn lock(&self) -> MutexGuard<'_, S> {
        self.source.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next message that can be sent.
    fn next(&self) -> Option<Message> {
        loop {
            let message = self.lock().next(Instant::now())?;
            if message.payload.len() <= LARGEST_PAYLOAD {
                return Some(message);
            }
            self.too_large.fetch_add(1, Ordering::Relaxed);
        }
    }
}

/// Why a connection ended.
enum End {
    /// An end was asked for.
    Stopped,
    /// It was lost, with what to do.
    Lost(String),
}

/// Keeps a connection until `stop` becomes true, and then ends it in order.
pub async fn run<S: Source>(
    broker: &Broker,
    shared: &Shared<S>,
    times: LinkTimes,
    events: &mpsc::Sender<LinkEvent>,
    mut stop: watch::Receiver<bool>,
) {
    let mut back_off = BackOff::new(times.wait);
    loop {
        let began = Instant::now();
        let end = connection(broker, shared, times, events, &mut stop).await;
        let was_open = shared.is_open.swap(false, Ordering::Relaxed);
        shared.lock().disconnected();
        let why = match end {
            End::Stopped => return,
            End::Lost(why) => why,
        };
        if was_open && began.elapsed() >= times.good {
            back_off.reset();
        }
        let wait = back_off.next_wait();
        if events.send(LinkEvent::Waiting { why, wait }).await.is_err() {
            return;
        }
        tokio::select! {
            () = tokio::time::sleep(wait) => {}
            () = stopped(&mut stop) => return,
        }
    }
}

/// Completes when an end is asked for, or when no one is left who could ask for it.
async fn stopped(stop: &mut watch::Receiver<bool>) {
    // An error means that the sender is gone.
    let _ = stop.wait_for(|stop| *stop).await;
}

async fn connection<S: Source>(
    broker: &Broker,
    shared: &Shared<S>,
    times: LinkTimes,
    events: &mpsc::Sender<LinkEvent>,
    stop: &mut watch::Receiver<bool>,
) -> End {
    let (client_id, will) = {
        let mut source = shared.lock();
        (source.client_id(), source.will())
    };
    let mut options = match broker.options(&client_id, will, times.connect) {
        Ok(options) => options,
        Err(error) => return End::Lost(error.to_string()),
    };
    options.set_inflight(IN_FLIGHT);
    // One message at most waits with the library, so that what is sent is new.
    let (client, mut driver) = match AsyncClient::builder(options).capacity(1).try_build() {
        Ok(built) => built,
        Err(error) => return End::Lost(error.to_string()),
    };
    let mut network = NetworkOptions::new();
    network.set_connection_timeout(times.connect.as_secs().max(1));
    driver.set_network_options(network);
    let up = Notify::new();
    tokio::select! {
        end = drive(&mut driver, broker, shared, &up, events) => end,
        () = feed(&client, shared, times, &up, stop) => End::Stopped,
    }
}

/// Reads and writes the connection until it ends.
async fn drive<S: Source>(
    driver: &mut EventLoop,
    broker: &Broker,
    shared: &Shared<S>,
    up: &Notify,
    events: &mpsc::Sender<LinkEvent>,
) -> End {
    let mut note = None;
    loop {
        if let Some(note) = note.take() {
            // Without a receiver the program ends.
            let _ = events.send(LinkEvent::Note(note)).await;
        }
        match driver.poll().await {
            Ok(Event::Incoming(Packet::ConnAck(_))) => {
                shared.is_open.store(true, Ordering::Relaxed);
                shared.made.fetch_add(1, Ordering::Relaxed);
                shared.lock().connected(Instant::now());
                up.notify_one();
                let _ = events.send(LinkEvent::Connected).await;
            }
            Ok(Event::Incoming(Packet::PubAck(_))) => {
                shared.acknowledged.fetch_add(1, Ordering::Relaxed);
            }
            Ok(Event::Incoming(Packet::SubAck(answer)))
                if answer.return_codes.contains(&SubscribeReasonCode::Failure) =>
            {
                note = Some("the broker refuses the subscription; check the rights of the user there".to_owned());
            }
            Ok(Event::Incoming(Packet::Publish(message))) => {
                shared.received.fetch_add(1, Ordering::Relaxed);
                let topic = String::from_utf8_lossy(&message.topic);
                note = Some(shared.update(|source| source.received(&topic, &message.payload)));
            }
            Ok(_) => {}
            Err(ConnectionError::RequestsDone) => return End::Stopped,
            Err(error) => {
                return End::Lost(broker.explained(&error, shared.is_open.load(Ordering::Relaxed)));
            }
        }
    }
}

/// Hands messages to the connection, once there is one. Ends after an end was asked for.
async fn feed<S: Source>(
    client: &AsyncClient,
    shared: &Shared<S>,
    times: LinkTimes,
    up: &Notify,
    stop: &mut watch::Receiver<bool>,
) {
    tokio::select! {
        () = up.notified() => {}
        () = stopped(stop) => return,
    }
    let subscriptions = shared.lock().subscriptions();
    let sending = async {
        for topic in subscriptions {
            let _ = client.subscribe(topic, QoS::AtLeastOnce).await;
        }
        loop {
            while let Some(message) = shared.next() {
                let size = message.payload.len() as u64;
                let options = options(&message);
                if client.publish(message.topic, message.payload, options).await.is_ok() {
                    shared.sent.fetch_add(1, Ordering::Relaxed);
                    shared.bytes.fetch_add(size, Ordering::Relaxed);
                }
            }
            shared.work.notified().await;
        }
    };
    tokio::select! {
        () = sending => {}
        () = stopped(stop) => {}
    }
    let last = shared.lock().farewell();
    let ending = async {
        let options = options(&last);
        if let Ok(notice) = client.publish_tracked(last.topic, last.payload, options).await {
            let _ = notice.wait_completion_async().await;
        }
        let _ = client.disconnect().await;
        // The other half of the connection ends both.
        std::future::pending::<()>().await;
    };
    // A broker that does not answer publishes the will.
    let _ = tokio::time::timeout(times.farewell, ending).await;
}

const fn options(message: &Message) -> PublishOptions {
    let qos = if message.acknowledged {
        QoS::AtLeastOnce
    } else {
        QoS::AtMostOnce
    };
    PublishOptions::new(qos).retain(message.retained)
}
