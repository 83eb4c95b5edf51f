//! The command line of `run`, `rig` and `replay`: exit codes and what is said.

use std::process::{Command, Output};

use crate::common::{Network, Program, root};

fn flexdrill(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap()
}

fn refused(arguments: &[&str], code: i32, words: &[&str]) {
    let output = flexdrill(arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
    for word in words {
        assert!(said.contains(word), "{arguments:?} should say '{word}': {said}");
    }
}

#[test]
fn wrong_use_is_2_and_a_failure_is_1() {
    refused(&["run", "--no-such-option"], 2, &["--no-such-option"]);
    refused(&["run", "--ros-args", "-p", "x"], 2, &["name:=value"]);
    refused(&["run", "--ros-args", "-r", "__ns:=rig"], 2, &["begin with '/'"]);
    refused(&["run", "--domain", "400"], 2, &["400", "232"]);
    refused(&["run", "--service-mapping", "both"], 2, &["auto"]);
    refused(&["run", "--config", "/nowhere.yaml"], 1, &["/nowhere.yaml"]);
    // The parameter names the configuration too, and ROS 2 arguments alone run the node.
    refused(
        &["--ros-args", "-p", "config_file:=/nowhere.yaml"],
        1,
        &["/nowhere.yaml"],
    );
    refused(
        &[
            "run",
            "--config",
            "config/default.yaml",
            "--ros-args",
            "-p",
            "config_file:=config/coarse.yaml",
        ],
        2,
        &["config/default.yaml", "config/coarse.yaml", "give one of them"],
    );
    refused(
        &["run", "--ros-args", "-p", "config_file:=3"],
        2,
        &["config_file", "the path of a configuration"],
    );
    refused(&["run", "--ros-args", "-p", "tool.link:=3"], 1, &["tool.link"]);
    refused(&["run", "--ros-args", "-p", "tool.links:=-3"], 1, &["tool.links"]);
    refused(
        &["check", "config/default.yaml", "--ros-args", "-r", "a:=b"],
        2,
        &["--ros-args"],
    );
    refused(
        &["replay", "/nowhere.mcap", "--out", "/tmp/never.mcap"],
        1,
        &["/nowhere.mcap"],
    );
    let log = root().join("config/field_logs/demo.csv");
    refused(&["rig", log.to_str().unwrap(), "--rate", "0"], 2, &["--rate"]);
    let log = log.to_str().unwrap();
    let out = ["--out", "/tmp/never.mcap"];
    for text in ["nan", "inf", "1e-308", "1e300"] {
        refused(
            &["run", "--duration", text],
            2,
            &["--duration", text, "0.001 to 10000000 s"],
        );
        refused(&["rig", log, "--rate", text], 2, &["--rate", text, "times real time"]);
        refused(
            &["rig", log, "--from", text],
            2,
            &["--from", text, "not a position in a log"],
        );
        refused(
            &["replay", log, "--duration", text, out[0], out[1]],
            2,
            &["--duration", text],
        );
        refused(&["watch", "--interval", text], 2, &["--interval", text]);
        refused(&["watch", "--duration", text], 2, &["--duration", text]);
        refused(&["bench", "--rpm", text], 2, &["--rpm", text, "-5000 to 5000 r/min"]);
        refused(&["bench", "--wob", text], 2, &["--wob", text, "0 to 2000 kN"]);
        refused(&["bench", "--duration", text], 2, &["--duration", text]);
        refused(&["bench", "--time-step", text], 2, &["--time-step", text]);
        refused(&["paper", "--turns", text, out[0], out[1]], 2, &["--turns", text]);
        refused(&["paper", "--rpm", text, out[0], out[1]], 2, &["--rpm", text]);
    }
    refused(&["rig", log, "--from", "soon"], 2, &["soon"]);
}

#[test]
fn a_log_is_replayed_deterministically() {
    let folder = tempfile::tempdir().unwrap();
    let log = root().join("config/field_logs/demo.csv");
    let config = crate::common::small_config();
    let replay = |name: &str| {
        let out = folder.path().join(name).join("out.mcap");
        let output = flexdrill(&[
            "replay",
            log.to_str().unwrap(),
            "--config",
            config.to_str().unwrap(),
            "--from",
            "60",
            "--duration",
            "4",
            "--out",
            out.to_str().unwrap(),
        ]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(String::from_utf8_lossy(&output.stdout).contains("largest pipe-guide force"));
        flexdrill::bag::open(&out)
            .unwrap()
            .map(|message| message.unwrap())
            .map(|m| (m.topic.name.clone(), m.log_time, m.data))
            .collect::<Vec<_>>()
    };
    let (first, second) = (replay("a"), replay("b"));
    assert!(first.len() > 800, "{}", first.len());
    assert!(first == second, "two replays differ");
}

#[test]
fn a_rig_drives_the_twin_and_both_end_on_signals() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[
        "--domain",
        "7",
        "--namespace",
        "/rig_7",
        "--ros-args",
        "-r",
        "__node:=twin",
    ]);
    assert!(twin.wait_for("node /rig_7/twin").contains("flexdrill"));
    twin.wait_for("model time runs");
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command
        .env("ROS_DOMAIN_ID", "7")
        .arg("rig")
        .arg(root().join("config/field_logs/demo.csv"));
    command.args(["--from", "60", "--rate", "5", "--loop", "--namespace", "/rig_7"]);
    let mut rig = Program::start(command);
    assert!(rig.wait_for("subscribers").contains("subscribers: 1"));
    // Another domain hears nothing of it.
    peer.subscribe("/rig_7/twin/status", "flexdrill/msg/TwinStatus", "reliable");
    assert!(peer.take("/rig_7/twin/status", 1, 1.0).is_empty());
    rig.signal("INT");
    assert_eq!(rig.end(), Some(0));
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
    assert!(twin.said().contains("ended after"), "{}", twin.said());
}

