//! A managed node follows its transitions, and a pause is no lateness.

use super::*;

#[test]
fn a_managed_node_follows_its_transitions() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&["--lifecycle"]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    peer.subscribe(
        "/flexdrill/transition_event",
        "lifecycle_msgs/msg/TransitionEvent",
        "reliable",
    );
    let paused = peer.status_with(STATUS.0, |status| status["state"] == 2);
    assert_eq!(paused["step_count"], 0, "it begins unconfigured, at its start");
    let change = |peer: &mut crate::common::Peer, label: &str| {
        let request = json!({"transition": {"id": 0, "label": label}});
        peer.call("/flexdrill/change_state", "lifecycle_msgs/srv/ChangeState", request)["success"] == true
    };
    let refused = peer.call("/flexdrill/pause", "std_srvs/srv/SetBool", json!({"data": false}));
    let why = refused["message"].as_str().unwrap();
    assert!(
        refused["success"] == false && why.contains("unconfigured") && why.contains("activate"),
        "{refused}"
    );
    assert!(!change(&mut peer, "activate"), "there is no such way from unconfigured");
    assert!(change(&mut peer, "configure"));
    let possible = peer.call(
        "/flexdrill/get_available_transitions",
        "lifecycle_msgs/srv/GetAvailableTransitions",
        json!({}),
    );
    assert_eq!(
        length(&possible, "available_transitions"),
        3,
        "cleanup, activate, shutdown"
    );
    assert!(change(&mut peer, "activate"));
    let state = peer.call("/flexdrill/get_state", "lifecycle_msgs/srv/GetState", json!({}));
    assert_eq!(state["current_state"]["label"], "active");
    let active = peer.status_with(STATUS.0, |status| {
        status["state"] == 1 && status["step_count"].as_u64() > Some(0)
    });
    assert!(!is_slow(&active), "{active}");
    assert!(change(&mut peer, "deactivate"));
    peer.status_with(STATUS.0, |status| status["state"] == 2);
    assert!(change(&mut peer, "cleanup"));
    peer.status_with(STATUS.0, |status| status["step_count"] == 0);
    let events = peer.take("/flexdrill/transition_event", 4, 2.0);
    let goals: Vec<&Value> = events.iter().map(|event| &event["goal_state"]["label"]).collect();
    assert_eq!(goals, ["inactive", "active", "inactive", "unconfigured"]);
    assert!(change(&mut peer, "shutdown"));
    assert_eq!(twin.end(), Some(0));
}

/// Whether the status gives a factor that includes the time of a pause. In the first second there is none.
fn is_slow(status: &Value) -> bool {
    status["real_time_factor"].as_f64().is_some_and(|factor| factor < 0.5) || status["pace"].as_u64() > Some(1)
}

#[test]
fn a_pause_is_no_lateness() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    peer.subscribe("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", "reliable");
    let before = peer.status_with(STATUS.0, |status| status["state"] == 1);
    let pause = |peer: &mut crate::common::Peer, pause: bool| {
        let answer = peer.call("/flexdrill/pause", "std_srvs/srv/SetBool", json!({"data": pause}));
        assert_eq!(answer["success"], true, "{answer}");
    };
    pause(&mut peer, true);
    peer.status_with(STATUS.0, |status| status["state"] == 2);
    std::thread::sleep(std::time::Duration::from_secs(3));
    peer.take(STATUS.0, 100, 0.5);
    peer.take("/diagnostics", 100, 0.0);
    pause(&mut peer, false);
    let first = peer.status_with(STATUS.0, |status| status["state"] == 1);
    assert!(!is_slow(&first), "{first}");
    let count = |status: &Value, key: &str| status[key].as_u64().unwrap();
    let [skipped, stood] = ["steps_skipped", "steps_stood_still"].map(|key| count(&first, key) - count(&before, key));
    assert!(skipped < stood / 2, "{skipped} skipped, {stood} stood still");
    for message in peer.take("/diagnostics", 3, 4.0) {
        let items = message["status"].as_array().unwrap();
        let item = items.iter().find(|item| item["name"] == "/flexdrill: pacing").unwrap();
        assert_eq!(item["level"], 0, "{item}");
    }
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let said = twin.said();
    assert!(said.contains("not taken (paused or failed)"), "{said}");
    assert!(!said.contains("not in real time"), "{said}");
}

/// A client that has never asked before has to be found before a reply reaches it; the node's end waits for that.
#[test]
fn the_shutdown_of_a_managed_node_is_answered() {
    let Some(network) = Network::new() else { return };
    for as_cyclone in [false, true] {
        let mut twin = network.twin(&["--lifecycle"]);
        twin.wait_for("model time runs");
        let Some(mut peer) = network.peer() else { return };
        let request = json!({"transition": {"id": 5, "label": ""}});
        let (service, kind) = ("/flexdrill/change_state", "lifecycle_msgs/srv/ChangeState");
        // Without an answer this panics.
        let reply = if as_cyclone {
            peer.call_as_rmw_cyclone(service, kind, request)
        } else {
            peer.call(service, kind, request)
        };
        assert_eq!(reply["success"], true, "{reply}");
        assert_eq!(twin.end(), Some(0));
    }
}
