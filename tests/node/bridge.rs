//! From a rig's log over WITS to the twin's recording and its replay: `flexdrill rig --wits`, `flexdrill bridge wits`,
//! `flexdrill run --record`, `flexdrill replay`, each a process as a user starts it.

use std::io::Write as _;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::Path;
use std::process::{Command, Stdio};

use flexdrill::bag;
use flexdrill::messages::diagnostic_msgs::DiagnosticArray;
use flexdrill::messages::{AlarmEvent, AppliedInputs, RigInputs, RigMeasured};

use crate::common::{Network, Program, root, small_config};

/// Messages of a topic in a bag.
fn messages<M: flexdrill::messages::Message>(path: &std::path::Path, topic: &str) -> Vec<M> {
    let all = bag::open(path).unwrap().map(Result::unwrap);
    let of_topic = all.filter(|message| message.topic.is(topic));
    of_topic.map(|message| message.decode().unwrap()).collect()
}

#[test]
fn a_rigs_log_reaches_the_recording_over_wits_and_its_replay_is_the_same() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [live, again, line] = ["live", "again", "line.wits"].map(|name| folder.path().join(name));
    let program = |arguments: &[&str]| {
        let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
        command.args(arguments);
        command
    };
    let log = root().join("config/field_logs/demo.csv");
    let rig = [
        "rig",
        log.to_str().unwrap(),
        "--wits",
        "127.0.0.1:0",
        "--from",
        "60",
        "--loop",
    ];
    let mut rig = Program::start(program(&rig));
    let said = rig.wait_for("whoever connects to");
    let place = said
        .split_whitespace()
        .find(|word| word.starts_with("127.0.0.1:"))
        .unwrap()
        .to_owned();
    let mut bridge = program(&["bridge", "wits", "--connect", &place, "--capture"]);
    bridge.arg(&line);
    let mut bridge = Program::start(bridge);
    let mut twin = program(&["run", "--config"]);
    twin.arg(small_config()).arg("--record").arg(&live);
    let mut twin = Program::start(twin);
    twin.wait_for("model time runs");
    bridge.wait_for("connection 1 with");
    rig.wait_for("connections: 1");
    // Some frames at 1 Hz, and diagnostics.
    std::thread::sleep(std::time::Duration::from_secs(6));
    for program in [&mut bridge, &mut rig] {
        program.signal("INT");
        assert_eq!(program.end(), Some(0), "{}", program.said());
    }
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));

    let inputs: Vec<RigInputs> = messages(&live, "rig/inputs");
    let measured: Vec<RigMeasured> = messages(&live, "rig/measured");
    assert!(
        inputs.len() >= 3 && measured.len() >= 3,
        "{} {}",
        inputs.len(),
        measured.len()
    );
    assert!(
        inputs.iter().all(|message| message.source.contains("demonstration")),
        "{:?}",
        inputs[0]
    );
    assert!(inputs.iter().any(|message| message.weight_on_bit_kn > 0.0));
    // The log's hookload is 32 to 49 klbf.
    assert!(
        measured
            .iter()
            .all(|message| (140e3..220e3).contains(&message.hook_load)),
        "{:?}",
        measured[0]
    );
    let of_measured = messages::<DiagnosticArray>(&live, "/diagnostics");
    let last = of_measured
        .iter()
        .flat_map(|array| &array.status)
        .rfind(|item| item.name.ends_with(": measured"));
    let last = last.unwrap();
    assert!(last.message.contains("hook_load"), "{}", last.message);
    let received = last.values.iter().find(|pair| pair.key == "messages received").unwrap();
    assert!(received.value.parse::<usize>().unwrap() >= 2, "{received:?}");

    // What the recording and the capture hold is replayed.
    let replayed = |input: &std::path::Path, out: &std::path::Path, more: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
            .arg("replay")
            .arg(input)
            .arg("--out")
            .arg(out)
            .args(more)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(
            output.status.success(),
            "{said}{}",
            String::from_utf8_lossy(&output.stderr)
        );
        said
    };
    let said = replayed(&live, &again, &[]);
    assert!(
        said.contains("exact: the recording has everything that drove the model"),
        "{said}"
    );
    assert_eq!(
        messages::<AppliedInputs>(&again, "twin/applied_inputs"),
        messages::<AppliedInputs>(&live, "twin/applied_inputs")
    );
    assert_eq!(messages::<RigMeasured>(&again, "rig/measured").len(), measured.len());
    let from_line = folder.path().join("from_line");
    replayed(&line, &from_line, &["--config", small_config().to_str().unwrap()]);
    let from_line: Vec<RigMeasured> = messages(&from_line, "rig/measured");
    let first = from_line
        .iter()
        .position(|message| message.hook_load == measured[0].hook_load);
    assert!(first.is_some(), "{from_line:?}");
}

