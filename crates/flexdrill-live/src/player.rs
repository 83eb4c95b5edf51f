//! A bag as the source of live data: played in its own time, faster or slower, paused, and from any time on.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use foxglove::websocket::{PlaybackCommand, PlaybackControlRequest, PlaybackState, PlaybackStatus};

use crate::LiveError;
use crate::backlog::Backlog;
use crate::hub::Hub;
use flexdrill_bag::{Bag, BagMessage};
use flexdrill_messages::{AlarmList, Message as _};
use flexdrill_text::{log_ending, printable};

/// After a seek, viewers get the newest message of each topic from this long before the new time (ns). Every topic of
/// the node that is not latched has at least one message per second.
const BEFORE: u64 = 2_000_000_000;
/// Interval at which viewers get the time.
const TIME_INTERVAL: Duration = Duration::from_millis(100);
/// Largest lag of playback (wall time). Beyond it the playback clock is set back: a bag may hold more messages per
/// second than can be read.
const MOST_BEHIND: Duration = Duration::from_millis(250);
/// Slowest and fastest playback.
const SPEEDS: std::ops::RangeInclusive<f32> = 0.01..=100.0;
/// Largest number of latched messages kept for seeking.
const MOST_STATES: usize = 20_000;

/// The latched messages of a bag, as far as it has been read: after a seek, the newest ones before the new time apply.
#[derive(Debug, Default)]
pub struct LatchedStates(Mutex<Vec<(u64, usize, Vec<u8>)>>);

impl LatchedStates {
    /// Adds a message of the bag. The caller reads the bag in time order.
    pub fn observe(&self, message: &BagMessage) {
        let latched = message.topic.qos.iter().any(|qos| qos.transient_local);
        // The list of alarms is large, and the bag holds it every second.
        if !latched || message.topic.ros_type == AlarmList::ROS_TYPE {
            return;
        }
        let mut states = locked(&self.0);
        if states.len() < MOST_STATES {
            states.push((time_of(message), message.topic_index, message.data.clone()));
        }
    }

    /// The newest message of each topic up to `time`.
    fn before(&self, time: u64) -> BTreeMap<usize, (u64, Vec<u8>)> {
        let states = locked(&self.0);
        let before = states.iter().take_while(|(at, ..)| *at <= time);
        before.map(|(at, topic, data)| (*topic, (*at, data.clone()))).collect()
    }
}

/// First and last time of a bag (ns since 1970).
///
/// # Errors
/// When the bag has no message.
pub fn range(bag: &Bag, path: &Path) -> Result<(u64, u64), LiveError> {
    let time = |time: i64| u64::try_from(time).unwrap_or(0);
    let (start, end) = bag
        .bounds()
        .ok_or_else(|| LiveError::EmptyBag { path: path.to_owned() })?;
    Ok((time(start), time(end).max(time(start) + 1)))
}

struct Playback {
    playing: bool,
    speed: f32,
    /// An instant and the bag's time at it, from which the present time follows.
    anchor: (Instant, u64),
    ended: bool,
    /// The requested time, until the player has sought it.
    seek: Option<u64>,
    stop: bool,
}

impl Playback {
    fn time(&self, now: Instant, end: u64) -> u64 {
        let (since, time) = self.anchor;
        if !self.playing {
            return time;
        }
        let elapsed = now.saturating_duration_since(since).as_secs_f64() * f64::from(self.speed);
        time.saturating_add((elapsed * 1e9) as u64).min(end)
    }

    fn status(&self) -> PlaybackStatus {
        match (self.playing, self.ended) {
            (_, true) => PlaybackStatus::Ended,
            (true, false) => PlaybackStatus::Playing,
            (false, false) => PlaybackStatus::Paused,
        }
    }

    /// The state as the protocol carries it.
    fn message(&self, current_time: u64, did_seek: bool) -> PlaybackState {
        PlaybackState {
            status: self.status(),
            current_time,
            playback_speed: self.speed,
            did_seek,
            request_id: None,
        }
    }
}

/// Plays a bag: publishes its messages when they are due.
pub struct Player {
    state: Mutex<Playback>,
    changed: Condvar,
    /// First and last time of the bag (ns since 1970).
    range: (u64, u64),
}

/// A running player; dropping it ends the playback.
pub struct Playing {
    player: Arc<Player>,
    thread: Option<JoinHandle<()>>,
}

/// The destination of a player's messages.
struct Output {
    hub: Arc<Hub>,
    states: Arc<LatchedStates>,
}

impl Player {
    /// Plays a bag from its beginning. The hub must have the bag's topics. The caller fills `states` meanwhile by
    /// reading the bag.
    ///
    /// # Errors
    /// When the system refuses a thread.
    pub fn start(
        bag: Bag,
        range: (u64, u64),
        hub: &Arc<Hub>,
        states: &Arc<LatchedStates>,
    ) -> Result<Playing, LiveError> {
        let player = Arc::new(Self {
            state: Mutex::new(Playback {
                playing: true,
                speed: 1.0,
                anchor: (Instant::now(), range.0),
                ended: false,
                seek: Some(range.0),
                stop: false,
            }),
            changed: Condvar::new(),
            range,
        });
        hub.set_player(Arc::clone(&player));
        let output = Output {
            hub: Arc::clone(hub),
            states: Arc::clone(states),
        };
        let working = Arc::clone(&player);
        let thread = std::thread::Builder::new()
            .name("player".into())
            .spawn(move || working.play(bag, &output))?;
        Ok(Playing {
            player,
            thread: Some(thread),
        })
    }

