//! A sweep's directory: the same table whoever filled it and however often they were stopped; what is damaged, of another
//! plan or of another program is named and left alone.
//!
//! The results are made up from the point's name: the mechanics are tested with the program.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_sweep::directory::PLAN;
use flexdrill_sweep::map::{AlarmCount, Figure, Start};
use flexdrill_sweep::outcome::Begun;
use flexdrill_sweep::plan::Fast;
use flexdrill_sweep::spec::Program;
use flexdrill_sweep::{Chunk, Directory, Found, Outcome, Plan, Point, Spec, SweepError};

fn config() -> Config {
    Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/coarse.yaml")).unwrap()
}

fn program() -> Program {
    Program {
        name: "flexdrill 0.2.0".to_owned(),
        arithmetic: "fused".to_owned(),
        alarms: vec!["backward_whirl".to_owned(), "shock".to_owned()],
        figures: vec![
            ("stop_moment".to_owned(), "N m".to_owned()),
            ("damage".to_owned(), "1/h".to_owned()),
        ],
    }
}

const GRID: &str = "configuration: coarse.yaml
horizon: 20
seeds: [7, 3]
grid:
  inputs.rotary_speed.initial_rpm: {from: 20, to: 120, count: 5}
  contact.inner.friction_tangential: [0.1, 0.30000000000000004]
";

fn plan(text: &str) -> Plan {
    Spec::from_text("spec.yaml", text)
        .unwrap()
        .plan_for("spec.yaml", &config(), &program())
        .unwrap()
}

/// A result that follows from the point alone.
fn made_up(point: &Point) -> Outcome {
    let digit = |at: usize| u32::from(point.id.as_bytes()[at] % 3);
    let failed = digit(0).min(1);
    let ended = 3 - failed;
    let seen = digit(1).min(ended);
    Outcome {
        members: 3,
        failed,
        failure: if failed > 0 {
            "a step failed, \"so\" it is,\nunknown"
        } else {
            ""
        }
        .to_owned(),
        run_up: Some(2.5),
        model_time: 31.5,
        begun: vec![Begun {
            tool: Some(2),
            time: 13.5,
        }],
        any_alarm: [seen, seen, 0],
        alarms: (seen > 0)
            .then(|| AlarmCount {
                alarm: "shock".to_owned(),
                priority: Priority::Medium,
                seen,
                of: ended,
                interval: [0.1, 0.9],
                first: Some(1.0 / 3.0),
            })
            .into_iter()
            .collect(),
        figures: vec![
            Figure {
                name: "stop_moment".to_owned(),
                unit: "N m".to_owned(),
                quantiles: Some([0.1, 1.0 / 3.0, f64::from(digit(2)) + 1.0]),
            },
            Figure {
                name: "damage".to_owned(),
                unit: "1/h".to_owned(),
                quantiles: None,
            },
        ],
        quality: [ended, 0, 0],
    }
}

fn all(directory: &Directory) -> Vec<usize> {
    (0..directory.points().len()).collect()
}

