//! How long a snapshot takes to a DDS program of another vendor (Cyclone DDS, Python). The figures depend on the
//! machine: they are printed, not judged.
//!
//! `cargo test --release --test interop latency:: -- --nocapture`

use crate::common::Network;
use serde_json::json;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

const TOPICS: [(&str, &str); 2] = [
    ("/twin/bit_state", "flexdrill/msg/BitState"),
    ("/twin/joint_deflections", "flexdrill/msg/JointDeflections"),
];
const SECONDS: f64 = 10.0;

/// "p50, p99, max" of durations in ns, as ms.
fn percentiles(mut durations: Vec<i64>) -> String {
    durations.sort_unstable();
    let at = |share: f64| durations[((durations.len() - 1) as f64 * share).round() as usize] as f64 / 1e6;
    format!("p50 {:.2} ms, p99 {:.2} ms, max {:.2} ms", at(0.5), at(0.99), at(1.0))
}

#[test]
fn latency_of_a_snapshot_to_a_foreign_subscriber() {
    let Some(network) = Network::new() else { return };
    let (Some(mut listener), Some(mut rig)) = (network.peer(), network.peer()) else {
        return;
    };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    for (topic, kind) in TOPICS {
        listener.subscribe(topic, kind, "reliable");
    }
    listener.subscribe("/twin/status", "flexdrill/msg/TwinStatus", "reliable");
    rig.send("/rig/rotary_speed_rpm", json!(40.0));
    rig.send("/rig/weight_on_bit_kn", json!(10.0));
    let ended = AtomicBool::new(false);
    let received = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !ended.load(Ordering::Relaxed) {
                rig.send("/rig/rotary_speed_rpm", json!(40.0));
                rig.send("/rig/weight_on_bit_kn", json!(10.0));
                std::thread::sleep(Duration::from_millis(200));
            }
        });
        let received = listener.listen(&TOPICS.map(|(topic, _)| topic), SECONDS);
        ended.store(true, Ordering::Relaxed);
        received
    });
    let status = listener.take("/twin/status", 1, 5.0).pop().unwrap();
    println!(
        "real-time factor {}, {} steps skipped since the start",
        status["real_time_factor"], status["steps_skipped"]
    );
    for ((topic, _), messages) in TOPICS.iter().zip(received) {
        let count = messages.len();
        println!("{topic}: {count} messages in {SECONDS} s");
        assert!(count > 50, "{count} of some 500 messages have arrived");
        assert!(
            messages.windows(2).all(|pair| pair[0][0] < pair[1][0]),
            "stamps increase"
        );
        assert!(
            messages.windows(2).all(|pair| pair[0][2] <= pair[1][2]),
            "so do the times of arrival"
        );
        let since = |from: usize| messages.iter().map(|times| times[2] - times[from]).collect::<Vec<_>>();
        // Same clock on both sides: nothing of a minute ago, and nothing of the future.
        assert!(since(0).iter().all(|&ns| (0..60_000_000_000).contains(&ns)));
        println!("  header stamp to received: {}", percentiles(since(0)));
        if messages.iter().all(|times| times[1] > 0) {
            println!("  written to DDS to received: {}", percentiles(since(1)));
        }
    }
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}
