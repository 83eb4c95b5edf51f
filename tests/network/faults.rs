//! What the network, a signal or another program does to DDS, and what it must not do to the twin.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::common::program::signal_id;
use crate::common::{Network, Peer, Program};
use flexdrill::bag;
use flexdrill::messages::{JointDeflections, TwinStatus};
use serde_json::{Value, json};

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
const JOINTS: (&str, &str) = ("/twin/joint_deflections", "flexdrill/msg/JointDeflections");
/// Outputs are back within this (s).
const BACK: f64 = 3.0;

/// Newest status of a DDS process that came up after `restarts` others; how long it took (s).
fn back_after(peer: &mut Peer, restarts: u64) -> (Value, f64) {
    let began = Instant::now();
    let status = peer.status_with(STATUS.0, |status| status["dds_restarts"].as_u64().unwrap() >= restarts);
    (status, began.elapsed().as_secs_f64())
}

/// The recording has every frame: stamps of a topic of 50 Hz are 20 ms apart throughout, and the twin skipped nothing.
fn is_complete(recording: &Path, seconds: f64) {
    let (mut stamps, mut skipped) = (Vec::new(), 0);
    for message in bag::open(recording).unwrap() {
        let message = message.unwrap();
        if message.topic.is("twin/joint_deflections") {
            let joints: JointDeflections = message.decode().unwrap();
            stamps.push(joints.header.stamp.to_nanoseconds());
        } else if message.topic.is("twin/status") {
            let status: TwinStatus = message.decode().unwrap();
            skipped = status.steps_skipped;
        }
    }
    assert!(stamps.len() as f64 > seconds * 50.0, "{} frames", stamps.len());
    // Steps that a busy machine skipped are not there to be recorded, and say so in the status.
    let missing: i64 = stamps
        .windows(2)
        .map(|pair| (pair[1] - pair[0] + 1_000_000) / 20_000_000 - 1)
        .sum();
    assert!(
        missing as u64 * 40 <= skipped,
        "{missing} frames are missing, {skipped} steps were skipped"
    );
}

#[test]
fn dds_stopped_killed_or_interrupted_is_back_and_nothing_is_missing() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("live.mcap");
    let mut twin = network.twin(&["--record", recording.to_str().unwrap()]);
    twin.wait_for("model time runs");
    let began = Instant::now();
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    back_after(&mut peer, 0);

    // A debugger's attach or a freezer: the library's threads die of the interrupted wait.
    let dds = twin.dds_process();
    signal_id(dds, "STOP");
    std::thread::sleep(Duration::from_millis(100));
    signal_id(dds, "CONT");
    let (status, seconds) = back_after(&mut peer, 1);
    assert!(seconds < BACK, "back after {seconds} s");
    let cause = status["dds_restart_cause"].as_str().unwrap();
    assert!(cause.contains("threads have ended"), "{cause}");

    // Stopped for good.
    signal_id(twin.dds_process(), "STOP");
    let (status, seconds) = back_after(&mut peer, 2);
    assert!(seconds < BACK, "back after {seconds} s");
    let cause = status["dds_restart_cause"].as_str().unwrap();
    assert!(cause.contains("has not reported for"), "{cause}");

    // Killed.
    signal_id(twin.dds_process(), "KILL");
    let (status, seconds) = back_after(&mut peer, 3);
    assert!(seconds < BACK, "back after {seconds} s");
    let cause = status["dds_restart_cause"].as_str().unwrap();
    assert!(cause.contains("signal 9"), "{cause}");
    assert_eq!(status["state"], 1, "{status}");

    // An input still arrives, a service still answers, and the alarm stands.
    peer.send("/rig/rotary_speed_rpm", json!(40.0));
    peer.status_with(STATUS.0, |status| status["input_state"][0] != 0);
    let reply = peer.call(
        "/flexdrill/get_parameters",
        "rcl_interfaces/srv/GetParameters",
        json!({"names": ["use_sim_time"]}),
    );
    assert_eq!(reply["values"][0]["type"], 1, "{reply}");
    peer.subscribe("/twin/alarms", "flexdrill/msg/AlarmList", "latched");
    let lists = peer.take("/twin/alarms", 1, 5.0);
    let alarms = lists.last().unwrap()["alarms"].as_array().unwrap();
    let network_alarm = alarms.iter().find(|alarm| alarm["id"] == "network").unwrap();
    assert_eq!(network_alarm["priority"], 2, "{network_alarm}");

    let seconds = began.elapsed().as_secs_f64();
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    assert!(twin.said().contains("DDS is restarted"));
    is_complete(&recording, seconds - 1.0);
}

