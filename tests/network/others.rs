//! DDS beside others on a network that is not at its best: packets lost, an interface that goes away, a second node of the
//! same name.

use std::time::{Duration, Instant};

use crate::common::{Network, skipped};
use serde_json::json;

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
const JOINTS: (&str, &str) = ("/twin/joint_deflections", "flexdrill/msg/JointDeflections");
const ALARMS: (&str, &str) = ("/twin/alarms", "flexdrill/msg/AlarmList");

#[test]
fn lost_packets_are_sent_again_to_who_asked_for_every_sample() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    peer.subscribe(JOINTS.0, JOINTS.1, "reliable");
    peer.status_with(STATUS.0, |_| true);
    let table = "add table ip lossy; add chain ip lossy input { type filter hook input priority 0; }";
    if !network.done(&["nft", table]) {
        skipped::<()>("packets cannot be lost without nftables");
        return;
    }
    for (percent, least) in [(5, 240), (20, 200)] {
        let rule = format!(
            "flush chain ip lossy input; add rule ip lossy input udp dport >= 7400 numgen random mod 100 < {percent} drop"
        );
        assert!(network.done(&["nft", &rule]));
        let received = peer.listen(&[JOINTS.0], 5.0).remove(0);
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
    assert!(network.done(&["nft", "delete table ip lossy"]));
    let status = peer.status_with(STATUS.0, |_| true);
    assert_eq!(status["dds_restarts"], 0, "{}", status["dds_restart_cause"]);
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn an_interface_that_goes_and_comes_back_is_used_again() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    let before = peer.status_with(STATUS.0, |_| true);
    assert!(network.done(&["ip", "link", "set", "lo", "down"]));
    std::thread::sleep(Duration::from_secs(3));
    assert!(network.done(&["ip", "link", "set", "lo", "up"]));
    assert!(network.done(&["ip", "route", "replace", "224.0.0.0/4", "dev", "lo"]));
    let began = Instant::now();
    let after = peer.status_with(STATUS.0, |status| {
        status["sequence"].as_u64() > before["sequence"].as_u64().map(|sequence| sequence + 15)
    });
    assert!(began.elapsed() < Duration::from_secs(10), "{:?}", began.elapsed());
    assert_eq!(after["state"], 1, "{after}");
    assert_eq!(after["steps_skipped"], before["steps_skipped"], "the model went on");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn two_nodes_of_one_name_are_told() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", "reliable");
    peer.subscribe(ALARMS.0, ALARMS.1, "latched");
    let mut second = network.twin(&[]);
    // One file for the alarms of both would be written by each in turn.
    let line = second.wait_for("keeps the alarms of a node with this name and domain");
    assert!(line.contains(&format!("process {}", twin.id())), "{line}");
    second.wait_for("model time runs");
    let deadline = Instant::now() + Duration::from_secs(15);
    let mut told = 0;
    while told < 2 {
        assert!(Instant::now() < deadline, "nobody tells of the other");
        for message in peer.take("/diagnostics", 1, 1.0) {
            let items = message["status"].as_array().unwrap();
            let item = items.iter().find(|item| item["name"] == "/flexdrill: network").unwrap();
            told += usize::from(
                item["message"]
                    .as_str()
                    .unwrap()
                    .contains("Another node has the name of this one"),
            );
        }
    }
    let line = twin.wait_for("another node has the name of this one");
    assert!(line.contains("--namespace"), "{line}");
    second.signal("KILL");
    // A node that was killed and started again is not its own namesake for long: the dead one is forgotten with its lease.
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    assert_eq!(
        peer.command(json!({"do": "matched", "topic": ALARMS.0}))["error"],
        json!(null)
    );
}

#[test]
fn on_this_machine_alone_and_without_multicast_it_stays_up() {
    let Some(network) = Network::new() else { return };
    assert!(network.done(&["ip", "route", "del", "224.0.0.0/4", "dev", "lo"]));
    assert!(network.done(&["ip", "link", "set", "lo", "multicast", "off"]));
    let local = |arguments: &[&str]| {
        let mut command = network.command("env");
        command.args(["ROS_LOCALHOST_ONLY=1", env!("CARGO_BIN_EXE_flexdrill")]);
        command.args(arguments);
        command
    };
    let config = crate::common::small_config();
    let mut twin = crate::common::Program::start(local(&["run", "--config", config.to_str().unwrap()]));
    twin.wait_for("model time runs");
    // Longer than any of its patience with DDS.
    std::thread::sleep(Duration::from_secs(8));
    let heard = local(&["watch", "--plain", "--duration", "2"]).output().unwrap();
    assert!(heard.status.success(), "{}", String::from_utf8_lossy(&heard.stderr));
    assert!(!twin.said().contains("DDS is restarted"), "{}", twin.said());
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}
