//! `flexdrill bridge mqtt` with Debian's mosquitto as the broker, read by paho-mqtt and pysparkplug: documents, births,
//! data and deaths, while broker, bridge and twin are killed and come back. SKIPPED without them.

mod refused;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common::{Network, Program, python, root, skipped, small_config};

/// Longest wait for a message. The slowest is a birth after a broker's return: the waits before an attempt double from
/// half a second, and a busy machine starts a twin in 20 s.
const PATIENCE: Duration = Duration::from_secs(60);

/// A broker in a network of its own, where its port is free.
struct Broker {
    program: Option<Program>,
    folder: tempfile::TempDir,
}

fn mosquitto() -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    folders.push("/usr/sbin".into());
    let found = folders
        .into_iter()
        .map(|folder| folder.join("mosquitto"))
        .find(|path| path.is_file());
    found.or_else(|| skipped("no mosquitto; launch_scripts/test.sh installs it"))
}

impl Broker {
    /// A broker with these lines in its configuration.
    fn start(network: &Network, lines: &str) -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let mut broker = Self { program: None, folder };
        // Without this line a broker that root starts becomes another user, who cannot read the folder.
        std::fs::write(
            broker.file("broker.conf"),
            format!("user root\nlog_dest stderr\n{lines}"),
        )
        .unwrap();
        broker.again(network)?;
        Some(broker)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn again(&mut self, network: &Network) -> Option<()> {
        let mut command = network.command(mosquitto()?);
        command.arg("-c").arg(self.file("broker.conf"));
        let mut program = Program::start(command);
        program.wait_for("running");
        self.program = Some(program);
        Some(())
    }

    fn kill(&mut self) {
        let mut program = self.program.take().unwrap();
        program.signal("KILL");
        assert_eq!(program.end(), None);
    }
}

/// Foreign eyes on the broker.
struct Listener {
    child: Child,
    input: ChildStdin,
    lines: Receiver<String>,
}