fn work(directory: &Directory, numbers: &[usize], jobs: usize) -> Result<usize, SweepError> {
    let stop = AtomicBool::new(false);
    let worked = directory.work(numbers, jobs, &stop, |point| Some(made_up(point)), |_| {})?;
    Ok(worked.ran)
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn the_table_is_the_same_whoever_computed_it() {
    let folder = tempfile::tempdir().unwrap();
    let plan = plan(GRID);
    assert_eq!((plan.len(), plan.seeds.as_slice()), (40, &[3, 7][..]));
    let whole = Directory::create(&folder.path().join("whole"), &plan).unwrap();
    assert_eq!(work(&whole, &all(&whole), 1).unwrap(), 40);
    let table = whole.collect(false).unwrap();
    // Parts, threads, and workers that stop in between.
    let path = folder.path().join("parts");
    let parts = Directory::create(&path, &plan).unwrap();
    for part in 0..3 {
        let parts = Directory::open(&path).unwrap();
        let chunk = Chunk { part, of: 3 };
        let numbers: Vec<usize> = all(&parts).into_iter().filter(|number| chunk.has(*number)).collect();
        let (stop, count) = (AtomicBool::new(false), AtomicUsize::new(0));
        let run = |point: &Point| {
            if count.fetch_add(1, Ordering::Relaxed) == 4 {
                stop.store(true, Ordering::Relaxed);
                return None;
            }
            Some(made_up(point))
        };
        let worked = parts.work(&numbers, 2, &stop, run, |_| {}).unwrap();
        assert!(worked.left > 0 && worked.ran >= 4, "{worked:?}");
        let error = parts.collect(false).unwrap_err();
        assert!(error.to_string().contains("points have no result"), "{error}");
        assert!(
            String::from_utf8(parts.collect(true).unwrap())
                .unwrap()
                .contains(",missing,")
        );
    }
    let left = 40 - parts.status().unwrap().done;
    assert_eq!(work(&parts, &all(&parts), 3).unwrap(), left);
    assert_eq!(parts.collect(false).unwrap(), table);
    // The files are the same as well, and no temporary one stays.
    let [a, b] = [whole.path(), parts.path()].map(|path| {
        let names = files(path);
        names
            .iter()
            .map(|file| {
                (
                    file.strip_prefix(path).unwrap().to_owned(),
                    std::fs::read(file).unwrap(),
                )
            })
            .collect::<Vec<_>>()
    });
    assert_eq!((a.len(), a == b), (41, true));
    // A second call computes nothing.
    assert_eq!(work(&parts, &all(&parts), 1).unwrap(), 0);
}

#[test]
fn two_workers_at_once_seldom_compute_the_same_point() {
    let folder = tempfile::tempdir().unwrap();
    let text = GRID.replace("count: 5", "count: 50");
    let plan = plan(&text);
    Directory::create(folder.path(), &plan).unwrap();
    let run = || {
        let directory = Directory::open(folder.path()).unwrap();
        let stop = AtomicBool::new(false);
        let slow = |point: &Point| {
            std::thread::sleep(std::time::Duration::from_millis(2));
            Some(made_up(point))
        };
        directory.work(&all(&directory), 1, &stop, slow, |_| {}).unwrap().ran
    };
    let (a, b) = std::thread::scope(|scope| {
        let other = scope.spawn(run);
        (run(), other.join().unwrap())
    });
    let points = plan.len();
    // 400 points: expected twice are the few that both begin within the same 2 ms.
    assert!(a + b >= points && a + b < points + points / 5, "{a} + {b} of {points}");
    assert_eq!(Directory::open(folder.path()).unwrap().status().unwrap().done, points);
}

#[test]
fn the_table_has_a_row_per_point_with_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    work(&directory, &all(&directory), 2).unwrap();
    let table = directory.collect(false).unwrap();
    let mut reader = csv::Reader::from_reader(table.as_slice());
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    for name in [
        "inputs.rotary_speed.initial_rpm",
        "start",
        "seed",
        "shock_medium",
        "stop_moment_nm_p50",
        "damage_per_h_p5",
    ] {
        assert!(header.iter().any(|column| column == name), "{name} {header:?}");
    }
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 40);
    for (row, point) in rows.iter().zip(directory.points()) {
        let at = |name: &str| &row[header.iter().position(|column| column == name).unwrap()];
        let outcome = made_up(point);
        assert_eq!((at("point"), at("start")), (point.id.as_str(), point.start.name()));
        assert_eq!(at("failure"), outcome.failure);
        assert_eq!(at("stop_moment_nm_p50"), "0.3333333333333333");
        assert_eq!(at("damage_per_h_p5"), "");
        let seen = outcome.alarms.first().map_or(0, |count| count.seen);
        assert_eq!(at("shock_medium"), seen.to_string());
    }
    // The first key changes slowest.
    assert_eq!((&rows[0][1], &rows[4][1], &rows[8][1]), ("20.0", "20.0", "45.0"));
}

#[test]
fn another_plan_and_another_program_are_refused_and_nothing_changes() {
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    work(&directory, &all(&directory), 1).unwrap();
    let before: Vec<_> = files(folder.path())
        .iter()
        .map(|file| std::fs::read(file).unwrap())
        .collect();
    Directory::create(folder.path(), &plan(GRID)).unwrap();
    for (from, to, said) in [
        ("horizon: 20", "horizon: 21", "horizon, members"),
        ("to: 120", "to: 110", "horizon, members, run_all, alarms or figures"),
        ("[0.1, ", "[0.2, ", "the values"),
        ("seeds: [7, 3]", "seeds: [7]", "the seeds"),
        ("horizon: 20", "horizon: 20\nstarts: [rest]", "the starts"),
    ] {
        let other = plan(&GRID.replace(from, to));
        let error = Directory::create(folder.path(), &other).unwrap_err().to_string();
        assert!(error.contains("another plan") && error.contains(said), "{to}: {error}");
    }
    let error = directory
        .belongs_to("flexdrill 0.3.0", "fused")
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("flexdrill 0.2.0 (fused arithmetic)") && error.contains("not mixed"),
        "{error}"
    );
    directory.belongs_to("flexdrill 0.2.0", "portable").unwrap_err();
    directory.belongs_to("flexdrill 0.2.0", "fused").unwrap();
    let after: Vec<_> = files(folder.path())
        .iter()
        .map(|file| std::fs::read(file).unwrap())
        .collect();
    assert_eq!(before, after);
}

