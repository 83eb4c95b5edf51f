//! Connections to a rig that come back after a loss: TCP as client and as server, and serial lines.
//!
//! [`run`] keeps a line for as long as it is polled. What happens is sent as [`LineState`] and bytes; what is to be written
//! is taken from a broadcast, of which a slow connection loses the oldest.

mod ask;
mod seats;

use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::{broadcast, mpsc};
use tokio::task::JoinSet;

pub use ask::Ask;
use ask::{Asking, Heard};
pub use seats::{MOST_CONNECTIONS, Seats};

/// Where the line is.
#[derive(Debug)]
pub enum Place {
    /// A server of the rig: host and port.
    Connect(String),
    /// A port here that the rig connects to.
    Listen(TcpListener),
    /// A serial line, 8 data bits, no parity, one stop bit.
    Serial {
        /// Its device.
        device: PathBuf,
        /// Bits per second.
        baud: u32,
    },
}

/// Times of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Times {
    /// A TCP connection that brings nothing for so long is given up, because a dead peer is not noticed otherwise; none
    /// where the other end only reads.
    pub silence: Option<Duration>,
    /// Time to connect.
    pub connect: Duration,
    /// Shortest and longest wait before another attempt; it doubles from one to the next.
    pub wait: [Duration; 2],
}

impl Default for Times {
    fn default() -> Self {
        Self {
            silence: Some(Duration::from_secs(60)),
            connect: Duration::from_secs(10),
            wait: [Duration::from_millis(500), Duration::from_secs(30)],
        }
    }
}

/// What happens on a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LineState {
    /// A connection was made.
    Opened {
        /// Its number, counted from 1.
        connection: u64,
        /// Its other end: an address without the port, which changes with every connection, or a name.
        peer: String,
        /// Its other end with the port, for logs.
        address: String,
    },
    /// The connection was silent and was asked for frames.
    Asked {
        /// The connection.
        connection: u64,
    },
    /// Bytes came.
    Bytes {
        /// The connection.
        connection: u64,
        /// When (ns since 1970).
        time: i64,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// A connection ended.
    Closed {
        /// Its number.
        connection: u64,
        /// When (ns since 1970).
        time: i64,
        /// The reason, in words for a log.
        why: String,
    },
    /// No connection; another attempt follows.
    Waiting {
        /// The reason, in words for a log.
        why: String,
        /// Until the next attempt.
        wait: Duration,
    },
    /// A connection was refused, because there are [`MOST_CONNECTIONS`] that send, or none yields.
    Refused {
        /// Its other end.
        peer: String,
    },
    /// Frames were not written, because the connection was too slow for them.
    NotWritten {
        /// The connection.
        connection: u64,
        /// How many.
        frames: u64,
    },
}

/// Bytes that are read at a time.
const CHUNK: usize = 4096;
/// Longest time for writing a frame.
const WRITE_TIMEOUT: Duration = Duration::from_secs(5);

/// The waits between attempts: each twice the one before, up to the longest.
#[derive(Debug, Clone, Copy)]
pub struct BackOff {
    wait: [Duration; 2],
    next: Duration,
}

impl BackOff {
    /// Begins with the shortest.
    pub const fn new(wait: [Duration; 2]) -> Self {
        Self { wait, next: wait[0] }
    }

    /// The next wait.
    pub fn next_wait(&mut self) -> Duration {
        let next = self.next;
        self.next = (2 * next).min(self.wait[1]);
        next
    }

    /// Begins again, after a connection that brought something.
    pub fn reset(&mut self) {
        self.next = self.wait[0];
    }
}

/// The present instant (ns since 1970).
pub fn now() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| i64::try_from(since.as_nanos()).unwrap_or(i64::MAX))
}

/// The ends of a line that its connections need.
#[derive(Clone)]
struct Ends {
    events: mpsc::Sender<LineState>,
    outgoing: broadcast::Sender<Arc<[u8]>>,
    times: Times,
    ask: Option<Ask>,
}

