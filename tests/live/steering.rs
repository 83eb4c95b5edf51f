//! A viewer from other hands (Python: websockets, mcap-ros2-support) that steers the twin, and one that may not.

use std::time::{Duration, Instant};

use crate::common::Network;
use serde_json::{Value, json};

const LIVE: &str = "127.0.0.1:8765";
const URL: &str = "ws://127.0.0.1:8765";
const TOKEN: &str = "a-token-that-nobody-guesses";
const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
const RAD_PER_S: f64 = std::f64::consts::PI / 30.0;

fn steering_url() -> String {
    format!("{URL}/?token={TOKEN}")
}

impl crate::common::Network {
    fn steering(&self, arguments: &[&str]) -> Option<Value> {
        self.python("websockets", "steering_viewer.py", arguments, "")
    }
}

/// A file with the token; it goes with the folder.
fn token_file() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("token");
    std::fs::write(&file, TOKEN).unwrap();
    let path = file.to_str().unwrap().to_owned();
    (folder, path)
}

fn speed(state: &Value) -> f64 {
    state["received"][0].as_f64().unwrap() / RAD_PER_S
}

#[test]
fn who_has_the_token_sets_parameters_calls_services_and_drives() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let (_folder, token) = token_file();
    let bag = tempfile::tempdir().unwrap();
    let recorded = bag.path().join("run.mcap");
    let mut twin = network.twin(&[
        "--foxglove",
        LIVE,
        "--allow-control",
        "--token-file",
        &token,
        "--record",
        recorded.to_str().unwrap(),
    ]);
    twin.wait_for("model time runs");
    peer.subscribe("/twin/applied_inputs", "flexdrill/msg/AppliedInputs", "reliable");
    let Some(seen) = network.steering(&["steer", &steering_url()]) else {
        return;
    };
    assert_eq!(
        seen["capabilities"],
        json!(["clientPublish", "services", "parameters", "parametersSubscribe"])
    );
    assert_eq!(seen["encodings"], json!(["cdr"]));

    // Parameters, through the node's own checks.
    assert!(seen["all"].as_u64().unwrap() > 100, "{seen}");
    let before = &seen["before"];
    assert!(
        before["contact.inner.friction_axial"].is_f64() && before.as_object().unwrap().len() == 2,
        "{before}"
    );
    let set = &seen["set"];
    assert_eq!(set["contact.inner.friction_axial"], json!(0.31));
    assert_eq!(
        set["inputs.rotary_speed.max_rpm"], before["inputs.rotary_speed.max_rpm"],
        "refused: as it was"
    );
    assert_eq!(seen["whole"]["inputs.weight_on_bit.slew_kn_per_s"], json!(30.0));
    let followed = seen["followed"].as_array().unwrap();
    assert_eq!(followed[0][0]["value"], json!(0.31), "{followed:?}");
    let refused = seen["refused"].to_string();
    assert!(
        refused.contains("inputs.hard_limits.max_rpm")
            && refused.contains("'tool.links' cannot change while the twin runs"),
        "{refused}"
    );

    // Services, with their own definitions.
    let services = seen["services"].as_object().unwrap();
    for (name, kind) in [
        ("/flexdrill/pause", "std_srvs/srv/SetBool"),
        ("/flexdrill/reset", "std_srvs/srv/Trigger"),
        ("/flexdrill/save_checkpoint", "std_srvs/srv/Trigger"),
        ("/flexdrill/acknowledge_alarm", "flexdrill/srv/AcknowledgeAlarm"),
        ("/flexdrill/shelve_alarm", "flexdrill/srv/ShelveAlarm"),
        ("/flexdrill/unshelve_alarm", "flexdrill/srv/UnshelveAlarm"),
        ("/flexdrill/set_parameters", "rcl_interfaces/srv/SetParameters"),
        ("/flexdrill/set_logger_levels", "rcl_interfaces/srv/SetLoggerLevels"),
        (
            "/flexdrill/get_type_description",
            "type_description_interfaces/srv/GetTypeDescription",
        ),
        // An action is three services, for viewers that know no actions.
        (
            "/flexdrill/what_if/_action/send_goal",
            "flexdrill/action/WhatIf_SendGoal",
        ),
        ("/flexdrill/what_if/_action/cancel_goal", "action_msgs/srv/CancelGoal"),
        (
            "/flexdrill/get_simulator_features",
            "simulation_interfaces/srv/GetSimulatorFeatures",
        ),
        ("/flexdrill/step_simulation", "simulation_interfaces/srv/StepSimulation"),
        (
            "/flexdrill/what_if/_action/get_result",
            "flexdrill/action/WhatIf_GetResult",
        ),
    ] {
        assert_eq!(services[name], kind);
    }
    // Six of parameters, two of loggers, one of types, three of the run, three of alarms, five of simulators, three of
    // each of two actions: all that DDS offers.
    assert_eq!(services.len(), 26, "{services:?}");
    assert_eq!(seen["paused"], json!({"success": true, "message": "paused"}));
    assert_eq!(seen["resumed"], json!({"success": true, "message": "running"}));
    assert_eq!(seen["alarm"]["success"], false);
    assert!(seen["alarm"]["message"].as_str().unwrap().contains("no_such"), "{seen}");
    assert!(seen["broken"].as_str().unwrap().contains("was not answered"), "{seen}");
    assert!(
        seen["json"].as_str().unwrap().contains("not little-endian CDR"),
        "{seen}"
    );

    // Inputs, judged as those of DDS.
    let driven = &seen["driven"];
    assert!((speed(driven) - 60.0).abs() < 1e-6, "{driven}");
    assert!(
        (driven["received"][1].as_f64().unwrap() - 12e3).abs() < 1e-6,
        "{driven}"
    );
    for driver in driven["driver"].as_array().unwrap() {
        assert!(
            driver.as_str().unwrap().starts_with("foxglove client @ 127.0.0.1:"),
            "{driver}"
        );
    }
    assert_eq!(seen["too_fast"]["rejected"], json!([1, 0]));
    assert_eq!(seen["unreadable"]["unreadable"], json!([1, 0]));
    let stamped = &seen["stamped"];
    assert!((speed(stamped) - 50.0).abs() < 1e-6, "{stamped}");
    // Zeros of a sender that does not say what it gives are no rate and no pressure.
    assert_eq!(stamped["source"], json!(vec!["a hand"; 2]));
    assert_eq!(
        stamped["several_drivers"],
        json!(vec![false; 2]),
        "one viewer is one, by both ways"
    );
    assert_eq!(seen["quiet"], json!([]));
    let said = seen["no_input"].to_string();
    for part in [
        "/twin/status is no input of the twin",
        "/rig/rotary_speed_rpm has the type std_msgs/msg/Float64 in cdr, not std_msgs/msg/Float64 in json",
        "not little-endian CDR",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(
        seen["name"].as_str().unwrap().contains("already advertising channel"),
        "{seen}"
    );

    // What was asked for is recorded with who asked.
    let changes = peer.take("/twin/applied_inputs", 100_000, 1.0);
    let asked: Vec<String> = changes
        .iter()
        .flat_map(|change| change["parameter_asked_by"].as_array().unwrap())
        .map(|by| by.as_str().unwrap().to_owned())
        .collect();
    assert!(
        asked.iter().any(|by| by.starts_with("foxglove client at 127.0.0.1:")),
        "{asked:?}"
    );
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let said = twin.said();
    for part in [
        "parameter contact.inner.friction_axial is 0.31, was 0.",
        "asked for by foxglove client at 127.0.0.1:",
        "paused: asked for by foxglove client at 127.0.0.1:",
        "1000 r/min",
        &format!("ws://{LIVE}/?token={TOKEN}"),
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // The recording is replayed with what the viewer did.
    let out = bag.path().join("again");
    let mut replay = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    let replayed = replay
        .arg("replay")
        .arg(&recorded)
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    assert!(
        replayed.status.success(),
        "{}",
        String::from_utf8_lossy(&replayed.stderr)
    );
}

/// Without the option, and without the token, all three are refused in words, and nothing is offered.
#[test]
fn who_may_only_look_is_told_so() {
    let Some(network) = Network::new() else { return };
    let (_folder, token) = token_file();
    let control: &[&str] = &["--foxglove", LIVE, "--allow-control", "--token-file", &token];
    for (arguments, others) in [(control, 401), (&control[..2], 403)] {
        let mut twin = network.twin(arguments);
        twin.wait_for("model time runs");
        let Some(seen) = network.steering(&["steer", URL]) else {
            return;
        };
        assert_eq!(seen["capabilities"], json!([]));
        assert_eq!(seen["services"], json!({}));
        let said = seen["said"].to_string();
        for capability in ["parameters", "parametersSubscribe", "clientPublish"] {
            assert!(said.contains(&format!("does not support {capability}")), "{said}");
        }
        assert_eq!(seen["reply"], "Server does not support services");
        assert_eq!(seen["state"]["driver"], json!(["", ""]));
        let refused = network.viewer(&["refused", &format!("{URL}/?token=wrong"), "foxglove.sdk.v1", "-"]);
        assert_eq!(refused.unwrap()["code"], others);
        twin.signal("INT");
        assert_eq!(twin.end(), Some(0));
        let said = twin.said();
        let logged = [
            "a viewer sent a token, but steering is off",
            "127.0.0.1:",
            "sent a wrong token",
        ];
        let logged = if others == 403 { &logged[..1] } else { &logged[1..] };
        assert!(logged.iter().all(|part| said.contains(part)), "{said}");
    }
}

/// A viewer and a rig at once are two drivers; which of them is heard is the configuration's word, as for any two.
#[test]
fn a_viewer_is_one_driver_among_others() {
    let Some(network) = Network::new() else { return };
    let Some(mut rig) = network.peer() else { return };
    let (_folder, token) = token_file();
    let mut arguments = vec!["--foxglove", LIVE, "--allow-control", "--token-file", &token];
    arguments.extend(["--ros-args", "-p", "inputs.driver.policy:=named"]);
    arguments.extend(["-p", "inputs.driver.named:=['foxglove client']"]);
    let mut twin = network.twin(&arguments);
    twin.wait_for("model time runs");
    rig.subscribe(STATUS.0, STATUS.1, "reliable");
    rig.send("/rig/rotary_speed_rpm", json!(40.0));
    let both = std::thread::scope(|scope| {
        let driving = scope.spawn(|| network.steering(&["drive", &steering_url(), "70", "4"]));
        let end = Instant::now() + Duration::from_secs(6);
        while Instant::now() < end && !driving.is_finished() {
            rig.send("/rig/rotary_speed_rpm", json!(40.0));
            std::thread::sleep(Duration::from_millis(50));
        }
        driving.join().unwrap()
    });
    let Some(both) = both else { return };
    assert!((speed(&both) - 70.0).abs() < 1e-6, "{both}");
    assert!(
        both["not_driving"][0].as_u64().unwrap() > 10,
        "the rig is not named: {both}"
    );
    assert_eq!(both["several_drivers"][0], true, "{both}");
    twin.wait_for("alarm two_drivers");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}
