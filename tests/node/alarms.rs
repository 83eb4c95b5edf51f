//! The node's alarms over DDS: a late joiner sees them, an operator acknowledges and shelves, a restart keeps that, and
//! the journal is in the bag.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::common::{Network, Peer};
use flexdrill::bag;
use flexdrill::messages::{Alarm, AlarmEvent};
use serde_json::{Value, json};

const ALARMS: (&str, &str) = ("/twin/alarms", "flexdrill/msg/AlarmList");

/// The alarm of that id in a list that fulfils a condition.
fn alarm_with(peer: &mut Peer, id: &str, condition: impl Fn(&Value) -> bool) -> (Value, Value) {
    let deadline = Instant::now() + Duration::from_secs(30);
    let mut last = Value::Null;
    while Instant::now() < deadline {
        for list in peer.take(ALARMS.0, 1, 2.0) {
            let alarms = list["alarms"]
                .as_array()
                .unwrap_or_else(|| panic!("no alarms in {list}"));
            let found = alarms.iter().find(|alarm| alarm["id"] == id);
            last = found.unwrap_or_else(|| panic!("no {id} in {list}")).clone();
            if condition(&last) {
                return (last, list);
            }
        }
    }
    panic!("{id} is not as it should be; the last: {last}");
}

fn request(peer: &mut Peer, service: &str, kind: &str, request: Value) -> (bool, String) {
    let name = format!("/flexdrill/{service}");
    let answer = peer.call(&name, &format!("flexdrill/srv/{kind}"), request);
    (
        answer["success"].as_bool().unwrap(),
        answer["message"].as_str().unwrap().to_owned(),
    )
}

fn journal(path: &Path) -> Vec<AlarmEvent> {
    bag::open(path)
        .unwrap()
        .map(Result::unwrap)
        .filter(|message| message.topic.is("twin/alarm_events"))
        .map(|message| message.decode().unwrap())
        .collect()
}