#[test]
fn two_plans_at_the_same_time_leave_one() {
    for _ in 0..20 {
        let folder = tempfile::tempdir().unwrap();
        let plans = [plan(GRID), plan(&GRID.replace("horizon: 20", "horizon: 30"))];
        let made = std::thread::scope(|scope| {
            let workers = plans
                .each_ref()
                .map(|plan| scope.spawn(|| Directory::create(folder.path(), plan).is_ok()));
            workers.map(|worker| worker.join().unwrap())
        });
        assert_eq!(made.iter().filter(|made| **made).count(), 1, "{made:?}");
        let there = Directory::open(folder.path()).unwrap();
        let horizon = if made[0] { 20.0 } else { 30.0 };
        assert_eq!(there.plan().runs.horizon, horizon);
        assert_eq!(files(folder.path()).len(), 1);
    }
}

#[test]
fn damaged_points_are_named_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    work(&directory, &all(&directory), 1).unwrap();
    let file = |number: usize| directory.file(&directory.points()[number]);
    let good = std::fs::read(file(0)).unwrap();
    let flipped = |at: usize| {
        let mut bytes = good.clone();
        bytes[at] ^= 1;
        bytes
    };
    for bytes in [
        vec![],
        good[..good.len() - 1].to_vec(),
        flipped(10),
        flipped(good.len() - 5),
        vec![b'x'; 1 << 19],
    ] {
        std::fs::write(file(0), &bytes).unwrap();
        assert!(matches!(
            directory.find(&directory.points()[0]).unwrap(),
            Found::Damaged(_)
        ));
    }
    // The result of another point under this one's name.
    std::fs::copy(file(1), file(0)).unwrap();
    std::fs::remove_file(file(2)).unwrap();
    let error = work(&directory, &all(&directory), 2).unwrap_err().to_string();
    assert!(error.contains(&file(0).display().to_string()), "{error}");
    assert!(
        error.contains("the result of another point") && error.contains("left alone"),
        "{error}"
    );
    // The others were computed, and the file is as it was.
    assert!(directory.has_file(&directory.points()[2]));
    assert_eq!(std::fs::read(file(0)).unwrap(), std::fs::read(file(1)).unwrap());
    let status = directory.status().unwrap();
    assert_eq!((status.done, status.damaged.len(), status.missing()), (39, 1, 0));
    assert!(directory.collect(true).unwrap_err().to_string().contains("damaged"));
    std::fs::remove_file(file(0)).unwrap();
    assert_eq!(work(&directory, &all(&directory), 1).unwrap(), 1);
    assert_eq!(std::fs::read(file(0)).unwrap(), good);
    // What killed workers leave, and what is no point, is counted and not read.
    std::fs::write(file(0).parent().unwrap().join(".part-abc"), "{").unwrap();
    std::fs::write(file(0).parent().unwrap().join("else.jsonl"), "{").unwrap();
    let status = directory.status().unwrap();
    assert_eq!((status.done, status.unfinished, status.foreign), (40, 1, 1));
    directory.collect(false).unwrap();
}

/// Another user of a shared directory may have put them there.
#[test]
fn pipes_and_links_are_named_and_not_followed() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    work(&directory, &all(&directory), 1).unwrap();
    let file = |number: usize| directory.file(&directory.points()[number]);
    std::fs::remove_file(file(0)).unwrap();
    let made = std::process::Command::new("mkfifo").arg(file(0)).status().unwrap();
    assert!(made.success());
    std::fs::rename(file(1), elsewhere.path().join("result")).unwrap();
    symlink(elsewhere.path().join("result"), file(1)).unwrap();
    let status = directory.status().unwrap();
    let damaged: Vec<String> = status.damaged.iter().map(|(_, damage)| damage.to_string()).collect();
    assert_eq!(damaged, ["it is no regular file"; 2]);
    assert!(directory.collect(true).is_err());
    assert!(work(&directory, &all(&directory), 1).is_err());
    // A plan that is a pipe does not hang either.
    let other = tempfile::tempdir().unwrap();
    let pipe = other.path().join(PLAN);
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    assert!(Directory::open(other.path()).is_err());
    // All results elsewhere.
    std::fs::rename(folder.path().join("points"), elsewhere.path().join("points")).unwrap();
    symlink(elsewhere.path().join("points"), folder.path().join("points")).unwrap();
    for refused in [
        directory.status().err(),
        directory.collect(true).err(),
        work(&directory, &all(&directory), 1).err(),
        directory
            .put(&directory.points()[0], &made_up(&directory.points()[0]))
            .err(),
    ] {
        let text = refused.unwrap().to_string();
        assert!(text.contains("points: is a link"), "{text}");
    }
}

