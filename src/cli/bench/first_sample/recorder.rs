//! Made recorders: each sends as a recorder of the table in `docs/rig_inputs.md` does, on loopback or a pseudo terminal, from
//! a separate thread, as a recorder is a separate machine.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::os::fd::OwnedFd;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};
use std::time::{Duration, Instant};

use flexdrill_bridge::lines::{self, MOST_CONNECTIONS, Place};
use flexdrill_text::compact_date_time;

/// Time between two frames of a recorder that streams: the usual rate of rigs.
const PERIOD: Duration = Duration::from_secs(1);
/// How often a recorder that waits for requests looks whether it is to end.
const LOOK: Duration = Duration::from_millis(100);

/// How a recorder is plugged in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wire {
    /// It serves, and the bridge connects.
    Server,
    /// It connects to the bridge.
    Client,
    /// It connects to the bridge, all of whose seats are held by connections with half a frame.
    ClientBehindHalves,
    /// A serial line.
    Serial,
}

/// When a recorder sends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Habit {
    /// Once per second, whoever listens.
    Streams,
    /// In answer to a packet only ("send and receive", polled).
    Answers,
}

/// A recorder.
#[derive(Debug, Clone, Copy)]
pub(super) struct Recorder {
    /// How it is plugged in.
    pub(super) wire: Wire,
    /// When it sends.
    pub(super) habit: Habit,
    /// What it sends before its first frame.
    pub(super) before: &'static [u8],
    /// Its frame of a number.
    pub(super) frame: fn(u64) -> String,
}

/// A recorder that was plugged in. It is unplugged with this.
pub(super) struct Plugged {
    /// When the connection was made, then when the first frame was sent.
    pub(super) moments: Receiver<Instant>,
    /// Its thread ends when this is dropped.
    _held: Sender<()>,
}

/// A connection or a terminal.
trait End: Read + Write + Send {}
impl<T: Read + Write + Send> End for T {}

/// Makes the connection: when that was, its end, and the half frames that are held meanwhile.
type Opens = Box<dyn FnOnce() -> std::io::Result<(Instant, Box<dyn End>, Vec<TcpStream>)> + Send>;

impl Recorder {
    /// The line at which a bridge waits for it, and what plugs it in: after `phase` a recorder that streams sends its first
    /// frame.
    ///
    /// # Errors
    /// When loopback or a pseudo terminal cannot be used.
    pub(super) async fn line(self, phase: Duration) -> std::io::Result<(Place, impl FnOnce() -> Plugged)> {
        let loopback = SocketAddr::from(([127, 0, 0, 1], 0));
        let (place, opens): (Place, Opens) = match self.wire {
            Wire::Server => {
                let server = TcpListener::bind(loopback)?;
                let place = Place::Connect(server.local_addr()?.to_string());
                let opens = move || {
                    let (rig, _) = server.accept()?;
                    Ok((Instant::now(), of_tcp(rig)?, Vec::new()))
                };
                (place, Box::new(opens))
            }
            Wire::Client | Wire::ClientBehindHalves => {
                let listener = tokio::net::TcpListener::bind(loopback).await?;
                let address = listener.local_addr()?;
                let halves = match self.wire {
                    Wire::ClientBehindHalves => MOST_CONNECTIONS,
                    _ => 0,
                };
                let opens = move || {
                    let held = (0..halves).map(|_| half_frame(address)).collect::<Result<_, _>>()?;
                    let plugged = Instant::now();
                    Ok((plugged, of_tcp(TcpStream::connect(address)?)?, held))
                };
                (Place::Listen(listener), Box::new(opens))
            }
            Wire::Serial => {
                let (ours, device) = pseudo_terminal()?;
                let terminal: Box<dyn End> = Box::new(std::fs::File::from(ours));
                let opens = move || Ok((Instant::now(), terminal, Vec::new()));
                (Place::Serial { device, baud: 9600 }, Box::new(opens))
            }
        };
        let plug = move || {
            let (sender, moments) = channel();
            let (held, unplugged) = channel();
            std::thread::spawn(move || {
                // An end that fails sends no moment, which the receiver reports. The half frames stay open meanwhile.
                if let Ok((plugged, end, _halves)) = opens() {
                    let _ = sender.send(plugged);
                    let _ = match self.habit {
                        Habit::Streams => self.stream(end, phase, &sender, &unplugged),
                        Habit::Answers => self.answer(end, &sender, &unplugged),
                    };
                }
            });
            Plugged { moments, _held: held }
        };
        Ok((place, plug))
    }

