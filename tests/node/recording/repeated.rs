//! A recording that was made live is replayed with the same bytes.

use super::*;

/// A message of the rig's surface torque and hook load (N m, N), of now.
fn measured(torque: f64, hook_load: f64) -> Value {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    let mut value = json!({
        "header": {"stamp": {"sec": now.as_secs(), "nanosec": now.subsec_nanos()}, "frame_id": ""},
        "quality": 0, "source": "sub 3",
    });
    for kind in MeasuredKind::ALL {
        value[kind.name()] = json!("NaN");
    }
    value["surface_torque"] = json!(torque);
    value["hook_load"] = json!(hook_load);
    json!({"do": "publish", "topic": "/rig_7/rig/measured", "type": "flexdrill/msg/RigMeasured", "value": value})
}

/// What the journal says of parameters that clients have changed: who, and which values. Each change of the test has an
/// entry with the values that alarms depend on, and none with a rate of publishing.
fn changes_of_parameters(bag: &Path) -> Vec<(String, String)> {
    let events = bag::open(bag).unwrap().map(Result::unwrap);
    let entries: Vec<(String, String)> = events
        .filter(|message| message.topic.is("twin/alarm_events"))
        .map(|message| message.decode::<AlarmEvent>().unwrap())
        .filter(|event| event.id == "changed_parameters" && event.change == AlarmEvent::ADJUSTED)
        .map(|event| (event.operator_name, event.reason))
        .collect();
    let all: String = entries.iter().map(|(_, reason)| format!("{reason}; ")).collect();
    for friction in ["from 0.2 to 0.22", "to 0.24", "to 0.26"] {
        assert!(all.contains(friction), "{friction}: {all}");
    }
    assert!(all.contains("whirl.hysteresis from 0.15 to 0.1;"), "{all}");
    assert!(!all.contains("outputs."), "{all}");
    for (by, _) in &entries {
        assert!(by.starts_with("service set_parameters_atomically, client "), "{by}");
    }
    entries
}

const BANDS: &str = "/rig_7/twin/bands";

/// The small tool with eight plausible ones that run with it, as a file in this folder.
fn with_an_ensemble(folder: &Path) -> PathBuf {
    let mut text = std::fs::read_to_string(crate::common::small_config()).unwrap();
    text += "uncertainty:\n  keys:\n    - {key: contact.outer.friction_tangential, distribution: \
             {log_normal: {low: 0.2, high: 0.4}}, source: a test}\n  sensors: {weight_indicator: \
             {factor_error: 0.05, tare_range_kn: 1}}\nensemble: {members: 8}\n";
    let path = folder.join("plausible.yaml");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_live_recording_replayed_gives_the_same_bytes() {
    a_recording_is_repeated(false);
}

#[test]
fn a_live_recording_with_plausible_tools_replayed_gives_the_same_bytes() {
    a_recording_is_repeated(true);
}

fn a_recording_is_repeated(with_plausible_tools: bool) {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (live, again) = (folder.path().join("live.mcap"), folder.path().join("again/again.mcap"));
    let live_text = live.to_str().unwrap();
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["run", "--record", live_text, "--namespace", "rig_7", "--config"]);
    command.arg(match with_plausible_tools {
        true => with_an_ensemble(folder.path()),
        false => crate::common::small_config(),
    });
    command.args(["--ros-args", "-p", "inputs.weight_on_bit.initial_kn:=5"]);
    let mut twin = Program::start(command);
    twin.wait_for("model time runs");
    if with_plausible_tools {
        peer.subscribe(BANDS, "flexdrill/msg/Bands", "reliable");
    }
    let double = |name: &str, value: f64| json!({"name": name, "value": {"type": 3, "double_value": value}});
    for round in 0..4 {
        peer.send("/rig_7/rig/rotary_speed_rpm", json!(30.0 + 10.0 * f64::from(round)));
        peer.send("/rig_7/rig/weight_on_bit_kn", json!(8.0 + f64::from(round)));
        peer.command(measured(300.0 + f64::from(round), 1.5e5));
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
            let pause = |peer: &mut crate::common::Peer, on: bool| {
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
    if with_plausible_tools {
        // They run in the time that all else leaves, so that their first second may come late.
        let heard = peer.take(BANDS, 1, 60.0);
        assert_eq!(heard[0]["members"], 8, "{heard:?}");
    }
    // The alarms are judged ten times per second: the last change is in the journal before the end.
    std::thread::sleep(Duration::from_millis(500));
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
    assert!(printed.contains("  exact: "), "{printed}");
    // Inputs and rates have changed up to the end here, so that the second half has changes too.
    if !with_plausible_tools {
        others_bags_are_replayed(&live, folder.path());
    }
    assert_eq!(
        changes_of_parameters(&again),
        changes_of_parameters(&live),
        "who changed what"
    );
    let (live, again) = (messages(&live), messages(&again));
    assert_eq!(live.keys().collect::<Vec<_>>(), again.keys().collect::<Vec<_>>());
    assert!(live.contains_key("/rig_7/twin/contact_forces"));
    assert!(
        live["/rig_7/twin/residuals"].len() > 1,
        "the rig is compared with the twin"
    );
    for (topic, recorded) in &live {
        let replayed = &again[topic];
        for (index, (a, b)) in recorded.iter().zip(replayed).enumerate() {
            assert!(a == b, "message {index} of {topic} differs");
        }
        if topic == BANDS {
            // The node ends before its plausible tools have come to its last instant; a replay waits for them.
            assert!(
                (1..=replayed.len()).contains(&recorded.len()),
                "{} of {}",
                recorded.len(),
                replayed.len()
            );
        } else {
            assert_eq!(recorded.len(), replayed.len(), "{topic}");
        }
    }
    if with_plausible_tools {
        let newest: Bands = from_cdr(again[BANDS].last().unwrap()).unwrap();
        assert_eq!((newest.members, newest.failed, newest.no_bands.as_str()), (8, 0, ""));
    }
}
