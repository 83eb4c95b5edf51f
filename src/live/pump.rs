//! The way from the protocol's server to one viewer, with a queue that gives up its oldest messages and counts them.
//!
//! The protocol's crate would do that too, but does not say how many. Here its socket is always read, so that nothing is
//! lost there.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use flexdrill_realtime::monotonic;
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _, BufReader};
use tokio::sync::Notify;

use crate::told::Throttle;

/// Messages that a viewer may leave lying; then its oldest goes. At 20 kB each, the largest of the default tool, 5 MB.
pub(super) const BACKLOG: usize = 256;
/// Answers and notices that a viewer may leave lying; then it is let go, since none of them may be left out.
const MOST_ANSWERS: usize = 256;
/// Longest frame that the server may send: far above a message of 200 stations.
const MOST_BYTES: u64 = 64 << 20;
/// Bytes that are read at once.
const READ: usize = 64 << 10;
/// What the server has said last goes out in this time, or not.
const LAST_WORDS: Duration = Duration::from_secs(1);
/// Least time between two lines about one viewer (s).
const TOLD_INTERVAL: f64 = 10.0;

/// Bits of a frame's first two bytes (RFC 6455).
const OPCODE: u8 = 0x0f;
const BINARY: u8 = 2;
const MASKED: u8 = 0x80;
const LENGTH: u8 = 0x7f;
const TWO_BYTES: u8 = 126;
const EIGHT_BYTES: u8 = 127;
/// First byte of the protocol's binary messages that a newer one replaces: data of a topic, time.
const REPLACED: [u8; 2] = [1, 2];

/// A frame as it goes over the wire.
struct Frame {
    bytes: Vec<u8>,
    /// May be given up for newer ones.
    is_data: bool,
}

/// Frames on their way.
#[derive(Default)]
struct Queue {
    frames: VecDeque<Frame>,
    data: usize,
}

impl Queue {
    /// How many messages had to go for it; none where the viewer must be let go.
    fn push(&mut self, frame: Frame) -> Option<u64> {
        let mut given_up = 0;
        if frame.is_data {
            if self.data == BACKLOG
                && let Some(oldest) = self.frames.iter().position(|frame| frame.is_data)
            {
                self.frames.remove(oldest);
                given_up = 1;
            } else {
                self.data += 1;
            }
        } else if self.frames.len() - self.data == MOST_ANSWERS {
            return None;
        }
        self.frames.push_back(frame);
        Some(given_up)
    }

    fn pop(&mut self) -> Option<Frame> {
        let frame = self.frames.pop_front()?;
        self.data -= usize::from(frame.is_data);
        Some(frame)
    }
}

/// One viewer's queue.
pub(super) struct Pump {
    viewer: SocketAddr,
    queue: Mutex<Queue>,
    came: Notify,
    /// The server sends nothing more.
    closed: AtomicBool,
    given_up: AtomicU64,
}

impl Pump {
    /// To the viewer at that address.
    pub fn new(viewer: SocketAddr) -> Self {
        Self {
            viewer,
            queue: Mutex::default(),
            came: Notify::new(),
            closed: AtomicBool::new(false),
            given_up: AtomicU64::new(0),
        }
    }

    /// Hands frames over until either side goes.
    pub async fn run(&self, from: impl AsyncRead + Unpin, to: impl AsyncWrite + Unpin) {
        let mut give = pin!(self.give(to));
        tokio::select! {
            () = self.take(from) => {}
            _ = &mut give => return,
        }
        self.closed.store(true, Ordering::Release);
        self.came.notify_one();
        // A viewer that takes nothing is not waited for.
        let _ = tokio::time::timeout(LAST_WORDS, give).await;
    }

    async fn take(&self, from: impl AsyncRead + Unpin) {
        let mut from = BufReader::with_capacity(READ, from);
        let mut lines = Throttle::new(TOLD_INTERVAL);
        while let Ok(frame) = read(&mut from).await {
            let Some(gone) = self.lock().push(frame) else {
                tracing::warn!(
                    "the viewer at {} takes no answers: {MOST_ANSWERS} wait for it, which is the most; its connection is \
                     closed",
                    self.viewer
                );
                return;
            };
            self.came.notify_one();
            if gone > 0 {
                let given_up = self.given_up.fetch_add(gone, Ordering::Relaxed) + gone;
                if lines.pass(monotonic::now() as f64 * 1e-9).is_some() {
                    tracing::warn!(
                        "the viewer at {} does not take its data: {given_up} messages given up for it so far, {BACKLOG} wait; \
                         let it subscribe to less",
                        self.viewer
                    );
                }
            }
        }
    }

