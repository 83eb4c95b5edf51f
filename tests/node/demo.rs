//! `flexdrill demo`: the twin drills, and nothing outlives the demonstration.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::common::{Network, Program, small_config};

fn started(network: &Network, arguments: &[&str]) -> Program {
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["demo", "--plain"]).args(arguments);
    Program::start(command)
}

/// A demonstration of a tool that a busy machine can hold.
fn demo(network: &Network, more: &[&str]) -> Program {
    let config = small_config();
    started(network, &[&["--config", config.to_str().unwrap()], more].concat())
}

/// A process with all that it has started, and they in turn.
fn family(id: u32) -> BTreeSet<u32> {
    let parent = |id: u32| -> Option<u32> {
        let status = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
        status
            .lines()
            .find_map(|line| line.strip_prefix("PPid:"))?
            .trim()
            .parse()
            .ok()
    };
    let all: Vec<u32> = std::fs::read_dir("/proc")
        .unwrap()
        .filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok())
        .collect();
    let mut found = BTreeSet::from([id]);
    loop {
        let more: Vec<u32> = all
            .iter()
            .copied()
            .filter(|id| !found.contains(id) && parent(*id).is_some_and(|parent| found.contains(&parent)))
            .collect();
        if more.is_empty() {
            return found;
        }
        found.extend(more);
    }
}

/// Waits until these processes have ended.
fn all_end(family: &BTreeSet<u32>) {
    let deadline = Instant::now() + Duration::from_secs(20);
    let runs = |id: &u32| {
        let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
        // One whose parent has not looked at it yet has ended too.
        !status.is_empty() && !status.contains("State:\tZ")
    };
    while let Some(id) = family.iter().find(|id| runs(id)) {
        assert!(Instant::now() < deadline, "process {id} outlives the demonstration");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// What a demonstration has left in the folder of temporary files.
fn folders(id: u32) -> Vec<PathBuf> {
    let begin = format!("flexdrill_demo_{id}_");
    let entries = std::fs::read_dir(std::env::temp_dir()).unwrap();
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    paths
        .filter(|path| {
            path.file_name()
                .is_some_and(|name| name.to_string_lossy().starts_with(&begin))
        })
        .collect()
}

/// The number before a unit in a line of the view.
fn before(line: &str, unit: &str) -> Option<f64> {
    line.split(unit).next()?.split_whitespace().next_back()?.parse().ok()
}

#[test]
fn the_demonstration_drills_and_leaves_nothing_behind() {
    let Some(network) = Network::new() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("demo.mcap");
    let mut demo = demo(&network, &["--seconds", "15", "--record", bag.to_str().unwrap()]);
    demo.wait_for("twin       RUNNING");
    let family = family(demo.id());
    // Itself, twin, rig and view, and a DDS process of each of the three.
    assert!(family.len() >= 7, "{family:?}");
    let code = demo.end();
    let said = demo.said();
    assert_eq!(code, Some(0), "{said}");
    all_end(&family);
    // From second 45 of the log on the tool turns and is put to work: speed, weight, torque.
    let largest = |begin: &str, unit: &str| {
        let lines = said.lines().filter(|line| line.starts_with(begin));
        lines
            .filter_map(|line| before(line, unit))
            .fold(0.0_f64, |largest, value| largest.max(value.abs()))
    };
    assert!(largest("bit ", " r/min") > 20.0, "{said}");
    assert!(largest("bit ", " N m") > 1.0, "{said}");
    assert!(largest("input      WOB", " kN") > 1.0, "{said}");
    // The recording is complete.
    let bag = flexdrill::bag::open(&bag).unwrap();
    assert_eq!(bag.cuts().count(), 0);
    assert_eq!(folders(demo.id()), Vec::<PathBuf>::new());
}

#[test]
fn a_demonstration_that_is_ended_or_killed_takes_its_processes_along() {
    let Some(network) = Network::new() else {
        return;
    };
    for (signal, code) in [("TERM", Some(0)), ("INT", Some(0)), ("KILL", None)] {
        let mut demo = demo(&network, &[]);
        demo.wait_for("twin       RUNNING");
        let family = family(demo.id());
        assert!(family.len() >= 7, "{family:?}");
        demo.signal(signal);
        assert_eq!(demo.end(), code, "{signal}: {}", demo.said());
        all_end(&family);
        // What is killed cannot remove its folder.
        for folder in folders(demo.id()) {
            assert_eq!(signal, "KILL", "{}", folder.display());
            std::fs::remove_dir_all(folder).unwrap();
        }
    }
}

#[test]
fn a_twin_or_rig_that_fails_ends_the_demonstration_with_its_reason() {
    let Some(network) = Network::new() else {
        return;
    };
    for (arguments, who) in [
        (["--config", "/nowhere/tool.yaml"], "twin"),
        (["--mapping", "/nowhere/columns.yaml"], "rig"),
    ] {
        let mut demo = started(&network, &arguments);
        assert_eq!(demo.end(), Some(1));
        let said = demo.said();
        assert!(said.contains(&format!("error: the {who} ended: exit code 1")), "{said}");
        assert!(said.contains(&format!("error: {}", arguments[1])), "{said}");
    }
}
