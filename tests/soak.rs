//! The node for a long time: a log played in a loop, a recording, two foreign readers. Memory, handles, losses, latency.
//!
//! `FLEXDRILL_SOAK_SECONDS=7200 cargo test --release --test soak -- --nocapture` for two hours.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod common;

use std::path::PathBuf;
use std::time::Instant;

use common::{Network, Program};
use flexdrill::bag;

const STATUS: (&str, &str) = ("/twin/status", "flexdrill/msg/TwinStatus");
const JOINTS: (&str, &str) = ("/twin/joint_deflections", "flexdrill/msg/JointDeflections");
/// Time between two looks (s).
const LOOK: f64 = 5.0;
/// Growth of either process over the second half that is still the allocator's (bytes): an hour at the largest slope ever
/// seen without a leak is 7 MB.
const GROWTH: i64 = 8 << 20;

/// How long (s): what is asked for, ten minutes in CI, else a short one.
fn seconds() -> f64 {
    let asked = std::env::var("FLEXDRILL_SOAK_SECONDS").ok();
    match asked.and_then(|text| text.parse().ok()) {
        Some(seconds) => seconds,
        None if std::env::var_os("CI").is_some() => 600.0,
        None => 30.0,
    }
}

/// A real log where it is, else the one that the project carries.
fn log() -> PathBuf {
    let real = common::root().join("../shared/data/field_log");
    let found = std::fs::read_dir(real).ok().and_then(|files| {
        let mut logs: Vec<PathBuf> = files
            .filter_map(|file| Some(file.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|extension| extension == "csv"))
            .collect();
        logs.sort();
        logs.into_iter().next()
    });
    found.unwrap_or_else(|| common::root().join("config/field_logs/demo.csv"))
}

/// Resident memory (bytes) and open handles of a process; none when it has gone.
fn look(id: u32) -> Option<(i64, usize)> {
    let text = std::fs::read_to_string(format!("/proc/{id}/statm")).ok()?;
    let pages: i64 = text.split_whitespace().nth(1).unwrap().parse().unwrap();
    let handles = std::fs::read_dir(format!("/proc/{id}/fd")).ok()?.count();
    Some((pages * 4096, handles))
}

/// Least-squares slope of values at equal distances, per value.
fn slope(values: &[i64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<i64>() as f64 / n;
    let middle = (n - 1.0) / 2.0;
    let (mut up, mut down) = (0.0, 0.0);
    for (index, value) in values.iter().enumerate() {
        let x = index as f64 - middle;
        up += x * (*value as f64 - mean);
        down += x * x;
    }
    if down > 0.0 { up / down } else { 0.0 }
}

#[test]
fn it_can_be_left_running() {
    let Some(network) = Network::new() else { return };
    let (Some(mut first), Some(mut second)) = (network.peer(), network.peer()) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("soak");
    let mut twin = network.twin(&["--record", recording.to_str().unwrap()]);
    twin.wait_for("model time runs");
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.arg("rig").arg(log()).arg("--loop");
    command
        .arg("--mapping")
        .arg(common::root().join("config/field_logs/rig_1hz.yaml"));
    let rig = Program::start(command);
    for peer in [&mut first, &mut second] {
        peer.subscribe(STATUS.0, STATUS.1, "reliable");
        peer.subscribe(JOINTS.0, JOINTS.1, "reliable");
    }
    first.status_with(STATUS.0, |_| true);
    let (node, dds) = (twin.id(), twin.dds_process());
    let (began, whole) = (Instant::now(), seconds());
    let (mut memory, mut handles, mut latencies, mut received) = ([vec![], vec![]], vec![], vec![], 0);
    while began.elapsed().as_secs_f64() < whole {
        let heard = first.listen(&[JOINTS.0], LOOK).remove(0);
        received += heard.len();
        latencies.extend(heard.iter().map(|times| times[2] - times[0]));
        // The other one looks now and then.
        second.take(JOINTS.0, 1, 0.0);
        let (Some(of_node), Some(of_dds)) = (look(node), look(dds)) else {
            panic!(
                "after {:.0} s the node or its DDS process has gone, which said:\n{}",
                began.elapsed().as_secs_f64(),
                twin.said()
            );
        };
        memory[0].push(of_node.0);
        memory[1].push(of_dds.0);
        handles.push(of_node.1 + of_dds.1);
    }
    let elapsed = began.elapsed().as_secs_f64();
    let status = first.status_with(STATUS.0, |_| true);
    let sum = |field: &str| -> u64 {
        let values = status[field].as_array().unwrap();
        values.iter().map(|value| value.as_u64().unwrap()).sum()
    };
    latencies.sort_unstable();
    let at = |share: f64| latencies[((latencies.len() - 1) as f64 * share) as usize] as f64 * 1e-6;
    println!(
        "{elapsed:.0} s: {received} samples, stamp to received p50 {:.2} ms, p99 {:.2} ms, p99.9 {:.2} ms",
        at(0.5),
        at(0.99),
        at(0.999)
    );
    for (name, values) in ["node", "DDS process"].iter().zip(&memory) {
        let half = &values[values.len() / 2..];
        println!(
            "{name}: {:.1} MB at the end, {:+.1} kB/min over the second half",
            *values.last().unwrap() as f64 / 1e6,
            slope(half) * 60.0 / LOOK / 1e3
        );
        let growth = half.last().unwrap() - half.first().unwrap();
        assert!(growth < GROWTH, "{name}: {growth} bytes more in {:.0} s", elapsed / 2.0);
    }
    println!(
        "handles {} to {}, dropped {}, not recorded {}, skipped {} steps, {} snapshots not published",
        handles.iter().min().unwrap(),
        handles.iter().max().unwrap(),
        sum("output_dropped"),
        status["recording_drops"],
        status["steps_skipped"],
        status["frames_dropped"]
    );
    // A file of the recording or a connection more at the moment of a look.
    let (few, many) = (handles[handles.len() / 2], *handles.last().unwrap());
    assert!(many <= few + 2, "{few} handles became {many}");
    assert_eq!(sum("output_dropped"), 0, "{status}");
    assert_eq!(status["recording_drops"], 0);
    assert_eq!(status["dds_restarts"], 0, "{}", status["dds_restart_cause"]);
    rig.signal("INT");
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let counted = bag::open(&recording)
        .unwrap()
        .filter(|message| message.as_ref().unwrap().topic.is("twin/joint_deflections"))
        .count();
    // At 50 Hz, less what a busy machine made it skip or drop: all of it is told.
    let told = |field: &str| status[field].as_u64().unwrap();
    let missing = told("steps_skipped") / 40 + told("frames_dropped");
    assert!(
        counted as u64 + missing + 50 >= (elapsed * 50.0) as u64,
        "{counted} frames in {elapsed} s, {missing} told as missing"
    );
}
