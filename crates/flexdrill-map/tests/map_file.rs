//! What is written as a map reads as the same; what is not one is refused in words.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_alarms::Priority;
use flexdrill_map::{AlarmCount, Axis, Cell, FORMAT, Figure, Map, OfStart, Origin, Start, Verdict};
use serde_json::{Value, json};

fn axis(key: &str, values: &[f64]) -> Axis {
    Axis {
        key: key.to_owned(),
        name: key.to_owned(),
        unit: "1".to_owned(),
        values: values.to_vec(),
    }
}

fn known(seen: u32, of: u32) -> OfStart {
    OfStart {
        state: Origin::Known,
        expected: seen > 0,
        confidence: 1.0,
        chance: Some(f64::from(seen) / f64::from(of)),
        interval: [0.0, 1.0],
        alarm: if seen > 0 { "shock" } else { "" }.to_owned(),
        members: of,
        alarms: (seen > 0)
            .then(|| AlarmCount {
                alarm: "shock".to_owned(),
                priority: Priority::Low,
                seen,
                of,
                interval: [0.1, 0.9],
                first: Some(7.5),
            })
            .into_iter()
            .collect(),
        figures: vec![Figure {
            name: "stop_moment".to_owned(),
            unit: "N m".to_owned(),
            quantiles: Some([1.0, 2.0, 3.0]),
        }],
        ..OfStart::inferred(false, 1.0)
    }
}

fn map() -> Map {
    let unknown = OfStart {
        state: Origin::Unknown,
        members: 2,
        failed: 2,
        failure: "a step failed".to_owned(),
        ..OfStart::inferred(false, 0.5)
    };
    let starts = [
        [known(0, 3), known(0, 3)],
        [known(2, 3), known(3, 3)],
        [known(0, 3), known(2, 3)],
        [unknown, known(0, 3)],
        [OfStart::inferred(true, 0.97), OfStart::inferred(true, 0.96)],
        [OfStart::inferred(false, 0.98), OfStart::inferred(false, 0.98)],
    ];
    let at = [1.0, 2.0].into_iter().flat_map(|y| [10.0, 20.0, 40.0].map(|x| (x, y)));
    Map {
        format: FORMAT,
        program: "flexdrill 0.2.0".to_owned(),
        title: "a tool".to_owned(),
        configuration: "0".repeat(64),
        motion: "a".repeat(64),
        x: axis("a.b", &[10.0, 20.0, 40.0]),
        y: axis("c.d", &[1.0, 2.0]),
        horizon: 30.0,
        members: 3,
        run_all: false,
        first_alarm: false,
        plausible: false,
        posterior: None,
        seed: 1,
        priority: Priority::Low,
        limit: 0.1,
        starts: Start::ALL.to_vec(),
        runs: 8,
        first_looks: 0,
        model_time: 0.0,
        cells: at
            .zip(starts)
            .map(|((x, y), starts)| Cell {
                x,
                y,
                verdict: Verdict::of(&starts),
                starts: starts.to_vec(),
            })
            .collect(),
    }
}

#[test]
fn a_map_reads_as_it_was_written() {
    let map = map();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.json");
    std::fs::write(&path, map.to_json().unwrap()).unwrap();
    assert_eq!(Map::load(&path).unwrap(), map);
    let verdicts: Vec<&str> = map.cells.iter().map(|cell| cell.verdict.name()).collect();
    assert_eq!(
        verdicts,
        ["clear", "alarm", "depends_on_start", "unknown", "alarm", "clear"]
    );
}

#[test]
fn only_what_all_starts_are_sure_of_together_is_clear() {
    let clear = |confidence: f64| OfStart::inferred(false, confidence);
    let alarm = OfStart::inferred(true, 0.96);
    let not_known = OfStart::not_known(0.94);
    for (starts, verdict) in [
        (vec![known(0, 3), known(0, 3)], Verdict::Clear),
        (vec![known(0, 3), clear(0.95)], Verdict::Clear),
        // 0.96 of both is 0.92 together.
        (vec![clear(0.96), clear(0.96)], Verdict::NotKnown),
        (vec![clear(0.98), clear(0.98)], Verdict::Clear),
        (vec![clear(0.98), not_known.clone()], Verdict::NotKnown),
        (vec![not_known.clone(), known(3, 3)], Verdict::NotKnown),
        (vec![alarm.clone(), alarm.clone()], Verdict::Alarm),
        (vec![alarm, clear(0.96)], Verdict::DependsOnStart),
        (vec![not_known.clone(), not_known], Verdict::NotKnown),
    ] {
        assert_eq!(Verdict::of(&starts), verdict, "{starts:?}");
    }
}