#[test]
fn a_foreign_failure_is_text_in_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    let point = &directory.points()[0];
    let mut outcome = made_up(point);
    outcome.failure = "=HYPERLINK(\"http://x\")\x1b[2J\u{202e}".to_owned();
    directory.put(point, &outcome).unwrap();
    let table = String::from_utf8(directory.collect(true).unwrap()).unwrap();
    assert!(
        table.contains("'=HYPERLINK") && table.contains("\\u{1b}[2J\\u{202e}"),
        "{table}"
    );
    assert!(!table.contains(['\x1b', '\u{202e}']));
}

#[test]
fn a_disk_that_refuses_a_write_costs_no_result() {
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    work(&directory, &[0, 1, 2, 3], 1).unwrap();
    // A file where a folder of points must be.
    let blocked = directory
        .points()
        .iter()
        .find(|point| !directory.file(point).parent().unwrap().exists())
        .unwrap();
    std::fs::write(directory.file(blocked).parent().unwrap(), "").unwrap();
    let error = work(&directory, &all(&directory), 2).unwrap_err().to_string();
    assert!(error.contains("cannot be"), "{error}");
    std::fs::remove_file(directory.file(blocked).parent().unwrap()).unwrap();
    work(&directory, &all(&directory), 2).unwrap();
    assert_eq!(directory.status().unwrap().done, 40);
}

#[test]
fn damaged_plans_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let error = Directory::open(folder.path()).unwrap_err().to_string();
    assert!(error.contains("no sweep") && error.contains("sweep plan"), "{error}");
    let path = folder.path().join(PLAN);
    let good = serde_json::to_value(plan(GRID)).unwrap();
    for (pointer, value, said) in [
        ("/format", serde_json::json!(9), "format 9; this program reads format 2"),
        (
            "/runs/horizon",
            serde_json::json!(1e9),
            "horizon = 1000000000: must be 10 to 600 s",
        ),
        ("/runs/members", serde_json::json!(0), "members = 0: must be 1 to 200"),
        ("/rows/3", serde_json::json!([1.0]), "2 values each, one per key"),
        ("/starts", serde_json::json!(["rest", "rest"]), "starts = "),
        ("/seeds", serde_json::json!([]), "seeds = []"),
        ("/keys", serde_json::json!(["a", "a"]), "keys = a: must be given once"),
        (
            "/seeds",
            serde_json::json!((0..20_000).collect::<Vec<u64>>()),
            "points = 400000: must be 1 to 200000",
        ),
    ] {
        let mut tree = good.clone();
        *tree.pointer_mut(pointer).unwrap() = value;
        std::fs::write(&path, tree.to_string()).unwrap();
        let error = Directory::open(folder.path()).unwrap_err().to_string();
        assert!(error.contains(PLAN) && error.contains(said), "{pointer}: {error}");
    }
    for text in ["", "{", "[]", "{\"format\": 2}"] {
        std::fs::write(&path, text).unwrap();
        let error = Directory::open(folder.path()).unwrap_err().to_string();
        assert!(error.contains("not the plan of a sweep, or damaged"), "{error}");
    }
}

#[test]
fn a_point_is_named_by_all_that_determines_it() {
    let base = plan(GRID);
    let ids = |plan: &Plan| plan.points().into_iter().map(|point| point.id).collect::<Vec<_>>();
    let first = ids(&base);
    let mut unique = first.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), 40);
    let changed = |change: &dyn Fn(&mut Plan)| {
        let mut plan = base.clone();
        change(&mut plan);
        ids(&plan)
    };
    for (what, other) in [
        ("program", changed(&|plan| plan.runs.program.push('1'))),
        (
            "arithmetic",
            changed(&|plan| plan.runs.arithmetic = "portable".to_owned()),
        ),
        ("configuration", changed(&|plan| plan.runs.hash = "1".repeat(64))),
        ("horizon", changed(&|plan| plan.runs.horizon = 20.000_000_1)),
        ("members", changed(&|plan| plan.runs.members = 4)),
        ("run_all", changed(&|plan| plan.runs.run_all = true)),
        (
            "fast",
            changed(&|plan| {
                plan.runs.fast = Some(Fast {
                    first_alarm: Priority::Low,
                    calm_after: 20.0,
                    turns: 3,
                });
            }),
        ),
        ("plausible", changed(&|plan| plan.runs.plausible = true)),
    ] {
        assert!(first.iter().all(|id| !other.contains(id)), "{what}");
    }
    // What a start from rest does not need does not change it.
    let other = changed(&|plan| plan.runs.running.time = 11.0);
    for ((a, b), point) in first.iter().zip(&other).zip(base.points()) {
        assert_eq!(a == b, point.start == Start::Rest);
    }
}

