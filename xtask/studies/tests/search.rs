//! `cargo xtask search` on a small tool.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::process::Command;

#[test]
fn a_small_search_lists_every_trial_and_is_taken_up() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let path = out.join("search.csv");
    let run = || {
        let small = "tests/data/small.yaml";
        let output = Command::new(env!("CARGO_BIN_EXE_flexdrill-studies"))
            .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
            .args(["search", "--turns", "1", "--coarse", small, "--full", small])
            .args(["--points", "2", "--descents", "1", "--generations", "2"])
            .args(["--per-generation", "2", "--finalists", "1", "--out"])
            .arg(&out)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        flexdrill_config::Config::load(out.join("best.yaml")).unwrap();
        std::fs::read_to_string(&path).unwrap()
    };
    let table = run();
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let titles = reader.headers().unwrap().clone();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    // Ten starts, two points, two generations of two, one finalist; failed ones included.
    assert_eq!(rows.len(), 17);
    let column = |name: &str| titles.iter().position(|title| title == name).unwrap();
    for row in &rows {
        let failed = !row[column("failure")].is_empty();
        assert_eq!(failed, row[column("inner_force")].is_empty());
        assert!(row[column("wob_kn")].parse::<f64>().unwrap() >= 5.0);
    }
    // Stopped in the middle of a line, it goes on to the same table; done, it has nothing left to do.
    std::fs::write(&path, &table[..2 * table.len() / 3]).unwrap();
    assert_eq!(run(), table);
    assert_eq!(run(), table);
    // A trial of other parameters is none of this plan's, and done again.
    let other = table.replacen("1.00000e1", "1.10000e1", 1);
    assert_ne!(other, table);
    std::fs::write(&path, other).unwrap();
    assert_eq!(run(), table);
}
