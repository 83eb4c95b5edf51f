//! What clients that only look can take of a node: its handles, its memory, its time. They take bounded parts of each,
//! and DDS and the recording go on.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::common::{Network, Program};
use serde_json::Value;

const LIVE: &str = "127.0.0.1:8765";
const URL: &str = "ws://127.0.0.1:8765";
const LIVE_PORT: u16 = 8765;
const PAGE_PORT: u16 = 8080;
const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");

/// A TCP socket of a network, as the system lists it.
struct Socket {
    port: u16,
    listens: bool,
    /// Bytes that the other side has not acknowledged.
    unsent: u64,
}

fn sockets(network: &Network) -> Vec<Socket> {
    let read = |name: &str| std::fs::read_to_string(format!("/proc/{}/net/{name}", network.id())).unwrap_or_default();
    let (four, six) = (read("tcp"), read("tcp6"));
    let line = |line: &str| {
        let fields: Vec<&str> = line.split_whitespace().collect();
        let port = fields.get(1)?.rsplit(':').next()?;
        let unsent = fields.get(4)?.split(':').next()?;
        Some(Socket {
            port: u16::from_str_radix(port, 16).ok()?,
            listens: *fields.get(3)? == "0A",
            unsent: u64::from_str_radix(unsent, 16).ok()?,
        })
    };
    four.lines().chain(six.lines()).filter_map(line).collect()
}

fn listening(network: &Network) -> Vec<u16> {
    let all = sockets(network);
    all.iter()
        .filter(|socket| socket.listens)
        .map(|socket| socket.port)
        .collect()
}

/// File handles that a process holds.
fn handles(process: u32) -> usize {
    std::fs::read_dir(format!("/proc/{process}/fd")).unwrap().count()
}

/// Most memory that a process has held so far (bytes).
fn peak_memory(program: &Program) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", program.id())).unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse::<u64>().unwrap() * 1024
}

fn crowd(network: &Network, arguments: &[&str]) -> Option<Value> {
    network.python("json", "crowd.py", arguments, "")
}

/// Whatever is asked of the gateway is asked of nothing else: any page of a browser reaches a port of this machine.
#[test]
fn the_announced_address_is_the_only_one_that_listens() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let token = folder.path().join("token");
    std::fs::write(&token, "a-token-that-nobody-guesses").unwrap();
    let token = token.to_str().unwrap();
    let mut twin = network.twin(&["--foxglove", LIVE, "--allow-control", "--token-file", token]);
    twin.wait_for("model time runs");
    assert_eq!(listening(&network), [LIVE_PORT]);
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.arg("dashboard");
    let mut dashboard = Program::start(command);
    dashboard.wait_for("dashboard at");
    let mut ports = listening(&network);
    ports.sort_unstable();
    assert_eq!(ports, [PAGE_PORT, LIVE_PORT]);
    for program in [&mut twin, &mut dashboard] {
        program.signal("INT");
        assert_eq!(program.end(), Some(0));
    }
}

