//! What is shown live, as a viewer from other hands sees it (Python: websockets, mcap-ros2-support).

use std::collections::BTreeSet;

use crate::common::{Network, Program};
use serde_json::{Value, json};

const LIVE: &str = "127.0.0.1:8765";
const URL: &str = "ws://127.0.0.1:8765";

fn topics_of(value: &Value) -> BTreeSet<String> {
    let names = value.as_object().unwrap().keys();
    names.cloned().collect()
}

/// Every topic of the node and what the rig sends come as the bytes that their own schema decodes.
#[test]
fn a_foreign_viewer_decodes_every_topic() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&["--foxglove", LIVE]);
    twin.wait_for("model time runs");
    for number in 0..3 {
        peer.send("/rig/rotary_speed_rpm", json!(40.0 + f64::from(number)));
    }
    let sending = std::thread::spawn(move || {
        for number in 0..100 {
            peer.send("/rig/rotary_speed_rpm", json!(40.0 + 0.1 * f64::from(number)));
            peer.send("/rig/weight_on_bit_kn", json!(10.0));
            std::thread::sleep(std::time::Duration::from_millis(30));
        }
    });
    let Some(seen) = network.viewer(&["decode", URL, "4"]) else {
        return;
    };
    sending.join().unwrap();
    assert_eq!(seen["capabilities"], json!([]), "nothing that a viewer sends acts");
    let offered: BTreeSet<String> = serde_json::from_value(seen["offered"].clone()).unwrap();
    let found = topics_of(&seen["found"]);
    // Without use_sim_time there is no clock. This rig does not stamp, and sends no optional input and nothing measured.
    // Nothing happens that the journal would report. Forecast, plausible tools and map are off by default, and without
    // measured values there are no residuals.
    let quiet: BTreeSet<String> = [
        "/clock",
        "/rig/inputs",
        "/rig/measured",
        "/rig/rate_of_penetration",
        "/rig/standpipe_pressure",
        "/rig/survey",
        "/twin/alarm_events",
        "/twin/bands",
        "/twin/forecast",
        "/twin/hole_drilled",
        "/twin/residuals",
        "/twin/safe_window",
    ]
    .map(str::to_owned)
    .into();
    let missing: Vec<_> = offered
        .difference(&found)
        .filter(|name| !quiet.contains(*name))
        .collect();
    assert!(missing.is_empty(), "{missing:?} of {offered:?}");
    assert_eq!(offered.len(), 31);
    let joints = &seen["found"]["/twin/joint_deflections"];
    // 50 Hz for 4 s, less the time until the subscription.
    assert!((150..=205).contains(&joints["count"].as_u64().unwrap()), "{joints}");
    assert_eq!(
        (&joints["frame"], &joints["type"]),
        (&json!("flexible_tool"), &json!("flexdrill/msg/JointDeflections"))
    );
    // The time that viewers sort by is that of the message.
    assert_eq!(joints["header"], joints["last"]);
    assert!(
        seen["found"]["/twin/session"]["configuration"]
            .as_str()
            .unwrap()
            .contains("build_angle_deg: 19")
    );
    assert_eq!(
        seen["found"]["/twin/session"]["count"], 1,
        "latched: told once, though sent before"
    );
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

/// Twenty viewers of everything, one of which takes nothing: the others, DDS and the model's deadlines know nothing of it.
#[test]
fn twenty_viewers_and_a_frozen_one_slow_nobody() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&["--foxglove", LIVE]);
    twin.wait_for("model time runs");
    peer.subscribe("/twin/status", "flexdrill/msg/TwinStatus", "reliable");
    let before = peer.status_with("/twin/status", |status| status["state"] == 1);
    let Some(seen) = network.viewer(&["crowd", URL, "20", "8"]) else {
        return;
    };
    let after = peer.take("/twin/status", 1000, 1.0).pop().unwrap();
    let counts: Vec<u64> = serde_json::from_value(seen["counts"].clone()).unwrap();
    assert_eq!(counts.len(), 19);
    let (least, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
    // 300 messages a second for 8 s and a little; they began one after another.
    assert!(*least > 1500 && most - least < 600, "{counts:?}");
    let gone = |field: &str| after[field].as_u64().unwrap() - before[field].as_u64().unwrap();
    // Where the machine made the model skip steps there is nothing to send; else every sample has come.
    assert!(seen["gaps"] == 0 || gone("steps_skipped") > 0, "{seen}");
    assert_eq!(
        (gone("frames_dropped"), gone("events_lost"), gone("dds_restarts")),
        (0, 0, 0),
        "{after}"
    );
    let dropped: u64 = after["output_dropped"]
        .as_array()
        .unwrap()
        .iter()
        .map(|count| count.as_u64().unwrap())
        .sum();
    assert_eq!(dropped, 0, "{after}");
    // This machine runs other tests too: a share, not none.
    let (late, steps) = (gone("deadline_misses"), gone("step_count"));
    assert!(late * 20 < steps, "{late} of {steps} steps were late");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    assert!(!twin.said().contains("did not reach the viewers"), "{}", twin.said());
}