/// 40 r/min with 8 kN and 100 r/min with 30 kN in turn drove the twin between 40 and 62 r/min, and nothing said so.
#[test]
fn a_second_source_on_a_bridge_is_refused_and_named() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let live = folder.path().join("live");
    let program = |arguments: &[&str]| {
        let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
        command.args(arguments);
        command
    };
    // A confirmed mapping leaves the dispute as the only doubt.
    let state = folder.path().join("state");
    let mut bridge = program(&["bridge", "wits", "--listen", "127.0.0.1:0", "--confirm", "--state-dir"]);
    bridge.arg(&state);
    let mut bridge = Program::start(bridge);
    let said = bridge.wait_for("wits at 127.0.0.1:");
    let place = said
        .split_whitespace()
        .find(|word| word.starts_with("127.0.0.1:"))
        .unwrap();
    let mut twin = program(&["run", "--config"]);
    twin.arg(small_config()).arg("--record").arg(&live);
    let mut twin = Program::start(twin);
    twin.wait_for("model time runs");
    // The rig first, and both for longer than the two programs need to find each other.
    let port = place.rsplit(':').next().unwrap();
    let mut sources = network.command("bash");
    let script = "exec 3<>/dev/tcp/127.0.0.1/$0; sleep 0.5; exec 4<>/dev/tcp/127.0.0.1/$0; for turn in {1..40}; do \
                  printf '&&\\r\\n0116 0.8\\r\\n0120 40\\r\\n!!\\r\\n' >&3; sleep 0.1; \
                  printf '&&\\r\\n0116 3\\r\\n0120 100\\r\\n!!\\r\\n' >&4; sleep 0.1; done";
    assert!(sources.args(["-c", script, port]).status().unwrap().success());
    bridge.wait_for("also sends rotary_speed, weight_on_bit, which connection 1 (127.0.0.1:");
    for program in [&mut bridge, &mut twin] {
        program.signal("TERM");
        assert_eq!(program.end(), Some(0), "{}", program.said());
    }
    let inputs: Vec<RigInputs> = messages(&live, "rig/inputs");
    assert!(inputs.len() > 10, "{}", inputs.len());
    // The conversion to SI and back rounds.
    let is_of_the_rig = |message: &RigInputs| (message.rotary_speed_rpm - 40.0).abs() < 1e-9;
    assert!(inputs.iter().all(is_of_the_rig), "{inputs:?}");
    assert!(inputs.iter().any(|message| message.quality == RigInputs::SUSPECT));
    let applied: Vec<AppliedInputs> = messages(&live, "twin/applied_inputs");
    let fastest = applied.iter().map(|message| message.rotary_speed).fold(0.0, f64::max);
    // 40 r/min is 4.19 rad/s.
    assert!(fastest < 4.2, "{fastest} rad/s");
    let diagnostics = messages::<DiagnosticArray>(&live, "/diagnostics");
    let mut texts = diagnostics
        .iter()
        .flat_map(|array| &array.status)
        .map(|item| &item.message);
    assert!(
        texts.any(|text| text.contains("marked suspect by its source")),
        "the twin does not tell the operator"
    );
}

