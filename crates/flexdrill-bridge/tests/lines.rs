//! Lines over loopback and over a pseudo terminal: they come back, and a loss costs one frame at most.

#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::sync::Arc;
use std::time::Duration;

use flexdrill_bridge::lines::{self, Ask, BackOff, LineState, Place, Seats, Times};
use flexdrill_bridge::wits::{Counts, Line, Mapping};
use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{broadcast, mpsc};
use tokio::time::timeout;

/// Longest wait for anything on loopback; the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(60);

const QUICK: Times = Times {
    silence: Some(Duration::from_secs(60)),
    connect: Duration::from_secs(10),
    wait: [Duration::from_millis(5), Duration::from_millis(20)],
};

struct Running {
    events: mpsc::Receiver<LineState>,
    outgoing: broadcast::Sender<Arc<[u8]>>,
    seats: Seats,
    task: tokio::task::JoinHandle<()>,
}

fn start(place: Place, times: Times) -> Running {
    start_asking(place, times, None)
}

fn start_asking(place: Place, times: Times, ask: Option<Ask>) -> Running {
    let (sender, events) = mpsc::channel(16);
    let (outgoing, _) = broadcast::channel(4);
    let seats = Seats::default();
    let task = tokio::spawn(lines::run(place, times, ask, sender, outgoing.clone(), seats.clone()));
    Running {
        events,
        outgoing,
        seats,
        task,
    }
}

impl Running {
    /// The next event that `pick` takes.
    async fn until<T>(&mut self, mut pick: impl FnMut(LineState) -> Option<T>) -> T {
        let found = timeout(PATIENCE, async {
            loop {
                if let Some(found) = pick(self.events.recv().await.unwrap()) {
                    return found;
                }
            }
        });
        found.await.unwrap()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.task.abort();
    }
}

fn frame(sequence: u32) -> String {
    format!("&&\r\n0104{sequence}\r\n012040\r\n01162.5\r\n!!\r\n")
}

#[tokio::test]
async fn a_client_comes_back_and_loses_at_most_the_frame_in_flight() {
    let server = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let mut line = start(Place::Connect(server.local_addr().unwrap().to_string()), QUICK);
    let mapping = Mapping::default();
    let (mut counts, mut sent) = (Counts::default(), 0);
    for round in 1..=3_u64 {
        let (mut rig, _) = timeout(PATIENCE, server.accept()).await.unwrap().unwrap();
        for _ in 0..5 {
            sent += 1;
            rig.write_all(frame(sent).as_bytes()).await.unwrap();
        }
        // The connection ends within a frame.
        rig.write_all(&frame(sent + 1).as_bytes()[..20]).await.unwrap();
        drop(rig);
        let mut reader = None;
        line.until(|event| match event {
            LineState::Opened { connection, peer, .. } => {
                assert_eq!(connection, round);
                reader = Some(Line::new(&mapping, &peer));
                None
            }
            LineState::Bytes { bytes, time, .. } => {
                reader.as_mut().unwrap().push(&bytes, time, &mut counts, |_| {});
                None
            }
            LineState::Closed { time, .. } => {
                reader.take().unwrap().finish(time, &mut counts, |_| {});
                Some(())
            }
            _ => None,
        })
        .await;
        assert_eq!(counts.used, u64::from(sent), "after connection {round}");
        assert_eq!(
            counts.discarded.iter().sum::<u64>(),
            round,
            "one frame in flight per loss"
        );
    }
}

#[tokio::test]
async fn a_server_takes_several_sources_refuses_too_many_and_writes_to_all() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let mut line = start(Place::Listen(listener), QUICK);
    let mut rigs = Vec::new();
    for number in 1..=lines::MOST_CONNECTIONS as u64 {
        let rig = TcpStream::connect(address).await.unwrap();
        let opened = line.until(|event| match event {
            LineState::Opened { connection, .. } => Some(connection),
            _ => None,
        });
        assert_eq!(opened.await, number);
        line.seats.whole_frame(number);
        rigs.push(rig);
    }
    let mut refused = TcpStream::connect(address).await.unwrap();
    line.until(|event| matches!(event, LineState::Refused { .. }).then_some(()))
        .await;
    let mut rest = Vec::new();
    // A refused connection ends, in order or with a reset.
    let _ = timeout(PATIENCE, refused.read_to_end(&mut rest)).await.unwrap();
    assert!(rest.is_empty());
    line.outgoing.send(Arc::from(frame(1).into_bytes())).unwrap();
    for rig in &mut rigs {
        let mut read = vec![0; frame(1).len()];
        timeout(PATIENCE, rig.read_exact(&mut read)).await.unwrap().unwrap();
        assert_eq!(read, frame(1).as_bytes());
    }
    rigs[3].write_all(b"&&").await.unwrap();
    let from = line.until(|event| match event {
        LineState::Bytes { connection, bytes, .. } => Some((connection, bytes)),
        _ => None,
    });
    assert_eq!(from.await, (4, b"&&".to_vec()));
}

