//! Our server, with asyncua as client.

use std::path::PathBuf;
use std::time::Duration;

use flexdrill_bridge::opcua::event::ServerEvent;
use flexdrill_messages::TwinStatus;
use flexdrill_messages::topics;
use serde_json::Value;

use crate::peer::{ask, python};
use crate::running::{Running, USER, alarm, speak, status};

/// What becomes different in a status.
type Change = fn(&mut TwinStatus);

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn interop_asyncua_browses_and_reads_values_with_units_and_status_and_may_not_write() {
    let Some(python) = python() else { return };
    let running = Running::new().await;
    let paths = [
        "figures/bit_torque",
        "figures/stick_slip_index",
        "figures/max_bend_angle",
        "status/state",
        "inputs/weight_on_bit/applied",
        "inputs/weight_on_bit/state",
        "alarms/backward_whirl/active",
        "alarms/backward_whirl/level",
        "alarms/backward_whirl/evidence",
        "alarms/backward_whirl/advice",
        "alarms/backward_whirl/measured_depth",
        "residuals/hook_load/ratio",
        "residuals/hook_load/measured",
        "safe_window/rotary_speed",
        "safe_window/verdict",
        "targets/rotary_speed",
    ];
    let url = running.url();
    let mut arguments = vec!["read", &url];
    arguments.extend(&paths[..2]);
    // Before the twin speaks there is a status and no value.
    let seen = ask(&python, &arguments).await;
    assert_eq!(
        seen["values"]["figures/bit_torque"]["status"],
        "BadWaitingForInitialData"
    );
    assert_eq!(seen["values"]["figures/bit_torque"]["value"], Value::Null);

    speak(&running);
    arguments.extend(&paths[2..]);
    // Until the next update.
    tokio::time::sleep(Duration::from_millis(300)).await;
    let seen = ask(&python, &arguments).await;
    let folders: Vec<&str> = seen["folders"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Value::as_str)
        .collect();
    assert_eq!(
        folders,
        [
            "alarms",
            "bands",
            "figures",
            "inputs",
            "residuals",
            "safe_window",
            "status",
            "targets"
        ]
    );
    assert_eq!(seen["alarms"], serde_json::json!(["backward_whirl", "late"]));
    let of = |path: &str| seen["values"][path].clone();
    let torque = of("figures/bit_torque");
    assert_eq!((&torque["value"], &torque["status"]), (&350.0.into(), &"Good".into()));
    assert_eq!(torque["type"], "Double");
    assert_eq!(torque["time"].as_f64(), Some(1.7e9));
    // The number of UNECE's code NU, newton metre.
    let unit = serde_json::json!(["N.m", 20053, "http://www.opcfoundation.org/UA/units/un/cefact"]);
    assert_eq!(torque["unit"], unit);
    // The twin has no such value at present, or has not sent its message.
    assert_eq!(of("figures/stick_slip_index")["status"], "BadNoData");
    assert_eq!(of("figures/max_bend_angle")["status"], "BadWaitingForInitialData");
    for (path, value) in [
        ("status/state", Value::from("running")),
        ("inputs/weight_on_bit/applied", 25e3.into()),
        ("inputs/weight_on_bit/state", "ok".into()),
        ("alarms/backward_whirl/active", true.into()),
        ("alarms/backward_whirl/level", "high".into()),
        ("alarms/backward_whirl/evidence", alarm().evidence.into()),
        ("alarms/backward_whirl/advice", alarm().what_to_do.into()),
        ("alarms/backward_whirl/measured_depth", 1.5.into()),
        ("residuals/hook_load/ratio", 1.2.into()),
        ("residuals/hook_load/measured", 412e3.into()),
        ("safe_window/rotary_speed", serde_json::json!([40.0, 80.0])),
    ] {
        assert_eq!(
            (&of(path)["value"], &of(path)["status"]),
            (&value, &"Good".into()),
            "{path}"
        );
    }
    assert_eq!(of("safe_window/rotary_speed")["unit"][0], "r/min");
    assert_eq!(of("targets/rotary_speed")["unit"][0], "r/min");
    assert_eq!(seen["write"]["targets/rotary_speed"], "BadUserAccessDenied");
    assert_eq!(seen["write"]["figures/bit_torque"], "BadUserAccessDenied");
    assert_eq!(running.count(|event| matches!(event, ServerEvent::Written { .. })), 0);

    // Doubtful inputs make what is computed from them uncertain, and a twin that stands makes it bad.
    let cases: [(&str, Change); 2] = [
        ("UncertainSubNormal", |status| {
            status.input_state[1] = TwinStatus::INPUT_STALE;
        }),
        ("BadOutOfService", |status| status.state = TwinStatus::FAILED),
    ];
    for (state, change) in cases {
        running.send(&topics::STATUS, &status(change));
        tokio::time::sleep(Duration::from_millis(300)).await;
        let seen = ask(&python, &["read", &url, "figures/bit_torque"]).await;
        let torque = &seen["values"]["figures/bit_torque"];
        assert_eq!((&torque["status"], &torque["value"]), (&state.into(), &350.0.into()));
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn interop_a_user_of_asyncua_writes_targets_and_nothing_else() {
    let Some(python) = python() else { return };
    let running = Running::new().await;
    let url = running.url();
    let wrong = ask(&python, &["write", &url, USER[0], "wrong horse", "60"]).await;
    assert_eq!(wrong["login"], "BadUserAccessDenied");
    let refused = |event: &ServerEvent| matches!(event, ServerEvent::LoginRefused { user } if user == USER[0]);
    assert_eq!(running.count(refused), 1);
    let seen = ask(&python, &["write", &url, USER[0], USER[1], "60"]).await;
    assert_eq!(
        (&seen["login"], &seen["good"], &seen["read"]["value"]),
        (&"".into(), &"".into(), &60.0.into()),
        "{seen}"
    );
    assert_eq!(
        (&seen["nan"], &seen["far"]),
        (&"BadOutOfRange".into(), &"BadOutOfRange".into())
    );
    assert_eq!(seen["text"], "BadTypeMismatch");
    assert_eq!(seen["figure"], "BadUserAccessDenied");
    let events = running.events.lock().unwrap();
    let written: Vec<_> = events
        .iter()
        .filter_map(|event| match event {
            ServerEvent::Written { quantity, value, user } => Some((quantity.name(), *value, user.as_str())),
            _ => None,
        })
        .collect();
    let [(name, value, user)] = written.as_slice() else {
        panic!("{written:?}");
    };
    assert_eq!((*name, *user), ("rotary_speed", USER[0]));
    // 60 r/min, rounded once.
    assert!((value - std::f64::consts::TAU).abs() < 1e-12, "{value}");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn interop_asyncua_receives_the_alarms_that_stand_as_conditions() {
    let Some(python) = python() else { return };
    let running = Running::new().await;
    speak(&running);
    let url = running.url();
    let seen = ask(&python, &["conditions", &url]).await;
    for key in ["first", "again"] {
        let all = seen[key].as_array().unwrap();
        let conditions: Vec<_> = all.iter().filter(|event| event["EventType"] == "i=2915").collect();
        // The alarm "late" is normal and acknowledged: nothing to show.
        let [condition] = conditions.as_slice() else {
            panic!("{key}: {all:?}");
        };
        assert_eq!(condition["ConditionName"], "Backward whirl");
        let message = format!("{} {}", alarm().evidence, alarm().what_to_do);
        assert_eq!(
            (&condition["Message"], &condition["Severity"]),
            (&message.into(), &800.into())
        );
        for (field, value) in [("Retain", true), ("ActiveState/Id", true), ("AckedState/Id", false)] {
            assert_eq!(condition[field], value, "{field}");
        }
        assert_eq!(all.first().unwrap()["EventType"], "i=2787", "{key}");
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn interop_asyncua_encrypts_once_its_certificate_is_trusted() {
    let Some(python) = python() else { return };
    let running = Running::new().await;
    speak(&running);
    let (url, folder) = (running.url(), running.folder.path().join("client"));
    std::fs::create_dir(&folder).unwrap();
    let arguments = ["encrypted", &url, folder.to_str().unwrap(), USER[0], USER[1]];
    let before = ask(&python, &arguments).await;
    assert_eq!(before["connected"], false, "{before}");
    let keys = running.folder.path().join("keys");
    let rejected: Vec<PathBuf> = std::fs::read_dir(keys.join("rejected"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    let [certificate] = rejected.as_slice() else {
        panic!("{rejected:?}");
    };
    let name = certificate.file_name().unwrap();
    std::fs::rename(certificate, keys.join("trusted").join(name)).unwrap();
    let after = ask(&python, &arguments).await;
    assert_eq!(
        (&after["connected"], &after["value"]["value"]),
        (&true.into(), &350.0.into()),
        "{after}"
    );
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn interop_a_greedy_client_gets_what_fits_and_harms_no_other() {
    let Some(python) = python() else { return };
    let running = Running::new().await;
    speak(&running);
    let url = running.url();
    let seen = ask(&python, &["greedy", &url]).await;
    assert_eq!(seen["subscriptions"], 3, "{seen}");
    assert_eq!(seen["subscription_refused"], "BadTooManySubscriptions");
    assert_eq!(seen["items"], 1000, "{seen}");
    assert_eq!(seen["item_refused"], serde_json::json!(["BadTooManyMonitoredItems"]));
    // More than the arrays of a message hold.
    assert_eq!(seen["read_refused"], "BadDecodingError");
    let seen = ask(&python, &["read", &url, "figures/bit_torque"]).await;
    assert_eq!(seen["values"]["figures/bit_torque"]["status"], "Good");
}