#[test]
fn who_may_not_look_is_told_why() {
    let Some(network) = Network::new() else { return };
    let mut twin = network.twin(&["--foxglove", LIVE]);
    twin.wait_for("model time runs");
    let refused = |protocol: &str, origin: &str| network.viewer(&["refused", URL, protocol, origin]);
    let Some(old) = refused("foxglove.websocket.v1", "-") else {
        return;
    };
    assert_eq!(old["code"], 400);
    assert!(old["body"].as_str().unwrap().contains("newer viewer"), "{old}");
    let foreign = refused("foxglove.sdk.v1", "https://evil.example").unwrap();
    assert_eq!(foreign["code"], 403);
    // A page that somebody has sent as a file.
    for file in ["file://", "null"] {
        assert_eq!(refused("foxglove.sdk.v1", file).unwrap()["code"], 403, "{file}");
    }
    for origin in ["-", "http://localhost:8080", "https://app.foxglove.dev"] {
        assert_eq!(refused("foxglove.sdk.v1", origin).unwrap()["code"], 101, "{origin}");
    }
    let page = network.http("GET", "http://127.0.0.1:8765/", &[], "").unwrap();
    assert_eq!(page["code"], 426);
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let said = twin.said();
    assert!(
        said.contains("newer viewer") && said.contains("https://evil.example"),
        "{said}"
    );
}

#[test]
fn a_recording_is_played_paused_and_sought() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("run.mcap");
    let mut twin = network.twin(&["--record", bag.to_str().unwrap(), "--duration", "8"]);
    assert_eq!(twin.end(), Some(0));
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["replay", bag.to_str().unwrap(), "--foxglove", LIVE]);
    let mut player = Program::start(command);
    player.wait_for("playing");
    let Some(seen) = network.viewer(&["play", URL]) else {
        return;
    };
    let time = |value: &Value| value.as_u64().unwrap();
    assert!(
        seen["capabilities"]
            .as_array()
            .unwrap()
            .contains(&json!("playbackControl"))
    );
    let (start, end, middle) = (time(&seen["start"]), time(&seen["end"]), time(&seen["middle"]));
    assert!((7_500_000_000..10_000_000_000).contains(&(end - start)), "{seen}");
    // Who comes is told at once how it plays, without asking.
    assert_eq!(seen["greeted"][0]["status"], 0, "{seen}");
    let late = &seen["late"][0];
    assert_eq!((&late["status"], time(&late["time"])), (&json!(1), middle), "{seen}");
    assert_eq!(
        (
            &seen["paused"]["status"],
            &seen["paused"]["did_seek"],
            &seen["paused"]["time"]
        ),
        (&json!(1), &json!(1), &json!(middle))
    );
    // The status of five per second that stood there, and nothing after it.
    assert!(
        (middle - 400_000_000..=middle).contains(&time(&seen["at_rest"])),
        "{seen}"
    );
    assert_eq!(seen["still"], 0, "paused, nothing comes");
    assert_eq!(
        seen["session"].as_u64().map(|count| count > 0),
        Some(true),
        "what is latched stands everywhere"
    );
    // Half of 8 s at four times the speed, and what the machine takes.
    let took = seen["took"].as_f64().unwrap();
    assert!((0.7..6.0).contains(&took), "{took} s");
    assert_eq!(
        (&seen["ended"]["status"], time(&seen["ended"]["time"])),
        (&json!(3), end)
    );
    assert_eq!(
        (&seen["again"]["status"], time(&seen["again"]["time"])),
        (&json!(0), start)
    );
    assert!(time(&seen["after"]) < start + 2_000_000_000, "{seen}");
    player.signal("INT");
    assert_eq!(player.end(), Some(0));
}
