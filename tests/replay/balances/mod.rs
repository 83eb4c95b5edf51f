//! Balances of the whole tool, by `tests/python/balances.py` from published messages alone: of every shipped
//! configuration, and of a covering array of the switches of the physics. What is on together is right together.
//!
//! FLEXDRILL_BALANCES_LONG=1 runs every row three times as long and with half of the step.

mod covering;
mod invariances;
mod tool;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::Value;

use crate::common::{python, root};
use covering::{EXCLUDED, FACTORS, ROCK, Row};
use tool::{Variant, WEIGHT, yaml};

/// A part of a run with constant inputs: seconds, speed (r/min), weight on bit (kN), standpipe pressure (MPa).
pub type Phase = (u32, f64, f64, f64);

/// Longer by this factor, and at half the step, where it is asked for.
fn is_long() -> bool {
    std::env::var_os("FLEXDRILL_BALANCES_LONG").is_some_and(|value| value == "1")
}

/// Records a run of `config` through `phases` into a bag. The error is what the program says.
pub fn record(folder: &Path, name: &str, config: &str, phases: &[Phase]) -> Result<PathBuf, String> {
    let file = |ending: &str| folder.join(format!("{name}{ending}"));
    let mut log = "time_s,rpm,wob_kn,pressure_mpa\n".to_owned();
    let mut second = 0;
    for &(seconds, rpm, weight, pressure) in phases {
        for _ in 0..seconds {
            log += &format!("{second},{rpm},{weight},{pressure}\n");
            second += 1;
        }
    }
    std::fs::write(file(".csv"), log).unwrap();
    std::fs::write(file(".yaml"), config).unwrap();
    let mapping = file("_mapping.yaml");
    std::fs::write(
        &mapping,
        "title: made\ncolumns:\n  time: {column: time_s, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit: {direct: {column: wob_kn, unit: kN}}\n  standpipe_pressure: {column: pressure_mpa, unit: MPa}\n",
    )
    .unwrap();
    let bag = file("");
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("replay")
        .arg(file(".csv"))
        .arg("--mapping")
        .arg(mapping)
        .arg("--config")
        .arg(file(".yaml"))
        .arg("--duration")
        .arg(second.to_string())
        .arg("--out")
        .arg(&bag)
        .output()
        .unwrap();
    if output.status.success() {
        Ok(bag)
    } else {
        Err(String::from_utf8_lossy(&output.stderr).into_owned())
    }
}

/// A violated balance, or a run that failed: what it is of, the condition, and the line.
type Violation = (String, String, String);

/// What the report of a bag says about its balances, where it finds one violated.
fn reported(bag: &Path) -> Option<String> {
    let out = bag.with_extension("report");
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(["report".as_ref(), bag, "--out".as_ref(), &out])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    let found = page.split("Out of balance: ").nth(1);
    assert!(
        found.is_some() || page.contains("Every balance that was judged holds."),
        "{}",
        bag.display()
    );
    Some(found?.split("</b>").next()?.to_owned())
}

/// The balances of a bag; violated ones into `violations`. `None` without Python.
fn judge(bag: &Path, of: &str, least: usize, violations: &Mutex<Vec<Violation>>) -> Option<Value> {
    let printed = python::run_with_codes("balances.py", &[bag.to_str().unwrap(), "--json"], "", &[0, 1])?;
    let judged: Value = serde_json::from_str(&printed).unwrap();
    let windows = judged["windows"].as_array().unwrap();
    assert!(
        windows.len() >= least,
        "{of}: {} of {least} conditions were judged",
        windows.len()
    );
    if let Some(line) = reported(bag) {
        violations
            .lock()
            .unwrap()
            .push((of.to_owned(), "report".to_owned(), line));
    }
    for window in windows {
        let condition = window["condition"].as_str().unwrap();
        for balance in window["balances"].as_array().unwrap() {
            if balance["violated"] == true {
                let line = format!(
                    "{}: {} of {} {}, limit {} ({})",
                    balance["name"],
                    balance["residual"],
                    balance["scale"],
                    balance["unit"],
                    balance["limit"],
                    balance["reason"]
                );
                violations
                    .lock()
                    .unwrap()
                    .push((of.to_owned(), condition.to_owned(), line));
            }
        }
    }
    Some(judged)
}

/// The largest residual of each balance over its limit, for the documents.
fn print_largest(of: &str, judged: &Value) {
    let mut largest: std::collections::BTreeMap<String, (f64, String)> = std::collections::BTreeMap::new();
    for window in judged["windows"].as_array().unwrap() {
        for balance in window["balances"].as_array().unwrap() {
            let (Some(residual), Some(limit)) = (balance["residual"].as_f64(), balance["limit"].as_f64()) else {
                continue;
            };
            let share = residual.abs() / limit;
            let entry = largest.entry(balance["name"].as_str().unwrap().to_owned()).or_default();
            if share >= entry.0 {
                let line = format!(
                    "{residual:.3e} {}, limit {limit:.3e}, {}",
                    balance["unit"], window["condition"]
                );
                *entry = (share, line);
            }
        }
    }
    for (name, (share, line)) in largest {
        println!("{of} | {name} | {share:.2} | {line}");
    }
}