    /// First and last time of the bag (ns since 1970).
    pub(crate) fn range(&self) -> (u64, u64) {
        self.range
    }

    /// Carries out a viewer's request, and sends the new state to all viewers.
    pub(crate) fn control(&self, request: &PlaybackControlRequest, hub: &Hub) {
        let mut state = locked(&self.state);
        let now = Instant::now();
        let mut time = state.time(now, self.range.1);
        state.playing = request.playback_command == PlaybackCommand::Play;
        if SPEEDS.contains(&request.playback_speed) {
            state.speed = request.playback_speed;
        }
        let again = state.playing && state.ended;
        let seek = request.seek_time.or(again.then_some(self.range.0));
        if let Some(wanted) = seek {
            time = wanted.clamp(self.range.0, self.range.1);
            state.seek = Some(time);
            state.ended = false;
        }
        state.anchor = (now, time);
        let mut answer = state.message(time, seek.is_some());
        answer.request_id = Some(request.request_id.clone());
        // The lock is held until the state is sent, so that no viewer gets an older state after a newer one.
        hub.broadcast_playback(&answer);
        drop(state);
        self.changed.notify_all();
    }

    /// Sends the state to a new viewer.
    pub(crate) fn greet(&self, backlog: &Backlog) {
        let state = locked(&self.state);
        let now = state.message(state.time(Instant::now(), self.range.1), false);
        backlog.time(now.current_time);
        backlog.answer(&now);
    }

    fn play(&self, mut bag: Bag, output: &Output) {
        let mut next: Option<BagMessage> = None;
        let mut time_sent = Instant::now();
        loop {
            let mut state = locked(&self.state);
            if state.stop {
                return;
            }
            // A seek comes before everything else, also while paused: the picture of that instant is shown at once.
            if let Some(time) = state.seek.take() {
                drop(state);
                next = publish_state_at(&mut bag, time, output);
                // The playback clock does not run while the bag is searched.
                // Another seek may have come meanwhile. Its time counts then, and this one must not set the clock.
                let mut state = locked(&self.state);
                if state.seek.is_none() {
                    state.anchor = (Instant::now(), time);
                }
                continue;
            }
            // The condition releases the lock while it waits, and any change of the state wakes it.
            if !state.playing {
                drop(self.changed.wait(state));
                continue;
            }
            let now = Instant::now();
            // At the end the player waits for a seek or stops; the bag stays open for that.
            let Some(message) = &next else {
                self.end(state, output);
                continue;
            };
            let (due, time) = (time_of(message), state.time(now, self.range.1));
            if due > time {
                // Waits are bounded, because the viewers' clock must advance through gaps in the bag.
                let wait = Duration::from_nanos(((due - time) as f64 / f64::from(state.speed)) as u64);
                drop(self.changed.wait_timeout(state, wait.min(TIME_INTERVAL)));
            } else {
                // A machine that is too slow would fall behind without limit, and then send everything at once. The
                // clock is set back instead.
                let behind = Duration::from_nanos(((time - due) as f64 / f64::from(state.speed)) as u64);
                if behind > MOST_BEHIND {
                    state.anchor = (now, due);
                }
                // The lock is released before publishing: controls must never wait for the hub.
                drop(state);
                if let Some(message) = next.take() {
                    output.hub.publish(message.topic_index, due, message.data);
                }
                next = next_readable(&mut bag);
            }
            if time_sent.elapsed() >= TIME_INTERVAL {
                time_sent = Instant::now();
                output.hub.broadcast_time(time);
            }
        }
    }

    fn end(&self, mut state: MutexGuard<'_, Playback>, output: &Output) {
        state.anchor = (Instant::now(), self.range.1);
        (state.playing, state.ended) = (false, true);
        output.hub.broadcast_playback(&state.message(self.range.1, false));
    }
}

impl Drop for Playing {
    fn drop(&mut self) {
        locked(&self.player.state).stop = true;
        self.player.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            // The thread checks the flag between two messages.
            let _ = thread.join();
        }
    }
}

/// Publishes the state of every topic at `time`. Returns the first message after it.
fn publish_state_at(bag: &mut Bag, time: u64, output: &Output) -> Option<BagMessage> {
    bag.seek(i64::try_from(time.saturating_sub(BEFORE)).unwrap_or(i64::MAX));
    let mut newest = output.states.before(time);
    let next = loop {
        match next_readable(bag) {
            Some(message) if time_of(&message) <= time => {
                newest.insert(message.topic_index, (time_of(&message), message.data));
            }
            after => break after,
        }
    };
    output.hub.clear_latched();
    let mut current: Vec<_> = newest.into_iter().collect();
    current.sort_by_key(|(_, (at, _))| *at);
    for (topic, (at, data)) in current {
        output.hub.publish(topic, at, data);
    }
    output.hub.broadcast_time(time);
    next
}

/// The next readable message; defects of the bag are logged.
fn next_readable(bag: &mut Bag) -> Option<BagMessage> {
    loop {
        match bag.next()? {
            Ok(message) => return Some(message),
            Err(error) => {
                if let Some(more) = log_ending("defect of the bag") {
                    tracing::warn!("{}{more}", printable(&error.to_string()));
                }
            }
        }
    }
}

fn time_of(message: &BagMessage) -> u64 {
    u64::try_from(message.log_time).unwrap_or(0)
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
