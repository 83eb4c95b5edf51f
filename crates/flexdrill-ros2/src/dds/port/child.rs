//! The DDS process, from its start to its end.

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

use super::inbox::{Request, Sample};
use super::keeper::{LONGEST_SILENCE, SILENCE};
use super::run_delay::RunDelay;
use super::{Shared, TopicCounters};
use crate::dds::frames::{self, Beat, FromSide, LogLevel, Stall, ToSide};
use crate::dds::plan::{GuidPrefix, Plan};
use crate::dds::side::{LAST_REPLIES, SUBCOMMAND};
use flexdrill_clock::monotonic;
use flexdrill_text::log_ending;

/// Longest write before the state of the process is checked.
const WRITE: Duration = Duration::from_millis(100);
/// Longest time for leaving the network: the process waits for its last replies, then announces that it leaves.
const LEAVE: Duration = LAST_REPLIES.saturating_add(Duration::from_secs(2));

/// The process, and the thread that reads from it.
pub(super) struct Child {
    process: std::process::Child,
    socket: UnixStream,
    state: Arc<ChildState>,
    thread: Option<JoinHandle<()>>,
    /// Its wait for a processor since its latest report.
    delay: RunDelay,
    /// That report (ns of the monotonic clock).
    marked: u64,
}

/// The state that the process has reported.
#[derive(Default)]
pub(super) struct ChildState {
    /// The participant as which the process has joined the network.
    up: Mutex<Option<GuidPrefix>>,
    /// The latest report of its health (ns of the monotonic clock).
    beat: AtomicU64,
    /// The socket is closed.
    ended: AtomicBool,
    failure: Mutex<Option<String>>,
    written: Mutex<Vec<(u64, u64)>>,
    published: Mutex<Vec<u64>>,
}

impl Child {
    /// Starts the process.
    ///
    /// # Errors
    /// When the system does not start another process of this program.
    pub(super) fn start(plan: &Plan, life: u64, shared: &Arc<Shared>, report: &StartReport) -> io::Result<Self> {
        // One end of the pair is the child's standard input: no name in
        // the file system, and it closes with either process.
        let (socket, theirs) = UnixStream::pair()?;
        // This path leads to the running program also where its file was replaced meanwhile.
        let program = if cfg!(target_os = "linux") {
            "/proc/self/exe".into()
        } else {
            std::env::current_exe()?
        };
        let process = Command::new(program)
            .arg0("flexdrill")
            .arg(SUBCOMMAND)
            // The backtrace of a refused allocation would repeat its line in the log.
            .env("RUST_BACKTRACE", "0")
            .stdin(Stdio::from(OwnedFd::from(theirs)))
            .stdout(Stdio::null())
            // Ctrl-C in a terminal must reach the node only, which then ends this process in order.
            .process_group(0)
            .spawn()?;
        // A child that does not read must not hold up the keeper, which supervises it.
        socket.set_write_timeout(Some(WRITE))?;
        // Counters exist per writer from the beginning, so that a beat can be compared with them.
        let state = Arc::new(ChildState {
            written: Mutex::new(vec![(0, 0); shared.writers.len()]),
            published: Mutex::new(vec![0; shared.writers.len()]),
            ..ChildState::default()
        });
        let reader = ChildReader {
            life,
            state: Arc::clone(&state),
            shared: Arc::clone(shared),
            report: report.clone(),
        };
        let from = BufReader::new(socket.try_clone()?);
        // The thread ends by itself with the socket.
        let thread = std::thread::Builder::new()
            .name("from dds".into())
            .spawn(move || reader.run(from))?;
        let mut child = Self {
            delay: RunDelay::of(process.id()),
            marked: 0,
            process,
            socket,
            state,
            thread: Some(thread),
        };
        // The plan is the first frame. The child knows nothing before it.
        child.send(&ToSide::Begin(plan.clone()))?;
        Ok(child)
    }