/// Eight half frames would otherwise hold all seats for the time of silence, a minute.
#[tokio::test]
async fn a_connection_without_a_whole_frame_gives_way_to_the_rig() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let mut line = start(Place::Listen(listener), QUICK);
    let mut halves = Vec::new();
    for _ in 0..lines::MOST_CONNECTIONS {
        let mut half = TcpStream::connect(address).await.unwrap();
        half.write_all(b"&&\r\n0104").await.unwrap();
        line.until(|event| matches!(event, LineState::Opened { .. }).then_some(()))
            .await;
        halves.push(half);
    }
    let mut rig = TcpStream::connect(address).await.unwrap();
    rig.write_all(frame(1).as_bytes()).await.unwrap();
    let (mut left, mut came) = (None, false);
    while left.is_none() || !came {
        line.until(|event| match event {
            LineState::Closed { connection, why, .. } => {
                assert!(why.contains("gave way"), "{why}");
                left = Some(connection);
                Some(())
            }
            LineState::Bytes { connection: 9, .. } => {
                came = true;
                Some(())
            }
            LineState::Refused { peer } => panic!("{peer} was refused"),
            _ => None,
        })
        .await;
    }
    assert_eq!(left, Some(1), "the oldest leaves");
    let mut rest = Vec::new();
    // The connection ends, in order or with a reset.
    let _ = timeout(PATIENCE, halves[0].read_to_end(&mut rest)).await.unwrap();
}

#[tokio::test]
async fn a_dead_peer_is_given_up_and_an_absent_one_is_called_with_growing_waits() {
    let server = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = server.local_addr().unwrap().to_string();
    let times = Times {
        silence: Some(Duration::from_millis(100)),
        ..QUICK
    };
    let mut line = start(Place::Connect(address), times);
    let (_silent, _) = timeout(PATIENCE, server.accept()).await.unwrap().unwrap();
    let why = line.until(|event| match event {
        LineState::Closed { why, .. } => Some(why),
        _ => None,
    });
    assert_eq!(why.await, "no data for 0.1 s");
    drop(server);
    let mut waits = Vec::new();
    while waits.len() < 5 {
        waits.push(
            line.until(|event| match event {
                LineState::Waiting { wait, .. } => Some(wait),
                _ => None,
            })
            .await,
        );
    }
    assert!(waits.is_sorted() && waits[4] == QUICK.wait[1], "{waits:?}");
}

#[test]
fn waits_double_up_to_their_bound_and_begin_again() {
    let mut back_off = BackOff::new([Duration::from_secs(1), Duration::from_secs(5)]);
    let waits: Vec<u64> = (0..5).map(|_| back_off.next_wait().as_secs()).collect();
    assert_eq!(waits, [1, 2, 4, 5, 5]);
    back_off.reset();
    assert_eq!(back_off.next_wait().as_secs(), 1);
}

#[tokio::test]
async fn a_serial_line_reads_and_writes_over_a_pseudo_terminal() {
    let Ok((mut rig, device)) = pseudo_terminal() else {
        println!("SKIPPED: no pseudo terminal on this machine");
        return;
    };
    let mut line = start(Place::Serial { device, baud: 9600 }, QUICK);
    line.until(|event| matches!(event, LineState::Opened { .. }).then_some(()))
        .await;
    rig.write_all(frame(7).as_bytes()).await.unwrap();
    let (mut reader, mut counts) = (Line::new(&Mapping::default(), "serial"), Counts::default());
    line.until(|event| {
        if let LineState::Bytes { bytes, time, .. } = event {
            reader.push(&bytes, time, &mut counts, |_| {});
        }
        (counts.used == 1).then_some(())
    })
    .await;
    line.outgoing.send(Arc::from(frame(8).into_bytes())).unwrap();
    let mut read = vec![0; frame(8).len()];
    timeout(PATIENCE, rig.read_exact(&mut read)).await.unwrap().unwrap();
    assert_eq!(read, frame(8).as_bytes());
}

/// The request of the default mapping, with short times.
fn quick_ask() -> Ask {
    Ask {
        every: Duration::from_millis(50),
        after: Duration::from_millis(100),
        ..Mapping::default().ask().unwrap()
    }
}

/// Sends a frame in answer to each valid packet and nothing otherwise, as a recorder in "send and receive" mode does.
async fn polled_recorder(mut line: impl AsyncRead + AsyncWrite + Unpin) {
    let (mut received, mut buffer, mut sent) = (Vec::new(), vec![0; 4096], 0);
    while let Ok(count @ 1..) = line.read(&mut buffer).await {
        received.extend(&buffer[..count]);
        while let Some(end) = received.windows(2).position(|mark| mark == b"!!") {
            let packet: Vec<u8> = received.drain(..end + 2).collect();
            if packet.windows(2).any(|mark| mark == b"&&") {
                sent += 1;
                line.write_all(frame(sent).as_bytes()).await.unwrap();
            }
        }
    }
}

