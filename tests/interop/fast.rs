//! The node against Fast DDS, the layer below rmw_fastrtps: a program in C++ (`tests/cpp/fast_peer.cpp`).

use std::time::{Duration, Instant};

use crate::common::program::signal_id;
use crate::common::{Network, Peer, Program, skipped};
use serde_json::json;

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
const JOINTS: (&str, &str) = ("/twin/joint_deflections", "flexdrill/msg/JointDeflections");

/// Reads the status reliably, and has heard it.
fn hears_status(peer: &mut Peer) -> u64 {
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    newest_status(peer)
}

/// Sequence of the next status of a twin that runs.
fn newest_status(peer: &mut Peer) -> u64 {
    let status = peer.status_with(STATUS.0, |status| status["state"] == 1);
    assert_eq!(status["header"]["frame_id"], "flexible_tool", "{status}");
    status["sequence"].as_u64().unwrap()
}

#[test]
fn data_goes_both_ways_and_a_killed_peer_comes_back() {
    let Some(network) = Network::new() else { return };
    let (Some(mut fast), Some(mut judge)) = (network.fast_peer(), network.peer()) else {
        return;
    };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    judge.subscribe(STATUS.0, STATUS.1, "reliable");
    let applied = |judge: &mut Peer, rpm: f64| {
        judge.status_with(STATUS.0, |status| {
            let received = status["input_received"][0].as_f64().unwrap_or(0.0);
            (received - rpm * std::f64::consts::PI / 30.0).abs() < 1e-12
        })
    };
    let first = hears_status(&mut fast);
    fast.send("/rig/rotary_speed_rpm", json!(33.5));
    let status = applied(&mut judge, 33.5);
    assert_eq!(status["input_state"][0], 1, "{status}");
    assert!(newest_status(&mut fast) > first);
    fast.signal("KILL");
    let mut again = network.fast_peer().unwrap();
    let began = Instant::now();
    let later = hears_status(&mut again);
    assert!(
        later > first && began.elapsed() < Duration::from_secs(10),
        "{:?}",
        began.elapsed()
    );
    again.send("/rig/rotary_speed_rpm", json!(21.25));
    let status = applied(&mut judge, 21.25);
    assert_eq!(status["dds_restarts"], 0, "{}", status["dds_restart_cause"]);
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

/// Calls of a client on Fast DDS are carried out once each while the DDS process is killed between them, and the next node
/// carries out none of those to the node before.
#[test]
fn a_client_is_served_once_per_call_whatever_restarts() {
    let Some(network) = Network::new() else { return };
    let (Some(mut client), Some(mut judge)) = (network.fast_peer(), network.peer()) else {
        return;
    };
    // At this level the log has every reset, also those that follow another within ten seconds.
    let every_reset = ["--ros-args", "--log-level", "flexdrill::node::control:=debug"];
    let mut twin = network.twin(&every_reset);
    twin.wait_for("model time runs");
    judge.subscribe(STATUS.0, STATUS.1, "reliable");
    let reset = |client: &mut Peer| {
        let reply = client.call("/flexdrill/reset", "std_srvs/srv/Trigger", json!({}));
        assert_eq!(reply["success"], true, "{reply}");
    };
    let resets = |twin: &mut Program| twin.said().matches("reset: the model returns").count();
    reset(&mut client);
    for restarts in 1..=2 {
        signal_id(twin.dds_process(), "KILL");
        judge.status_with(STATUS.0, |status| status["dds_restarts"].as_u64().unwrap() >= restarts);
        reset(&mut client);
    }
    // What a writer still holds it sends when it finds the reader; the last call was answered, so it has.
    std::thread::sleep(Duration::from_secs(1));
    assert_eq!(resets(&mut twin), 3, "{}", twin.said());
    twin.signal("KILL");
    twin.end();
    let mut next = network.twin(&every_reset);
    next.wait_for("model time runs");
    judge.status_with(STATUS.0, |status| status["dds_restarts"] == 0);
    reset(&mut client);
    std::thread::sleep(Duration::from_secs(1));
    assert_eq!(resets(&mut next), 1, "{}", next.said());
}

/// One that takes nothing, and one that is stopped: the others hear the twin on.
#[test]
fn a_reader_that_never_takes_and_a_frozen_one_cost_others_a_second_at_most() {
    let Some(network) = Network::new() else { return };
    let (Some(mut hoarding), Some(mut frozen), Some(mut healthy)) =
        (network.fast_peer(), network.fast_peer(), network.fast_peer())
    else {
        return;
    };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    hoarding.subscribe(JOINTS.0, JOINTS.1, "hoarding");
    for peer in [&mut frozen, &mut healthy] {
        peer.subscribe(JOINTS.0, JOINTS.1, "reliable");
        assert!(!peer.take(JOINTS.0, 1, 15.0).is_empty());
    }
    hears_status(&mut healthy);
    frozen.signal("STOP");
    // Longer than the history of a topic: 15 s.
    let received = healthy.listen(&[JOINTS.0], 20.0).remove(0);
    frozen.signal("CONT");
    let longest = received.windows(2).map(|pair| pair[1][2] - pair[0][2]).max().unwrap();
    assert!(received.len() > 700, "{} of 1000 have come", received.len());
    assert!(
        longest < 1_500_000_000,
        "{:.2} s without a sample",
        longest as f64 * 1e-9
    );
    assert!(newest_status(&mut healthy) > 0);
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn lost_packets_are_sent_again() {
    let Some(network) = Network::new() else { return };
    let Some(mut fast) = network.fast_peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    fast.subscribe(JOINTS.0, JOINTS.1, "reliable");
    hears_status(&mut fast);
    assert!(!fast.take(JOINTS.0, 1, 15.0).is_empty());
    let table = "add table ip lossy; add chain ip lossy input { type filter hook input priority 0; }";
    if !network.done(&["nft", table]) {
        skipped::<()>("packets cannot be lost without nftables");
        return;
    }
    // Of 250; what was lost in the last half second is still to be sent again, and a busy machine skips some.
    for (percent, least) in [(5, 215), (20, 180)] {
        let rule = format!(
            "flush chain ip lossy input; add rule ip lossy input udp dport >= 7400 numgen random mod 100 < {percent} drop"
        );
        assert!(network.done(&["nft", &rule]));
        let received = fast.listen(&[JOINTS.0], 5.0).remove(0);
        assert!(
            received.len() >= least,
            "{percent} % lost: {} of 250 samples have come",
            received.len()
        );
        let gaps = received
            .windows(2)
            .filter(|pair| pair[1][0] - pair[0][0] > 21_000_000)
            .count();
        assert_eq!(
            gaps, 0,
            "{percent} % lost: none is missing between those that have come"
        );
    }
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}
