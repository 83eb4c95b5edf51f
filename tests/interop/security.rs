//! DDS Security (SROS2): the twin with keys, a program on Fast DDS with keys of the same authority, and others without.
//! Only in a build with the feature `security`.
#![cfg(feature = "security")]

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{Network, Program, root, small_config};
use serde_json::json;

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");

/// A keystore whose governance has everything signed and encrypted, with the enclaves `twin` and `peer`.
fn keystore(folder: &Path) -> PathBuf {
    let made = Command::new("sh")
        .arg(root().join("tests/security/make_keystore.sh"))
        .arg(folder)
        .args(["twin", "peer"])
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    folder.to_owned()
}

fn enclave(keystore: &Path, name: &str) -> [(&'static str, String); 3] {
    [
        ("ROS_SECURITY_ENABLE", "true".to_owned()),
        ("ROS_SECURITY_KEYSTORE", keystore.display().to_string()),
        ("ROS_SECURITY_ENCLAVE_OVERRIDE", format!("/{name}")),
    ]
}

#[test]
fn who_has_keys_reads_and_drives_and_others_do_neither() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let keys = keystore(folder.path());
    let of_peer = keys.join("enclaves/peer").display().to_string();
    let (Some(mut known), Some(mut outsider), Some(mut other)) = (
        network.fast_peer_with(&[("FAST_KEYS", &of_peer)]),
        network.fast_peer(),
        network.peer(),
    ) else {
        return;
    };
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.envs(enclave(&keys, "twin")).args(["run", "--config"]);
    let mut twin = Program::start({
        command.arg(small_config());
        command
    });
    assert!(twin.wait_for("  network").contains("with DDS Security"));
    twin.wait_for("model time runs");
    for peer in [&mut known, &mut outsider, &mut other] {
        peer.subscribe(STATUS.0, STATUS.1, "reliable");
    }
    let statuses = known.take(STATUS.0, 1, 20.0);
    assert_eq!(
        statuses.last().expect("a status")["header"]["frame_id"],
        "flexible_tool"
    );
    assert!(
        outsider.take(STATUS.0, 1, 3.0).is_empty(),
        "Fast DDS without keys reads"
    );
    assert!(
        other.take(STATUS.0, 1, 1.0).is_empty(),
        "Cyclone DDS without keys reads"
    );
    for (peer, speed) in [(&mut outsider, 77.0), (&mut other, 88.0), (&mut known, 33.0)] {
        peer.command(json!({
            "do": "publish", "topic": "/rig/rotary_speed_rpm", "type": "std_msgs/msg/Float64",
            "value": {"data": speed}, "wait": 3.0,
        }));
    }
    // Silence: each that was heard would be told of on the way to the safe value, or be the first.
    let line = twin.wait_for("the model is brought from ");
    assert!(line.contains("brought from 33.0"), "{line}");
    // Our own programs with and without keys.
    let mut watch = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    let heard = watch.args(["watch", "--plain", "--duration", "6"]).output().unwrap();
    assert!(!heard.status.success(), "watch without keys hears the twin");
    let mut watch = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    let heard = watch
        .envs(enclave(&keys, "peer"))
        .args(["watch", "--plain", "--duration", "8"])
        .output()
        .unwrap();
    assert!(heard.status.success(), "{}", String::from_utf8_lossy(&heard.stderr));
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    assert!(!twin.said().contains("DDS is restarted"), "{}", twin.said());
}

#[test]
fn keys_that_are_not_there_are_told() {
    let Some(network) = Network::new() else { return };
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.envs(enclave(Path::new("/nowhere"), "twin")).arg("run");
    let ended = command.output().unwrap();
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(1), "{said}");
    assert!(said.contains("/nowhere/enclaves/twin/identity_ca.cert.pem"), "{said}");
}