/// A connection for which its line has a name.
struct Named {
    connection: u64,
    peer: String,
    address: String,
    silence: Option<Duration>,
}

/// Keeps the line for as long as it is polled, or until the receiver of `events` is gone. `outgoing` is written to every
/// connection. The receiver reports whole frames to `seats`; where connections have to send ([`Times::silence`]), one that
/// sends nothing leaves its seat to a new one. `ask` is written to connections whose other end sends on request only.
pub async fn run(
    place: Place,
    times: Times,
    ask: Option<Ask>,
    events: mpsc::Sender<LineState>,
    outgoing: broadcast::Sender<Arc<[u8]>>,
    seats: Seats,
) {
    let ends = Ends {
        events,
        outgoing,
        times,
        ask,
    };
    match place {
        Place::Listen(listener) => listen(&listener, &ends, &seats).await,
        Place::Connect(address) => {
            let (name, limit) = (address.clone(), times.connect);
            redial(&ends, times.silence, &name, move || connect(address.clone(), limit)).await;
        }
        Place::Serial { device, baud } => {
            let name = device.display().to_string();
            let open = move || std::future::ready(serial2_tokio::SerialPort::open(&device, baud));
            // A line without data is no fault: the rig may be switched off.
            redial(&ends, None, &name, open).await;
        }
    }
}

async fn connect(address: String, limit: Duration) -> io::Result<TcpStream> {
    let connecting = tokio::time::timeout(limit, TcpStream::connect(address));
    let stream = connecting.await.map_err(|_| {
        let text = format!("no answer within {} s", limit.as_secs_f64());
        io::Error::new(io::ErrorKind::TimedOut, text)
    })??;
    stream.set_nodelay(true)?;
    Ok(stream)
}

async fn redial<S: AsyncRead + AsyncWrite + Unpin, F: Future<Output = io::Result<S>>>(
    ends: &Ends,
    silence: Option<Duration>,
    name: &str,
    open: impl Fn() -> F,
) {
    let mut back_off = BackOff::new(ends.times.wait);
    let mut connection = 0;
    loop {
        let why = match open().await {
            Err(error) => error.to_string(),
            Ok(stream) => {
                connection += 1;
                // The only connection of the line yields to no other.
                let stays = std::future::pending();
                let named = Named {
                    connection,
                    peer: name.to_owned(),
                    address: name.to_owned(),
                    silence,
                };
                let (why, brought) = ends.serve(stream, named, stays).await;
                if brought {
                    back_off.reset();
                }
                why
            }
        };
        let wait = back_off.next_wait();
        if ends.events.send(LineState::Waiting { why, wait }).await.is_err() {
            return;
        }
        tokio::time::sleep(wait).await;
    }
}

async fn listen(listener: &TcpListener, ends: &Ends, seats: &Seats) {
    let mut connections = JoinSet::new();
    let mut number = 0;
    loop {
        while connections.try_join_next().is_some() {}
        match listener.accept().await {
            Ok((stream, peer)) => {
                number += 1;
                let Some(leave) = seats.take(number, peer.ip(), ends.times.silence.is_some()) else {
                    number -= 1;
                    let peer = peer.to_string();
                    if ends.events.send(LineState::Refused { peer }).await.is_err() {
                        return;
                    }
                    continue;
                };
                let (ends, seats) = (ends.clone(), seats.clone());
                connections.spawn(async move {
                    // Without it the frames of the twin wait for one another; the connection works all the same.
                    let _ = stream.set_nodelay(true);
                    let named = Named {
                        connection: number,
                        peer: peer.ip().to_string(),
                        address: peer.to_string(),
                        silence: ends.times.silence,
                    };
                    ends.serve(stream, named, leave.notified()).await;
                    seats.leave(number);
                });
            }
            Err(error) => {
                // No handles are left, for example.
                let wait = ends.times.wait[0];
                let why = format!("connections are not accepted: {error}");
                if ends.events.send(LineState::Waiting { why, wait }).await.is_err() {
                    return;
                }
                tokio::time::sleep(wait).await;
            }
        }
    }
}

