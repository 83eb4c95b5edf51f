//! Connections to brokers that answer nonsense, nothing, or too much.
#![cfg(feature = "mqtt")]
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::sync::Arc;
use std::time::{Duration, Instant};

use flexdrill_bridge::mqtt::{Broker, Documents, LinkEvent, LinkTimes, Shared, SparkplugNode, Tls, link};
use serde_json::json;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{mpsc, watch};
use tokio::task::JoinHandle;

/// Short, so that many connections fit into a test.
const TIMES: LinkTimes = LinkTimes {
    connect: Duration::from_secs(5),
    wait: [Duration::from_millis(1), Duration::from_millis(1)],
    good: Duration::from_secs(5),
    farewell: Duration::from_millis(200),
};

const ACCEPTED: [u8; 4] = [0x20, 2, 0, 0];

struct Running {
    node: Arc<Shared<SparkplugNode>>,
    events: mpsc::Receiver<LinkEvent>,
    stop: watch::Sender<bool>,
    link: JoinHandle<()>,
}

/// A Sparkplug connection to what listens there: it subscribes, and so reads more than the others.
fn connect(listener: &TcpListener, times: LinkTimes) -> Running {
    let address = listener.local_addr().unwrap().to_string();
    let broker = Broker::new(&address, Tls::None, None).unwrap();
    let node = Arc::new(Shared::new(SparkplugNode::new("a/b".parse().unwrap(), None)));
    let (sender, events) = mpsc::channel(1024);
    let (stop, stopping) = watch::channel(false);
    let shared = node.clone();
    let link = tokio::spawn(async move { link::run(&broker, &shared, times, &sender, stopping).await });
    Running {
        node,
        events,
        stop,
        link,
    }
}

impl Running {
    /// Why the connection was lost.
    async fn why(&mut self) -> String {
        loop {
            match tokio::time::timeout(Duration::from_secs(20), self.events.recv()).await {
                Ok(Some(LinkEvent::Waiting { why, .. })) => return why,
                Ok(Some(_)) => {}
                other => panic!("{other:?}"),
            }
        }
    }

    /// Ends it. A panic of the connection fails the test.
    async fn end(mut self) {
        self.stop.send_replace(true);
        self.events.close();
        tokio::time::timeout(Duration::from_secs(10), self.link)
            .await
            .unwrap()
            .unwrap();
    }
}

async fn accept(listener: &TcpListener) -> TcpStream {
    let (mut stream, _) = listener.accept().await.unwrap();
    let mut connect = [0; 4096];
    assert!(stream.read(&mut connect).await.unwrap() > 0);
    stream
}

#[tokio::test]
async fn what_answers_nonsense_is_named() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let mut running = connect(&listener, TIMES);
    let answers: [(&[u8], &str); 6] = [
        (b"", "without an answer; if this port expects TLS"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", "speaks no MQTT 3.1.1"),
        (&[0x20, 2, 0, 5], "the broker requires a user"),
        (&[0x20, 2, 0, 2], "give another one with --client-id"),
        (&[0x20, 2, 0, 3], "refuses the connection (ServiceUnavailable)"),
        // The length of the packet is 256 MiB: it must not be reserved.
        (&[0x30, 0xff, 0xff, 0xff, 0x7f], "speaks no MQTT 3.1.1"),
    ];
    for (answer, expected) in answers {
        let mut stream = accept(&listener).await;
        stream.write_all(answer).await.unwrap();
        drop(stream);
        let why = running.why().await;
        assert!(why.contains(expected), "{answer:?}: {why}");
    }
    assert_eq!(running.node.counts().made, 0);
    running.end().await;
}