#[test]
fn an_alarm_is_acknowledged_shelved_and_kept_over_a_restart() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let folder = tempfile::tempdir().unwrap();
    let live = folder.path().join("live.mcap");
    let mut twin = network.twin(&["--record", live.to_str().unwrap()]);
    twin.wait_for("model time runs");
    // Once each: stale after 2 s, on safe values 0.5 s later, both with the alarms' delay of 2 s.
    peer.send("/rig/rotary_speed_rpm", json!(30.0));
    peer.send("/rig/weight_on_bit_kn", json!(5.0));
    twin.wait_for("alarm rotary_speed_input (high)");
    twin.wait_for("alarm weight_on_bit_input (high)");

    // Whoever comes late has the list at once, and again within a second.
    peer.subscribe(ALARMS.0, ALARMS.1, "latched");
    let (speed, list) = alarm_with(&mut peer, "rotary_speed_input", |alarm| {
        alarm["state"] == Alarm::ACTIVE_UNACKNOWLEDGED && alarm["priority"] == Alarm::HIGH
    });
    assert_eq!(
        list["alarms"].as_array().unwrap().len(),
        flexdrill::alarms::AlarmId::ALL.len()
    );
    assert_eq!(list["alarms"][0]["priority"], Alarm::HIGH, "the worst first: {list}");
    let evidence = speed["evidence"].as_str().unwrap();
    assert!(
        evidence.contains("rig/rotary_speed_rpm") && evidence.contains("r/min"),
        "{evidence}"
    );
    assert!(!speed["what_to_do"].as_str().unwrap().is_empty());
    // The drive stands, so the tool's alarms mean nothing.
    alarm_with(&mut peer, "backward_whirl", |alarm| {
        alarm["state"] == Alarm::SUPPRESSED_BY_DESIGN
    });

    let acknowledge = |peer: &mut Peer, id: &str, name: &str| {
        let asked = json!({"id": id, "operator_name": name, "reason": "rig restarts"});
        request(peer, "acknowledge_alarm", "AcknowledgeAlarm", asked)
    };
    let (done, why) = acknowledge(&mut peer, "rotary_speed_input", "");
    assert!(!done && why.contains("operator"), "{why}");
    let (done, why) = acknowledge(&mut peer, "rotary_sped_input", "ann");
    assert!(!done && why.contains("rotary_speed_input"), "{why}");
    assert_eq!(
        acknowledge(&mut peer, "rotary_speed_input", "ann"),
        (true, "rotary_speed_input acknowledged".to_owned())
    );
    alarm_with(&mut peer, "rotary_speed_input", |alarm| {
        alarm["state"] == Alarm::ACTIVE_ACKNOWLEDGED
    });

    let shelve = |peer: &mut Peer, duration: f64, reason: &str| {
        let asked =
            json!({"id": "weight_on_bit_input", "duration": duration, "operator_name": "ann", "reason": reason});
        request(peer, "shelve_alarm", "ShelveAlarm", asked)
    };
    let (done, why) = shelve(&mut peer, 600.0, "");
    assert!(!done && why.contains("reason"), "{why}");
    let (done, why) = shelve(&mut peer, 1e6, "sensor replaced");
    assert!(!done && why.contains("at most 3600 s"), "{why}");
    let (done, why) = shelve(&mut peer, 600.0, "sensor replaced");
    assert!(done, "{why}");
    let (shelved, before) = alarm_with(&mut peer, "weight_on_bit_input", |alarm| {
        alarm["state"] == Alarm::SHELVED
    });
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));

    // The journal: without a gap, with who and why.
    let events = journal(&live);
    for (index, event) in events.iter().enumerate() {
        assert_eq!(event.sequence, index as u64 + 1);
    }
    let asked = |change: u8, id: &str| {
        events
            .iter()
            .find(|event| event.change == change && event.id == id)
            .unwrap_or_else(|| panic!("no {change} of {id} in {events:?}"))
    };
    let acknowledged = asked(AlarmEvent::ACKNOWLEDGED, "rotary_speed_input");
    assert_eq!(
        (acknowledged.operator_name.as_str(), acknowledged.reason.as_str()),
        ("ann", "rig restarts")
    );
    let put_aside = asked(AlarmEvent::SHELVED, "weight_on_bit_input");
    assert_eq!(
        (put_aside.operator_name.as_str(), put_aside.reason.as_str()),
        ("ann", "sensor replaced")
    );

    // Killed, too, it comes back as it was. A rig that has not sent yet is not waited for here.
    let at_once = ["--ros-args", "-p", "alarms.first_sample_within:=0.0"];
    let mut again = network.twin(&at_once);
    again.wait_for("model time runs");
    again.signal("KILL");
    again.end();
    let mut again = network.twin(&at_once);
    again.wait_for("model time runs");
    let (kept, after) = alarm_with(&mut peer, "weight_on_bit_input", |alarm| {
        alarm["state"] == Alarm::SHELVED
    });
    assert_eq!(kept["shelved_until"], shelved["shelved_until"]);
    assert!(after["sequence"].as_u64() >= before["sequence"].as_u64(), "{after}");
    alarm_with(&mut peer, "rotary_speed_input", |alarm| {
        alarm["state"] == Alarm::ACTIVE_ACKNOWLEDGED
    });
    let unshelve = json!({"id": "weight_on_bit_input", "operator_name": "ann", "reason": "sensor is back"});
    // As a client of the other DDS layer asks.
    let answer = peer.call_as_rmw_cyclone("/flexdrill/unshelve_alarm", "flexdrill/srv/UnshelveAlarm", unshelve);
    assert_eq!(answer["success"], true, "{answer}");
    alarm_with(&mut peer, "weight_on_bit_input", |alarm| {
        alarm["state"] == Alarm::ACTIVE_UNACKNOWLEDGED
    });
}

#[test]
fn a_damaged_state_is_told_and_the_node_starts() {
    let Some(network) = Network::new() else { return };
    let folder = network.state().join("flexdrill");
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("alarms_domain_0.flexdrill.json");
    std::fs::write(&file, "{\"format\":1,\"seq").unwrap();
    let mut twin = network.twin(&["--duration", "3"]);
    let line = twin.wait_for("damaged");
    assert!(line.contains("alarms_domain_0.flexdrill.json"), "{line}");
    twin.wait_for("model time runs");
    assert_eq!(twin.end(), Some(0));
    let kept: Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    assert_eq!(kept["format"], 1, "the next state replaces it");
}