/// Runs `work` on the numbers below `count`, on as many threads as there are processors.
fn spread(count: usize, work: impl Fn(usize) + Sync) {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads.min(count) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        return;
                    }
                    work(index);
                }
            });
        }
    });
}

fn check(violations: Mutex<Vec<Violation>>) {
    let violations = violations.into_inner().unwrap();
    for (of, condition, line) in &violations {
        println!("VIOLATED {of} | {condition} | {line}");
    }
    assert!(violations.is_empty(), "{} balances are violated", violations.len());
}

/// Standing, drilling, drilling with the pump on, lifted, and reversed.
fn conditions(row: &Row) -> Vec<Phase> {
    let weight = WEIGHT / 1e3;
    let times = if is_long() { 3 } else { 1 };
    // A hoist needs eight of its response times, 1 s, to settle.
    let more = if row[ROCK] == 2 { 8 } else { 0 };
    let of = |seconds: u32| 3 * times + seconds + more;
    vec![
        (of(3), 0.0, weight, 0.0),
        (of(5), 50.0, weight, 0.0),
        (of(4), 50.0, weight, 2.0),
        (of(4), 50.0, 0.0, 2.0),
        (of(6), -50.0, weight, 0.0),
    ]
}

#[test]
fn every_pair_of_switches_balances_in_every_condition() {
    if python::with("rosbags").is_none() {
        return;
    }
    let rows = covering::rows();
    let violations = Mutex::new(Vec::new());
    let failed = Mutex::new(Vec::new());
    spread(rows.len(), |index| {
        let row = &rows[index];
        let of = format!("row {index} ({})", covering::name(row));
        let folder = tempfile::tempdir().unwrap();
        let mut config = yaml(row, &Variant::default());
        if is_long() {
            config = config.replace("solver: {step: fixed}", "solver: {step: fixed, time_step: 0.00025}");
        }
        match record(folder.path(), "run", &config, &conditions(row)) {
            Ok(bag) => {
                if let Some(judged) = judge(&bag, &of, 4, &violations) {
                    print_largest(&of, &judged);
                }
            }
            Err(said) => failed.lock().unwrap().push(format!("{of}: {said}")),
        }
    });
    let failed = failed.into_inner().unwrap();
    failed.iter().for_each(|line| println!("FAILED {line}"));
    assert!(failed.is_empty(), "{} rows did not run", failed.len());
    check(violations);
}

#[test]
fn every_shipped_configuration_balances() {
    if python::with("rosbags").is_none() {
        return;
    }
    let mut files: Vec<PathBuf> = std::fs::read_dir(root().join("config"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "yaml"))
        .collect();
    files.sort();
    assert!(files.len() >= 4, "{files:?}");
    let violations = Mutex::new(Vec::new());
    spread(files.len(), |index| {
        let of = files[index].file_name().unwrap().to_str().unwrap();
        let config = std::fs::read_to_string(&files[index]).unwrap();
        // The hoist of the rig's tool needs eight response times of 4 s.
        let more = if of == "rig.yaml" { 34 } else { 0 };
        let phases = [
            (8 + more, 0.0, 10.0, 0.0),
            (12 + more, 40.0, 10.0, 0.0),
            (10 + more, 40.0, 0.0, 0.0),
        ];
        let folder = tempfile::tempdir().unwrap();
        let bag = record(folder.path(), "run", &config, &phases).unwrap_or_else(|said| panic!("{of}: {said}"));
        if let Some(judged) = judge(&bag, of, 3, &violations) {
            print_largest(of, &judged);
        }
    });
    check(violations);
}

/// What the array leaves out is what the program refuses.
#[test]
fn every_excluded_pair_is_refused() {
    let base: Row = [0; FACTORS.len()];
    for ((a, x), (b, y), why) in EXCLUDED {
        let mut row = base;
        // A held end needs a tied guide and the reverse, except in the pairs that are about this.
        (row[a], row[b]) = (x, y);
        if row[ROCK] == 2 && a != covering::STRING {
            row[covering::STRING] = 1;
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("row.yaml");
        std::fs::write(&path, yaml(&row, &Variant::default())).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
            .arg("check")
            .arg(&path)
            .output()
            .unwrap();
        let accepted = output.status.success();
        // A film without mud cannot be written: it is a key of the mud.
        let cannot_be_written = (a, b) == (covering::MUD, covering::FILM);
        assert!(
            !accepted || cannot_be_written,
            "{} {} with {} {} is accepted, and the array leaves it out because {why}",
            FACTORS[a].name,
            FACTORS[a].levels[x],
            FACTORS[b].name,
            FACTORS[b].levels[y]
        );
    }
}