impl Ends {
    /// Reads and writes a connection until it ends or has to `leave`. Returns why it ended and whether it brought anything.
    async fn serve<S: AsyncRead + AsyncWrite + Unpin>(
        &self,
        stream: S,
        named: Named,
        leave: impl Future<Output = ()>,
    ) -> (String, bool) {
        let mut outgoing = self.outgoing.subscribe();
        let Named {
            connection,
            peer,
            address,
            silence,
        } = named;
        let opened = LineState::Opened {
            connection,
            peer,
            address,
        };
        if self.events.send(opened).await.is_err() {
            return (String::new(), false);
        }
        let (mut reader, mut writer) = tokio::io::split(stream);
        let (mut brought, heard) = (false, Heard::default());
        let why = tokio::select! {
            why = self.read(&mut reader, connection, silence, &mut brought, &heard) => why,
            why = self.write(&mut writer, connection, &mut outgoing, &heard, silence.is_some()) => why,
            () = leave => "it sent no whole frame and gave way to a new connection".to_owned(),
        };
        let closed = LineState::Closed {
            connection,
            time: now(),
            why: why.clone(),
        };
        // Without a receiver the whole line ends.
        let _ = self.events.send(closed).await;
        (why, brought)
    }

    async fn read(
        &self,
        reader: &mut (impl AsyncRead + Unpin),
        connection: u64,
        silence: Option<Duration>,
        brought: &mut bool,
        heard: &Heard,
    ) -> String {
        let mut buffer = vec![0; CHUNK];
        loop {
            let reading = reader.read(&mut buffer);
            let read = match silence {
                Some(silence) => match tokio::time::timeout(silence, reading).await {
                    Ok(read) => read,
                    Err(_) => return format!("no data for {} s", silence.as_secs_f64()),
                },
                None => reading.await,
            };
            match read {
                Ok(0) => return "the other end closed it".to_owned(),
                Ok(count) => {
                    *brought = true;
                    heard.bytes(&buffer[..count]);
                    let bytes = LineState::Bytes {
                        connection,
                        time: now(),
                        bytes: buffer[..count].to_vec(),
                    };
                    if self.events.send(bytes).await.is_err() {
                        return String::new();
                    }
                }
                Err(error) => return error.to_string(),
            }
        }
    }

    async fn write(
        &self,
        writer: &mut (impl AsyncWrite + Unpin),
        connection: u64,
        outgoing: &mut broadcast::Receiver<Arc<[u8]>>,
        heard: &Heard,
        ends_by_silence: bool,
    ) -> String {
        let mut asking = self.ask.clone().map(Asking::new);
        let mut is_closed = false;
        loop {
            let due = async {
                match &asking {
                    Some(asking) => asking.due().await,
                    None => std::future::pending().await,
                }
            };
            let bytes = tokio::select! {
                () = due => {
                    let Some((bytes, is_first)) = asking.as_mut().and_then(|asking| asking.take(heard, ends_by_silence))
                    else {
                        continue;
                    };
                    if is_first && self.events.send(LineState::Asked { connection }).await.is_err() {
                        return String::new();
                    }
                    bytes
                }
                received = outgoing.recv(), if !is_closed => match received {
                    Ok(bytes) => bytes,
                    Err(RecvError::Lagged(frames)) => {
                        let lost = LineState::NotWritten { connection, frames };
                        if self.events.send(lost).await.is_err() {
                            return String::new();
                        }
                        continue;
                    }
                    // No frame of the twin follows; the connection is read and asked as before.
                    Err(RecvError::Closed) => {
                        is_closed = true;
                        continue;
                    }
                },
            };
            match tokio::time::timeout(WRITE_TIMEOUT, writer.write_all(&bytes)).await {
                Ok(Ok(())) => {}
                Ok(Err(error)) => return error.to_string(),
                Err(_) => return format!("it takes no data for {} s", WRITE_TIMEOUT.as_secs()),
            }
        }
    }
}
