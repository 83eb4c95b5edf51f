//! The standard services of simulators (`simulation_interfaces`), asked by a DDS program of another vendor whose types come
//! from the definitions. The constants here are those of the standard, written once more.

use crate::common::{Network, Peer, Program};
use serde_json::{Value, json};

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
const STOPPED: u8 = 0;
const PLAYING: u8 = 1;
const PAUSED: u8 = 2;
const QUITTING: u8 = 3;
const LOADING: u8 = 5;
const UNSUPPORTED: u64 = 0;
const OK: u64 = 1;
const OPERATION_FAILED: u64 = 4;
const ALREADY: u64 = 101;
const TRANSITION_ERROR: u64 = 102;
const ACTION: &str = "/flexdrill/simulate_steps/_action";
const TYPE: &str = "simulation_interfaces/action/SimulateSteps";

fn call(peer: &mut Peer, service: &str, kind: &str, request: Value) -> Value {
    let kind = format!("simulation_interfaces/srv/{kind}");
    peer.command(json!({
        "do": "call", "service": format!("/flexdrill/{service}"), "type": kind, "request": request, "seconds": 20.0,
    }))["reply"]
        .clone()
}

/// Result code and text of a reply.
fn result(reply: &Value) -> (u64, String) {
    let result = &reply["result"];
    (
        result["result"].as_u64().unwrap(),
        result["error_message"].as_str().unwrap().to_owned(),
    )
}

fn set(peer: &mut Peer, state: u8) -> (u64, String) {
    let request = json!({"state": {"state": state}});
    result(&call(peer, "set_simulation_state", "SetSimulationState", request))
}

fn state(peer: &mut Peer) -> u8 {
    let reply = call(peer, "get_simulation_state", "GetSimulationState", json!({}));
    assert_eq!(result(&reply).0, OK, "{reply}");
    reply["state"]["state"].as_u64().unwrap() as u8
}

fn step(peer: &mut Peer, steps: u64) -> (u64, String) {
    result(&call(
        peer,
        "step_simulation",
        "StepSimulation",
        json!({"steps": steps}),
    ))
}

fn reset(peer: &mut Peer, scope: u8) -> (u64, String) {
    result(&call(
        peer,
        "reset_simulation",
        "ResetSimulation",
        json!({"scope": scope}),
    ))
}

/// Steps and model time (s) of the next status that is published after what was asked before.
fn model_time(peer: &mut Peer) -> (u64, f64) {
    peer.take(STATUS.0, 100, 0.3);
    let status = peer.status_with(STATUS.0, |_| true);
    (
        status["step_count"].as_u64().unwrap(),
        status["model_time"].as_f64().unwrap(),
    )
}

fn features(peer: &mut Peer) -> (Vec<u64>, Value) {
    let reply = call(peer, "get_simulator_features", "GetSimulatorFeatures", json!({}));
    let features = reply["features"]["features"].as_array().unwrap();
    (
        features.iter().map(|feature| feature.as_u64().unwrap()).collect(),
        reply["features"].clone(),
    )
}