#[test]
fn specifications_are_refused_with_file_line_key_and_bound() {
    for (text, said) in [
        ("horizon: 20\n", "configuration"),
        (
            "configuration: a\nhorizon: 5\ngrid: {a.b: [1]}\n",
            "spec.yaml:2: horizon = 5 s: must be",
        ),
        ("configuration: a\nmembers: 500\ngrid: {a.b: [1]}\n", "members = 500"),
        ("configuration: a\n", "exactly one of them"),
        (
            "configuration: a\ngrid: {a.b: [1]}\nlist: [{a.b: 1}]\n",
            "exactly one of them",
        ),
        (
            "configuration: a\ngrid: {a.b: {from: 1, to: 0, count: 3}}\n",
            "from a smaller to a larger",
        ),
        (
            "configuration: a\ngrid: {a.b: {from: 1, to: 2, count: 3, by: 1}}\n",
            "of `from`, `to` and `count` only",
        ),
        ("configuration: a\ngrid: {a.b: [[1]]}\n", "grid.a.b"),
        (
            "configuration: a\nlist: [{a.b: 1}, {a.c: 1}]\n",
            "of the same keys as the first point",
        ),
        (
            "configuration: a\nlatin_hypercube: {points: 3, ranges: {a.b: [2, 1]}}\n",
            "two numbers, the smaller first",
        ),
        (
            "configuration: a\nlatin_hypercube: {points: 0, ranges: {a.b: [1, 2]}}\n",
            "latin_hypercube.points = 0",
        ),
        (
            "configuration: a\ngrid: {a: {from: 0, to: 1, count: 1000}, b: {from: 0, to: 1, count: 1000}}\n",
            "at most 200000",
        ),
        ("configuration: a\nspeed: 3\n", "spec.yaml:2"),
        ("configuration: a\nstarts: [sliding]\ngrid: {a.b: [1]}\n", "spec.yaml:2"),
    ] {
        let error = Spec::from_text("spec.yaml", text).unwrap_err().to_string();
        assert!(error.contains(said), "{text}{error}");
    }
    for (from, to, said) in [
        ("to: 120", "to: 130", "row 9 of the values"),
        (
            "contact.inner.friction_tangential",
            "contact.inner.friction",
            "row 1 of the values",
        ),
        ("[0.1, ", "[-0.1, ", "contact.inner.friction_tangential = -0.1"),
        (
            "horizon: 20",
            "horizon: 20\nrunning: {rpm: 200}",
            "running.rpm = 200: must be within inputs.rotary_speed",
        ),
    ] {
        let spec = Spec::from_text("spec.yaml", &GRID.replace(from, to)).unwrap();
        let error = spec
            .plan_for("spec.yaml", &config(), &program())
            .unwrap_err()
            .to_string();
        assert!(error.contains(said), "{to}: {error}");
    }
}

#[test]
fn lists_and_hypercubes_give_the_values() {
    let list =
        plan("configuration: a\nlist:\n- {tool.links: 20, rock.law: paper}\n- {rock.law: paper, tool.links: 30}\n");
    assert_eq!(
        serde_json::to_string(&list.rows).unwrap(),
        r#"[[20,"paper"],[30,"paper"]]"#
    );
    let text = "configuration: a\nlatin_hypercube:\n  points: 50\n  seed: 4\n  ranges:\n    \
                contact.inner.friction_tangential: [0.1, 0.6]\n    tool.links: [20, 40]\n";
    let cube = plan(text);
    assert_eq!(cube.rows, plan(text).rows);
    assert_ne!(cube.rows, plan(&text.replace("seed: 4", "seed: 5")).rows);
    // One value in each fiftieth of the range; links are whole.
    let mut parts: Vec<usize> = cube
        .rows
        .iter()
        .map(|row| ((row[0].as_f64().unwrap() - 0.1) / 0.01).floor() as usize)
        .collect();
    parts.sort_unstable();
    assert_eq!(parts, (0..50).collect::<Vec<_>>());
    assert!(
        cube.rows
            .iter()
            .all(|row| (20..=40).contains(&row[1].as_u64().unwrap()))
    );
}
