//! A bag as a source of live data: played at its own times, faster or slower, paused, and from any place on.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use foxglove::websocket::{PlaybackCommand, PlaybackControlRequest, PlaybackState, PlaybackStatus};

use super::LiveError;
use super::backlog::Backlog;
use super::hub::Hub;
use crate::bag::{Bag, BagMessage};
use crate::messages::{AlarmList, Message as _};
use flexdrill_text::printable;

/// After a jump, what stands there is told: of each topic the newest message of so long before (ns). Every topic of the
/// node that is not latched comes at least each second.
const BEFORE: u64 = 2_000_000_000;
/// How often viewers are told the time.
const TIME_INTERVAL: Duration = Duration::from_millis(100);
/// Wall time that playing may be behind until its clock waits for it: a bag may hold more per second than can be read.
const MOST_BEHIND: Duration = Duration::from_millis(250);
/// Slowest and fastest playing.
const SPEEDS: std::ops::RangeInclusive<f32> = 0.01..=100.0;
/// Latched messages that are kept to be told after a jump.
const MOST_STATES: usize = 20_000;

/// The latched messages of a bag, as far as it has been read: after a jump the newest before it hold.
#[derive(Debug, Default)]
pub struct States(Mutex<Vec<(u64, usize, Vec<u8>)>>);

impl States {
    /// Takes a message of the bag, in the order of time.
    pub fn observe(&self, message: &BagMessage) {
        let latched = message.topic.qos.iter().any(|qos| qos.transient_local);
        // The list of alarms comes each second, and is large.
        if !latched || message.topic.ros_type == AlarmList::ROS_TYPE {
            return;
        }
        let mut states = locked(&self.0);
        if states.len() < MOST_STATES {
            states.push((time_of(message), message.topic_index, message.data.clone()));
        }
    }

    /// Per topic, the newest before `time`.
    fn before(&self, time: u64) -> BTreeMap<usize, (u64, Vec<u8>)> {
        let states = locked(&self.0);
        let before = states.iter().take_while(|(at, ..)| *at <= time);
        before.map(|(at, topic, data)| (*topic, (*at, data.clone()))).collect()
    }
}

/// First and last time of a bag (ns since 1970).
///
/// # Errors
/// When there is no message in it.
pub(crate) fn range(bag: &Bag, path: &Path) -> Result<(u64, u64), LiveError> {
    let time = |time: i64| u64::try_from(time).unwrap_or(0);
    let (start, end) = bag
        .bounds()
        .ok_or_else(|| LiveError::EmptyBag { path: path.to_owned() })?;
    Ok((time(start), time(end).max(time(start) + 1)))
}

/// Time of the bag at an instant, and how it goes on from there.
struct State {
    playing: bool,
    speed: f32,
    /// At this instant it was this time of the bag.
    anchor: (Instant, u64),
    ended: bool,
    /// To go there.
    seek: Option<u64>,
    stop: bool,
}

impl State {
    fn time(&self, now: Instant, end: u64) -> u64 {
        let (since, time) = self.anchor;
        if !self.playing {
            return time;
        }
        let gone = now.saturating_duration_since(since).as_secs_f64() * f64::from(self.speed);
        time.saturating_add((gone * 1e9) as u64).min(end)
    }

    fn status(&self) -> PlaybackStatus {
        match (self.playing, self.ended) {
            (_, true) => PlaybackStatus::Ended,
            (true, false) => PlaybackStatus::Playing,
            (false, false) => PlaybackStatus::Paused,
        }
    }

    /// What viewers hear of it.
    fn told(&self, current_time: u64, did_seek: bool) -> PlaybackState {
        PlaybackState {
            status: self.status(),
            current_time,
            playback_speed: self.speed,
            did_seek,
            request_id: None,
        }
    }
}

/// Decides what of a bag is told when.
pub struct Player {
    state: Mutex<State>,
    changed: Condvar,
    /// First and last time of the bag (ns since 1970).
    range: (u64, u64),
}

/// A player at work, until it is dropped.
pub struct Playing {
    player: Arc<Player>,
    thread: Option<JoinHandle<()>>,
}

/// What a player speaks to.
struct Stage {
    hub: Arc<Hub>,
    states: Arc<States>,
}

