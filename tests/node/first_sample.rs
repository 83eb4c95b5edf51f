//! `flexdrill bench --cases first-sample`: made recorders, the bridge, DDS and the input of a twin, as a user measures them.

use crate::common::Network;

/// What a busy machine may add to a time (s).
const BUSY: f64 = 8.0;
/// Silence after which the bridge asks (s), as `docs/bridge.md` says.
const ASKED_AFTER: f64 = 10.0;

/// The last number of a cell, the longest time.
fn longest(cell: &str) -> f64 {
    cell.rsplit(", ")
        .next()
        .unwrap()
        .parse()
        .unwrap_or_else(|_| panic!("{cell:?} is no time"))
}

#[test]
fn every_line_has_its_first_sample_when_it_must() {
    let Some(network) = Network::new() else { return };
    let mut bench = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    let output = bench.args(["bench", "--cases", "first-sample"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let rows: Vec<Vec<&str>> = said
        .lines()
        .filter(|line| line.starts_with("| "))
        .map(|line| line.trim_matches('|').split(" | ").map(str::trim).collect())
        .collect();
    let [_, _, lines @ .., log] = rows.as_slice() else {
        panic!("no table: {said}")
    };
    assert_eq!(lines.len(), 13, "{said}");
    for line in lines {
        let (sent, accepted) = (longest(line[2]), longest(line[3]));
        // A recorder that answers has nothing to answer before it is asked; one that streams sends once a second.
        let earliest = if line[0].starts_with("answers only") && !line[0].contains("ask:") {
            ASKED_AFTER
        } else {
            0.0
        };
        let latest = earliest + 1.0 + BUSY;
        assert!((earliest..latest).contains(&sent), "{line:?}");
        // Times have two digits after the point.
        assert!((sent - 0.01..latest).contains(&accepted), "{line:?}");
    }
    assert!(log[0].starts_with("a log of ") && longest(log[3]) < BUSY, "{log:?}");
}

/// What has no meaning is refused before anything is measured.
#[test]
fn the_recorders_have_their_own_times() {
    let mut bench = std::process::Command::new(env!("CARGO_BIN_EXE_flexdrill"));
    let output = bench
        .args(["bench", "--cases", "first-sample", "--duration", "3"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("--duration") && said.contains("first-sample"), "{said}");
}
