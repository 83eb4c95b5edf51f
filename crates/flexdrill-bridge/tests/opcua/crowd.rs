//! Garbage, crowds, and a client that is served all the same.

use std::time::{Duration, Instant};

use flexdrill_bridge::opcua::client::RigEvent;
use flexdrill_bridge::opcua::event::ServerEvent;
use flexdrill_bridge::opcua::gate::MOST_OF_ADDRESS;
use flexdrill_bridge::opcua::values::Collector;
use flexdrill_messages::BitState;
use flexdrill_messages::topics;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;

use crate::follower::Follower;
use crate::running::{Running, header, speak};

#[tokio::test(flavor = "multi_thread", worker_threads = 3)]
async fn garbage_and_crowds_are_refused_and_clients_are_served_all_the_same() {
    let running = Running::new().await;
    speak(&running);
    // Our own client reads the twin, as it would a rig.
    let mapping = "interval_s: 0.1\nnodes:\n  \"nsu=urn:flexdrill:twin;s=figures/bit_torque\": {quantity: surface_torque, \
                   unit: N.m}\n";
    let mut follower = Follower::new(&running.url(), mapping);
    let opened = |_: &mut Collector, event: &RigEvent| matches!(event, RigEvent::Opened { .. }).then_some(());
    follower.until(60, opened).await;

    // What does not begin as OPC UA is closed at once, also a request of HTTP and the end of a Hello without its beginning.
    for garbage in [
        b"GET / HTTP/1.1\r\n\r\n".as_slice(),
        b"\0\0\0\0\0\0\0\0",
        &[0xff; 5000],
        b"HELX",
    ] {
        let mut stream = TcpStream::connect(running.address).await.unwrap();
        // The server may close it before all is written.
        let _ = stream.write_all(garbage).await;
        closed(stream, 10).await;
    }
    // What begins as OPC UA and is none: lengths beyond all bounds, a Hello of nonsense, chunks out of turn.
    let mut hello = b"HELF\x20\0\0\0".to_vec();
    hello.extend([0xff; 24]);
    let mut huge = b"HELF".to_vec();
    huge.extend(u32::MAX.to_le_bytes());
    huge.extend([0; 4096]);
    for garbage in [
        hello,
        huge,
        [b"HELF\x08\0\0\0".to_vec(), b"MSGF\x08\0\0\0".to_vec()].concat(),
    ] {
        let mut stream = TcpStream::connect(running.address).await.unwrap();
        let _ = stream.write_all(&garbage).await;
        // A Hello may take five seconds, the message after it five more.
        closed(stream, 20).await;
    }
    assert!(running.count(|event| matches!(event, ServerEvent::NotOpcUa { .. })) >= 4);

    // A crowd: those that fit wait and are closed after five seconds, the others at once.
    let mut crowd = Vec::new();
    for _ in 0..300 {
        crowd.push(TcpStream::connect(running.address).await.unwrap());
    }
    let refused = |event: &ServerEvent| matches!(event, ServerEvent::Refused { .. });
    let end = Instant::now() + Duration::from_secs(30);
    while running.count(refused) < 300 - MOST_OF_ADDRESS {
        assert!(Instant::now() < end, "{}", running.count(refused));
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    // The first client is served as before: the value changes and arrives.
    let bit = BitState {
        header: header(),
        torque: 777.0,
        ..BitState::default()
    };
    running.send(&topics::BIT_STATE, &bit);
    let arrived = |_: &mut Collector, event: &RigEvent| match event {
        RigEvent::Value(raw) => (raw.value == Some(777.0.into())).then_some(()),
        RigEvent::Closed { why, .. } => panic!("{why}"),
        _ => None,
    };
    follower.until(30, arrived).await;
    for stream in crowd {
        closed(stream, 20).await;
    }
    // There is room again.
    let mut second = Follower::new(&running.url(), mapping);
    second.until(60, opened).await;
}

/// The other end closes a connection within so many seconds.
async fn closed(mut stream: TcpStream, seconds: u64) {
    let reading = async {
        let mut rest = [0; 4096];
        // An answer that says why may come before the end; a reset is an end too.
        while let Ok(1..) = stream.read(&mut rest).await {}
    };
    tokio::time::timeout(Duration::from_secs(seconds), reading)
        .await
        .expect("the connection stays open");
}