impl Player {
    /// Plays a bag, whose topics are those of the hub, from its beginning on. `states` are filled meanwhile by who
    /// reads the bag through.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(bag: Bag, range: (u64, u64), hub: &Arc<Hub>, states: &Arc<States>) -> Result<Playing, LiveError> {
        let player = Arc::new(Self {
            state: Mutex::new(State {
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
        let stage = Stage {
            hub: Arc::clone(hub),
            states: Arc::clone(states),
        };
        let working = Arc::clone(&player);
        let thread = std::thread::Builder::new()
            .name("player".into())
            .spawn(move || working.play(bag, &stage))?;
        Ok(Playing {
            player,
            thread: Some(thread),
        })
    }

    /// First and last time of the bag (ns since 1970).
    pub(super) fn range(&self) -> (u64, u64) {
        self.range
    }

    /// Carries a viewer's request out, and sends all viewers how it plays from then on.
    pub(super) fn control(&self, request: &PlaybackControlRequest, hub: &Hub) {
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
        let mut answer = state.told(time, seek.is_some());
        answer.request_id = Some(request.request_id.clone());
        // The state cannot change meanwhile, so that no viewer hears an older one after a newer.
        hub.broadcast_playback(&answer);
        drop(state);
        self.changed.notify_all();
    }

    /// Sends a new viewer how it plays.
    pub(super) fn greet(&self, backlog: &Backlog) {
        let state = locked(&self.state);
        let now = state.told(state.time(Instant::now(), self.range.1), false);
        backlog.time(now.current_time);
        backlog.answer(&now);
    }

    fn play(&self, mut bag: Bag, stage: &Stage) {
        let mut next: Option<BagMessage> = None;
        let mut told = Instant::now();
        loop {
            let mut state = locked(&self.state);
            if state.stop {
                return;
            }
            if let Some(time) = state.seek.take() {
                drop(state);
                next = show(&mut bag, time, stage);
                // The clock stood still while the bag was searched.
                let mut state = locked(&self.state);
                if state.seek.is_none() {
                    state.anchor = (Instant::now(), time);
                }
                continue;
            }
            if !state.playing {
                drop(self.changed.wait(state));
                continue;
            }
            let now = Instant::now();
            let Some(message) = &next else {
                self.end(state, stage);
                continue;
            };
            let (due, time) = (time_of(message), state.time(now, self.range.1));
            if due > time {
                let wait = Duration::from_nanos(((due - time) as f64 / f64::from(state.speed)) as u64);
                drop(self.changed.wait_timeout(state, wait.min(TIME_INTERVAL)));
            } else {
                let behind = Duration::from_nanos(((time - due) as f64 / f64::from(state.speed)) as u64);
                if behind > MOST_BEHIND {
                    state.anchor = (now, due);
                }
                drop(state);
                if let Some(message) = next.take() {
                    stage.hub.publish(message.topic_index, due, message.data);
                }
                next = following(&mut bag);
            }
            if told.elapsed() >= TIME_INTERVAL {
                told = Instant::now();
                stage.hub.broadcast_time(time);
            }
        }
    }

    fn end(&self, mut state: MutexGuard<'_, State>, stage: &Stage) {
        state.anchor = (Instant::now(), self.range.1);
        (state.playing, state.ended) = (false, true);
        stage.hub.broadcast_playback(&state.told(self.range.1, false));
    }
}

impl Drop for Playing {
    fn drop(&mut self) {
        locked(&self.player.state).stop = true;
        self.player.changed.notify_all();
        if let Some(thread) = self.thread.take() {
            // It looks at the flag between two messages.
            let _ = thread.join();
        }
    }
}

/// Tells what stands at `time`; the first message after it.
fn show(bag: &mut Bag, time: u64, stage: &Stage) -> Option<BagMessage> {
    bag.seek(i64::try_from(time.saturating_sub(BEFORE)).unwrap_or(i64::MAX));
    let mut newest = stage.states.before(time);
    let next = loop {
        match following(bag) {
            Some(message) if time_of(&message) <= time => {
                newest.insert(message.topic_index, (time_of(&message), message.data));
            }
            after => break after,
        }
    };
    stage.hub.forget();
    let mut standing: Vec<_> = newest.into_iter().collect();
    standing.sort_by_key(|(_, (at, _))| *at);
    for (topic, (at, data)) in standing {
        stage.hub.publish(topic, at, data);
    }
    stage.hub.broadcast_time(time);
    next
}

/// The next message that can be read; what cannot is told.
fn following(bag: &mut Bag) -> Option<BagMessage> {
    loop {
        match bag.next()? {
            Ok(message) => return Some(message),
            Err(error) => tracing::warn!("{}", printable(&error.to_string())),
        }
    }
}

fn time_of(message: &BagMessage) -> u64 {
    u64::try_from(message.log_time).unwrap_or(0)
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
