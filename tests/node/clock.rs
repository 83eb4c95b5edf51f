//! The node under `/clock`: at half speed and standing still it is as healthy as under its own clock.

use std::time::{Duration, Instant};

use crate::common::{Network, Peer};
use serde_json::{Value, json};

const STATUS: &str = "/twin/status";
const DIAGNOSTICS: &str = "/diagnostics";
/// Begin of the simulated time (s).
const BEGIN: f64 = 1000.0;

/// Sends `/clock` at half speed, 50 times a second, for so long; where it has got to (s).
fn half_speed(clock: &mut Peer, from: f64, seconds: f64) -> f64 {
    let (began, mut time) = (Instant::now(), from);
    while began.elapsed().as_secs_f64() < seconds {
        time = from + 0.5 * began.elapsed().as_secs_f64();
        let value = json!({"clock": {"sec": time as i64, "nanosec": (time.fract() * 1e9) as i64}});
        let publish = json!({"do": "publish", "topic": "/clock", "type": "rosgraph_msgs/msg/Clock", "value": value});
        clock.command(publish);
        std::thread::sleep(Duration::from_millis(20));
    }
    time
}

/// Sends one `/clock` message (s).
fn tick(clock: &mut Peer, time: f64) {
    let value = json!({"clock": {"sec": time as i64, "nanosec": (time.fract() * 1e9) as i64}});
    clock.command(json!({"do": "publish", "topic": "/clock", "type": "rosgraph_msgs/msg/Clock", "value": value}));
}

/// Stamp of a message (s).
fn stamp(message: &Value) -> f64 {
    let stamp = &message["header"]["stamp"];
    stamp["sec"].as_f64().unwrap() + stamp["nanosec"].as_f64().unwrap() * 1e-9
}

/// Level of the pacing item in every diagnostics message that has come.
fn pacing(peer: &mut Peer) -> Vec<Value> {
    let items = |message: Value| message["status"].as_array().cloned().unwrap_or_default();
    peer.take(DIAGNOSTICS, 1, 3.0)
        .into_iter()
        .flat_map(items)
        .filter(|item| item["name"] == "/flexdrill: pacing")
        .collect()
}

#[test]
fn a_slow_and_a_paused_clock_are_no_fault_of_the_node() {
    let Some(network) = Network::new() else { return };
    let (Some(mut peer), Some(mut clock)) = (network.peer(), network.peer()) else {
        return;
    };
    let mut twin = network.twin(&["--ros-args", "-p", "use_sim_time:=true"]);
    twin.wait_for("Ctrl-C ends it");
    peer.subscribe(STATUS, "flexdrill/msg/TwinStatus", "reliable");
    peer.subscribe(DIAGNOSTICS, "diagnostic_msgs/msg/DiagnosticArray", "reliable");
    let time = half_speed(&mut clock, BEGIN, 2.0);
    // What came while it started is not judged.
    peer.take(STATUS, 1, 0.0);
    pacing(&mut peer);
    let time = half_speed(&mut clock, time, 4.0);
    let status = peer.take(STATUS, 1, 5.0).pop().unwrap();
    let factor = status["real_time_factor"].as_f64().unwrap();
    assert!((factor - 1.0).abs() < 0.02, "{factor} of the clock");
    assert_eq!(status["deadline_misses"], 0, "{status}");
    assert_eq!(status["steps_skipped"], 0, "{status}");
    let gained = status["model_time"].as_f64().unwrap();
    assert!(
        (gained - (time - BEGIN)).abs() < 1.0,
        "{gained} s of {} s",
        time - BEGIN
    );
    let moving = pacing(&mut peer);
    assert!(
        !moving.is_empty() && moving.iter().all(|item| item["level"] == 0),
        "{moving:?}"
    );
    // It stands still.
    std::thread::sleep(Duration::from_secs(3));
    let standing = pacing(&mut peer);
    assert!(
        !standing.is_empty() && standing.iter().all(|item| item["level"] == 0),
        "{standing:?}"
    );
    // Stamps are those of the clock, and not ahead of it.
    let status = peer.take(STATUS, 1, 5.0).pop().unwrap();
    let stamp = &status["header"]["stamp"];
    let stamp = stamp["sec"].as_f64().unwrap() + stamp["nanosec"].as_f64().unwrap() * 1e-9;
    assert!((time - 1.0..=time).contains(&stamp), "{stamp} and {time}");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn a_forged_clock_moves_no_stamp_and_one_that_was_believed_is_left_again() {
    /// 2038-01-18.
    const FORGED: f64 = 2_147_400_000.0;
    let Some(network) = Network::new() else { return };
    let (Some(mut peer), Some(mut clock)) = (network.peer(), network.peer()) else {
        return;
    };
    let mut twin = network.twin(&["--ros-args", "-p", "use_sim_time:=true"]);
    twin.wait_for("Ctrl-C ends it");
    peer.subscribe(STATUS, "flexdrill/msg/TwinStatus", "reliable");
    let time = half_speed(&mut clock, BEGIN, 2.0);
    peer.take(STATUS, 1, 5.0);
    // One forged message among those of the true clock.
    tick(&mut clock, FORGED);
    let mut time = half_speed(&mut clock, time, 1.5);
    let status = peer.take(STATUS, 1, 5.0).pop().unwrap();
    assert!((BEGIN..=time).contains(&stamp(&status)), "{} at {time}", stamp(&status));
    assert_eq!(status["steps_skipped"], 0, "{status}");
    assert!(
        twin.said().contains("is ignored until all messages agree on it"),
        "{}",
        twin.said()
    );
    // The true clock stops, and the forged one alone is heard until it is believed.
    half_speed(&mut clock, FORGED, 4.0);
    peer.status_with(STATUS, |status| stamp(status) > FORGED - 10.0);
    // The true one is back.
    for _ in 0..4 {
        time = half_speed(&mut clock, time, 1.5);
    }
    let last = time;
    let status = peer.status_with(STATUS, |status| stamp(status) < FORGED - 10.0);
    assert!((BEGIN..=last).contains(&stamp(&status)), "{} at {last}", stamp(&status));
    assert_eq!(status["steps_skipped"], 0, "{status}");
    assert_eq!(twin.said().matches("/clock was set by").count(), 2, "{}", twin.said());
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}