/// Cyclone DDS keeps a request for readers that died without acknowledging it, and sends it to the reader of the next
/// DDS process and of the next node.
#[test]
fn requests_are_carried_out_once_whatever_restarts() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let start = || {
        // At this level the log has every reset, also those that follow another within ten seconds.
        let levels = ["flexdrill_ros2::dds:=debug", "flexdrill::node::control:=debug"];
        let mut twin = network.twin(&["--ros-args", "--log-level", levels[0], "--log-level", levels[1]]);
        twin.wait_for("model time runs");
        twin
    };
    let reset = |peer: &mut Peer| {
        let reply = peer.call_as_rmw_cyclone("/flexdrill/reset", "std_srvs/srv/Trigger", json!({}));
        assert_eq!(reply["success"], true, "{reply}");
    };
    let resets = |twin: &mut Program| twin.said().matches("reset: the model returns").count();
    let mut twin = start();
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    back_after(&mut peer, 0);
    reset(&mut peer);
    for restarts in 1..=3 {
        signal_id(twin.dds_process(), "KILL");
        back_after(&mut peer, restarts);
        reset(&mut peer);
    }
    // What a writer still holds it sends when it finds the reader; the last call was answered, so it has.
    std::thread::sleep(Duration::from_secs(1));
    let said = twin.said();
    assert_eq!(resets(&mut twin), 4, "{said}");
    assert!(
        said.contains("arrived again and is not carried out again"),
        "nothing was sent again, so that this test proves nothing:\n{said}"
    );

    twin.signal("KILL");
    twin.end();
    let mut next = start();
    peer.status_with(STATUS.0, |status| status["dds_restarts"] == 0);
    reset(&mut peer);
    std::thread::sleep(Duration::from_secs(1));
    let said = next.said();
    assert_eq!(resets(&mut next), 1, "{said}");
    assert!(
        said.contains("before this node was started"),
        "nothing was sent again, so that this test proves nothing:\n{said}"
    );
}

/// A request that is open when the DDS process is replaced is answered through the next one: the result of a goal, which
/// comes after a while, and the reply to a goal that is sent at the moment.
#[test]
fn requests_that_are_open_when_dds_restarts_are_answered() {
    const ACTION: &str = "/flexdrill/what_if/_action";
    const TYPE: &str = "flexdrill/action/WhatIf";
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    back_after(&mut peer, 0);
    let id = |number: u8| json!({"uuid": vec![number; 16]});
    // It takes minutes, and ends when it is cancelled.
    let goal = json!({"candidates": [{"rotary_speed": 60.0, "weight_on_bit": 5.0}], "horizon": 300.0, "members": 200,
        "run_all": true, "seed": 5});
    let send = |number: u8| {
        json!({"do": "call", "service": format!("{ACTION}/send_goal"), "type": format!("{TYPE}_SendGoal"),
            "request": {"goal_id": id(number), "goal": goal}, "seconds": 20.0})
    };
    let result = |number: u8| {
        json!({"do": "call", "service": format!("{ACTION}/get_result"), "type": format!("{TYPE}_GetResult"),
            "request": {"goal_id": id(number)}, "seconds": 50.0})
    };
    let cancel_all = json!({"do": "call", "service": format!("{ACTION}/cancel_goal"), "type": "action_msgs/srv/CancelGoal",
        "request": {"goal_info": {}}, "seconds": 20.0});
    // The first calls make the clients known, so that the next requests are under way at once.
    assert_eq!(peer.command(send(1))["reply"]["accepted"], true);
    assert_eq!(peer.command(cancel_all.clone())["reply"]["return_code"], 0);
    assert_eq!(peer.command(result(1))["reply"]["status"], 5);
    let mut restarts = 0;
    for (number, after_ms) in [(2, 0), (3, 5), (4, 20), (5, 80)] {
        peer.ask(&send(number));
        std::thread::sleep(Duration::from_millis(after_ms));
        signal_id(twin.dds_process(), "KILL");
        let reply = peer.answer();
        assert_eq!(
            reply["reply"]["accepted"], true,
            "goal {number}, {after_ms} ms: {reply}"
        );
        restarts += 1;
        back_after(&mut peer, restarts);
        assert_eq!(peer.command(cancel_all.clone())["reply"]["return_code"], 0);
    }
    assert_eq!(peer.command(send(9))["reply"]["accepted"], true);
    peer.ask(&result(9));
    std::thread::sleep(Duration::from_millis(300));
    signal_id(twin.dds_process(), "KILL");
    back_after_elsewhere(&network, restarts + 1);
    let mut other = network.peer().unwrap();
    assert_eq!(other.command(cancel_all)["reply"]["return_code"], 0);
    let reply = peer.answer();
    assert_eq!(reply["reply"]["status"], 5, "{reply}");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

/// As [`back_after`], while the peer waits for an answer.
fn back_after_elsewhere(network: &Network, restarts: u64) {
    let mut other = network.peer().unwrap();
    other.subscribe(STATUS.0, STATUS.1, "reliable");
    back_after(&mut other, restarts);
}

#[test]
fn the_whole_program_stopped_for_a_while_goes_on() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    back_after(&mut peer, 0);
    let dds = twin.dds_process();
    twin.signal("STOP");
    signal_id(dds, "STOP");
    std::thread::sleep(Duration::from_secs(2));
    signal_id(dds, "CONT");
    twin.signal("CONT");
    let (_, seconds) = back_after(&mut peer, 1);
    assert!(seconds < BACK, "back after {seconds} s");
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn packets_from_nobody_do_not_end_it_and_memory_is_bounded() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    back_after(&mut peer, 0);
    for kind in [
        "huge_fragment",
        "large_fragments",
        "prefixes",
        "noise",
        "mutated 1",
        "mutated 2",
        "announced_gap",
    ] {
        let mut sender = network.command("python3");
        sender
            .arg(crate::common::root().join("tests/python/packets.py"))
            .args(kind.split(' '));
        let sent = sender.status().unwrap();
        assert!(sent.success(), "{kind}");
        let began = Instant::now();
        // What was sent is still read for a while; then a newcomer hears the twin too.
        let deadline = began + Duration::from_secs(20);
        loop {
            let mut watch = network.command(env!("CARGO_BIN_EXE_flexdrill"));
            watch.args(["watch", "--plain", "--duration", "1.5"]);
            if watch.output().unwrap().status.success() {
                break;
            }
            assert!(Instant::now() < deadline, "{kind}: a newcomer does not hear the twin");
        }
        let memory = resident(twin.dds_process());
        assert!(memory < 400 << 20, "{kind}: {memory} bytes");
    }
    peer.subscribe(JOINTS.0, JOINTS.1, "best_effort");
    assert!(!peer.take(JOINTS.0, 1, BACK).is_empty());
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    assert!(
        twin.said().contains("signal 6"),
        "the packets that abort are still such"
    );
}

