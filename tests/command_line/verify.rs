//! `flexdrill verify --record`: the bags hold the runs from which the figures are.

use std::path::Path;
use std::process::{Command, Output};

use flexdrill::bag;
use flexdrill::messages::{JointDeflections, Message};

fn record(only: &str, folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["verify", "--only", only, "--record"])
        .arg(folder)
        .output()
        .unwrap()
}

fn table(path: &Path) -> Vec<csv::StringRecord> {
    csv::Reader::from_path(path)
        .unwrap()
        .records()
        .map(Result::unwrap)
        .collect()
}

#[test]
fn the_bag_of_a_case_ends_with_its_figures() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("bags");
    let output = record("chain_in_guide", &folder);
    assert!(output.status.success(), "{output:?}");
    let runs = table(&folder.join("runs.csv"));
    assert_eq!(runs.len(), 1);
    assert_eq!((&runs[0][0], &runs[0][1]), ("chain_in_guide", "chain_in_guide"));
    let seconds: f64 = runs[0][4].parse().unwrap();
    let mut last: Option<JointDeflections> = None;
    for message in bag::open(&folder.join(&runs[0][0])).unwrap() {
        let message = message.unwrap();
        if message.topic.ros_type == JointDeflections::ROS_TYPE {
            last = Some(message.decode().unwrap());
        }
    }
    let last = last.unwrap();
    let newest = last.header.stamp.to_nanoseconds() as f64 * 1e-9;
    assert!((newest - seconds).abs() < 1e-9, "{newest} s instead of {seconds} s");
    let mut compared = 0;
    for figure in table(&folder.join("figures.csv")) {
        let joint = figure[1]
            .strip_prefix("chain at joint ")
            .and_then(|rest| rest.split_once(' '));
        if let Some((number, _)) = joint {
            let ours: f64 = figure[3].parse().unwrap();
            let index = number.parse::<usize>().unwrap() - 1;
            // The message turns the node's displacement into the station's frame: rounding of 3e-16 m.
            let got = last.lateral_z[index];
            assert!(
                (got - ours).abs() < 1e-14,
                "joint {number}: {got} m instead of {ours} m"
            );
            compared += 1;
        }
    }
    assert_eq!(compared, 2);
    // A folder with files is never written into.
    let again = record("chain_in_guide", &folder);
    assert_eq!(again.status.code(), Some(1));
    let said = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(said.contains("it has files already"), "{said}");
}

#[test]
fn a_published_figure_has_a_bag_of_every_run() {
    let scratch = tempfile::tempdir().unwrap();
    let output = record("val_capstan_with_advance", scratch.path());
    assert!(output.status.success(), "{output:?}");
    let (runs, figures) = (
        table(&scratch.path().join("runs.csv")),
        table(&scratch.path().join("figures.csv")),
    );
    assert_eq!((runs.len(), figures.len()), (10, 10));
    for run in &runs {
        let messages = bag::open(&scratch.path().join(&run[0])).unwrap();
        assert!(messages.map(Result::unwrap).count() > 100, "{run:?}");
    }
}
