//! OPC UA as a user starts it: a rig's server (asyncua, by others) drives the twin through `flexdrill bridge opcua
//! --connect`, and the twin is read and written through `flexdrill bridge opcua --listen`. SKIPPED without asyncua.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use flexdrill::bag;
use flexdrill::messages::{RigInputs, RigMeasured};
use serde_json::Value;

use crate::common::{Network, Program, root, small_config};

/// A Python with asyncua; `None` where there is none, which is a failure in CI.
fn python() -> Option<PathBuf> {
    let given = std::env::var_os("FLEXDRILL_PYTHON").map(PathBuf::from);
    let mut pythons = given.into_iter().chain([root().join(".venv/bin/python")]);
    let has_asyncua = |python: &PathBuf| {
        let asked = Command::new(python)
            .args(["-c", "import asyncua"])
            .stderr(Stdio::null())
            .status();
        asked.is_ok_and(|status| status.success())
    };
    let found = pythons.find(has_asyncua);
    if found.is_none() {
        let text = "SKIPPED: no Python with asyncua; run launch_scripts/test.sh or set FLEXDRILL_PYTHON";
        assert!(std::env::var_os("CI").is_none_or(|ci| ci != "true"), "{text}");
        eprintln!("{text}");
    }
    found
}

/// What asyncua sees.
fn ask(network: &Network, python: &Path, arguments: &[&str]) -> Value {
    let script = root().join("tests/python/opcua_client.py");
    let output = network.command(python).arg(script).args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Reads a variable until it is close to a value.
fn until(network: &Network, python: &Path, url: &str, path: &str, expected: f64) -> Value {
    let end = Instant::now() + Duration::from_secs(60);
    loop {
        let seen = ask(network, python, &["read", url, path]);
        let value = &seen["values"][path];
        if value["value"]
            .as_f64()
            .is_some_and(|value| (value - expected).abs() < 1e-9)
        {
            return seen;
        }
        assert!(Instant::now() < end, "{path} should be {expected}: {value}");
    }
}

/// The address after `opc.tcp://` in a line.
fn address(line: &str) -> String {
    let words = line.split([' ', ',']);
    words
        .into_iter()
        .find(|word| word.starts_with("opc.tcp://"))
        .unwrap()
        .to_owned()
}

#[test]
fn interop_a_rig_of_asyncua_drives_the_twin_and_asyncua_reads_and_writes_it() {
    let Some(python) = python() else { return };
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut rig = network
        .command(&python)
        .arg(root().join("tests/python/opcua_rig.py"))
        .arg("0")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut to_rig = rig.stdin.take().unwrap();
    let mut from_rig = BufReader::new(rig.stdout.take().unwrap()).lines();
    let rig_url = format!("opc.tcp://127.0.0.1:{}", from_rig.next().unwrap().unwrap());
    for line in ["Speed 60", "Weight 12", "HookLoad 40"] {
        writeln!(to_rig, "{line}").unwrap();
        assert_eq!(from_rig.next().unwrap().unwrap(), "done");
    }
    let map = path("site.yaml");
    let text = "nodes:\n  \"nsu=urn:rig;s=Rig.Speed\": {quantity: rotary_speed, unit: r/min}\n  \"nsu=urn:rig;s=Rig.Weight\": \
                {quantity: weight_on_bit, unit: kN}\n  \"nsu=urn:rig;s=Rig.HookLoad\": {quantity: hook_load, unit: kdaN}\n";
    std::fs::write(&map, text).unwrap();
    let users = path("users");
    std::fs::write(&users, "ann:correct horse\n").unwrap();
    std::fs::set_permissions(&users, std::os::unix::fs::PermissionsExt::from_mode(0o600)).unwrap();

    let program = |arguments: &[&str]| {
        let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
        command.args(arguments);
        command
    };
    let live = path("live");
    let mut twin = program(&["run", "--config"]);
    twin.arg(small_config()).arg("--record").arg(&live);
    let mut twin = Program::start(twin);
    let mut bridge = program(&["bridge", "opcua", "--connect", &rig_url, "--map"]);
    bridge.arg(&map).arg("--state").arg(path("bridge_keys"));
    let mut bridge = Program::start(bridge);
    let mut server = program(&["bridge", "opcua", "--listen", "127.0.0.1:0", "--allow-write", "--users"]);
    server.arg(&users).arg("--state").arg(path("server_keys"));
    let mut server = Program::start(server);
    let url = address(&server.wait_for("opcua at opc.tcp://"));
    twin.wait_for("model time runs");
    bridge.wait_for("follows 3 nodes");

    // 60 r/min and 12 kN reach the model.
    let seen = until(
        &network,
        &python,
        &url,
        "inputs/rotary_speed/received",
        std::f64::consts::TAU,
    );
    assert_eq!(seen["write"]["targets/rotary_speed"], "BadUserAccessDenied");
    until(&network, &python, &url, "inputs/weight_on_bit/received", 12e3);
    let seen = ask(
        &network,
        &python,
        &["read", &url, "status/state", "figures/bit_torque", "figures/model_time"],
    );
    assert_eq!(seen["values"]["status/state"]["value"], "running");
    for figure in ["figures/bit_torque", "figures/model_time"] {
        let value = &seen["values"][figure];
        assert!(
            value["value"].is_f64() && value["status"] == "Good",
            "{figure}: {value}"
        );
    }

    // A value that does not change comes again every second.
    std::thread::sleep(Duration::from_millis(2500));

    // The rig dies, the bridge says so and tries again; then a user drives.
    rig.kill().unwrap();
    rig.wait().unwrap();
    bridge.wait_for("the next attempt is in");
    bridge.signal("INT");
    assert_eq!(bridge.end(), Some(0), "{}", bridge.said());
    // The twin hears another publisher once the one that drove is silent.
    let end = Instant::now() + Duration::from_secs(60);
    loop {
        let seen = ask(&network, &python, &["write", &url, "ann", "correct horse", "30"]);
        assert_eq!((&seen["login"], &seen["good"]), (&"".into(), &"".into()), "{seen}");
        let seen = ask(&network, &python, &["read", &url, "inputs/rotary_speed/received"]);
        let value = &seen["values"]["inputs/rotary_speed/received"]["value"];
        if value
            .as_f64()
            .is_some_and(|value| (value - std::f64::consts::PI).abs() < 1e-9)
        {
            break;
        }
        assert!(Instant::now() < end, "{value}");
    }
    for program in [&mut server, &mut twin] {
        program.signal("TERM");
        assert_eq!(program.end(), Some(0), "{}", program.said());
    }

    let of_rig = format!("opcua {}", rig_url.trim_start_matches("opc.tcp://"));
    let inputs: Vec<RigInputs> = messages(&live, "rig/inputs");
    let sent = |source: &str, speed: f64| {
        let fits = |message: &&RigInputs| message.source == source && (message.rotary_speed_rpm - speed).abs() < 1e-9;
        inputs.iter().filter(fits).count()
    };
    assert!(sent(&of_rig, 60.0) >= 2, "{inputs:?}");
    assert!(sent("opcua user ann", 30.0) >= 1, "{inputs:?}");
    let measured: Vec<RigMeasured> = messages(&live, "rig/measured");
    assert!(
        measured.iter().any(|message| (message.hook_load - 400e3).abs() < 1e-6),
        "{measured:?}"
    );
}

/// Messages of a topic in a bag.
fn messages<M: flexdrill::messages::Message>(path: &Path, topic: &str) -> Vec<M> {
    let all = bag::open(path).unwrap().map(Result::unwrap);
    let of_topic = all.filter(|message| message.topic.is(topic));
    of_topic.map(|message| message.decode().unwrap()).collect()
}
