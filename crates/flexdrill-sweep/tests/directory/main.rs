//! A sweep's directory: the same table whoever filled it and however often they were stopped; what is damaged, of another
//! plan or of another program is named and left alone.
//!
//! The results are made up from the point's name: the mechanics are tested with the program.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod damaged;
mod specification;

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