    /// Sends a frame; waits while the process reads slowly.
    ///
    /// # Errors
    /// When the process has ended, or reads nothing for longer than [`SILENCE`] in which it could have run.
    pub(super) fn send(&mut self, frame: &ToSide) -> io::Result<()> {
        if let ToSide::Publish { writer, .. } = frame {
            let mut published = self.state.published.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(count) = published.get_mut(usize::from(*writer)) {
                *count += 1;
            }
        }
        let bytes = frames::encode(frame)?;
        let mut left = bytes.as_slice();
        let (began, mut delay) = (Instant::now(), None);
        while !left.is_empty() {
            match self.socket.write(left) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(written) => left = &left[written..],
                Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                    let delay = delay.get_or_insert_with(|| RunDelay::of(self.process.id()));
                    if is_too_long(began.elapsed(), delay) {
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
        *self.state.up.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Time since the latest report of its health.
    pub(super) fn silent(&self) -> Duration {
        let beat = self.state.beat.load(Ordering::Acquire);
        Duration::from_nanos(monotonic::now().saturating_sub(beat))
    }

    /// Time for which it has waited for a processor since its latest report.
    pub(super) fn waited(&self) -> Duration {
        self.delay.since_mark()
    }

    /// Whether it has not reported for longer than [`SILENCE`] in which it could have run.
    pub(super) fn is_silent(&mut self) -> bool {
        let beat = self.state.beat.load(Ordering::Acquire);
        if beat != self.marked {
            self.marked = beat;
            self.delay.mark();
        }
        is_too_long(self.silent(), &self.delay)
    }

    /// Restarts the count of its silence, because this process itself stood still.
    pub(super) fn restart_silence(&self) {
        self.state.beat.store(monotonic::now(), Ordering::Release);
    }

    /// Whether the process has ended or closed its socket.
    pub(super) fn has_ended(&mut self) -> bool {
        self.state.ended.load(Ordering::Acquire) || matches!(self.process.try_wait(), Ok(Some(_)) | Err(_))
    }

    /// Makes the process leave the network, and ends it.
    pub(super) fn leave(mut self) {
        if self.send(&ToSide::End).is_ok() {
            let deadline = Instant::now() + LEAVE;
            while !self.has_ended() && Instant::now() < deadline {
                std::thread::sleep(Duration::from_millis(2));
            }
            // The process closes its socket just before it ends.
            std::thread::sleep(Duration::from_millis(2));
        }
        self.end(&[]);
    }

    /// Ends the process, and counts the samples that did not reach DDS as dropped. Returns the cause of its end, where the
    /// process or the system states one.
    pub(super) fn end(mut self, counters: &[Arc<TopicCounters>]) -> Option<String> {
        let ended = self.process.try_wait().ok().flatten();
        let _ = self.process.kill();
        let _ = self.process.wait();
        let _ = self.socket.shutdown(std::net::Shutdown::Both);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        let published = self.state.published.lock().unwrap_or_else(PoisonError::into_inner);
        let written = self.state.written.lock().unwrap_or_else(PoisonError::into_inner);
        for ((counter, published), (sent, dropped)) in counters.iter().zip(published.iter()).zip(written.iter()) {
            let lost = published.saturating_sub(sent + dropped);
            counter.dropped.fetch_add(lost, Ordering::Relaxed);
        }
        let failure = self.state.failure.lock().unwrap_or_else(PoisonError::into_inner).take();
        failure.or_else(|| ended.and_then(describe))
    }
}

/// Whether a process that could have run has done nothing for too long. Its wait for a processor is looked up last, because
/// that reads some files.
fn is_too_long(silent: Duration, delay: &RunDelay) -> bool {
    silent > SILENCE && (silent > LONGEST_SILENCE || silent.saturating_sub(delay.since_mark()) > SILENCE)
}

fn describe(status: ExitStatus) -> Option<String> {
    match (status.signal(), status.code()) {
        (Some(6), _) => Some(
            "it ended with signal 6 (abort), as after a packet that makes it allocate more memory than its limit"
                .into(),
        ),
        (Some(signal), _) => Some(format!("it was ended by signal {signal}")),
        (None, None | Some(0)) => None,
        (None, Some(code)) => Some(format!("it ended with code {code}")),
    }
}

/// Reports the result of the first start.
#[derive(Clone)]
pub(super) struct StartReport(pub(super) Sender<Result<(), String>>);

/// Reads the frames of the process, on a separate thread.
struct ChildReader {
    life: u64,
    state: Arc<ChildState>,
    shared: Arc<Shared>,
    report: StartReport,
}

impl ChildReader {
    fn run(self, mut from: BufReader<UnixStream>) {
        self.state.beat.store(monotonic::now(), Ordering::Release);
        while let Ok(Some(frame)) = frames::read(&mut from) {
            self.handle(frame);
        }
        self.state.ended.store(true, Ordering::Release);
        self.shared.outbox.wake();
    }

    fn handle(&self, frame: FromSide) {
        match frame {
            FromSide::Up(prefix) => {
                // Participant and heartbeat are known before the outbox opens: from then on silence counts.
                *self.state.up.lock().unwrap_or_else(PoisonError::into_inner) = Some(prefix);
                self.state.beat.store(monotonic::now(), Ordering::Release);
                {
                    let mut health = self.shared.health();
                    (health.is_up, health.participant) = (true, Some(prefix));
                }
                // Only for this life of the process: frames of an earlier one may be on their way.
                self.shared.outbox.open(self.life);
                // The receiver may have given up waiting.
                let _ = self.report.0.send(Ok(()));
            }
            FromSide::Failed(why) => {
                *self.state.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
            }
            FromSide::Sample { reader, writer, body } => self.sample(reader, Sample::Body { writer, body }),
            FromSide::Unreadable { reader, why } => self.sample(reader, Sample::Unreadable(why)),
            FromSide::Request {
                service,
                id,
                client,
                sequence,
                sent,
                body,
            } => {
                // The child's numbers are not trusted further than their range.
                let index = usize::from(service);
                // Requests are judged before they wait, so that repeated and outdated ones take no place in the inbox.
                if let Some(judged) = self.shared.judge(index, &client, sequence, sent)
                    && let Some(inbox) = self.shared.services.get(index)
                {
                    let refused = judged.err();
                    inbox.push(Request::of_a_client(id, client, body, refused, &self.shared.open));
                }
            }
            // A reply that was written frees its place in the outbox.
            FromSide::Replied { service, to } => self.shared.outbox.replied(service, to),
            FromSide::Beat(beat) => self.beat(&beat),
            FromSide::Peers(peers) => *self.shared.peers() = peers,
            // The child does not log by itself: its lines reach `/rosout` through this process.
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
        self.state.beat.store(monotonic::now(), Ordering::Release);
        self.shared.health().memory = beat.memory;
        let mut before = self.state.written.lock().unwrap_or_else(PoisonError::into_inner);
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
            ([], _) => "a reader that has left since".to_owned(),
            (readers, true) => readers.join(" and "),
            (readers, false) => format!("one of {}", readers.join(", ")),
        };
        let text = format!(
            "{}: {who} requested every sample and does not acknowledge them; its pending samples are dropped so that other \
             readers get theirs",
            stall.topic
        );
        if let Some(more) = log_ending("stalled reader") {
            tracing::warn!("{text}{more}");
        }
        self.shared.health().stalled = Some((monotonic::now(), text));
    }
}
