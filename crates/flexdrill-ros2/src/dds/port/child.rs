//! One life of the DDS process.

use std::io::{self, BufReader, Write};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::{CommandExt as _, ExitStatusExt as _};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::inbox::{ReplyTo, Request, Sample};
use super::{Shared, TopicCounters};
use crate::dds::frames::{self, Beat, FromSide, LogLevel, Stall, ToSide};
use crate::dds::plan::{GuidPrefix, Plan};
use crate::dds::side::{LAST_REPLIES, SUBCOMMAND};
use flexdrill_realtime::monotonic;

/// Longest a write may take before it is looked whether the process still lives.
const WRITE: Duration = Duration::from_millis(100);
/// How long it may take to leave the network: it waits for its last replies, and then says that it goes.
const LEAVE: Duration = LAST_REPLIES.saturating_add(Duration::from_secs(2));

/// The process and the thread that hears it.
pub(super) struct Child {
    process: std::process::Child,
    socket: UnixStream,
    heard: Arc<Heard>,
    thread: Option<JoinHandle<()>>,
}

/// What the process has said.
#[derive(Default)]
pub(super) struct Heard {
    /// It has joined the network, as this participant.
    up: Mutex<Option<GuidPrefix>>,
    /// When it was last well (ns of the monotonic clock).
    beat: AtomicU64,
    /// It says nothing any more.
    ended: AtomicBool,
    failure: Mutex<Option<String>>,
    written: Mutex<Vec<(u64, u64)>>,
    published: Mutex<Vec<u64>>,
}

impl Child {
    /// Starts it.
    ///
    /// # Errors
    /// When the system does not start another process of this program.
    pub(super) fn start(plan: &Plan, life: u64, shared: &Arc<Shared>, told: &Told) -> io::Result<Self> {
        let (socket, theirs) = UnixStream::pair()?;
        // A program that was replaced on disk meanwhile still finds itself here.
        let program = if cfg!(target_os = "linux") {
            "/proc/self/exe".into()
        } else {
            std::env::current_exe()?
        };
        let process = Command::new(program)
            .arg0("flexdrill")
            .arg(SUBCOMMAND)
            // The backtrace of a refused allocation tells what its line in the log does.
            .env("RUST_BACKTRACE", "0")
            .stdin(Stdio::from(OwnedFd::from(theirs)))
            .stdout(Stdio::null())
            // Ctrl-C in a terminal is for the node, which then ends this one in order.
            .process_group(0)
            .spawn()?;
        socket.set_write_timeout(Some(WRITE))?;
        let heard = Arc::new(Heard {
            written: Mutex::new(vec![(0, 0); shared.writers.len()]),
            published: Mutex::new(vec![0; shared.writers.len()]),
            ..Heard::default()
        });
        let hearing = Hearing {
            life,
            heard: Arc::clone(&heard),
            shared: Arc::clone(shared),
            told: told.clone(),
        };
        let from = BufReader::new(socket.try_clone()?);
        let thread = std::thread::Builder::new()
            .name("from dds".into())
            .spawn(move || hearing.run(from))?;
        let mut child = Self {
            process,
            socket,
            heard,
            thread: Some(thread),
        };
        child.send(&ToSide::Begin(plan.clone()))?;
        Ok(child)
    }