fn ended(mut twin: Program) {
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn a_harness_asks_pauses_steps_resets_and_plays() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    let (offered, described) = features(&mut peer);
    // Reset, reset of the state, state getting and setting, pause, one step, several, the action.
    assert_eq!(offered, [20, 22, 24, 25, 26, 31, 32, 33]);
    assert_eq!(described["spawn_formats"], json!([]));
    let about = described["custom_info"].as_str().unwrap();
    assert!(about.contains("0.0005 s") && about.contains("spawned"), "{about}");

    while state(&mut peer) == LOADING {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(state(&mut peer), PLAYING);
    assert_eq!(set(&mut peer, PLAYING).0, ALREADY);
    let (refused, why) = step(&mut peer, 1);
    assert!(refused == OPERATION_FAILED && why.contains("STATE_PAUSED"), "{why}");
    assert_eq!(set(&mut peer, PAUSED), (OK, String::new()));
    assert_eq!(state(&mut peer), PAUSED);
    assert_eq!(set(&mut peer, PAUSED).0, ALREADY);

    // Model time waits, then goes on by exactly the steps that were ordered.
    let (before, time) = model_time(&mut peer);
    assert_eq!(model_time(&mut peer).0, before, "it stands still");
    assert_eq!(step(&mut peer, 5), (OK, String::new()));
    let (after, later) = model_time(&mut peer);
    assert_eq!(after, before + 5);
    assert!((later - time - 5.0 * 0.0005).abs() < 1e-9, "{time} to {later}");
    assert_eq!(step(&mut peer, 137).0, OK);
    assert_eq!(model_time(&mut peer).0, before + 142);
    assert_eq!(step(&mut peer, 0).0, OPERATION_FAILED);
    assert_eq!(model_time(&mut peer).0, before + 142);

    // A reset keeps the pause. Stamps cannot be set back, and nothing is spawned.
    for scope in [1, 3, 4] {
        let (refused, why) = reset(&mut peer, scope);
        assert!(refused == UNSUPPORTED && why.contains("SCOPE_STATE"), "{scope}: {why}");
    }
    for scope in [0, 2, 255] {
        assert_eq!(step(&mut peer, 3).0, OK);
        assert_eq!(reset(&mut peer, scope), (OK, String::new()));
        assert_eq!(model_time(&mut peer).0, 0);
        assert_eq!(state(&mut peer), PAUSED);
    }

    // Stopped is paused at the start; it is stepped in the state paused only.
    assert_eq!(step(&mut peer, 4).0, OK);
    assert_eq!(set(&mut peer, STOPPED).0, OK);
    assert_eq!((state(&mut peer), model_time(&mut peer).0), (STOPPED, 0));
    assert_eq!(set(&mut peer, STOPPED).0, ALREADY);
    assert_eq!(step(&mut peer, 1).0, OPERATION_FAILED);
    assert_eq!(set(&mut peer, PAUSED).0, OK);
    assert_eq!(step(&mut peer, 1).0, OK);

    for impossible in [QUITTING, 4, LOADING, 77] {
        assert_eq!(set(&mut peer, impossible).0, UNSUPPORTED);
    }
    assert_eq!(set(&mut peer, PLAYING).0, OK);
    peer.status_with(STATUS.0, |status| {
        status["state"] == 1 && status["step_count"].as_u64() > Some(10)
    });
    // The node's own service and the standard's are one switch.
    peer.call("/flexdrill/pause", "std_srvs/srv/SetBool", json!({"data": true}));
    peer.status_with(STATUS.0, |status| status["state"] == 2);
    assert_eq!(state(&mut peer), PAUSED);
    ended(twin);
}

/// What two twins publish after the same steps, in one order and in many.
#[test]
fn steps_in_one_order_and_in_many_publish_the_same() {
    let outputs = [
        ("/twin/joint_deflections", "flexdrill/msg/JointDeflections"),
        ("/twin/contact_forces", "flexdrill/msg/ContactForces"),
        ("/twin/bit_state", "flexdrill/msg/BitState"),
    ];
    let mut published = Vec::new();
    for orders in [vec![200], vec![1; 40], vec![3, 77, 120]] {
        let Some(network) = Network::new() else { return };
        let Some(mut peer) = network.peer() else { return };
        // Values that the configuration sets do not age while the model waits.
        let mut twin = network.twin(&[
            "--ros-args",
            "-p",
            "inputs.rotary_speed.initial_rpm:=40.0",
            "-p",
            "inputs.weight_on_bit.initial_kn:=10.0",
        ]);
        twin.wait_for("model time runs");
        while state(&mut peer) == LOADING {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        assert_eq!(set(&mut peer, STOPPED).0, OK);
        assert_eq!(set(&mut peer, PAUSED).0, OK);
        for (topic, kind) in outputs {
            peer.subscribe(topic, kind, "reliable");
        }
        peer.subscribe(STATUS.0, STATUS.1, "reliable");
        // Time for discovery, in which nothing is published.
        peer.status_with(STATUS.0, |status| status["step_count"] == 0);
        for steps in &orders {
            assert_eq!(step(&mut peer, *steps).0, OK);
        }
        let messages: Vec<Vec<Value>> = outputs
            .iter()
            .map(|(topic, _)| {
                let mut messages = peer.take(topic, 5, 2.0);
                for message in &mut messages {
                    message.as_object_mut().unwrap().remove("header");
                }
                messages
            })
            .collect();
        published.push(messages);
        ended(twin);
    }
    // 50 Hz of model time: each 40 steps. 40 single steps publish the first of the five messages.
    for (index, (topic, _)) in outputs.iter().enumerate() {
        let [whole, single, mixed] = [0, 1, 2].map(|run| &published[run][index]);
        assert!(
            whole.len() == 5 && single.len() == 1,
            "{topic}: {} {}",
            whole.len(),
            single.len()
        );
        assert_eq!(whole, mixed, "{topic}");
        assert_eq!(whole[0], single[0], "{topic}");
        assert_ne!(whole[0], whole[4], "{topic}: nothing moved");
    }
}

fn goal(peer: &mut Peer, number: u8, steps: u64) -> bool {
    let request = json!({"goal_id": {"uuid": vec![number; 16]}, "goal": {"steps": steps}});
    let reply = peer.call(&format!("{ACTION}/send_goal"), &format!("{TYPE}_SendGoal"), request);
    reply["accepted"].as_bool().unwrap()
}

/// State of a goal and its result, once it has ended.
fn goal_result(peer: &mut Peer, number: u8) -> (i64, (u64, String)) {
    let reply = peer.command(json!({
        "do": "call", "service": format!("{ACTION}/get_result"), "type": format!("{TYPE}_GetResult"),
        "request": {"goal_id": {"uuid": vec![number; 16]}}, "seconds": 20.0,
    }))["reply"]
        .clone();
    (reply["status"].as_i64().unwrap(), result(&reply["result"]))
}

#[test]
fn the_action_steps_says_how_far_it_is_and_can_be_cancelled() {
    const SUCCEEDED: i64 = 4;
    const CANCELED: i64 = 5;
    const ABORTED: i64 = 6;
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    while state(&mut peer) == LOADING {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    let feedback = format!("{ACTION}/feedback");
    peer.subscribe(&feedback, &format!("{TYPE}_FeedbackMessage"), "reliable");
    assert!(goal(&mut peer, 1, 10));
    let (status, (code, why)) = goal_result(&mut peer, 1);
    assert_eq!((status, code), (ABORTED, OPERATION_FAILED), "it plays: {why}");

    assert_eq!(set(&mut peer, PAUSED).0, OK);
    let (before, _) = model_time(&mut peer);
    peer.take(&feedback, 100, 0.1);
    assert!(goal(&mut peer, 2, 400));
    assert_eq!(goal_result(&mut peer, 2), (SUCCEEDED, (OK, String::new())));
    assert_eq!(model_time(&mut peer).0, before + 400);
    let heard = peer.take(&feedback, 100, 0.5);
    let counts: Vec<(u64, u64)> = heard
        .iter()
        .map(|message| {
            let count = |field: &str| message["feedback"][field].as_u64().unwrap();
            (count("completed_steps"), count("remaining_steps"))
        })
        .collect();
    assert!(counts.iter().all(|(done, left)| done + left == 400), "{counts:?}");
    assert!(counts.is_sorted() && counts.len() >= 2, "{counts:?}");
    assert_eq!(counts.last(), Some(&(400, 0)));

    // A minute of model time, cancelled. Meanwhile nobody else steps.
    assert!(goal(&mut peer, 3, 120_000));
    assert!(!goal(&mut peer, 4, 1), "one goal at a time");
    assert_eq!(step(&mut peer, 1).0, OPERATION_FAILED);
    let request = json!({"goal_info": {"goal_id": {"uuid": vec![3; 16]}}});
    let reply = peer.call(&format!("{ACTION}/cancel_goal"), "action_msgs/srv/CancelGoal", request);
    assert_eq!(reply["return_code"], 0);
    let (status, (code, why)) = goal_result(&mut peer, 3);
    assert_eq!((status, code), (CANCELED, OPERATION_FAILED));
    let taken: u64 = why.split(' ').nth(2).unwrap().parse().unwrap();
    assert_eq!(model_time(&mut peer).0, before + 400 + taken, "{why}");

    // A long order ends with the node, and its client has an answer.
    assert!(goal(&mut peer, 5, 120_000));
    ended(twin);
}

#[test]
fn a_managed_twin_and_one_on_a_clock_offer_less() {
    let Some(network) = Network::new() else { return };
    let mut twin = network.twin(&["--lifecycle"]);
    twin.wait_for("model time runs");
    let Some(mut peer) = network.peer() else { return };
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    peer.status_with(STATUS.0, |status| status["state"] == 2);
    assert_eq!(features(&mut peer).0, [20, 22, 24, 25]);
    // Unconfigured: model time stands still, and does not run before a supervisor activates the node.
    assert_eq!(state(&mut peer), PAUSED);
    let (refused, why) = set(&mut peer, PLAYING);
    assert!(refused == TRANSITION_ERROR && why.contains("activate"), "{why}");
    assert_eq!(step(&mut peer, 1).0, UNSUPPORTED);
    for label in ["configure", "activate"] {
        let request = json!({"transition": {"id": 0, "label": label}});
        peer.call("/flexdrill/change_state", "lifecycle_msgs/srv/ChangeState", request);
    }
    // The transition is answered before the solver runs on.
    peer.status_with(STATUS.0, |status| status["state"] == 1);
    let (refused, why) = set(&mut peer, PAUSED);
    assert!(refused == TRANSITION_ERROR && why.contains("deactivate"), "{why}");
    assert_eq!(set(&mut peer, QUITTING), (OK, String::new()));
    assert_eq!(twin.end(), Some(0));

    // The program that publishes the clock is the one to be paused and stepped.
    let mut twin = network.twin(&["--ros-args", "-p", "use_sim_time:=true"]);
    twin.wait_for("model time runs");
    let (offered, described) = features(&mut peer);
    assert_eq!(offered, [20, 22, 24, 25, 26]);
    assert!(
        described["custom_info"].as_str().unwrap().contains("/clock"),
        "{described}"
    );
    assert_eq!(state(&mut peer), LOADING, "no clock has ticked");
    assert_eq!(step(&mut peer, 1).0, UNSUPPORTED);
    ended(twin);
}