/// Standard output of each subcommand on a device that is full, and on a pipe that nobody reads.
#[test]
fn a_standard_output_that_takes_nothing_is_told_and_ends_no_run() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (bag, again) = (place("first"), place("again"));
    let log = root().join("config/field_logs/demo.csv");
    let (log, small) = (log.to_str().unwrap().to_owned(), crate::common::small_config());
    let small = small.to_str().unwrap();
    let replay = |out: &str| -> Vec<String> {
        let arguments = [
            "replay",
            &log,
            "--config",
            small,
            "--from",
            "60",
            "--duration",
            "1",
            "--out",
            out,
        ];
        arguments.map(str::to_owned).to_vec()
    };
    let made = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(replay(&bag))
        .output()
        .unwrap();
    assert!(made.status.success());
    let Some(network) = Network::new() else { return };
    let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<String>>();
    let commands = [
        words("check config/default.yaml"),
        words("check config/default.yaml --full"),
        words(&format!("recover {bag} --out {again}")),
        replay(&place("other")),
        words(&format!("run --config {small} --duration 1")),
        words(&format!("rig {log} --from 60 --to 62")),
        words(&format!("bench --config {small} --duration 1")),
        words("verify --only sliding_mass"),
        words("watch --plain --interval 0.2 --duration 20"),
        words(&format!(
            "paper --config {small} --turns 1 --no-step-check --out {}",
            place("paper")
        )),
    ];
    for arguments in commands {
        for out in ["/dev/full", "a closed pipe"] {
            let _ = std::fs::remove_dir_all(&again);
            let _ = std::fs::remove_dir_all(place("other"));
            let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
            command
                .args(&arguments)
                .current_dir(root())
                .stderr(std::process::Stdio::piped());
            let stdout: std::process::Stdio = match out {
                "/dev/full" => std::fs::File::create(out).unwrap().into(),
                // The reader goes at once.
                _ => std::io::pipe().unwrap().1.into(),
            };
            let ended = command.stdout(stdout).output().unwrap();
            let said = String::from_utf8_lossy(&ended.stderr).into_owned();
            assert!(!said.contains("panicked"), "{arguments:?} on {out}: {said}");
            let told = out == "/dev/full";
            assert_eq!(
                ended.status.code(),
                Some(i32::from(told)),
                "{arguments:?} on {out}: {said}"
            );
            assert_eq!(
                said.contains("cannot write to standard output: No space left"),
                told,
                "{arguments:?} on {out}: {said}"
            );
        }
    }
    // Without standard error nobody can be told, and the work is done all the same.
    let _ = std::fs::remove_dir_all(place("other"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(replay(&place("other")));
    let full = || std::fs::File::create("/dev/full").unwrap();
    let ended = command.stdout(full()).stderr(full()).status().unwrap();
    assert_eq!(ended.code(), Some(1));
    let whole = |path: &str| flexdrill::bag::open(path.as_ref()).unwrap().count();
    assert_eq!(whole(&place("other")), whole(&bag));
}