    /// Sends a frame; waits while the process takes it slowly.
    ///
    /// # Errors
    /// When it has ended, or takes nothing for longer than it may be silent.
    pub(super) fn send(&mut self, frame: &ToSide) -> io::Result<()> {
        if let ToSide::Publish { writer, .. } = frame {
            let mut published = self.heard.published.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(count) = published.get_mut(usize::from(*writer)) {
                *count += 1;
            }
        }
        let bytes = frames::encode(frame)?;
        let mut left = bytes.as_slice();
        let began = Instant::now();
        while !left.is_empty() {
            match self.socket.write(left) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(written) => left = &left[written..],
                Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                    if began.elapsed() > super::keeper::SILENCE {
                        return Err(error);
                    }
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// The participant as which it has joined the network.
    pub(super) fn up(&self) -> Option<GuidPrefix> {
        *self.heard.up.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How long it has not said that it is well.
    pub(super) fn silent(&self) -> Duration {
        let beat = self.heard.beat.load(Ordering::Acquire);
        Duration::from_nanos(monotonic::now().saturating_sub(beat))
    }

    /// The silence so far is forgiven: this process itself stood still.
    pub(super) fn forgive(&self) {
        self.heard.beat.store(monotonic::now(), Ordering::Release);
    }

    /// Whether it has ended or says nothing any more.
    pub(super) fn has_ended(&mut self) -> bool {
        self.heard.ended.load(Ordering::Acquire) || matches!(self.process.try_wait(), Ok(Some(_)) | Err(_))
    }

    /// Has it leave the network, and ends it.
    pub(super) fn leave(mut self) {
        if self.send(&ToSide::End).is_ok() {
            let deadline = Instant::now() + LEAVE;
            while !self.has_ended() && Instant::now() < deadline {
                std::thread::sleep(Duration::from_millis(2));
            }
            // It closes its end just before it ends.
            std::thread::sleep(Duration::from_millis(2));
        }
        self.end(&[]);
    }

    /// Ends it. What it did not get through to DDS is counted as dropped; why it ended, as far as it or the system says.
    pub(super) fn end(mut self, counters: &[Arc<TopicCounters>]) -> Option<String> {
        let ended = self.process.try_wait().ok().flatten();
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = self.socket.shutdown(std::net::Shutdown::Both);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        let published = self.heard.published.lock().unwrap_or_else(PoisonError::into_inner);
        let written = self.heard.written.lock().unwrap_or_else(PoisonError::into_inner);
        for ((counter, published), (sent, dropped)) in counters.iter().zip(published.iter()).zip(written.iter()) {
            let lost = published.saturating_sub(sent + dropped);
            counter.dropped.fetch_add(lost, Ordering::Relaxed);
        }
        let failure = self.heard.failure.lock().unwrap_or_else(PoisonError::into_inner).take();
        failure.or_else(|| ended.and_then(describe))
    }
}

fn describe(status: ExitStatus) -> Option<String> {
    match (status.signal(), status.code()) {
        (Some(6), _) => Some(
            "it ended with signal 6 (abort), as it does when a packet makes it ask for more memory than it may have"
                .into(),
        ),
        (Some(signal), _) => Some(format!("it was ended by signal {signal}")),
        (None, None | Some(0)) => None,
        (None, Some(code)) => Some(format!("it ended with code {code}")),
    }
}

/// Tells whoever waits for the first start how that went.
#[derive(Clone)]
pub(super) struct Told(pub(super) Sender<Result<(), String>>);

/// The thread that hears the process.
struct Hearing {
    life: u64,
    heard: Arc<Heard>,
    shared: Arc<Shared>,
    told: Told,
}

impl Hearing {
    fn run(self, mut from: BufReader<UnixStream>) {
        self.heard.beat.store(monotonic::now(), Ordering::Release);
        while let Ok(Some(frame)) = frames::read(&mut from) {
            self.take(frame);
        }
        self.heard.ended.store(true, Ordering::Release);
        self.shared.outbox.wake();
    }

    fn take(&self, frame: FromSide) {
        match frame {
            FromSide::Up(prefix) => {
                *self.heard.up.lock().unwrap_or_else(PoisonError::into_inner) = Some(prefix);
                self.heard.beat.store(monotonic::now(), Ordering::Release);
                {
                    let mut health = self.shared.health();
                    (health.is_up, health.participant) = (true, Some(prefix));
                }
                self.shared.outbox.open(self.life);
                // Who waited for that may have gone.
                let _ = self.told.0.send(Ok(()));
            }
            FromSide::Failed(why) => {
                *self.heard.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
            }
            FromSide::Sample { reader, writer, body } => self.sample(reader, Sample::Body { writer, body }),
            FromSide::Unreadable { reader, why } => self.sample(reader, Sample::Unreadable(why)),
            FromSide::Request {
                service,
                ticket,
                client,
                sequence,
                sent,
                body,
            } => {
                if self
                    .shared
                    .is_to_be_taken(usize::from(service), &client, sequence, sent)
                    && let Some(inbox) = self.shared.services.get(usize::from(service))
                {
                    let reply_to = ReplyTo::Dds {
                        life: self.life,
                        ticket,
                    };
                    inbox.push(Request::of_a_client(reply_to, client, body, &self.shared.open));
                }
            }
            FromSide::Beat(beat) => self.beat(&beat),
            FromSide::Peers(peers) => *self.shared.peers() = peers,
            FromSide::Log { level, text } => match level {
                LogLevel::Error => tracing::error!("{text}"),
                LogLevel::Warning => tracing::warn!("{text}"),
                LogLevel::Info => tracing::info!("{text}"),
                LogLevel::Debug => tracing::debug!("{text}"),
            },
            FromSide::Stalled(stall) => self.stalled(&stall),
        }
    }

    fn sample(&self, reader: u16, sample: Sample) {
        if let Some(inbox) = self.shared.readers.get(usize::from(reader)) {
            inbox.push(sample);
        }
    }

    fn beat(&self, beat: &Beat) {
        self.heard.beat.store(monotonic::now(), Ordering::Release);
        self.shared.health().memory = beat.memory;
        let mut before = self.heard.written.lock().unwrap_or_else(PoisonError::into_inner);
        for ((counters, now), before) in self.shared.writers.iter().zip(&beat.written).zip(before.iter_mut()) {
            counters
                .sent
                .fetch_add(now.0.saturating_sub(before.0), Ordering::Relaxed);
            counters
                .dropped
                .fetch_add(now.1.saturating_sub(before.1), Ordering::Relaxed);
            *before = *now;
        }
    }

    fn stalled(&self, stall: &Stall) {
        let readers: Vec<String> = stall.readers.iter().map(ToString::to_string).collect();
        let who = match (readers.as_slice(), stall.is_certain) {
            ([], _) => "a reader that has gone since".to_owned(),
            (readers, true) => readers.join(" and "),
            (readers, false) => format!("one of {}", readers.join(", ")),
        };
        let text = format!(
            "{}: {who} asked for every sample and does not take them; what it left lying is given up so that others get theirs",
            stall.topic
        );
        tracing::warn!("{text}");
        self.shared.health().stalled = Some((monotonic::now(), text));
    }
}
