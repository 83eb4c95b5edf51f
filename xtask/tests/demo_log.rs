//! The checked-in log of the demonstration is what its generator writes, and has the torque of the rig's tool.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

#[test]
fn the_demo_log_is_what_its_generator_writes() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/field_logs/demo.csv");
    let written = std::fs::read_to_string(path).unwrap();
    assert!(
        written == xtask::demo_log::demo_log(),
        "config/field_logs/demo.csv is not up to date: cargo xtask demo-log"
    );
}

/// The torques of the generator are those of the measured table, and the log has them where speed and weight are
/// steady.
#[test]
fn the_torque_of_the_demo_log_is_that_of_the_rigs_tool() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/measurements.md");
    let document = std::fs::read_to_string(path).unwrap();
    let table = document.split("**Guide: as shipped").nth(1).unwrap();
    for (weight, torques) in &xtask::demo_log::BIT_TORQUE[1..] {
        let row = table
            .lines()
            .find(|line| line.starts_with(&format!("| {weight} |")))
            .unwrap();
        // Cells of 40 and 60 r/min, such as `0.16, 3.6 (6.7, 122)`.
        let measured: Vec<f64> = row.split('|').skip(3).take(2).map(in_brackets).collect();
        assert_eq!(measured, torques, "{weight} kN");
    }
    let log = xtask::demo_log::demo_log();
    // (rows of the last ten seconds of a phase, r/min, kN)
    for (from, speed, weight) in [
        (40.0, 40.0, 0.0),
        (70.0, 40.0, 5.0),
        (100.0, 40.0, 10.0),
        (115.0, 50.0, 15.0),
    ] {
        let torques: Vec<f64> = log.lines().skip(1).filter_map(|row| torque_of(row, from)).collect();
        let mean = torques.iter().sum::<f64>() / torques.len() as f64;
        let expected = xtask::demo_log::torque_nm(speed, weight);
        // Three standard errors of ten rows with a deviation of 8 N m, and what the hoist has not brought after its
        // last change: a tenth of the step of 5 kN within ten seconds.
        assert!(
            (mean - expected).abs() < 8.0 + 0.05 * expected,
            "{speed} r/min, {weight} kN: {mean} for {expected}"
        );
    }
}

/// The second number in the brackets of a cell.
fn in_brackets(cell: &str) -> f64 {
    let inside = cell.split_once('(').unwrap().1.split_once(')').unwrap().0;
    inside.split(", ").nth(1).unwrap().parse().unwrap()
}

/// The torque of a row (N m) within ten seconds after a time (s).
fn torque_of(row: &str, from: f64) -> Option<f64> {
    let cells: Vec<&str> = row.split(',').collect();
    let time: f64 = cells[0].parse().unwrap();
    let within = (from..from + 10.0).contains(&time);
    within.then(|| 1.355_818 * cells[4].parse::<f64>().unwrap())
}
