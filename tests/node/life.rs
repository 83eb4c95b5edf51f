//! Joint life of a running node: the table has the run while it runs and at its end, and the recording adds nothing to it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use crate::common::{Network, Program, small_config};
use flexdrill::bag;
use flexdrill::messages::Ageing;
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

/// `twin/ageing` of a recording, as bytes and read.
fn ageing(recording: &Path) -> Vec<(Vec<u8>, Ageing)> {
    let messages = bag::open(recording).unwrap().map(Result::unwrap);
    let counts = messages.filter(|message| message.topic.is("twin/ageing"));
    counts
        .map(|message| (message.data.clone(), message.decode().unwrap()))
        .collect()
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

    // The next run has the lives in its messages: those of the table, from the top down, and what it adds. Its replay, which has
    // no table, has the same. A folder holds one recording.
    let (copy, next, replay) = (at("copy.csv"), at("next"), at("replay"));
    std::fs::copy(&table, &copy).unwrap();
    let more = ["--duration", "3", "--record", next.to_str().unwrap()];
    assert_eq!(Program::start(command(&network, &config, &copy, &more)).end(), Some(0));
    let recorded = ageing(&next);
    let last = &recorded.last().unwrap().1;
    assert_eq!(last.joint_serial_number, ["J-6", "J-5", "J-4", "J-3", "J-2", "J-1"]);
    for (index, serial) in last.joint_serial_number.iter().enumerate() {
        let row = known.rows.iter().find(|row| row.serial == *serial).unwrap();
        let before = [last.stop_life_damage_before[index], last.link_life_damage_before[index]];
        assert_eq!(before, [row.stop, row.link], "{serial}");
        let [low, at, high] = [
            last.link_life_damage_low[index],
            last.link_life_damage[index],
            last.link_life_damage_high[index],
        ];
        assert!(
            before[1] <= at && low <= at && at <= high,
            "{serial}: {at} ({low} to {high})"
        );
    }
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("replay")
        .arg(&next)
        .arg("--out")
        .arg(&replay)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let replayed = ageing(&replay);
    assert!(recorded.len() > 1 && recorded.len() <= replayed.len());
    assert!(recorded.iter().zip(&replayed).all(|(run, again)| run.0 == again.0));

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