    async fn give(&self, mut to: impl AsyncWrite + Unpin) -> std::io::Result<()> {
        loop {
            let closed = self.closed.load(Ordering::Acquire);
            let next = self.lock().pop();
            match next {
                Some(frame) => to.write_all(&frame.bytes).await?,
                None if closed => return to.flush().await,
                None => {
                    to.flush().await?;
                    self.came.notified().await;
                }
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Pump {
    fn drop(&mut self) {
        let given_up = self.given_up.load(Ordering::Relaxed);
        if given_up > 0 {
            tracing::info!(
                "the viewer at {} has gone; {given_up} messages had been given up for it",
                self.viewer
            );
        }
    }
}

/// The next frame of a server, which masks nothing.
async fn read(from: &mut (impl AsyncRead + Unpin)) -> std::io::Result<Frame> {
    let mut bytes = vec![0; 2];
    from.read_exact(&mut bytes).await?;
    let (opcode, second) = (bytes[0] & OPCODE, bytes[1]);
    let more = match second & LENGTH {
        TWO_BYTES => 2,
        EIGHT_BYTES => 8,
        _ => 0,
    };
    if second & MASKED != 0 {
        return Err(std::io::ErrorKind::InvalidData.into());
    }
    bytes.resize(2 + more, 0);
    from.read_exact(&mut bytes[2..]).await?;
    let length = match more {
        0 => u64::from(second & LENGTH),
        _ => bytes[2..].iter().fold(0, |length, byte| length << 8 | u64::from(*byte)),
    };
    if length > MOST_BYTES {
        return Err(std::io::ErrorKind::InvalidData.into());
    }
    let head = bytes.len();
    bytes.resize(head + length as usize, 0);
    from.read_exact(&mut bytes[head..]).await?;
    let is_data = opcode == BINARY && bytes.get(head).is_some_and(|kind| REPLACED.contains(kind));
    Ok(Frame { bytes, is_data })
}

/// A text as one frame of a client.
pub(super) fn text_of_client(text: &str) -> Vec<u8> {
    /// The last frame of a text.
    const TEXT: u8 = 0x81;
    let mut bytes = vec![TEXT];
    match u16::try_from(text.len()) {
        Ok(length) if length < u16::from(TWO_BYTES) => bytes.push(MASKED | length as u8),
        Ok(length) => {
            bytes.push(MASKED | TWO_BYTES);
            bytes.extend(length.to_be_bytes());
        }
        Err(_) => {
            bytes.push(MASKED | EIGHT_BYTES);
            bytes.extend((text.len() as u64).to_be_bytes());
        }
    }
    // A mask of zeros is one.
    bytes.extend([0; 4]);
    bytes.extend(text.as_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(opcode: u8, payload: &[u8]) -> Vec<u8> {
        let mut bytes = vec![0x80 | opcode];
        match payload.len() {
            short if short < 126 => bytes.push(short as u8),
            long if long < 65536 => {
                bytes.push(126);
                bytes.extend((long as u16).to_be_bytes());
            }
            longest => {
                bytes.push(127);
                bytes.extend((longest as u64).to_be_bytes());
            }
        }
        bytes.extend(payload);
        bytes
    }

    #[tokio::test]
    async fn frames_of_every_length_go_through_as_they_are() {
        let wire: Vec<u8> = [0, 125, 126, 65535, 65536]
            .iter()
            .flat_map(|length| frame(BINARY, &vec![7; *length]))
            .collect();
        let pump = Pump::new(([127, 0, 0, 1], 1).into());
        let (mut ours, theirs) = tokio::io::duplex(1000);
        let (sent, mut taken) = (wire.clone(), vec![0; wire.len()]);
        tokio::select! {
            () = pump.run(sent.as_slice().chain(Forever), theirs) => panic!("it ended"),
            result = ours.read_exact(&mut taken) => { result.unwrap(); }
        }
        assert_eq!(taken, wire);
        assert_eq!(pump.given_up.load(Ordering::Relaxed), 0);
    }

    /// A viewer that takes nothing loses its oldest data, never an answer; both are counted.
    #[test]
    fn what_is_not_taken_is_given_up_oldest_first() {
        let mut queue = Queue::default();
        let data = |number: u16| Frame {
            bytes: number.to_be_bytes().to_vec(),
            is_data: true,
        };
        let answer = || Frame {
            bytes: vec![],
            is_data: false,
        };
        assert_eq!(queue.push(answer()), Some(0));
        let given_up: u64 = (0..300).map(|number| queue.push(data(number)).unwrap()).sum();
        assert_eq!(given_up, 300 - BACKLOG as u64);
        for _ in 1..MOST_ANSWERS {
            assert_eq!(queue.push(answer()), Some(0));
        }
        assert_eq!(queue.push(answer()), None, "let go");
        assert!(queue.pop().is_some_and(|frame| !frame.is_data));
        assert_eq!(queue.pop().unwrap().bytes, 44_u16.to_be_bytes());
        assert_eq!(queue.push(data(300)), Some(0), "there is room again");
    }

    #[tokio::test]
    async fn a_text_of_the_door_is_a_masked_frame() {
        for length in [5, 125, 126, 70_000] {
            let text = "x".repeat(length);
            let mut bytes = text_of_client(&text);
            assert_eq!((bytes[0], bytes[1] & MASKED), (0x81, MASKED));
            bytes[1] &= LENGTH;
            let head = bytes.len() - length;
            bytes.drain(head - 4..head);
            let read = read(&mut bytes.as_slice()).await.unwrap();
            assert_eq!(read.bytes.len(), bytes.len());
        }
    }

    /// Never ends, and says nothing.
    struct Forever;

    impl AsyncRead for Forever {
        fn poll_read(
            self: std::pin::Pin<&mut Self>,
            _: &mut std::task::Context<'_>,
            _: &mut tokio::io::ReadBuf<'_>,
        ) -> std::task::Poll<std::io::Result<()>> {
            std::task::Poll::Pending
        }
    }
}