#[tokio::test]
async fn no_answer_of_a_broker_ends_the_bridge() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let mut running = connect(&listener, TIMES);
    // Each kind of packet that a broker sends, right and wrong: acknowledgements of what was not sent, a second answer to
    // the connection, commands.
    let packets: [&[u8]; 12] = [
        &ACCEPTED,
        &[0x90, 3, 0, 1, 1],
        &[0x90, 3, 0, 1, 0x80],
        &[0x90, 4, 0, 1, 1, 1],
        &[0x40, 2, 0, 1],
        &[0x50, 2, 0, 1],
        &[0x62, 2, 0, 1],
        &[0x70, 2, 0, 1],
        &[0xb0, 2, 0, 1],
        &[0xd0, 0],
        &[
            0x32, 17, 0, 11, b's', b'p', b'B', b'v', b'1', b'/', b'a', b'/', b'N', b'/', b'b', 0, 1, 0xff, 0xff,
        ],
        &[0x34, 7, 0, 1, b'a', 0, 9, 0, 0],
    ];
    let mut random = 1_u64;
    let mut next = move |below: usize| {
        // Multiplier and increment of Knuth's MMIX.
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as usize % below
    };
    // Each connection carries up to eight packets; one of two has a changed byte.
    const CONNECTIONS: usize = 2000;
    for round in 0..CONNECTIONS {
        let mut answer = ACCEPTED.to_vec();
        for _ in 0..=next(8) {
            let mut packet = packets[next(packets.len())].to_vec();
            if round % 2 == 1 {
                let place = next(packet.len());
                packet[place] = next(256) as u8;
            }
            answer.extend(packet);
        }
        let mut stream = accept(&listener).await;
        // It may have closed the connection already.
        let _ = stream.write_all(&answer).await;
        drop(stream);
        running.why().await;
    }
    assert_eq!(running.node.counts().made, CONNECTIONS as u64);
    // After all that a right command is read.
    let mut stream = accept(&listener).await;
    stream.write_all(&[&ACCEPTED[..], packets[10]].concat()).await.unwrap();
    let began = Instant::now();
    while running.node.counts().received == 0 {
        assert!(began.elapsed() < Duration::from_secs(20));
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
    running.end().await;
}

#[tokio::test]
async fn a_broker_that_takes_nothing_holds_up_nobody_and_then_gets_the_newest() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let broker = Broker::new(&address, Tls::None, None).unwrap();
    let documents = Arc::new(Shared::new(Documents::new("a", None).unwrap()));
    let (sender, _events) = mpsc::channel(16);
    let (stop, stopping) = watch::channel(false);
    let shared = documents.clone();
    let link = tokio::spawn(async move { link::run(&broker, &shared, TIMES, &sender, stopping).await });
    let mut stream = accept(&listener).await;
    stream.write_all(&ACCEPTED).await.unwrap();
    // It acknowledges nothing and reads nothing. 64 kB each: far more than all buffers between.
    let filling = "x".repeat(64 * 1024);
    let (began, mut longest) = (Instant::now(), Duration::ZERO);
    for number in 0..2000 {
        let before = Instant::now();
        documents.update(|documents| documents.put("n", &json!({"number": number, "filling": filling})));
        longest = longest.max(before.elapsed());
        tokio::task::yield_now().await;
    }
    // A document is written in well below a millisecond; half a second is a machine that does something else meanwhile.
    assert!(longest < Duration::from_millis(500), "{longest:?}");
    assert!(began.elapsed() < Duration::from_secs(20));
    let replaced = documents.update(|documents| documents.replaced());
    let sent = documents.counts().sent;
    // Eight wait for their acknowledgement, and some are on their way.
    assert!(replaced > 1900 && sent < 100, "{replaced} replaced, {sent} sent");
    drop(stream);

    let mut stream = accept(&listener).await;
    stream.write_all(&ACCEPTED).await.unwrap();
    let mut read = Vec::new();
    let newest = b"\"number\":1999";
    let reading = async {
        let mut chunk = [0; 4096];
        while !read.windows(newest.len()).any(|window| window == newest) {
            let count = stream.read(&mut chunk).await.unwrap();
            assert!(count > 0);
            read.extend_from_slice(&chunk[..count]);
        }
    };
    tokio::time::timeout(Duration::from_secs(20), reading).await.unwrap();
    let text = String::from_utf8_lossy(&read);
    let numbers: Vec<&str> = text.split("\"number\":").skip(1).map(|rest| &rest[..4]).collect();
    assert_eq!(numbers, ["1999"], "nothing old was sent");
    stop.send_replace(true);
    tokio::time::timeout(Duration::from_secs(10), link)
        .await
        .unwrap()
        .unwrap();
}