#[test]
fn the_words_say_how_many_members_ran_and_what_these_exclude() {
    let mut map = map();
    map.members = 20;
    for (of, most) in [(0, 6), (1, 9), (2, 6), (3, 7)] {
        for start in &mut map.cells[of].starts {
            if start.state == Origin::Known {
                start.members = most;
            }
        }
    }
    // Wilson's interval of 0 of 6 ends at 3.8415 / (6 + 3.8415).
    let words = map.members_in_words();
    assert!(
        words.starts_with("In each run 6 to 9 of at most 20 members ended; a run ends early"),
        "{words}"
    );
    assert!(
        words.ends_with("No alarm in 6 excludes chances above 39 %: a clear cell may have up to that."),
        "{words}"
    );
    // All ran: 0.1611 is Newcombe's figure for none of 20 (Stat. Med. 17, 1998, 857, table I).
    map.run_all = true;
    for start in map.cells.iter_mut().flat_map(|cell| &mut cell.starts) {
        if start.state == Origin::Known {
            start.members = 20;
        }
    }
    let (members, chance) = map.excluded().unwrap();
    assert!(members == 20 && (chance - 0.1611).abs() < 5e-5, "{members} {chance}");
    let words = map.members_in_words();
    assert!(
        words.starts_with("In each run 20 of at most 20 members ended. No alarm in 20"),
        "{words}"
    );
    // One is singular.
    map.members = 1;
    for start in map.cells.iter_mut().flat_map(|cell| &mut cell.starts) {
        if start.state == Origin::Known {
            start.members = 1;
        }
    }
    let words = map.members_in_words();
    assert!(words.starts_with("In each run 1 of at most 1 member ended."), "{words}");
}

#[test]
fn the_words_say_which_tools_clear_does_not_speak_of() {
    let mut map = map();
    for (plausible, words) in [
        (true, "clear does not speak of others"),
        (false, "clear for its friction"),
    ] {
        map.plausible = plausible;
        assert!(map.tools_in_words().contains(words), "{}", map.tools_in_words());
    }
}

#[test]
fn the_nearest_cell_is_found_up_to_half_a_cell_beyond_the_axes() {
    let map = map();
    let at = |x, y| map.nearest(x, y).map(|cell| (cell.x, cell.y));
    assert_eq!(at(14.9, 1.4), Some((10.0, 1.0)));
    assert_eq!(at(31.0, 1.6), Some((40.0, 2.0)));
    assert_eq!((at(5.0, 0.5), at(50.0, 2.5)), (Some((10.0, 1.0)), Some((40.0, 2.0))));
    for (x, y) in [(4.9, 1.0), (50.1, 1.0), (10.0, 0.4), (10.0, 2.6), (f64::NAN, 1.0)] {
        assert_eq!(at(x, y), None, "{x} {y}");
    }
}

/// The map with a value replaced, as bytes.
fn damaged(pointer: &str, value: Value) -> Vec<u8> {
    let mut tree = serde_json::to_value(map()).unwrap();
    *tree.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}")) = value;
    serde_json::to_vec(&tree).unwrap()
}

#[test]
fn what_is_wrong_is_named() {
    for (pointer, value, said) in [
        (
            "/format",
            json!(1),
            "a map of format 1; this program reads format 2: make the map again",
        ),
        (
            "/configuration",
            json!("0"),
            "configuration = 0: must be 64 hexadecimal digits",
        ),
        (
            "/x/values/0",
            json!(30.0),
            "x.values = [30.0, 20.0, 40.0]: must be finite and rising",
        ),
        ("/x/values", json!([1.0]), "x.values = 1 values: must be 2 to 200"),
        ("/y/key", json!("a.b"), "y.key = a.b: must be another than x.key"),
        ("/horizon", json!(0.0), "horizon = 0: must be above 0 s"),
        ("/limit", json!(1.0), "limit = 1: must be 0 to below 1"),
        (
            "/starts",
            json!(["running", "rest"]),
            "must be `rest`, `running` or both",
        ),
        ("/runs", json!(7), "runs = 7: must be 8, as the cells say"),
        ("/cells", json!([]), "cells = 0: must be 6, as the axes have"),
        (
            "/cells/1/x",
            json!(21.0),
            "cells.1 = (21.0, 1.0): must be at (20.0, 1.0)",
        ),
        (
            "/cells/1/verdict",
            json!("clear"),
            "cells.1.verdict = clear: must be alarm",
        ),
        (
            "/cells/5/starts/0/confidence",
            json!(0.94),
            "cells.5.rest.confidence = 0.94: must be 0.95 to 1, as the state is inferred",
        ),
        (
            "/cells/5/verdict",
            json!("not_known"),
            "cells.5.verdict = not_known: must be clear",
        ),
        (
            "/cells/1/starts/0/expected",
            json!(false),
            "cells.1.rest.expected = false",
        ),
        (
            "/cells/1/starts/0/chance",
            json!(1.5),
            "cells.1.rest.chance = 1.5: must be 0 to 1",
        ),
        (
            "/cells/1/starts/0/members",
            json!(4),
            "cells.1.rest.members = 4: must be at most 3",
        ),
        (
            "/cells/1/starts/0/alarms/0/seen",
            json!(4),
            "alarms.0.seen = 4: must be 1 to 3",
        ),
        (
            "/cells/1/starts/0/alarms/0/interval",
            json!([0.9, 0.1]),
            "0.9 to 0.1: must be an interval",
        ),
        (
            "/cells/1/starts/0/figures/0/quantiles",
            json!([3.0, 2.0, 1.0]),
            "must be finite and rising",
        ),
        (
            "/cells/1/starts/0/state",
            json!("certain"),
            "not a map of flexdrill, or damaged: unknown variant",
        ),
        ("/x/unit", json!(3), "not a map of flexdrill, or damaged: invalid type"),
    ] {
        let error = Map::from_bytes("map.json", &damaged(pointer, value))
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("map.json: ") && error.contains(said),
            "{pointer}: {error}"
        );
    }
    for text in ["", "{", "[]", "\0", "{\"format\": 2}"] {
        let error = Map::from_bytes("m", text.as_bytes()).unwrap_err().to_string();
        assert!(error.contains("not a map of flexdrill"), "{error}");
    }
}
