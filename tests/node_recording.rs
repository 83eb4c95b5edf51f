//! A live recording is finished on SIGTERM, foreign programs read it, and its replay gives the same bytes.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod common;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use common::Network;
use flexdrill::bag;
use flexdrill::messages::TwinStatus;
use serde_json::json;

/// Messages of the topics that do not tell of wall-clock time or of the node itself, per topic in their order.
fn messages(path: &Path) -> BTreeMap<String, Vec<Vec<u8>>> {
    let mut found: BTreeMap<String, Vec<Vec<u8>>> = BTreeMap::new();
    let bag = bag::open(path).unwrap();
    for message in bag {
        let message = message.unwrap();
        let clocked = [
            "twin/status",
            "diagnostics",
            "twin/alarms",
            "twin/alarm_events",
            "rig/rotary_speed_rpm",
            "rig/weight_on_bit_kn",
        ];
        if !clocked.iter().any(|name| message.topic.is(name)) {
            found.entry(message.topic.name.clone()).or_default().push(message.data);
        }
    }
    found
}

/// rosbags and mcap-ros2-support read all of it, with the hashes of our types, and find the same values.
fn foreign_programs_read(recording: &Path) {
    let folder = recording.parent().unwrap();
    if let Some(printed) = common::python::run("bags.py", &["live", folder.to_str().unwrap()], "") {
        let found: BTreeMap<String, usize> =
            bag::open(recording)
                .unwrap()
                .fold(BTreeMap::new(), |mut found, message| {
                    *found.entry(message.unwrap().topic.name.clone()).or_default() += 1;
                    found
                });
        let total: usize = found.values().sum();
        assert_eq!(printed.trim(), format!("topics {} messages {total}", found.len()));
    }
}

/// The status tells where the time goes, once the model moves.
fn phases_are_told(recording: &Path) {
    let mut solve = 0.0_f64;
    for message in bag::open(recording).unwrap() {
        let message = message.unwrap();
        if message.topic.is("twin/status") {
            let status: TwinStatus = message.decode().unwrap();
            assert_eq!(status.phase_name.len(), status.phase_time.len());
            assert_eq!(status.phase_name.last().map(String::as_str), Some("publish"));
            let index = status.phase_name.iter().position(|name| name == "solve").unwrap();
            solve = solve.max(status.phase_time[index]);
        }
    }
    assert!(solve > 0.0);
}

#[test]
fn a_live_recording_replayed_gives_the_same_bytes() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (live, again) = (folder.path().join("live.mcap"), folder.path().join("again/again.mcap"));
    let live_text = live.to_str().unwrap();
    let mut twin = network.twin(&[
        "--record",
        live_text,
        "--namespace",
        "rig_7",
        "--ros-args",
        "-p",
        "inputs.weight_on_bit.initial_kn:=5",
    ]);
    twin.wait_for("model time runs");
    let double = |name: &str, value: f64| json!({"name": name, "value": {"type": 3, "double_value": value}});
    for round in 0..4 {
        peer.send("/rig_7/rig/rotary_speed_rpm", json!(30.0 + 10.0 * f64::from(round)));
        peer.send("/rig_7/rig/weight_on_bit_kn", json!(8.0 + f64::from(round)));
        std::thread::sleep(Duration::from_millis(400));
        let changes = json!({"parameters": [
            double("contact.inner.friction_tangential", 0.2 + 0.02 * f64::from(round)),
            double("outputs.rates.bit_state", 50.0 + 10.0 * f64::from(round)),
            double("whirl.hysteresis", 0.1 + 0.01 * f64::from(round)),
        ]});
        let set = peer.call(
            "/rig_7/flexdrill/set_parameters_atomically",
            "rcl_interfaces/srv/SetParametersAtomically",
            changes,
        );
        assert_eq!(set["result"]["successful"], true, "{set}");
        if round == 1 {
            let pause = |peer: &mut common::Peer, on: bool| {
                peer.call("/rig_7/flexdrill/pause", "std_srvs/srv/SetBool", json!({"data": on}))
            };
            pause(&mut peer, true);
            std::thread::sleep(Duration::from_millis(100));
            pause(&mut peer, false);
        }
        if round == 2 {
            peer.call("/rig_7/flexdrill/reset", "std_srvs/srv/Trigger", json!({}));
        }
    }
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
    assert!(twin.said().contains("recorded"), "{}", twin.said());
    foreign_programs_read(&live);
    phases_are_told(&live);

    let replay = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["replay", live_text, "--out", again.to_str().unwrap()])
        .output()
        .unwrap();
    assert!(replay.status.success(), "{}", String::from_utf8_lossy(&replay.stderr));
    let printed = String::from_utf8_lossy(&replay.stdout);
    assert!(printed.contains("time per step"), "{printed}");
    let (live, again) = (messages(&live), messages(&again));
    assert_eq!(live.keys().collect::<Vec<_>>(), again.keys().collect::<Vec<_>>());
    assert!(live.contains_key("/rig_7/twin/contact_forces"));
    for (topic, recorded) in &live {
        let replayed = &again[topic];
        for (index, (a, b)) in recorded.iter().zip(replayed).enumerate() {
            assert!(a == b, "message {index} of {topic} differs");
        }
        assert_eq!(recorded.len(), replayed.len(), "{topic}");
    }
}