/// Reads until a polled recorder has answered five times. Returns how often the line said that it asked.
async fn five_answers(line: &mut Running) -> u32 {
    let (mut reader, mut counts) = (Line::new(&Mapping::default(), "polled"), Counts::default());
    let mut asked = 0;
    line.until(|event| {
        match event {
            LineState::Bytes { bytes, time, .. } => reader.push(&bytes, time, &mut counts, |_| {}),
            LineState::Asked { .. } => asked += 1,
            _ => {}
        }
        (counts.used == 5).then_some(())
    })
    .await;
    asked
}

#[tokio::test]
async fn a_recorder_that_only_answers_is_asked_by_a_client_and_by_a_server() {
    let server = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let place = Place::Connect(server.local_addr().unwrap().to_string());
    let mut line = start_asking(place, QUICK, Some(quick_ask()));
    let (rig, _) = timeout(PATIENCE, server.accept()).await.unwrap().unwrap();
    let recorder = tokio::spawn(polled_recorder(rig));
    assert_eq!(five_answers(&mut line).await, 1, "said once");
    recorder.abort();

    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap();
    let mut line = start_asking(Place::Listen(listener), QUICK, Some(quick_ask()));
    let rig = TcpStream::connect(address).await.unwrap();
    let recorder = tokio::spawn(polled_recorder(rig));
    assert_eq!(five_answers(&mut line).await, 1, "said once");
    recorder.abort();
}

/// What a mapping orders is no surprise, and is not said.
#[tokio::test]
async fn a_mapping_that_asks_does_so_at_once() {
    let server = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let place = Place::Connect(server.local_addr().unwrap().to_string());
    let ask = Mapping::from_text("site.yaml", "ask: {every_s: 0.1}\n").unwrap().ask();
    let mut line = start_asking(place, QUICK, ask);
    let (rig, _) = timeout(PATIENCE, server.accept()).await.unwrap().unwrap();
    let recorder = tokio::spawn(polled_recorder(rig));
    assert_eq!(five_answers(&mut line).await, 0);
    recorder.abort();
}

#[tokio::test]
async fn a_recorder_that_sends_unasked_is_not_asked() {
    let server = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let place = Place::Connect(server.local_addr().unwrap().to_string());
    let _line = start_asking(place, QUICK, Some(quick_ask()));
    let (mut rig, _) = timeout(PATIENCE, server.accept()).await.unwrap().unwrap();
    rig.write_all(frame(1).as_bytes()).await.unwrap();
    let mut read = [0; 1];
    let reading = timeout(Duration::from_millis(400), rig.read(&mut read)).await;
    assert!(reading.is_err(), "it was asked: {reading:?}");
}

/// A recorder that needs no request, or one whose request is another, is not pestered: one request per connection.
#[tokio::test]
async fn a_request_without_an_answer_is_not_repeated() {
    let server = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let place = Place::Connect(server.local_addr().unwrap().to_string());
    let mut line = start_asking(place, QUICK, Some(quick_ask()));
    let (mut rig, _) = timeout(PATIENCE, server.accept()).await.unwrap().unwrap();
    line.until(|event| matches!(event, LineState::Asked { .. }).then_some(()))
        .await;
    let request = quick_ask().request;
    let mut read = vec![0; request.len()];
    timeout(PATIENCE, rig.read_exact(&mut read)).await.unwrap().unwrap();
    assert_eq!(read, &*request);
    let reading = timeout(Duration::from_millis(400), rig.read(&mut read)).await;
    assert!(reading.is_err(), "it was asked again: {reading:?}");
}

#[tokio::test]
async fn a_polled_recorder_on_a_serial_line_is_asked() {
    let Ok((rig, device)) = pseudo_terminal() else {
        println!("SKIPPED: no pseudo terminal on this machine");
        return;
    };
    let mut line = start_asking(Place::Serial { device, baud: 9600 }, QUICK, Some(quick_ask()));
    let recorder = tokio::spawn(polled_recorder(rig));
    assert_eq!(five_answers(&mut line).await, 1, "said once");
    recorder.abort();
}

/// The rig's end of a pseudo terminal, and the device of the other end.
fn pseudo_terminal() -> std::io::Result<(tokio::fs::File, std::path::PathBuf)> {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
    grantpt(&master)?;
    unlockpt(&master)?;
    let mut raw = tcgetattr(&master)?;
    raw.make_raw();
    tcsetattr(&master, OptionalActions::Now, &raw)?;
    let name = ptsname(&master, Vec::new())?;
    let device = std::path::PathBuf::from(name.to_string_lossy().into_owned());
    Ok((tokio::fs::File::from_std(std::fs::File::from(master)), device))
}
