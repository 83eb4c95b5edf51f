//! Joint life of a running node: the table has the run while it runs and at its end, and the recording adds nothing to it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::common::{Network, Program, small_config};
use flexdrill_life::Lives;

/// The short tool with serial numbers and a class.
fn configured(folder: &Path, first: &str) -> PathBuf {
    let text = std::fs::read_to_string(small_config()).unwrap();
    let joint = "joint: {limit_deg: 6.0}";
    assert!(text.contains(joint));
    let serials = format!("{first}, J-2, J-3, J-4, J-5, J-6");
    let life = format!("joint: {{limit_deg: 6.0, life: {{class: F1}}, serial_numbers: [{serials}]}}");
    let file = folder.join(format!("{first}.yaml"));
    std::fs::write(&file, text.replace(joint, &life)).unwrap();
    file
}

fn command(network: &Network, config: &Path, table: &Path, more: &[&str]) -> Command {
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command
        .args(["run", "--config"])
        .arg(config)
        .arg("--life")
        .arg(table)
        .args(more);
    command
}

fn lives(table: &Path) -> Lives {
    Lives::from_csv("joints.csv", &std::fs::read(table).unwrap()).unwrap()
}

#[test]
fn a_run_is_in_the_table_while_it_runs_and_counts_once() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (config, table) = (configured(folder.path(), "J-1"), at("joints.csv"));

    // At the end the whole run is there.
    let recording = at("first.mcap");
    let more = ["--duration", "3", "--record", recording.to_str().unwrap()];
    let mut first = Program::start(command(&network, &config, &table, &more));
    assert_eq!(first.end(), Some(0));
    let known = lives(&table);
    assert_eq!((known.runs(), known.serials().len()), (1, 6));
    assert!(
        known.rows.iter().all(|row| (row.hours * 3600.0 - 3.0).abs() < 1.1),
        "{known:?}"
    );
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["life", "add"])
        .args([&table, &recording])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && !said.contains("added the run"), "{said}");
    assert_eq!(lives(&table).runs(), 1);

    // A node that is killed leaves what it had written by then.
    let mut second = Program::start(command(&network, &config, &table, &[]));
    second.wait_for("model time runs");
    let limit = Instant::now() + Duration::from_secs(40);
    while lives(&table).runs() < 2 {
        assert!(Instant::now() < limit, "no second run in the table");
        std::thread::sleep(Duration::from_millis(200));
    }
    second.signal("KILL");
    second.end();
    let joint = lives(&table)
        .ranked()
        .into_iter()
        .find(|joint| joint.serial == "J-1")
        .unwrap();
    assert_eq!((joint.runs, joint.places), (2, vec![1, 1]));

    // A joint that the table does not have is refused before the node starts; the option adds it.
    let other = configured(folder.path(), "J-9");
    let mut refused = Program::start(command(&network, &other, &table, &["--duration", "1"]));
    let line = refused.wait_for("joints.csv does not have J-9");
    assert!(line.contains("--new J-9"), "{line}");
    assert_ne!(refused.end(), Some(0));
    let mut third = Program::start(command(&network, &other, &table, &["--duration", "2", "--new", "J-9"]));
    assert_eq!(third.end(), Some(0));
    assert_eq!((lives(&table).runs(), lives(&table).serials().len()), (3, 7));
    // A configuration without a class counts nothing for it.
    let mut nothing = Program::start(command(&network, &small_config(), &table, &["--duration", "1"]));
    nothing.wait_for("has no tool.joint.life");
    assert_ne!(nothing.end(), Some(0));
}
