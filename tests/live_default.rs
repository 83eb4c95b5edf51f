//! Viewers of the default tool, whose messages are the largest and whose steps take most of their time. The test has a
//! binary to itself: a test that ran at the same time would take the processor whose late steps are counted here.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod common;

use std::time::Duration;

use common::{Network, Peer, Program, unavailable};

const LIVE: &str = "127.0.0.1:8765";
const URL: &str = "ws://127.0.0.1:8765";
/// Time that is counted with and without viewers (s).
const TIME: u64 = 10;

/// How often it is tried: one late step of somebody else's is not the viewers'.
const ROUNDS: usize = 3;

/// What a viewer gets in that time (bytes) where the machine holds the pace, and a margin: 13 MB were measured. It is more
/// than queue and sockets of the frozen one hold.
const FULL: u64 = 9_000_000;

/// What must not come from viewers.
#[derive(Debug, Clone, Copy)]
struct Counts {
    late: u64,
    skipped: u64,
    frames_dropped: u64,
    events_lost: u64,
    steps: u64,
}

fn counts(peer: &mut Peer) -> Counts {
    peer.take("/twin/status", 10_000, 0.0);
    let status = peer.status_with("/twin/status", |status| status["state"] == 1);
    let of = |field: &str| status[field].as_u64().unwrap();
    Counts {
        late: of("deadline_misses"),
        skipped: of("steps_skipped"),
        frames_dropped: of("frames_dropped"),
        events_lost: of("events_lost"),
        steps: of("step_count"),
    }
}

fn since(then: Counts, now: Counts) -> Counts {
    Counts {
        late: now.late - then.late,
        skipped: now.skipped - then.skipped,
        frames_dropped: now.frames_dropped - then.frames_dropped,
        events_lost: now.events_lost - then.events_lost,
        steps: now.steps - then.steps,
    }
}

/// Processor time of the thread that serves viewers so far (s).
fn live_thread(twin: &Program) -> f64 {
    let tasks = std::fs::read_dir(format!("/proc/{}/task", twin.id())).unwrap();
    let times = tasks.filter_map(|task| {
        let folder = task.ok()?.path();
        let name = std::fs::read_to_string(folder.join("comm")).ok()?;
        let stat = std::fs::read_to_string(folder.join("stat")).ok()?;
        let fields: Vec<&str> = stat.rsplit(')').next()?.split_whitespace().collect();
        let ticks: f64 = fields.get(11)?.parse::<f64>().ok()? + fields.get(12)?.parse::<f64>().ok()?;
        // A hundred ticks a second, as Linux tells programs on all its machines.
        (name.trim() == "live").then_some(ticks / 100.0)
    });
    times.sum()
}

/// Deadlines, steps and frames are those of a run that nobody looks at: twenty viewers of everything, one of them frozen,
/// which only empty their sockets, so that they do not take the solver's processor themselves.
#[test]
fn twenty_viewers_leave_the_deadlines_alone_and_the_frozen_one_is_named() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["run", "--foxglove", LIVE]);
    let mut twin = Program::start(command);
    twin.wait_for("model time runs");
    peer.subscribe("/twin/status", "flexdrill/msg/TwinStatus", "reliable");
    // The first seconds are those of the start.
    std::thread::sleep(Duration::from_secs(2));
    let mut rounds = 0;
    let (mut left_alone, mut quiet, mut flooded) = (false, 0, 0);
    while rounds < ROUNDS && !left_alone {
        let begin = counts(&mut peer);
        std::thread::sleep(Duration::from_secs(TIME));
        let alone = since(begin, counts(&mut peer));
        let (begin, used) = (counts(&mut peer), live_thread(&twin));
        let Some(seen) = network.viewer(&["light", URL, "20", &TIME.to_string()]) else {
            return;
        };
        let (watched, used) = (since(begin, counts(&mut peer)), live_thread(&twin) - used);
        println!("alone {alone:?}; with twenty viewers {watched:?}, {used:.2} s of processor time for them");
        let bytes: Vec<u64> = serde_json::from_value(seen["bytes"].clone()).unwrap();
        let (least, most) = (bytes.iter().min().unwrap(), bytes.iter().max().unwrap());
        // They came and went within a moment of each other.
        assert!(*least > 0 && 10 * least > 8 * most, "{bytes:?}");
        flooded += usize::from(*least > FULL);
        assert_eq!((watched.frames_dropped, watched.events_lost), (0, 0));
        // A fourth of a core for 20 viewers of 24 MB/s in all; a tenth was measured.
        assert!(used < 0.25 * TIME as f64, "{used} s");
        rounds += 1;
        quiet += usize::from(alone.late == 0);
        left_alone = watched.late <= alone.late && watched.skipped <= alone.skipped;
    }
    // Where steps are late with nobody looking on, others use the machine, and more or less of it the next time.
    assert!(left_alone || quiet < ROUNDS, "late with viewers only, {ROUNDS} times");
    if !left_alone {
        let _: Option<()> =
            unavailable("steps are late without viewers too: this machine cannot show what viewers cost");
    }
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    let said = twin.said();
    // The frozen one is named by its address, with what it lost; the others have lost nothing.
    let gone: Vec<&str> = said
        .lines()
        .filter(|line| line.contains("had been dropped for it"))
        .collect();
    assert!(
        (flooded..=rounds).contains(&gone.len()),
        "one frozen viewer each time: {said}"
    );
    assert_eq!(
        gone.is_empty(),
        !said.contains("is too slow for what it subscribes to: "),
        "{said}"
    );
    for line in gone {
        let lost = line
            .split("has disconnected; ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next());
        assert!(lost.unwrap().parse::<u64>().unwrap() > 0, "{line}");
    }
}