/// Resident memory of a process (bytes).
fn resident(id: u32) -> u64 {
    let text = std::fs::read_to_string(format!("/proc/{id}/statm")).unwrap_or_default();
    let pages: u64 = text.split_whitespace().nth(1).unwrap_or("0").parse().unwrap();
    pages * 4096
}

#[test]
fn a_reader_that_never_takes_costs_others_a_second_and_is_named() {
    let Some(network) = Network::new() else { return };
    let Some(mut healthy) = network.peer() else { return };
    let Some(mut hoarding) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    healthy.subscribe(STATUS.0, STATUS.1, "reliable");
    healthy.subscribe(JOINTS.0, JOINTS.1, "reliable");
    let id = hoarding.subscribe(JOINTS.0, JOINTS.1, "hoarding");
    healthy.status_with(STATUS.0, |_| true);
    // The history is full after 15 s.
    let received = healthy.listen(&[JOINTS.0], 24.0).remove(0);
    assert!(received.len() > 1000, "{} samples", received.len());
    let longest = received.windows(2).map(|pair| pair[1][2] - pair[0][2]).max().unwrap();
    assert!(longest < 1_000_000_000, "nothing for {} ms", longest / 1_000_000);
    let status = healthy.status_with(STATUS.0, |status| status["dds_stalled_reader"] != "");
    let named = status["dds_stalled_reader"].as_str().unwrap();
    assert!(named.starts_with("/twin/joint_deflections: "), "{named}");
    assert!(named.contains(&id) && !named.contains("one of"), "{named}, not {id}");
    assert_eq!(status["dds_restarts"], 0, "{}", status["dds_restart_cause"]);
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn rig_and_watch_recover_too() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let log = crate::common::root().join("config/field_logs/demo.csv");
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.arg("rig").arg(&log).arg("--loop");
    let rig = Program::start(command);
    let fresh = |status: &Value| status["input_age"][0].as_f64().is_some_and(|age| age < 1.5);
    peer.status_with(STATUS.0, fresh);
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["watch", "--plain", "--interval", "0.5"]);
    let mut watch = Program::start(command);
    watch.wait_for("RUNNING");
    for program in [&rig, &watch] {
        signal_id(program.dds_process(), "KILL");
    }
    // Long enough that only samples sent after it can be fresh.
    std::thread::sleep(Duration::from_secs(4));
    peer.take(STATUS.0, 1000, 0.0);
    peer.status_with(STATUS.0, fresh);
    let before = watch.said().matches("RUNNING").count();
    let deadline = Instant::now() + Duration::from_secs(10);
    while watch.said().matches("RUNNING").count() < before + 2 {
        assert!(Instant::now() < deadline, "{}", watch.said());
        std::thread::sleep(Duration::from_millis(100));
    }
    rig.signal("INT");
    watch.signal("INT");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}