    /// Sends a frame per second until it is unplugged.
    fn stream(
        self,
        mut end: Box<dyn End>,
        phase: Duration,
        sent: &Sender<Instant>,
        unplugged: &Receiver<()>,
    ) -> std::io::Result<()> {
        end.write_all(self.before)?;
        let mut wait = phase;
        for number in 1.. {
            if unplugged.recv_timeout(wait) == Err(RecvTimeoutError::Disconnected) {
                break;
            }
            let now = Instant::now();
            end.write_all((self.frame)(number).as_bytes())?;
            let _ = sent.send(now);
            wait = PERIOD;
        }
        Ok(())
    }

    /// Answers every packet with a frame until it is unplugged.
    fn answer(self, mut end: Box<dyn End>, sent: &Sender<Instant>, unplugged: &Receiver<()>) -> std::io::Result<()> {
        let (mut heard, mut bytes, mut number) = (Vec::new(), [0; 1024], 0);
        while unplugged.try_recv() != Err(TryRecvError::Disconnected) {
            let read = match end.read(&mut bytes) {
                Ok(0) => break,
                Ok(read) => read,
                Err(error) if is_timeout(&error) => continue,
                Err(error) => return Err(error),
            };
            heard.extend_from_slice(&bytes[..read]);
            // A packet is whole at its `!!`; one without `&&` is not valid and gets no answer.
            while let Some(length) = heard.windows(2).position(|pair| pair == b"!!") {
                let packet: Vec<u8> = heard.drain(..length + 2).collect();
                if packet.windows(2).any(|pair| pair == b"&&") {
                    number += 1;
                    let now = Instant::now();
                    end.write_all((self.frame)(number).as_bytes())?;
                    let _ = sent.send(now);
                }
            }
        }
        Ok(())
    }
}

fn is_timeout(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted)
}

fn of_tcp(stream: TcpStream) -> std::io::Result<Box<dyn End>> {
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(LOOK))?;
    Ok(Box::new(stream))
}

/// A connection that has begun a frame and sends no more.
fn half_frame(address: SocketAddr) -> std::io::Result<TcpStream> {
    let mut stream = TcpStream::connect(address)?;
    stream.write_all(b"&&\r\n0116")?;
    Ok(stream)
}

/// The recorder's end of a pseudo terminal, and the device of the bridge's.
fn pseudo_terminal() -> std::io::Result<(OwnedFd, PathBuf)> {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

    let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
    grantpt(&ours)?;
    unlockpt(&ours)?;
    // Without it the terminal would answer with an echo of what it is sent before the bridge has opened it.
    let mut raw = tcgetattr(&ours)?;
    raw.make_raw();
    tcsetattr(&ours, OptionalActions::Now, &raw)?;
    let name = ptsname(&ours, Vec::new())?;
    Ok((ours, PathBuf::from(name.to_string_lossy().into_owned())))
}

/// Seven usual values, which change from frame to frame.
fn values(number: u64) -> String {
    format!(
        "0108{:.3}\r\n01102510.0\r\n01133.0\r\n01160.8{}\r\n01180.30\r\n0120{}\r\n01215000\r\n",
        2500.0 + number as f64 * 1e-3,
        number % 7,
        40 + number % 3
    )
}

/// Items 05 and 06 of the present instant, and that instant in digits, such as `20260925083724`.
fn now() -> (String, String) {
    let text = compact_date_time(lines::now());
    let (date, time) = text.trim_end_matches('Z').split_once('T').unwrap_or_default();
    let short = date.get(2..).unwrap_or_default();
    (format!("0105{short}\r\n0106{time}\r\n"), format!("{date}{time}"))
}

/// A frame with a header and a number that counts.
pub(super) fn plain(number: u64) -> String {
    let (header, _) = now();
    format!(
        "&&\r\n0101W\r\n01031\r\n0104{number}\r\n{header}{}!!\r\n",
        values(number)
    )
}

/// The frame of Pason's recorders: a line with their name, no header.
pub(super) fn named(number: u64) -> String {
    format!("&&\r\n1984PASON/EDR\r\n{}!!\r\n", values(number))
}

/// Item 04 is always 0.
pub(super) fn constant_number(number: u64) -> String {
    let (header, _) = now();
    format!("&&\r\n0101W\r\n01031\r\n01040\r\n{header}{}!!\r\n", values(number))
}

/// Item 04 has date and time in digits.
pub(super) fn date_as_number(number: u64) -> String {
    let (header, date) = now();
    format!("&&\r\n0101W\r\n01031\r\n0104{date}\r\n{header}{}!!\r\n", values(number))
}

/// A frame between the marks of a framed serial link.
pub(super) fn framed(number: u64) -> String {
    format!("\x02{}\x03", plain(number))
}