/// A bridge that listens, with its mapping and its state, on a terminal; and the port.
fn listening(network: &Network, [state, map]: [&Path; 2], more: &[&str], terminal: Stdio) -> (Program, String) {
    let mut bridge = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    bridge
        .args(["bridge", "wits", "--listen", "127.0.0.1:0", "--map"])
        .arg(map);
    bridge.arg("--state-dir").arg(state).args(more);
    let mut bridge = Program::start_at(bridge, terminal);
    let said = bridge.wait_for("wits at 127.0.0.1:");
    let mut words = said.split_whitespace();
    let place = words.find(|word| word.starts_with("127.0.0.1:")).unwrap();
    let port = place.rsplit(':').next().unwrap().to_owned();
    (bridge, port)
}

/// A rig that sends a speed to a port for six seconds, which is longer than twin and bridge need to find each other.
fn rig(network: &Network, port: &str, speed: u32) -> Command {
    let script = "exec 3<>/dev/tcp/127.0.0.1/$0; for turn in {1..60}; do \
                  printf '&&\\r\\n0116 0.8\\r\\n0120 %s\\r\\n!!\\r\\n' $1 >&3; sleep 0.1; done";
    let mut rig = network.command("bash");
    rig.args(["-c", script, port, &speed.to_string()]);
    rig
}

/// The qualities of the inputs with a speed (r/min).
fn qualities(inputs: &[RigInputs], speed: f64) -> Vec<u8> {
    // The conversion to SI and back rounds.
    let of_speed = inputs
        .iter()
        .filter(|message| (message.rotary_speed_rpm - speed).abs() < 1e-9);
    of_speed.map(|message| message.quality).collect()
}

/// Entries of a recording's journal by which `by` has confirmed the mapping of this machine's rig.
fn confirmations(recording: &Path, by: &str) -> usize {
    let journal: Vec<AlarmEvent> = messages(recording, "twin/alarm_events");
    let found = journal.iter().filter(|event| {
        let words = event.reason.contains("site.yaml) of 127.0.0.1 was confirmed at 20");
        words
            && (event.id.as_str(), event.change) == ("rig_disagrees", AlarmEvent::ADJUSTED)
            && event.operator_name == by
    });
    found.count()
}

/// A mapping that no person has compared drives the twin, and is shown as doubtful; the confirmation is of one mapping.
#[test]
fn a_mapping_is_suspect_until_a_person_confirms_it_and_again_when_it_is_changed() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [live, state, map] = ["live", "state", "site.yaml"].map(|name| folder.path().join(name));
    std::fs::write(&map, "title: \"Rig 7\"\n").unwrap();
    let mut twin = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    twin.args(["run", "--config"])
        .arg(small_config())
        .arg("--record")
        .arg(&live);
    let mut twin = Program::start(twin);
    twin.wait_for("model time runs");
    let drive = |speed: u32, more: &[&str], words: &str| {
        let (mut bridge, port) = listening(&network, [&state, &map], more, Stdio::null());
        assert!(rig(&network, &port, speed).status().unwrap().success());
        bridge.wait_for(words);
        bridge.signal("TERM");
        assert_eq!(bridge.end(), Some(0), "{}", bridge.said());
        bridge.said()
    };
    drive(30, &[], "marked SUSPECT until a person confirms");
    drive(35, &["--confirm"], "--confirm confirms it");
    drive(40, &[], "a person has confirmed this mapping for this source");
    // A file that is damaged confirms nothing.
    let confirmed = std::fs::read_dir(&state).unwrap().map(|entry| entry.unwrap().path());
    for file in confirmed.filter(|file| file.extension().is_some_and(|end| end == "confirmed")) {
        std::fs::write(file, b"mapping \xff").unwrap();
    }
    let said = drive(45, &[], "marked SUSPECT until a person confirms");
    assert!(said.contains("the mapping counts as not confirmed"), "{said}");
    drive(50, &["--confirm"], "--confirm confirms it");
    std::fs::write(&map, "title: \"Rig 8\"\n").unwrap();
    drive(55, &[], "marked SUSPECT until a person confirms");
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));

    let inputs: Vec<RigInputs> = messages(&live, "rig/inputs");
    for (speed, quality) in [
        (30.0, RigInputs::SUSPECT),
        (35.0, RigInputs::GOOD),
        (40.0, RigInputs::GOOD),
        (45.0, RigInputs::SUSPECT),
        (50.0, RigInputs::GOOD),
        (55.0, RigInputs::SUSPECT),
    ] {
        let found = qualities(&inputs, speed);
        assert!(
            !found.is_empty() && found.iter().all(|found| *found == quality),
            "{speed}: {found:?}"
        );
    }
    // A doubtful input drives.
    let applied: Vec<AppliedInputs> = messages(&live, "twin/applied_inputs");
    assert!(applied.iter().any(|message| message.rotary_speed > 0.0));
    // The journal has who confirmed what.
    let journal = std::fs::read_to_string(state.join("wits_mappings.journal")).unwrap();
    assert_eq!(journal.matches("by --confirm: mapping").count(), 2, "{journal}");
    // So has the recording's, once each: a bridge that comes back repeats a confirmation that is known.
    assert_eq!(confirmations(&live, "--confirm"), 2);
}

