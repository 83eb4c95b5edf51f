//! Inputs over DDS from a program of another vendor: who drives, stamps, bytes that are no message, parameters before the
//! first tick of `/clock`.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use crate::common::{Network, Peer};
use serde_json::{Value, json};

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
const SPEED: &str = "/rig/rotary_speed_rpm";
const RAD_PER_S: f64 = std::f64::consts::PI / 30.0;

fn received(status: &Value) -> Option<f64> {
    status["input_received"][0].as_f64().map(|speed| speed / RAD_PER_S)
}

/// Both send, in turn, for so long.
fn both_send(first: &mut Peer, second: &mut Peer, time: Duration) {
    let end = Instant::now() + time;
    while Instant::now() < end {
        first.send(SPEED, json!(40.0));
        second.send(SPEED, json!(90.0));
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn two_publishers_at_once_are_an_alarm_that_names_them() {
    let Some(network) = Network::new() else { return };
    let (Some(mut rig), Some(mut other)) = (network.peer(), network.peer()) else {
        return;
    };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    rig.subscribe(STATUS.0, STATUS.1, "reliable");
    rig.send(SPEED, json!(40.0));
    let alone = rig.status_with(STATUS.0, |status| status["input_driver"][0] != json!(""));
    assert_eq!(alone["input_several_drivers"], json!([false, false]), "{alone}");
    both_send(&mut rig, &mut other, Duration::from_secs(4));
    let both = rig.status_with(STATUS.0, |status| status["input_several_drivers"][0] == json!(true));
    let publishers = both["input_publishers"][0].as_str().unwrap();
    assert_eq!(publishers.matches(" @ 127.0.0.1 (").count(), 2, "{publishers}");
    assert_eq!(both["input_publishers"][1], "");
    twin.wait_for("alarm two_drivers (medium): Rotary speed is published by");
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn the_first_one_drives_where_the_configuration_says_so() {
    let Some(network) = Network::new() else { return };
    let (Some(mut rig), Some(mut other)) = (network.peer(), network.peer()) else {
        return;
    };
    let mut twin = network.twin(&["--ros-args", "-p", "inputs.driver.policy:=first"]);
    twin.wait_for("model time runs");
    rig.subscribe(STATUS.0, STATUS.1, "reliable");
    rig.send(SPEED, json!(40.0));
    both_send(&mut rig, &mut other, Duration::from_secs(2));
    let status = rig.status_with(STATUS.0, |status| status["input_not_driving"][0].as_u64() > Some(10));
    assert!((received(&status).unwrap() - 40.0).abs() < 1e-9, "{status}");
    let line = twin.wait_for("90 r/min of");
    assert!(line.contains("drives until it has been silent for 2 s"), "{line}");
    // The rig falls silent: the other one drives.
    let end = Instant::now() + Duration::from_secs(3);
    while Instant::now() < end {
        other.send(SPEED, json!(90.0));
        std::thread::sleep(Duration::from_millis(50));
    }
    rig.status_with(STATUS.0, |status| {
        received(status).is_some_and(|speed| (speed - 90.0).abs() < 1e-9)
    });
}

fn stamped(age: f64, quality: u8, speed: f64) -> Value {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs_f64() - age;
    json!({
        "do": "publish", "topic": "/rig/inputs", "type": "flexdrill/msg/RigInputs",
        "value": {
            "header": {"stamp": {"sec": now.floor() as i64, "nanosec": (now.fract() * 1e9) as u32}, "frame_id": ""},
            "rotary_speed_rpm": speed, "weight_on_bit_kn": 5.0, "quality": quality, "source": "encoder 2",
        },
    })
}

#[test]
fn stamped_inputs_age_from_their_stamp_and_what_is_no_message_is_counted() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let folder = tempfile::tempdir().unwrap();
    let live = folder.path().join("live.mcap");
    let mut twin = network.twin(&["--record", live.to_str().unwrap()]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    peer.command(stamped(1.2, 1, 41.0));
    // The peer waits for a moment with a new writer.
    peer.command(stamped(0.8, 1, 42.0));
    let status = peer.status_with(STATUS.0, |status| {
        received(status).is_some_and(|speed| (speed - 42.0).abs() < 1e-9)
    });
    let age = status["input_age"][0].as_f64().unwrap();
    assert!((0.8..2.0).contains(&age), "{age}");
    // The peer sends every field, 0 where none is asked of it, as a program does that does not know the field.
    assert_eq!(status["input_name"], json!(["rotary_speed", "weight_on_bit"]));
    assert_eq!(status["input_source"], json!(vec!["encoder 2"; 2]));
    assert_eq!(status["input_suspect"], json!(vec![true; 2]));
    let line = twin.wait_for("rig/inputs: ");
    assert!(
        line.contains("leaves values at 0") && line.contains("Set `given`"),
        "{line}"
    );
    peer.command(stamped(0.0, 2, 50.0));
    twin.wait_for("rig/inputs: rotary_speed 50 r/min refused: its source calls it BAD");
    peer.command(stamped(-30.0, 0, 51.0));
    let line = twin.wait_for("rig/inputs: rotary_speed 51 r/min refused: its stamp is");
    assert!(line.contains("ahead of the clock"), "{line}");
    peer.command(stamped(60.0, 0, 52.0));
    let line = twin.wait_for("rig/inputs: rotary_speed 52 r/min refused: its stamp is");
    assert!(line.contains("old, stale from 2 s on"), "{line}");
    for _ in 0..20 {
        let short =
            json!({"do": "publish", "topic": SPEED, "type": "std_msgs/msg/Float64", "value": {}, "short": true});
        peer.command(short);
    }
    let status = peer.status_with(STATUS.0, |status| status["input_unreadable"] == json!([20, 0]));
    assert_eq!(status["input_rejected"], json!([3, 3]), "{status}");
    // A program that says which values it gives can give a 0: the pump is off.
    let mut given = stamped(0.0, 0, 43.0);
    given["value"]["given"] = json!(1 | 8);
    peer.command(given);
    let status = peer.status_with(STATUS.0, |status| {
        received(status).is_some_and(|speed| (speed - 43.0).abs() < 1e-9)
    });
    // The rate of penetration was not given.
    let names = json!(["rotary_speed", "weight_on_bit", "standpipe_pressure"]);
    assert_eq!(status["input_name"], names, "{status}");
    assert_eq!(status["input_received"][2], 0.0, "{status}");
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
    let lines = twin.said().matches("a sample could not be read").count();
    assert!((1..=2).contains(&lines), "{lines} lines about 20 samples");
    let recorded = flexdrill::bag::open(&live).unwrap().map(Result::unwrap);
    let recorded = recorded.filter(|message| message.topic.is("rig/inputs"));
    assert_eq!(recorded.count(), 6);
}

/// What is answered with "successful" acts, whenever it was asked for.
#[test]
fn parameters_set_before_the_first_tick_act_and_a_standing_clock_ends_a_run() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&["--duration", "8", "--ros-args", "-p", "use_sim_time:=true"]);
    twin.wait_for("model time runs");
    peer.subscribe("/twin/applied_inputs", "flexdrill/msg/AppliedInputs", "reliable");
    let set = "rcl_interfaces/srv/SetParameters";
    let count = 120;
    let friction = |number: i32| 0.2 + 1e-3 * f64::from(number);
    let started = Instant::now();
    for number in 1..=count {
        let value = json!({"type": 3, "double_value": friction(number)});
        let parameters = json!({"parameters": [
            {"name": "contact.inner.friction_axial", "value": value},
            {"name": "whirl.hysteresis", "value": value},
        ]});
        let answer = peer.call("/flexdrill/set_parameters", set, parameters);
        assert_eq!(answer["results"][0]["successful"], true, "{number}: {answer}");
        assert_eq!(answer["results"][1]["successful"], true, "{number}: {answer}");
    }
    assert!(
        started.elapsed() < Duration::from_secs(8),
        "the run's duration would end it"
    );
    // The log has one line per parameter in ten seconds, so that no client fills it; the recording names each change.
    let line = twin.wait_for("parameter whirl.hysteresis is 0.201");
    assert!(
        !twin.said().contains("parameter whirl.hysteresis is 0.202"),
        "{}",
        twin.said()
    );
    assert!(line.contains("asked for by service set_parameters, client "), "{line}");
    // A name that would clear the terminal and forge a line of the log.
    let evil =
        json!({"parameters": [{"name": "\u{1b}[2Jx\nalarms are off", "value": {"type": 1, "bool_value": true}}]});
    let answer = peer.call("/flexdrill/set_parameters", set, evil);
    assert_eq!(answer["results"][0]["successful"], false);
    twin.wait_for("there is no parameter '\\u{1b}[2Jx\\nalarms are off'");
    assert!(!twin.said().contains('\u{1b}'), "{}", twin.said());
    peer.command(json!({
        "do": "publish", "topic": "/clock", "type": "rosgraph_msgs/msg/Clock",
        "value": {"clock": {"sec": 1000, "nanosec": 0}},
    }));
    let applied = peer.take("/twin/applied_inputs", 1, 10.0);
    assert_eq!(applied[0]["step"], 0);
    assert_eq!(applied[0]["inner_friction"][1], friction(count), "{}", applied[0]);
    let last = applied[0]["parameter_value"]
        .as_array()
        .unwrap()
        .last()
        .unwrap()
        .clone();
    assert_eq!(last, friction(count));
    let asked_by = applied[0]["parameter_asked_by"].as_array().unwrap();
    assert_eq!(asked_by.len(), 2 * count as usize, "one for each change");
    let asked_by = asked_by[0].as_str().unwrap();
    // A plain DDS program has no node; its address and the id of its writer are known.
    assert!(
        asked_by.starts_with("service set_parameters, client unnamed node @ ") && !asked_by.contains("unknown host"),
        "{asked_by}"
    );
    assert!(line.contains(asked_by), "{asked_by} in {line}");
    twin.wait_for("model time has stood still for the configured duration of 8 s");
    assert_eq!(twin.end(), Some(0));
}

/// A twin that is stopped for a moment, as a busy machine stops it, while a publisher floods an input: 256 samples wait,
/// and the others are counted and told, in the log, the status and the diagnostics.
#[test]
fn samples_that_come_faster_than_they_are_taken_are_counted_and_told() {
    let Some(network) = Network::new() else { return };
    let (Some(mut flood), Some(mut peer)) = (network.peer(), network.peer()) else {
        return;
    };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    peer.subscribe("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", "reliable");
    let before = peer.status_with(STATUS.0, |_| true);
    assert_eq!(before["input_overrun"], json!([0, 0]));
    let flooding = std::thread::spawn(move || {
        flood.command(json!({
            "do": "flood", "topic": SPEED, "type": "std_msgs/msg/Float64", "value": {"data": 40.0}, "seconds": 12.0,
        }))
    });
    // What goes through the sockets meanwhile depends on the machine, so several times; shorter than its patience with DDS.
    for _ in 0..8 {
        std::thread::sleep(Duration::from_millis(400));
        twin.signal("STOP");
        std::thread::sleep(Duration::from_millis(800));
        twin.signal("CONT");
    }
    let sent = flooding.join().unwrap()["count"].as_u64().unwrap();
    let lost = |status: &Value| status["input_overrun"][0].as_u64().unwrap();
    let status = peer.status_with(STATUS.0, |status| lost(status) > 0);
    assert!(
        lost(&status) < sent && status["input_overrun"][1] == json!(0),
        "{status}"
    );
    assert_eq!(received(&status).map(f64::round), Some(40.0), "the newest acts");
    assert_eq!(status["dds_restarts"], 0, "{}", status["dds_restart_cause"]);
    let line = twin.wait_for("came faster than the node reads them");
    assert!(line.contains("rig/rotary_speed_rpm: "), "{line}");
    let deadline = Instant::now() + Duration::from_secs(10);
    loop {
        assert!(Instant::now() < deadline, "the diagnostics do not tell");
        let told = peer.take("/diagnostics", 1, 1.0);
        if told
            .iter()
            .any(|message| message.to_string().contains("came too fast to be taken"))
        {
            break;
        }
    }
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
}