impl Listener {
    fn start(network: &Network) -> Option<Self> {
        let mut child = network
            .command(python::with("pysparkplug")?)
            .arg(root().join("tests/python/mqtt_listener.py"))
            .args(["127.0.0.1", "1883"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (sender, lines) = channel();
        crate::common::program::forward(child.stdout.take().unwrap(), sender);
        let input = child.stdin.take().unwrap();
        let mut listener = Self { child, input, lines };
        listener.wait(|line| line["connected"] == true);
        Some(listener)
    }

    /// Waits for a line. Everything that cannot be read fails the test.
    fn wait(&mut self, is_it: impl Fn(&Value) -> bool) -> Value {
        let deadline = Instant::now() + PATIENCE;
        let mut last = Value::Null;
        while let Ok(line) = self
            .lines
            .recv_timeout(deadline.saturating_duration_since(Instant::now()))
        {
            let line: Value = serde_json::from_str(&line).unwrap();
            assert!(line.get("error").is_none(), "{line}");
            if is_it(&line) {
                return line;
            }
            last = line;
        }
        panic!("it did not come; the last was {last}");
    }

    fn document(&mut self, topic: &str, is_it: impl Fn(&Value) -> bool) -> Value {
        let line = self.wait(|line| line["topic"] == topic && is_it(&line["json"]));
        assert_eq!(line["qos"], 1, "{line}");
        line["json"].clone()
    }

    fn sparkplug(&mut self, kind: &str, is_it: impl Fn(&Value) -> bool) -> Value {
        let line = self.wait(|line| line["sparkplug"]["kind"] == kind && is_it(&line["sparkplug"]));
        assert_eq!(line["topic"], format!("spBv1.0/field/{kind}/rig_7"));
        // A host that reads a kept birth or death would take it for a new one.
        assert_eq!(line["retained"], false, "{line}");
        line["sparkplug"].clone()
    }

    /// A document of `rigs/7/bridge` and a message of the node, whichever comes first: they have a connection each.
    fn both(&mut self, is_document: impl Fn(&Value) -> bool, kind: &str, is_it: impl Fn(&Value) -> bool) -> [Value; 2] {
        let (mut document, mut message) = (None, None);
        while document.is_none() || message.is_none() {
            let line = self.wait(|_| true);
            if line["topic"] == "rigs/7/bridge" && is_document(&line["json"]) {
                document = Some(line["json"].clone());
            } else if line["sparkplug"]["kind"] == kind && is_it(&line["sparkplug"]) {
                message = Some(line["sparkplug"].clone());
            }
        }
        [document.unwrap(), message.unwrap()]
    }

    fn say(&mut self, line: &str) {
        writeln!(self.input, "{line}").unwrap();
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn bridge(network: &Network, more: &[&str]) -> Program {
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["bridge", "mqtt", "--broker", "127.0.0.1"]).args(more);
    Program::start(command)
}

const OPEN: &str = "listener 1883 127.0.0.1\nallow_anonymous true\n";

#[test]
fn interop_twin_broker_and_bridge_may_be_killed_and_readers_know_what_holds() {
    let Some(network) = Network::new() else { return };
    let Some(mut broker) = Broker::start(&network, OPEN) else {
        return;
    };
    let Some(mut listener) = Listener::start(&network) else {
        return;
    };
    let options = ["--topic", "rigs/7", "--sparkplug", "field/rig_7", "--every", "0.5"];

    // Before there is a twin.
    let mut program = bridge(&network, &options);
    let [first, birth] = listener.both(|_| true, "NBIRTH", |_| true);
    assert_eq!(
        (&first["state"], &first["twin"]),
        (&"online".into(), &"not seen".into())
    );
    assert_eq!((&birth["seq"], &birth["metrics"]["bdSeq"]), (&0.into(), &0.into()));
    assert_eq!(birth["metrics"]["Twin/alive"], false);
    assert_eq!(birth["metrics"]["Twin/bit_torque"], Value::Null);
    assert_eq!(birth["metrics"]["Node Control/Rebirth"], false);
    assert_eq!(birth["types"]["Twin/bit_torque"], "DOUBLE");
    let alias = &birth["aliases"]["Twin/bit_torque"];
    assert_eq!(birth["units"][alias.to_string()], "N.m", "{birth}");
    for without in ["bdSeq", "Node Control/Rebirth"] {
        assert_eq!(birth["aliases"][without], Value::Null);
    }

    // With a twin.
    let mut twin = network.twin(&[]);
    listener.document("rigs/7/bridge", |bridge| bridge["twin"] == "running");
    let status = listener.document("rigs/7/status", |status| status["state"] == "running");
    assert_eq!(status["model_time"]["unit"], "s");
    assert_eq!(status["inputs"][0]["name"], "rotary_speed");
    assert_eq!(status["inputs"][0]["applied"]["unit"], "rad/s");
    let figures = listener.document("rigs/7/figures", |figures| {
        figures["figures"]["bit_weight"]["value"].is_number()
    });
    assert_eq!(figures["figures"]["bit_weight"]["unit"], "N");
    let alarms = listener.document("rigs/7/alarms", |_| true);
    assert!(alarms["alarms"].is_array() && alarms["active"].is_u64(), "{alarms}");
    let data = listener.sparkplug("NDATA", |data| data["metrics"]["Twin/model_time"].is_number());
    assert_eq!(data["named"], 0, "aliases instead of names: {data}");
    let seq = data["seq"].as_u64().unwrap();
    let next = listener.sparkplug("NDATA", |_| true);
    assert_eq!(next["seq"], (seq + 1) % 256);

    // The one command, and one that is none.
    listener.say("send spBv1.0/field/NCMD/rig_7 nonsense");
    listener.say("rebirth field rig_7");
    let again = listener.sparkplug("NBIRTH", |_| true);
    assert_eq!((&again["seq"], &again["metrics"]["bdSeq"]), (&0.into(), &0.into()));
    assert_eq!(again["metrics"]["Twin/alive"], true);
    assert!(again["metrics"]["Alarms/backward_whirl/active"].is_boolean(), "{again}");

    // The broker dies and forgets everything.
    broker.kill();
    program.wait_for("nothing listens at 127.0.0.1:1883");
    broker.again(&network);
    listener.wait(|line| line["connected"] == true);
    listener.document("rigs/7/status", |status| status["state"] == "running");
    listener.say("rebirth field rig_7");
    let after = listener.sparkplug("NBIRTH", |_| true);
    assert_eq!((&after["seq"], &after["metrics"]["bdSeq"]), (&0.into(), &1.into()));
    let Some(mut peer) = network.peer() else { return };
    peer.subscribe("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", "reliable");
    let counted = |peer: &mut crate::common::Peer| {
        let deadline = Instant::now() + PATIENCE;
        while Instant::now() < deadline {
            for message in peer.take("/diagnostics", 1, 1.0) {
                let items = message["status"].as_array().unwrap();
                let named = |name: &str| items.iter().find(|item| item["name"] == name).cloned();
                if let Some(json) = named("flexdrill_bridge_mqtt: mqtt") {
                    return [json, named("flexdrill_bridge_mqtt: sparkplug").unwrap()];
                }
            }
        }
        panic!("no diagnostics");
    };
    let value = |item: &Value, key: &str| -> u64 {
        let pairs = item["values"].as_array().unwrap();
        let pair = pairs.iter().find(|pair| pair["key"] == key);
        pair.unwrap_or_else(|| panic!("{key} in {item}"))["value"]
            .as_str()
            .unwrap()
            .parse()
            .unwrap()
    };
    let [json, sparkplug] = counted(&mut peer);
    assert_eq!(json["message"], "connected, the twin sends");
    assert_eq!(value(&json, "connections_made"), 2);
    assert!(
        value(&json, "messages_acknowledged") > 5 && value(&json, "bytes_sent") > 5000,
        "{json}"
    );
    assert_eq!(value(&sparkplug, "births_asked_for"), 2);
    assert_eq!(value(&sparkplug, "commands_ignored"), 1);

    // The twin dies: what it sent is no longer true.
    twin.signal("KILL");
    twin.end();
    let [_, silent] = listener.both(
        |bridge| bridge["twin"] == "silent",
        "NDATA",
        |data| data["metrics"]["Twin/alive"] == false,
    );
    let metrics = silent["metrics"].as_object().unwrap();
    assert_eq!(metrics.get("Twin/model_time"), Some(&Value::Null), "{silent}");

    // The bridge dies: its wills say so, also to those who come later.
    program.signal("KILL");
    program.end();
    let [_, death] = listener.both(|bridge| bridge["state"] == "offline", "NDEATH", |_| true);
    assert_eq!(death["metrics"]["bdSeq"], 1);
    drop(listener);
    let Some(mut late) = Listener::start(&network) else {
        return;
    };
    let kept = late.wait(|line| line["topic"] == "rigs/7/bridge");
    assert_eq!(
        (&kept["retained"], &kept["json"]["state"]),
        (&true.into(), &"offline".into())
    );

    // An orderly end says so too.
    let mut program = bridge(&network, &options);
    // The session continues the numbers of the one that was killed: its death, where it arrives late, ends not this one.
    let birth = late.sparkplug("NBIRTH", |_| true);
    assert_eq!(birth["metrics"]["bdSeq"], 2);
    program.signal("TERM");
    assert_eq!(program.end(), Some(0), "{}", program.said());
    let [end, death] = late.both(|bridge| bridge["state"] == "offline", "NDEATH", |_| true);
    assert!(end["reason"].as_str().unwrap().contains("was stopped"), "{end}");
    assert_eq!(death["metrics"]["bdSeq"], 2);
    let kept = network.state().join("flexdrill/sparkplug_field.rig_7.bdseq");
    assert_eq!(std::fs::read_to_string(&kept).unwrap().trim(), "2");
    // A damaged file costs the number, with a word, and not the session.
    std::fs::write(&kept, "nonsense").unwrap();
    let mut program = bridge(&network, &options);
    program.wait_for("the numbers begin again at 0");
    let birth = late.sparkplug("NBIRTH", |_| true);
    assert_eq!(birth["metrics"]["bdSeq"], 0);
    program.signal("TERM");
    assert_eq!(program.end(), Some(0), "{}", program.said());
}

/// A twin of the short tool that looks ahead and has a map, in a file of the folder.
fn looking_ahead(network: &Network, folder: &Path) -> Program {
    super::safe_window::made(&folder.join("map"));
    let text = std::fs::read_to_string(small_config()).unwrap();
    // Another YAML file next to the log of the rig would hide its mapping.
    let config = folder.join("twin.conf");
    let more = "look_ahead: {forecast: true, forecast_members: 2}\nmap: {file: map/map.json}\n";
    std::fs::write(&config, format!("{text}\n{more}")).unwrap();
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["run", "--config"]).arg(&config);
    Program::start(command)
}

/// A rig at 60 r/min and 4 kN that measures a torque of 500 N m, far above the twin's.
fn rig(network: &Network, folder: &Path) -> Program {
    let mut log = String::from("t,rpm,wob,torque\n");
    for second in 0..300 {
        log += &format!("{second},60,4,0.5\n");
    }
    let mapping = "columns:\n  time: {column: t, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
                   weight_on_bit:\n    direct: {column: wob, unit: kN}\n  torque: {column: torque, unit: kN.m}\n";
    let file = folder.join("rig.csv");
    std::fs::write(&file, log).unwrap();
    std::fs::write(folder.join("mapping.yaml"), mapping).unwrap();
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.arg("rig").arg(&file);
    Program::start(command)
}

#[test]
fn interop_forecast_residuals_and_map_reach_the_broker() {
    let Some(network) = Network::new() else { return };
    let Some(_broker) = Broker::start(&network, OPEN) else {
        return;
    };
    let Some(mut listener) = Listener::start(&network) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let _bridge = bridge(&network, &["--topic", "rigs/7"]);
    let mut twin = looking_ahead(&network, folder.path());
    twin.wait_for("model time runs");
    let _rig = rig(&network, folder.path());

    // Each document when it has what it is for, in the order in which they come.
    let torque = |document: &Value| {
        let all = document["residuals"].as_array().unwrap();
        all.iter().find(|of| of["name"] == "surface_torque").cloned().unwrap()
    };
    let at_60 =
        |forecast: &Value| (forecast["rotary_speed"]["value"].as_f64().unwrap() - std::f64::consts::TAU).abs() < 0.001;
    let [mut forecast, mut residuals, mut map] = [Value::Null, Value::Null, Value::Null];
    // A forecast is made every half minute, as idle work, and residuals begin 35 s after the speed has come.
    let deadline = Instant::now() + 4 * PATIENCE;
    while [&forecast, &residuals, &map].into_iter().any(Value::is_null) {
        assert!(Instant::now() < deadline, "missing: {forecast} {residuals} {map}");
        let line = listener.wait(|line| line["topic"].is_string());
        let document = line["json"].clone();
        match line["topic"].as_str().unwrap() {
            "rigs/7/forecast" if document["members"] == 2 && at_60(&document) => forecast = document,
            "rigs/7/residuals" if torque(&document)["ratio"].is_number() => residuals = document,
            "rigs/7/safe_window" => map = document,
            _ => continue,
        }
        assert_eq!((&line["qos"], &line["retained"]), (&1.into(), &false.into()), "{line}");
    }

    assert_eq!(forecast["failed"], 0, "{forecast}");
    let chance = &forecast["any_alarm"];
    let in_order = chance["lower"].as_f64() <= chance["probability"].as_f64()
        && chance["probability"].as_f64() <= chance["upper"].as_f64();
    assert!(chance["upper"].is_number() && in_order, "{forecast}");
    let bands = forecast["bands"].as_array().unwrap();
    let speed = bands.iter().find(|band| band["name"] == "bit_speed").unwrap();
    let seconds = speed["p50"].as_array().unwrap();
    assert!(speed["unit"] == "rad/s" && seconds.len() >= 60, "{speed}");
    for (low, high) in speed["p5"]
        .as_array()
        .unwrap()
        .iter()
        .zip(speed["p95"].as_array().unwrap())
    {
        assert!(low.as_f64() <= high.as_f64(), "{speed}");
    }

    let of = torque(&residuals);
    assert_eq!((&of["unit"], &of["measured"]), (&"N.m".into(), &500.0.into()), "{of}");
    // What the twin expects is far below, and the ratio has the sign of the difference.
    assert!(
        of["high"].as_f64().unwrap() < 500.0 && of["ratio"].as_f64().unwrap() > 1.0,
        "{of}"
    );
    assert_eq!(
        (&residuals["steady"], &residuals["drilling"]),
        (&true.into(), &true.into())
    );

    assert_eq!(
        map["rotary_speed"],
        serde_json::json!({"values": [40.0, 80.0], "unit": "r/min"})
    );
    assert_eq!(
        map["weight_on_bit"],
        serde_json::json!({"values": [2.0, 6.0], "unit": "kN"})
    );
    assert_eq!(map["verdict"], serde_json::json!(vec!["clear"; 4]), "{map}");

    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0), "{}", twin.said());
}