/// Ten times the places that there are for requests, and more than a usual limit of handles: requests that never end.
#[test]
fn half_sent_requests_take_few_handles_and_nothing_from_dds_or_the_recording() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("run.mcap");
    // The soft limit of most systems.
    let mut command = network.command("prlimit");
    command.args(["--nofile=1024:1024", env!("CARGO_BIN_EXE_flexdrill"), "run", "--config"]);
    command.arg(crate::common::small_config());
    command.args(["--foxglove", LIVE, "--record", bag.to_str().unwrap()]);
    let mut twin = Program::start(command);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    let before = peer.status_with(STATUS.0, |status| status["state"] == 1);
    let process = twin.id();
    let alone = handles(process);
    let done = AtomicBool::new(false);
    let (seen, viewer, most) = std::thread::scope(|scope| {
        let counting = scope.spawn(|| {
            let mut most = 0;
            while !done.load(Ordering::Relaxed) {
                most = most.max(handles(process));
                std::thread::sleep(Duration::from_millis(50));
            }
            most
        });
        let attack = scope.spawn(|| crowd(&network, &["half", LIVE, "1100", "8"]));
        std::thread::sleep(Duration::from_secs(3));
        let viewer = network.viewer(&["decode", URL, "2"]);
        let seen = attack.join().unwrap();
        done.store(true, Ordering::Relaxed);
        (seen, viewer, counting.join().unwrap())
    });
    let Some(seen) = seen else { return };
    assert_eq!(seen["held"], 1100, "{seen}");
    assert!(
        seen["answered"].as_u64() > Some(0),
        "whole requests are answered meanwhile: {seen}"
    );
    // 64 places for requests, 32 for viewers, and those that are being accepted and closed, at most 128 of one turn.
    assert!(
        most <= alone + 64 + 32 + 128,
        "{most} handles, {alone} without the crowd"
    );
    if let Some(viewer) = viewer {
        assert!(viewer["found"]["/twin/status"]["count"].as_u64() > Some(0), "{viewer}");
    }
    let after = peer.status_with(STATUS.0, |status| {
        status["sequence"].as_u64() > before["sequence"].as_u64()
    });
    let gone = |field: &str| after[field].as_u64().unwrap() - before[field].as_u64().unwrap();
    assert_eq!(
        (gone("dds_restarts"), gone("frames_dropped"), gone("events_lost")),
        (0, 0, 0),
        "{after}"
    );
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let said = twin.said();
    assert!(said.contains("connections are open, which is the most"), "{said}");
}

/// As many viewers as there are seats, each with 16 MB of a message that never ends: 512 MB, if they were kept.
#[test]
fn unfinished_messages_are_refused_before_they_are_stored() {
    let Some(network) = Network::new() else { return };
    let mut twin = network.twin(&["--foxglove", LIVE]);
    twin.wait_for("model time runs");
    let before = peak_memory(&twin);
    let Some(seen) = crowd(&network, &["fragments", LIVE, "32"]) else {
        return;
    };
    // 64 KiB, and what lies in the buffers of both sockets: four megabytes at most, as Linux sets them up.
    for accepted in seen["accepted"].as_array().unwrap() {
        assert!(accepted.as_u64() < Some(8 << 20), "{seen}");
    }
    let grown = peak_memory(&twin) - before;
    assert!(grown < 64 << 20, "{grown} bytes for 32 viewers");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

/// The system keeps little for a viewer that stops reading, so that what it reads later is recent.
#[test]
fn a_viewer_that_stops_reading_is_not_served_old_data() {
    let Some(network) = Network::new() else { return };
    let mut twin = network.twin(&["--foxglove", LIVE]);
    twin.wait_for("model time runs");
    let done = AtomicBool::new(false);
    let (seen, most) = std::thread::scope(|scope| {
        let counting = scope.spawn(|| {
            let mut most = 0;
            while !done.load(Ordering::Relaxed) {
                let all = sockets(&network);
                let unsent = all
                    .iter()
                    .filter(|socket| socket.port == LIVE_PORT)
                    .map(|socket| socket.unsent);
                most = most.max(unsent.max().unwrap_or(0));
                std::thread::sleep(Duration::from_millis(50));
            }
            most
        });
        let seen = crowd(&network, &["stall", LIVE, "12"]);
        done.store(true, Ordering::Relaxed);
        (seen, counting.join().unwrap())
    });
    let Some(seen) = seen else { return };
    println!("{most} bytes unsent at most; {seen}");
    // 128 KiB, which Linux doubles for its bookkeeping, and the write that finds the last room: 290 kB were measured.
    // Without the bound it is all of the 12 s that the system has room for.
    assert!((1..=384 << 10).contains(&most), "{most} bytes unsent");
    // Of 50 a second for 12 s: what both sockets hold, 400 kB of the 300 kB a second of all topics.
    assert!(seen["old"].as_u64().is_some_and(|old| old < 200), "{seen}");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let said = twin.said();
    assert!(
        said.contains("is too slow for what it subscribes to") && said.contains("messages had been dropped for it"),
        "{said}"
    );
}