/// A person at the terminal of the bridge presses c and Enter while the rig sends.
#[test]
fn a_key_in_the_terminal_of_the_bridge_confirms_its_mapping() {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [live, state, map] = ["live", "state", "site.yaml"].map(|name| folder.path().join(name));
    std::fs::write(&map, "title: \"Rig 7\"\n").unwrap();
    let mut twin = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    twin.args(["run", "--config"])
        .arg(small_config())
        .arg("--record")
        .arg(&live);
    let mut twin = Program::start(twin);
    twin.wait_for("model time runs");
    let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&ours).unwrap();
    unlockpt(&ours).unwrap();
    let name = ptsname(&ours, Vec::new()).unwrap();
    let terminal = std::fs::OpenOptions::new()
        .read(true)
        .write(true)
        .custom_flags(libc::O_NOCTTY)
        .open(name.to_str().unwrap())
        .unwrap();
    let mut ours = std::fs::File::from(ours);
    let (mut bridge, port) = listening(&network, [&state, &map], &[], terminal.into());
    // Before a frame was shown there is nothing that a person could have compared.
    ours.write_all(b"c\n").unwrap();
    bridge.wait_for("no source waits for a confirmation");
    assert!(rig(&network, &port, 30).status().unwrap().success());
    bridge.wait_for("marked SUSPECT until a person confirms");
    // The rest of a longer word is no key.
    ours.write_all(b"cancel\nx\n").unwrap();
    let mut sending = rig(&network, &port, 35).spawn().unwrap();
    // Lines on connections are limited, and so are tables: neither says when the second connection has sent.
    std::thread::sleep(std::time::Duration::from_secs(3));
    ours.write_all(b" C \n").unwrap();
    bridge.wait_for("is confirmed for 127.0.0.1 by a person at the bridge's terminal");
    assert!(sending.wait().unwrap().success());
    bridge.signal("TERM");
    assert_eq!(bridge.end(), Some(0), "{}", bridge.said());
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
    let inputs: Vec<RigInputs> = messages(&live, "rig/inputs");
    let first = qualities(&inputs, 30.0);
    assert!(
        !first.is_empty() && first.iter().all(|found| *found == RigInputs::SUSPECT),
        "{first:?}"
    );
    let second = qualities(&inputs, 35.0);
    let confirmed = second.iter().position(|found| *found == RigInputs::GOOD).unwrap();
    assert!(confirmed > 0, "the second was confirmed before the key: {second:?}");
    assert!(
        second[confirmed..].iter().all(|found| *found == RigInputs::GOOD),
        "{second:?}"
    );
    assert_eq!(confirmations(&live, "a person at the bridge's terminal"), 1);
}
